"""Commands with a hand at the controls: drive."""

from pathlib import Path
from typing import Annotated

import typer

from humanwalk.cli.changes import Changes, option_overrides, takes_changes
from humanwalk.cli.common import SIMULATE, CheckpointOption, ScenarioArgument, app, console
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD

DURATION = 300.0
"""Longest driven walk unless --duration is given, or --set duration [s]."""


@app.command(
    rich_help_panel=SIMULATE,
    epilog="Examples: humanwalk drive  |  humanwalk drive stand --mass 55  |  humanwalk drive thesis -o runs/pushed",
)
@takes_changes
def drive(
    changes: Changes,
    scenario: ScenarioArgument = "walk",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the run; new or empty. Default: runs/drive.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help=f"Longest simulated time of a walk [s]. Default: {DURATION:g}.")
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the page; 0 for a free one.")] = 0,
    record: Annotated[bool, typer.Option(help="Save the walks; the page can change it.")] = True,
    replay: Annotated[bool, typer.Option(help="Write replay.html.")] = True,
    plots: Annotated[bool, typer.Option(help="Write the plots.")] = False,
    checkpoint: CheckpointOption = CHECKPOINT_PERIOD,
) -> None:
    """Drive a walker in the browser, in real time: steer it, push it, pause; every walk becomes a run.

    Arrow keys or W and S: forward speed and turning; A and D: sideways; numeric keypad: pushes; space: pause; N: one
    frame; R: reset. Ctrl-C in this terminal saves and ends.
    """
    from humanwalk.cli.drive import drive_and_write

    options = option_overrides(changes.set_, {"duration": duration})
    overrides = {"duration": str(DURATION)} | changes.overrides(scenario) | options
    drive_and_write(
        scenario,
        overrides,
        output,
        browser=browser,
        port=port,
        record=record,
        replay=replay,
        plots=plots,
        console=console,
        checkpoint_period=checkpoint,
    )
