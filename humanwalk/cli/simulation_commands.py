"""Commands that simulate: walk, reproduce, scenarios."""

from pathlib import Path
from typing import Annotated

import typer

from humanwalk.cli.changes import Changes, option_overrides, takes_changes
from humanwalk.cli.common import (
    DIFFERS,
    FELL,
    INTERRUPTED,
    SIMULATE,
    CheckpointOption,
    ScenarioArgument,
    app,
    console,
    require_look,
    simulated_progress,
    stdout,
)
from humanwalk.measures import ends
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD


@app.command(
    rich_help_panel=SIMULATE,
    epilog="Examples: humanwalk walk  |  humanwalk walk thesis --duration 5 -o runs/short  |  "
    'humanwalk walk walk --speed 1.2 --push "40 N s at 8 s from behind"  |  '
    "humanwalk walk thesis --set controller.thesis.gait.path.step_height=0.12 --set contact=hydroelastic",
)
@takes_changes
def walk(
    changes: Changes,
    scenario: ScenarioArgument = "thesis",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the run; new or empty. Default: runs/SCENARIO.")
    ] = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s], instead of the scenario's.")] = None,
    look: Annotated[
        str | None, typer.Option(help="person or bones, instead of the scenario's; the motion is the same.")
    ] = None,
    follow: Annotated[
        Path | None, typer.Option(help="Follow the joint angles of a recording (.mot, .sto, .csv) instead of the gait.")
    ] = None,
    mapping: Annotated[
        Path | None, typer.Option(help="YAML file: which column of the recording is which joint, and its unit.")
    ] = None,
    kinematic: Annotated[bool, typer.Option("--kinematic", help="Show the recording without physics.")] = False,
    balanced: Annotated[
        bool, typer.Option("--balanced", help="Walk the recording without external force: its angles are a style.")
    ] = False,
    meshcat: Annotated[bool, typer.Option("--meshcat", help="Watch live in the browser, in real time.")] = False,
    replay: Annotated[bool, typer.Option(help="Write replay.html.")] = True,
    plots: Annotated[bool, typer.Option(help="Write the plots.")] = True,
    checkpoint: CheckpointOption = CHECKPOINT_PERIOD,
) -> None:
    """Simulate a walk and write its run folder: scenario, signals, summary, replay page and plots."""
    from humanwalk.cli.walk import balanced_overrides, file_name, follow_overrides, walk_and_write

    recorded: dict[str, str] = {}
    is_dynamic = follow is not None and not kinematic
    if balanced and not is_dynamic:
        raise ParameterError("--balanced: allowed: with --follow FILE and without --kinematic; name the recording")
    if follow is not None and balanced:
        recorded = balanced_overrides(follow, mapping, changes.subject(scenario))
    elif follow is not None:
        recorded = follow_overrides(follow, mapping, kinematic)
    elif kinematic:
        raise ParameterError("--kinematic: no recording; allowed: with --follow FILE; name the recording")
    elif mapping is not None:
        raise ParameterError(f"--mapping {mapping}: no recording; allowed: with --follow FILE; name the recording")
    overrides = changes.overrides(scenario, recorded)
    if recorded and overrides["controller"] != recorded["controller"]:
        raise ParameterError(
            f"--follow {printable(follow)}: --set controller replaces what follows the recording; allowed: one of the "
            "two; leave one out"
        )
    if look is not None:
        require_look(look)
    options = option_overrides(changes.set_, {"duration": duration, "subject.look": look})
    run = walk_and_write(
        scenario,
        overrides | options,
        output,
        name=None if follow is None else file_name(follow),
        live=meshcat,
        replay=replay,
        plots=plots,
        console=console,
        checkpoint_period=checkpoint,
    )
    end = run.summary["end"]
    if end == ends.INTERRUPTED:
        raise typer.Exit(INTERRUPTED)
    if end != ends.COMPLETED:
        raise typer.Exit(FELL)


@app.command(rich_help_panel=SIMULATE, epilog="Example: humanwalk reproduce runs/thesis")
def reproduce(run: Annotated[Path, typer.Argument(help="Folder of a run.")]) -> None:
    """Re-run and check that results match exactly, or within tolerance."""
    from humanwalk.run.folder import Run
    from humanwalk.run.reproduce import reproduce as repeat

    opened = Run.open(run)
    try:
        with simulated_progress(console) as progress:
            task = progress.add_task(f"{run} again", total=float(opened.time[-1]))
            result = repeat(opened, lambda time: progress.update(task, completed=time))
    except KeyboardInterrupt:
        console.print("interrupted; no verdict")
        raise typer.Exit(INTERRUPTED) from None
    for note in result.notes:
        console.print(note, soft_wrap=True)
    console.print(f"{run}: {result.verdict}", soft_wrap=True)
    if not result.measures_agree:
        raise typer.Exit(DIFFERS)


@app.command(
    rich_help_panel=SIMULATE,
    epilog="Examples: humanwalk scenarios  |  humanwalk scenarios --show walk > mine.yaml",
)
def scenarios(
    show: Annotated[
        str | None, typer.Option(metavar="NAME", help="Print one with all fields, to copy or change.")
    ] = None,
) -> None:
    """List the scenarios that come with humanwalk, or print one of them."""
    from rich.table import Column, Table

    from humanwalk.choices import CONTACTS
    from humanwalk.quantity import tag_of
    from humanwalk.scenario import dump_scenario, load_scenario, shipped_scenarios

    if show is not None:
        print(dump_scenario(load_scenario(show)), end="")
        return
    table = Table(Column("scenario", no_wrap=True), "duration [s]", "speed [m/s]", "contact", "description")
    for name in shipped_scenarios():
        loaded = load_scenario(name)
        table.add_row(
            name,
            f"{loaded.duration:g}",
            f"{loaded.controller.commanded_speed or 0.0:g}",
            tag_of(CONTACTS, loaded.contact),
            loaded.description,
        )
    stdout.print(table)
