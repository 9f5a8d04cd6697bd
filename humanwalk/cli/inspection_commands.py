"""Commands about models, diagrams and computational cost: model, diagram, bench."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from humanwalk.cli.changes import Changes, SetOption, overrides_of, takes_changes
from humanwalk.cli.common import (
    INSPECT,
    INTERRUPTED,
    LookOption,
    ScenarioArgument,
    app,
    console,
    counted_progress,
    require_look,
    stdout,
)
from humanwalk.quantity import ParameterError

if TYPE_CHECKING:
    from humanwalk.bench.result import BenchResult


@app.command(
    rich_help_panel=INSPECT,
    epilog="Examples: humanwalk model --mass 55 --stature 1.60 -o small.sdf  |  humanwalk model -o human.xml",
)
def model(
    output: Annotated[
        Path, typer.Option("--output", "-o", help="File to write; .sdf, .urdf, .xml (MJCF) or .osim by its suffix.")
    ],
    mass: Annotated[float, typer.Option(help="Body mass [kg].")] = 70.0,
    stature: Annotated[float, typer.Option(help="Standing height [m].")] = 1.75,
    look: LookOption = "person",
) -> None:
    """Write the human as a model: SDF or URDF for Drake, MJCF for MuJoCo, OSIM for OpenSim."""
    from humanwalk.body.model_file import write_model
    from humanwalk.body.plant import Subject
    from humanwalk.quantity import check

    require_look(look)
    subject = Subject(mass=mass, stature=stature)
    check(subject, "subject")
    write_model(output, subject.skeleton, look)  # type: ignore[arg-type]
    console.print(f"{output}: 44 bodies, 42 revolute joints, {mass:g} kg, {stature:g} m", soft_wrap=True)


@app.command(rich_help_panel=INSPECT, epilog="Example: humanwalk diagram thesis -o diagram.svg")
@takes_changes
def diagram(
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write; svg, png or pdf by its suffix.")],
    changes: Changes,
    scenario: ScenarioArgument = "thesis",
    depth: Annotated[int, typer.Option(min=0, max=5, help="Number of levels of diagrams to expand.")] = 1,
    every_port: Annotated[bool, typer.Option("--every-port", help="Also draw unconnected ports.")] = False,
) -> None:
    """Draw the block diagram of a scenario's systems."""
    from humanwalk.diagrams.walker import make_diagram
    from humanwalk.scenario import load_scenario
    from humanwalk.view.diagram_picture import draw_diagram

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
    duration: Annotated[float, typer.Option(help="Simulated time of each scenario [s].")] = 2.5,
    repeats: Annotated[int, typer.Option(min=1, help="Number of measurements of each scenario, taken by turns.")] = 2,
    json_file: Annotated[
        Path | None, typer.Option("--output", "-o", help="JSON file to write, updated after every repeat.")
    ] = None,
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
        stdout.print(comparison_table(*map(read_result, compare)))
        return
    if json_file is not None and not json_file.parent.is_dir():
        raise ParameterError(f"--output {json_file}: no such folder; allowed: a file in an existing folder; make it")
    overrides = {"duration": repr(duration)} | overrides_of(set_)
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
