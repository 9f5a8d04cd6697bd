"""Commands of studies."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from humanwalk.cli.common import BAD_INPUT, INTERRUPTED, STUDY, app, console, counted_progress, print_warnings, stdout
from humanwalk.files import require_replaceable
from humanwalk.quantity import ParameterError

if TYPE_CHECKING:
    from distributed import Client

WorkersOption = Annotated[
    int | None, typer.Option(min=1, max=1000, help="Worker processes, each with one thread. Default: one per core.")
]
SchedulerOption = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="A running Dask scheduler instead, like tcp://127.0.0.1:8786.")
]
SlurmOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Submit SLURM jobs as workers, as the YAML file describes them.")
]


class RunsByDefault(TyperGroup):
    """A group of commands whose first one is meant where none is named."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Insert the name of the first command before other arguments."""
        if args and args[0] not in self.commands and args[0] not in ctx.help_option_names:
            args = [next(iter(self.commands)), *args]
        return super().parse_args(ctx, args)


study_app = typer.Typer(
    cls=RunsByDefault, no_args_is_help=True, help="Simulate many runs that differ in factors, into one table."
)
app.add_typer(study_app, name="study", rich_help_panel=STUDY)


@study_app.command(
    epilog="Examples: humanwalk study steps.yaml -o studies/steps  |  "
    "humanwalk study steps.yaml -o studies/steps --scheduler tcp://127.0.0.1:8786  |  "
    "humanwalk study steps.yaml -o studies/part2 --shard 2/10 --slurm slurm.yaml"
)
def run(
    study: Annotated[str, typer.Argument(help="A shipped study's name, or the path of a YAML file.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the table; that of the same study resumes.")
    ],
    workers: WorkersOption = None,
    scheduler: SchedulerOption = None,
    slurm: SlurmOption = None,
    shard: Annotated[
        str, typer.Option(metavar="PART/PARTS", help="Simulate a part of the points, like 2/10; see: study join.")
    ] = "1/1",
) -> None:
    """Run a study: simulate its points on all cores, and write a row of the table as each ends. Resumes."""
    from humanwalk.run.monitor import caught_signals
    from humanwalk.study.execute import Shard, run_study
    from humanwalk.study.row import has_result
    from humanwalk.study.study import load_study
    from humanwalk.study.table import ROW

    part = Shard.parse(shard)
    loaded = load_study(study)
    with console.status("checking the points"):
        warnings = loaded.warnings
    print_warnings(warnings, console)
    with (
        caught_signals() as stopped,
        workers_client(workers, scheduler, slurm) as client,
        counted_progress("runs", estimate_period=3600.0) as progress,
    ):
        task = progress.add_task(Path(study).stem, total=part.size(loaded))
        table = run_study(
            loaded,
            output,
            client,
            on_progress=lambda done, total, row: progress.update(task, completed=done, total=total),
            should_stop=lambda: bool(stopped),
            shard=part,
        )
    rows = [row for row in table.select([ROW, "end", "survived"]).to_pylist() if part.has(row[ROW])]
    survived = sum(bool(row["survived"]) for row in rows)
    console.print(f"{output}: {len(rows)} of {part.size(loaded)} runs, {survived} survived", soft_wrap=True)
    if len(rows) < part.size(loaded):
        console.print("interrupted; the same command resumes")
        raise typer.Exit(INTERRUPTED)
    failures = [row for row in rows if not has_result(row["end"])]
    if failures:
        first = failures[0]
        console.print(f"{len(failures)} without a result; the first, row {first[ROW]}: {first['end']}", soft_wrap=True)
        raise typer.Exit(BAD_INPUT)


@study_app.command(epilog="Example: humanwalk study join studies/part1 studies/part2 -o studies/all")
def join(
    parts: Annotated[list[Path], typer.Argument(help="Folders of parts of one study; see --shard.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder of the whole table.")],
) -> None:
    """Put the rows of parts of a study into one table."""
    from humanwalk.study.table import join as join_tables

    with console.status("reading"):
        table = join_tables(parts, output)
    console.print(f"{output}: {table.num_rows} runs", soft_wrap=True)


@study_app.command(
    epilog="Examples: humanwalk study show studies/steps  |  "
    "humanwalk study show studies/steps --measure cost_of_transport --measure gait.cadence"
)
def show(
    study: Annotated[Path, typer.Argument(help="Folder of a study, finished or not.")],
    measure: Annotated[
        list[str],
        typer.Option(
            metavar="NAME", help="Measured number of the table to show instead of the usual ones; several times."
        ),
    ] = [],  # noqa: B006
    figures: Annotated[
        str | None, typer.Option(metavar="FORMAT", help="Also write the figures into its plots: png, svg or pdf.")
    ] = None,
) -> None:
    """Print survival, means and effects of the factors, and write study.html with figures into the study's folder."""
    from humanwalk.study.page import PAGE, terminal_tables, write_study_figures, write_study_page
    from humanwalk.study.results import Results
    from humanwalk.view.plots.drawing import require_format

    if figures is not None:
        require_format("--figures", figures)
    results = Results.read(study)
    require_replaceable(study / PAGE)
    measures = results.measures(measure)
    for table in terminal_tables(results, measures):
        stdout.print(table)
    with console.status("drawing"):
        written = write_study_figures(study, results, measures, figures) if figures is not None else []
        written.append(write_study_page(study, results, measures))
    for path in written:
        console.print(f"{path}", soft_wrap=True)


@contextmanager
def workers_client(workers: int | None, scheduler: str | None, slurm: Path | None = None) -> "Iterator[Client]":
    """Client of the workers that the options name.

    Raises:
        ParameterError: options that exclude each other, or a cluster that cannot be used.
    """
    from humanwalk.study.cluster import local_client, remote_client, slurm_client

    given = {"--workers": workers, "--scheduler": scheduler, "--slurm": slurm}
    if sum(value is not None for value in given.values()) > 1:
        named = ", ".join(name for name, value in given.items() if value is not None)
        raise ParameterError(f"{named}: exclude each other; allowed: one of them; remove the others")
    with ExitStack() as stack:
        with console.status("starting the workers"):
            if slurm is not None:
                cluster = slurm_client(slurm)
            elif scheduler is not None:
                cluster = remote_client(scheduler)
            else:
                cluster = local_client(workers)
            client = stack.enter_context(cluster)
        yield client
