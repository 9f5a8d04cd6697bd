"""Commands about models, diagrams and computational cost: model, diagram, bench."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from humanwalk.cli.changes import Changes, SetOption, option_overrides, overrides_of, takes_changes
from humanwalk.cli.common import (
    INSPECT,
    INTERRUPTED,
    LookOption,
    OverwriteOption,
    ScenarioArgument,
    app,
    console,
    counted_progress,
    require_look,
    stdout,
)
from humanwalk.files import require_new
from humanwalk.quantity import ParameterError, tag_of

if TYPE_CHECKING:
    from humanwalk.bench.result import BenchResult

BENCH_DURATION = 2.5
"""Simulated time of each scenario of a benchmark unless --duration is given [s]."""

BENCH_REPEATS = 2


@app.command(
    rich_help_panel=INSPECT,
    epilog="Examples: humanwalk model --mass 55 --stature 1.60 -o small.sdf  |  humanwalk model --sex female --age 8 "
    '--mass 26 --stature 1.28 --load "backpack 3 kg"  |  humanwalk model -o human.xml',
)
@takes_changes
def model(
    changes: Changes,
    scenario: ScenarioArgument = "thesis",
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write; .sdf, .urdf, .xml (MJCF) or .osim by its suffix."),
    ] = None,
    look: LookOption = "person",
    overwrite: OverwriteOption = False,
) -> None:
    """Print the segments of a scenario's subject beside the tables, and write its model.

    SDF or URDF for Drake, MJCF for MuJoCo, OSIM for OpenSim.
    """
    from humanwalk.body.devices import DEVICES
    from humanwalk.body.impairments import IMPAIRMENTS
    from humanwalk.body.loads import LOADS
    from humanwalk.body.model_file import write_model
    from humanwalk.cli.segment_table import segment_table
    from humanwalk.scenario import load_scenario

    require_look(look)
    if output is not None:
        require_new(output, overwrite)
    subject = load_scenario(scenario, changes.overrides(scenario)).subject
    skeleton = subject.skeleton
    if output is not None:
        write_model(output, skeleton, look)  # type: ignore[arg-type]
    stdout.print(segment_table(subject))
    parts = [(f"{tag_of(LOADS, load)}: {load.total:g} kg", load.known) for load in subject.loads]
    parts += [(f"impairment {tag_of(IMPAIRMENTS, part)}", part.known) for part in subject.impairments]
    parts += [(f"device {tag_of(DEVICES, part)}", part.known) for part in subject.devices]
    for text, is_known in parts:
        console.print(f"{text}, {'known' if is_known else 'unknown'} to the walker", soft_wrap=True)
    if output is not None:
        console.print(
            f"{output}: {len(skeleton.segments)} bodies, {len(skeleton.joints)} revolute joints, "
            f"{skeleton.total_mass:g} kg, {subject.stature:g} m",
            soft_wrap=True,
        )


@app.command(rich_help_panel=INSPECT, epilog="Example: humanwalk diagram thesis -o diagram.svg")
@takes_changes
def diagram(
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write; svg, png or pdf by its suffix.")],
    changes: Changes,
    scenario: ScenarioArgument = "thesis",
    depth: Annotated[int, typer.Option(min=0, max=5, help="Number of levels of diagrams to expand.")] = 1,
    every_port: Annotated[bool, typer.Option("--every-port", help="Also draw unconnected ports.")] = False,
    overwrite: OverwriteOption = False,
) -> None:
    """Draw the block diagram of a scenario's systems."""
    from humanwalk.diagrams.walker import make_diagram
    from humanwalk.scenario import load_scenario
    from humanwalk.view.diagram_picture import draw_diagram

    require_new(output, overwrite)
    draw_diagram(make_diagram(load_scenario(scenario, changes.overrides(scenario))), output, depth, every_port)
    console.print(f"{output}", soft_wrap=True)


@app.command(
    rich_help_panel=INSPECT,
    epilog="Examples: humanwalk bench thesis walk -o new.json  |  humanwalk bench --compare old.json new.json",
)
def bench(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[SCENARIO]...", help="Names or YAML files. Default: all shipped.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help=f"Simulated time of each scenario [s]. Default: {BENCH_DURATION:g}.")
    ] = None,
    repeats: Annotated[
        int, typer.Option(min=1, help="Number of measurements of each scenario, taken by turns.")
    ] = BENCH_REPEATS,
    json_file: Annotated[
        Path | None, typer.Option("--output", "-o", help="JSON file to write, updated after every repeat.")
    ] = None,
    overwrite: OverwriteOption = False,
    set_: SetOption = [],  # noqa: B006
    compare: Annotated[
        tuple[Path, Path] | None, typer.Option(metavar="OLD NEW", help="Compare two JSON files instead of measuring.")
    ] = None,
) -> None:
    """Measure the cost of scenarios: plant, solvers, other systems, logging, start-up, memory."""
    from humanwalk.bench.measure import bench as measure
    from humanwalk.bench.result import comparison_table, read_result, write_result
    from humanwalk.scenario import shipped_scenarios

    if compare is not None:
        others = {"SCENARIO": names, "-o": json_file, "--overwrite": overwrite, "--set": set_}
        others |= {"--duration": duration is not None, "--repeats": repeats != BENCH_REPEATS}
        if given := [name for name, value in others.items() if value]:
            raise ParameterError(
                f"--compare: measures nothing, and {', '.join(given)} would be ignored; allowed: two files alone; "
                "leave out the rest"
            )
        stdout.print(comparison_table(*map(read_result, compare)))
        return
    if json_file is not None:
        require_new(json_file, overwrite)
    options = option_overrides(set_, {"duration": duration})
    overrides = {"duration": str(BENCH_DURATION)} | overrides_of(set_) | options
    found: BenchResult | None = None
    with counted_progress("repeats") as progress:
        task = progress.add_task("", total=None)

        def show(name: str, done: int, total: int) -> None:
            progress.update(task, description=f"measuring {name}", completed=done, total=total)

        def keep(result: "BenchResult") -> None:
            nonlocal found
            found = result
            if json_file is not None:
                write_result(json_file, result)

        try:
            measure(names or list(shipped_scenarios()), overrides, repeats, show, keep)
        except (KeyboardInterrupt, ParameterError) as end:
            progress.stop()
            _print_result(found, json_file)
            if isinstance(end, ParameterError):
                raise
            console.print(f"interrupted; {'nothing was measured' if found is None else f'kept {found.progress}'}")
            raise typer.Exit(INTERRUPTED) from None
    _print_result(found, json_file)


def _print_result(result: "BenchResult | None", json_file: Path | None) -> None:
    from humanwalk.bench.result import cost_table, system_table

    if result is None:
        return
    stdout.print(cost_table(result), system_table(result))
    if json_file is not None:
        console.print(f"{json_file}", soft_wrap=True)
