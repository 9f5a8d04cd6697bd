"""Commands of studies."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from humanwalk.cli.common import INTERRUPTED, STUDY, app, console, counted_progress, stdout
from humanwalk.quantity import ParameterError

if TYPE_CHECKING:
    from distributed import Client

WorkersOption = Annotated[
    int | None, typer.Option(min=1, max=1000, help="Worker processes, each with one thread. Default: one per core.")
]
SchedulerOption = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="A running Dask scheduler instead, like tcp://127.0.0.1:8786.")
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
    "humanwalk study steps.yaml -o studies/steps --scheduler tcp://127.0.0.1:8786"
)
def run(
    study: Annotated[str, typer.Argument(help="A shipped study's name, or the path of a YAML file.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the table; that of the same study resumes.")
    ],
    workers: WorkersOption = None,
    scheduler: SchedulerOption = None,
) -> None:
    """Run a study: simulate its points on all cores, and write a row of the table as each ends. Resumes."""
    from humanwalk.run.monitor import caught_signals
    from humanwalk.study.execute import run_study
    from humanwalk.study.study import load_study

    loaded = load_study(study)
    with console.status(f"checking {len(loaded.points)} points"):
        loaded.require_valid()
    with (
        caught_signals() as stopped,
        workers_client(workers, scheduler) as client,
        counted_progress("runs", estimate_period=3600.0) as progress,
    ):
        task = progress.add_task(Path(study).stem, total=len(loaded.points))
        table = run_study(
            loaded,
            output,
            client,
            on_progress=lambda done, total, row: progress.update(task, completed=done, total=total),
            should_stop=lambda: bool(stopped),
        )
    survived = sum(bool(value) for value in table["survived"].to_pylist())
    console.print(f"{output}: {table.num_rows} of {len(loaded.points)} runs, {survived} survived", soft_wrap=True)
    if table.num_rows < len(loaded.points):
        console.print("interrupted; the same command resumes")
        raise typer.Exit(INTERRUPTED)


@study_app.command(
    epilog="Examples: humanwalk study show studies/steps  |  "
    "humanwalk study show studies/steps --measure cost_of_transport --measure gait.cadence"
)
def show(
    study: Annotated[Path, typer.Argument(help="Folder of a study, finished or not.")],
    measure: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="Column of the table to show instead of the usual ones; several times."),
    ] = [],  # noqa: B006
    figures: Annotated[
        str | None, typer.Option(metavar="FORMAT", help="Also write the figures into its plots: png, svg or pdf.")
    ] = None,
) -> None:
    """Print survival, means and effects of the factors, and write study.html with figures into the study's folder."""
    from humanwalk.study.page import terminal_tables, write_study_figures, write_study_page
    from humanwalk.study.results import Results

    results = Results.read(study)
    measures = results.measures(measure)
    for table in terminal_tables(results, measures):
        stdout.print(table)
    with console.status("drawing"):
        written = write_study_figures(study, results, measures, figures) if figures else []
        written.append(write_study_page(study, results, measures))
    for path in written:
        console.print(f"{path}", soft_wrap=True)


@contextmanager
def workers_client(workers: int | None, scheduler: str | None) -> "Iterator[Client]":
    """Client of the workers that the options name.

    Raises:
        ParameterError: options that exclude each other, or a scheduler that does not answer.
    """
    from humanwalk.study.cluster import local_client, remote_client

    if workers is not None and scheduler is not None:
        raise ParameterError(
            f"--workers {workers}: with --scheduler the workers are those of the scheduler; allowed: one of both; "
            "remove one"
        )
    with ExitStack() as stack:
        with console.status("starting the workers"):
            client = stack.enter_context(remote_client(scheduler) if scheduler else local_client(workers))
        yield client
