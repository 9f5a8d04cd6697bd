"""Commands of studies."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from humanwalk.cli.common import INTERRUPTED, STUDY, app, console, counted_progress
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
