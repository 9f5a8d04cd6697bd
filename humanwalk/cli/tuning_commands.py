"""Commands of tunings."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from humanwalk.cli.common import INTERRUPTED, STUDY, app, console, counted_progress, print_warnings, stdout
from humanwalk.cli.study_commands import RunsByDefault, SchedulerOption, SlurmOption, WorkersOption, workers_client
from humanwalk.files import require_replaceable

if TYPE_CHECKING:
    from humanwalk.study.row import Row

tune_app = typer.Typer(
    cls=RunsByDefault, no_args_is_help=True, help="Search for parameters of a scenario that walk better."
)
app.add_typer(tune_app, name="tune", rich_help_panel=STUDY)


@tune_app.command(
    epilog="Examples: humanwalk tune cost_of_transport -o tunings/cheap  |  humanwalk tune my.yaml -o tunings/my"
)
def run(
    tuning: Annotated[str, typer.Argument(help="A shipped tuning's name, or the path of a YAML file.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the trials; that of the same tuning resumes.")
    ],
    workers: WorkersOption = None,
    scheduler: SchedulerOption = None,
    slurm: SlurmOption = None,
) -> None:
    """Run a tuning: simulate its trials on all cores, and write a row of the table as each ends. Resumes."""
    from humanwalk.run.monitor import caught_signals
    from humanwalk.study.trials import best, number
    from humanwalk.study.tune import tune
    from humanwalk.study.tuning import load_tuning

    loaded = load_tuning(tuning)
    print_warnings(loaded.runs.warnings, console)
    done: Mapping[int, Row] = {}
    with (
        caught_signals() as stopped,
        workers_client(workers, scheduler, slurm) as client,
        counted_progress("trials", estimate_period=3600.0) as progress,
    ):
        task = progress.add_task(Path(tuning).stem, total=loaded.trials)

        def look(rows: "Mapping[int, Row]") -> None:
            nonlocal done
            done = rows
            found = best(loaded, list(rows.values()))
            state = f"best {found['trial']}, cost {number(found['cost'])}" if found else Path(tuning).stem
            progress.update(task, completed=len(rows), description=state)

        tune(loaded, output, client, on_trial=look, should_stop=lambda: bool(stopped))
    console.print(f"{output}: {len(done)} of {loaded.trials} trials", soft_wrap=True)
    found = best(loaded, list(done.values()))
    if found:
        console.print(f"best: {describe(loaded, found)}", soft_wrap=True)
    if len(done) < loaded.trials:
        console.print("interrupted; the same command resumes")
        raise typer.Exit(INTERRUPTED)
    console.print(f"show it: humanwalk tune show {output}", soft_wrap=True)


@tune_app.command(epilog="Example: humanwalk tune show tunings/cheap")
def show(folder: Annotated[Path, typer.Argument(help="Folder of a tuning, finished or not.")]) -> None:
    """Print the best trial, write it as a scenario, best.yaml, and write a page with the history of the search."""
    from rich.table import Table

    from humanwalk.study.trials import BEST, best, read_trials, write_best
    from humanwalk.study.tuning_page import PAGE, parameter_rows, value_rows, write_tuning_page

    tuning, rows = read_trials(folder)
    for name in (BEST, PAGE):
        require_replaceable(folder / name)
    found = best(tuning, rows)
    if found is not None:
        parameters = Table("parameter", "low", "start", "best", "high")
        for cells in parameter_rows(tuning, found):
            parameters.add_row(*cells)
        values = Table("measure", "start", "best", "goal")
        for cells in value_rows(tuning, rows[0], found):
            values.add_row(*cells)
        stdout.print(parameters)
        stdout.print(values)
    with console.status("drawing"):
        page = write_tuning_page(folder, tuning, rows)
    state = describe(tuning, found) if found else "no trial has walked yet"
    console.print(f"{folder}: {len(rows)} of {tuning.trials} trials; {state}; {page.name}", soft_wrap=True)
    if found is not None:
        console.print(f"walk it: humanwalk walk {write_best(folder, tuning, found)}", soft_wrap=True)


def describe(tuning: Any, row: Mapping[str, Any]) -> str:
    """A trial on one line."""
    from humanwalk.study.trials import number

    values = ", ".join(f"{name} {number(row[f'values.{name}'])}" for name in tuning.measured)
    return f"trial {row['trial']}, {values}" + ("" if row["feasible"] else " (a bound does not hold)")
