"""What the commands share: the application, consoles, exit codes, options."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import IO, Annotated, Any, cast

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    Task,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from humanwalk.cli.streams import BestEffort
from humanwalk.quantity import ParameterError, printable

# Drake, matplotlib and pyarrow are imported inside the commands: `--help` should not wait for them.

app = typer.Typer(
    help="A full-body human, 44 bodies and 42 joints, that walks in Drake.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    # Rich's markup would take a unit for a tag: [kg].
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"humanwalk {version('humanwalk')}, Drake {version('drake')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the versions and exit.")
    ] = False,
) -> None:
    pass


MAX_MESSAGE = 2000
"""Longest error message that is printed, in characters."""


class SafeConsole(Console):
    """A console for text that may come from others: control characters are escaped, and nothing is markup."""

    def __init__(self, **options: Any) -> None:
        """Make a console; see rich.console.Console."""
        super().__init__(markup=False, **options)

    def print(self, *objects: Any, **options: Any) -> None:
        """Print as Rich does; see rich.console.Console.print."""

        def safe(text: str) -> str:
            return "\n".join(printable(line, MAX_MESSAGE) for line in text.split("\n"))

        super().print(*(safe(thing) if isinstance(thing, str) else thing for thing in objects), **options)


class MessageConsole(SafeConsole):
    """A console on stderr whose failures are ignored: they would end the program, and a run be lost."""

    @property
    def file(self) -> IO[str]:
        """The stream; see `BestEffort`."""
        return cast(IO[str], BestEffort(super().file))

    @file.setter
    def file(self, new_file: IO[str]) -> None:
        super(MessageConsole, type(self)).file.__set__(self, new_file)  # type: ignore[attr-defined]


console = MessageConsole(stderr=True)
"""Progress and messages."""
stdout = SafeConsole()
"""Results, which a shell may redirect."""

BAD_INPUT = 2
FELL = 1
DIFFERS = 1
INTERRUPTED = 130

SIMULATE = "Simulate"
SHOW = "Show and analyze a run"
STUDY = "Studies: many runs"
INSPECT = "Models, diagrams and cost"

ScenarioArgument = Annotated[str, typer.Argument(help="A shipped scenario's name, or the path of a YAML file.")]
LookOption = Annotated[
    str, typer.Option(help="person, or bones: rods between the joints, their axes and the contact points.")
]

CheckpointOption = Annotated[float, typer.Option(min=0.0, help="Wall-clock seconds between checkpoints.")]

OverwriteOption = Annotated[bool, typer.Option("--overwrite", help="Replace a file that is there already.")]


MAX_WARNINGS = 5
"""Most warnings that are printed; a study of random pushes has one for each."""


def print_warnings(lines: Sequence[str], console: Console) -> None:
    """Print the first `MAX_WARNINGS` warnings, and how many more there are."""
    for line in lines[:MAX_WARNINGS]:
        console.print(f"warning: {line}", soft_wrap=True)
    if len(lines) > MAX_WARNINGS:
        console.print(f"warning: and {len(lines) - MAX_WARNINGS} more")


def require_look(look: str) -> None:
    """Raise ParameterError for an unknown look."""
    from humanwalk.body.sdf import LOOKS

    if look not in LOOKS:
        raise ParameterError(f"--look {look}: unknown; allowed: {', '.join(LOOKS)}; choose one of them")


class DescriptionColumn(TextColumn):
    """The description of a task; names in it may come from others, see `SafeConsole`."""

    def __init__(self) -> None:
        """Make a column."""
        super().__init__("{task.description}", markup=False)

    def render(self, task: Task) -> Text:
        """Return the description without control characters."""
        return Text(printable(task.description))


def simulated_progress(console: Console) -> Progress:
    """A progress bar of simulated time [s], with remaining time."""
    simulated = "{task.completed:.1f} of {task.total:g} s"
    return Progress(DescriptionColumn(), BarColumn(), simulated, TimeRemainingColumn(), console=console, transient=True)


def counted_progress(unit: str, estimate_period: float = 30.0) -> Progress:
    """A progress bar on terminals, with elapsed time, and remaining time by the last `estimate_period` [s]."""
    columns = (DescriptionColumn(), BarColumn(), MofNCompleteColumn(), f"{unit},")
    times = (TimeElapsedColumn(), "elapsed,", TimeRemainingColumn(), "remaining")
    return Progress(
        *columns,
        *times,
        console=console,
        transient=True,
        speed_estimate_period=estimate_period,
        disable=not console.is_terminal,
    )
