"""The command line: one function a command."""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from humanwalk.quantity import ParameterError

# Drake, matplotlib and pyarrow are imported inside the commands: `--help` should not wait for them.

app = typer.Typer(
    help="A full-body human, 44 bodies and 42 joints, that walks in Drake.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)


class _Console(Console):
    def on_broken_pipe(self) -> None:
        """Say no more to who has stopped to listen, and go on: rich would end the program, and a run be lost."""
        self.quiet = True
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), self.file.fileno())


# No markup: a folder may well be named [2].
console = _Console(stderr=True, markup=False)

BAD_INPUT = 2
FELL = 1
DIFFERS = 1
INTERRUPTED = 130

ScenarioArgument = Annotated[str, typer.Argument(help="A shipped scenario's name, or the path of a YAML file.")]
SetOption = Annotated[
    list[str],
    typer.Option("--set", metavar="FIELD=VALUE", help="Replace a field of the scenario; may be given several times."),
]

LookOption = Annotated[
    str, typer.Option(help="person, or bones: rods between the joints, their axes and the contact points.")
]
ViewOption = Annotated[str, typer.Option(help="follow, side (from the right), front, or orbit (around the walker).")]


@app.command(
    epilog="Examples: humanwalk walk  |  humanwalk walk thesis --duration 5 -o runs/short  |  "
    "humanwalk walk thesis --set controller.thesis.gait.path.step_height=0.12 --set contact=hydroelastic"
)
def walk(
    scenario: ScenarioArgument = "thesis",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the run; new or empty. Default: runs/SCENARIO.")
    ] = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s], instead of the scenario's.")] = None,
    set_: SetOption = [],  # noqa: B006
    look: Annotated[
        str | None, typer.Option(help="person or bones, instead of the scenario's: the same walk, another look.")
    ] = None,
    follow: Annotated[
        Path | None, typer.Option(help="Follow the joint angles of a recording (.mot, .sto, .csv) instead of the gait.")
    ] = None,
    mapping: Annotated[
        Path | None, typer.Option(help="YAML file: which column of the recording is which joint, in what unit.")
    ] = None,
    kinematic: Annotated[
        bool, typer.Option("--kinematic", help="Show the followed recording as it is, without physics.")
    ] = False,
    meshcat: Annotated[bool, typer.Option("--meshcat", help="Watch live in the browser, at true speed.")] = False,
    replay: Annotated[bool, typer.Option(help="Write replay.html.")] = True,
    plots: Annotated[bool, typer.Option(help="Write the plots.")] = True,
    checkpoint: Annotated[
        float, typer.Option(min=0.0, help="Seconds on the clock between two saves of an unfinished run.")
    ] = 60.0,
) -> None:
    """Simulate a walk and write its run folder: scenario, signals, summary, replay page and plots."""
    from humanwalk.cli.walk import follow_overrides, walk_and_write

    overrides = _overrides(set_)
    if follow is not None:
        overrides |= follow_overrides(follow, mapping, kinematic)
    elif kinematic:
        raise ParameterError("--kinematic: is for a recording; allowed: with --follow FILE; name the recording")
    elif mapping is not None:
        raise ParameterError(
            f"--mapping {mapping}: is for a recording; allowed: with --follow FILE; name the recording"
        )
    if duration is not None:
        overrides["duration"] = repr(duration)
    if look is not None:
        _require_look(look)
        overrides["subject.look"] = look
    run = walk_and_write(
        scenario,
        overrides,
        output,
        live=meshcat,
        replay=replay,
        plots=plots,
        console=console,
        checkpoint_period=checkpoint,
    )
    end = run.summary["end"]
    if end == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if end != "completed":
        raise typer.Exit(FELL)


@app.command(epilog="Example: humanwalk replay runs/thesis")
def replay(
    run: Annotated[Path, typer.Argument(help="Folder of a run.")],
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
) -> None:
    """Serve the replay of a run on this machine only, and open it in the browser."""
    from humanwalk.view.serve import serve_replay

    serve_replay(run, open_browser=browser, console=console)


@app.command(
    epilog="Examples: humanwalk video runs/thesis -o walk.mp4  |  "
    "humanwalk video runs/thesis -o slow.webp --speed 0.25 --to 2"
)
def video(
    run: Annotated[Path, typer.Argument(help="Folder of a run.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Video to write; mp4, gif or webp by its suffix.")],
    fps: Annotated[float, typer.Option(help="Frames per second of the video.")] = 30.0,
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Of the picture, in pixels.")] = "1280x720",
    view: ViewOption = "follow",
    speed: Annotated[float, typer.Option(help="Seconds of walking per second of video.")] = 1.0,
    from_: Annotated[float, typer.Option("--from", help="Begin at this time of the run [s].")] = 0.0,
    to: Annotated[float | None, typer.Option(help="End at this time of the run [s]. Default: its end.")] = None,
) -> None:
    """Record the replay of a run as a video, frame by frame, in a browser without a window."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from humanwalk.view.video import VideoParameters, parse_size, record_video

    width, height = parse_size(size)
    parameters = VideoParameters(fps, speed, width, height, view, from_, to)  # type: ignore[arg-type]
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("frames"))
    with Progress(*columns, TimeRemainingColumn(), console=console, transient=True) as progress:
        task = progress.add_task("starting the browser", total=None)

        def show(done: int, frames: int) -> None:
            what = "drawing" if done < frames else "encoding"
            progress.update(task, description=what, completed=done, total=frames)

        try:
            frames = record_video(run, output, parameters, show)
        except KeyboardInterrupt:
            progress.stop()
            console.print("interrupted; nothing was written")
            raise typer.Exit(INTERRUPTED) from None
    console.print(f"{output}: {frames} frames, {frames / fps:.2f} s", soft_wrap=True)


@app.command(epilog="Example: humanwalk snapshot runs/thesis --times 3.0,3.1,3.2,3.3 -o strip.png --view side")
def snapshot(
    run: Annotated[Path, typer.Argument(help="Folder of a run.")],
    times: Annotated[str, typer.Option(help="Instants [s], with commas between.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="PNG picture to write.")],
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Of one still, in pixels.")] = "320x480",
    view: ViewOption = "side",
) -> None:
    """Draw instants of a run side by side."""
    from humanwalk.view.video import parse_size, parse_times, write_snapshot

    write_snapshot(run, output, parse_times(times), *parse_size(size), view)  # type: ignore[arg-type]
    console.print(f"{output}", soft_wrap=True)


@app.command(epilog="Example: humanwalk plot runs/thesis --only figure_5_08 --only support --format pdf")
def plot(
    run: Annotated[Path, typer.Argument(help="Folder of a run.")],
    only: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="Plot to write, or how its name begins; may be given several times."),
    ] = [],  # noqa: B006
    format_: Annotated[str, typer.Option("--format", help="png, svg or pdf.")] = "png",
) -> None:
    """Write the plots of a run again, or some of them, or in another format."""
    from humanwalk.run.folder import Run
    from humanwalk.view.plots import write_plots

    written = write_plots(Run.open(run), only, format_)
    for path in written:
        console.print(f"{path}", soft_wrap=True)
    if not written:
        console.print(f"{run}: nothing to draw of what was asked for", soft_wrap=True)


@app.command(epilog="Examples: humanwalk report runs/walk  |  humanwalk report runs/walk --json > walk.json")
def report(
    run: Annotated[Path, typer.Argument(help="Folder of a run that walks straight ahead.")],
    json_: Annotated[
        bool, typer.Option("--json", help="Print the numbers of every stride instead of the tables; write no page.")
    ] = False,
) -> None:
    """Compare a run with people, stride by stride, and write report.html into its folder."""
    import json

    from humanwalk.run.folder import Run
    from humanwalk.view.report import compare_run, terminal_tables, to_json, write_report

    opened = Run.open(run)
    comparison = compare_run(opened)
    if json_:
        print(json.dumps(to_json(comparison), indent=2, allow_nan=False))
        return
    path = write_report(opened, comparison)
    for table in terminal_tables(comparison):
        Console(markup=False).print(table)
    console.print(f"{path}", soft_wrap=True)


@app.command(
    epilog="Examples: humanwalk export runs/thesis --to opensim  |  humanwalk export runs/thesis --to c3d -o lab"
)
def export(
    run: Annotated[Path, typer.Argument(help="Folder of a run.")],
    to: Annotated[str, typer.Option("--to", help="opensim, c3d, csv or mat.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Folder to write into. Default: the format's name in the run's."),
    ] = None,
) -> None:
    """Write a run for another program: OpenSim, motion-capture software, a spreadsheet, MATLAB."""
    from humanwalk.exchange import export_run
    from humanwalk.run.folder import Run

    for path in export_run(Run.open(run), to, output):
        console.print(f"{path}", soft_wrap=True)


@app.command(epilog="Example: humanwalk reproduce runs/thesis")
def reproduce(run: Annotated[Path, typer.Argument(help="Folder of a run.")]) -> None:
    """Simulate a run again, and say whether its bits, or else its measures, come out the same."""
    from humanwalk.run.folder import Run
    from humanwalk.run.reproduce import reproduce as repeat

    opened = Run.open(run)
    with console.status(f"simulating {opened.time[-1]:g} s again"):
        result = repeat(opened)
    for note in result.notes:
        console.print(note, soft_wrap=True)
    console.print(f"{run}: {result.verdict}", soft_wrap=True)
    if not result.measures_agree:
        raise typer.Exit(DIFFERS)


@app.command(epilog="Examples: humanwalk bench thesis walk -o new.json  |  humanwalk bench --compare old.json new.json")
def bench(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[SCENARIO]...", help="Names or YAML files. Default: all shipped.")
    ] = None,
    duration: Annotated[float, typer.Option(help="Simulated time of each [s].")] = 2.5,
    repeats: Annotated[int, typer.Option(min=1, help="How often each is measured, in turn with the others.")] = 2,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="JSON file, written anew after every repeat.")
    ] = None,
    set_: SetOption = [],  # noqa: B006
    compare: Annotated[
        tuple[Path, Path] | None, typer.Option(metavar="OLD NEW", help="Measure nothing, compare two files of -o.")
    ] = None,
) -> None:
    """Measure what scenarios cost: plant, solvers, other systems, logging, start-up, memory."""
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    from humanwalk.bench import BenchResult, read_result, write_result
    from humanwalk.bench import bench as measure
    from humanwalk.bench.tables import comparison_table, cost_table, system_table
    from humanwalk.scenario import shipped_scenarios

    if compare is not None:
        old, new = map(read_result, compare)
        Console().print(comparison_table(old, new))
        return
    if output is not None and not output.parent.is_dir():
        # Said now, not after the measuring.
        raise ParameterError(f"--output {output}: no such folder; allowed: a file in a folder that exists; make it")
    overrides = {"duration": repr(duration)} | _overrides(set_)
    found: BenchResult | None = None
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("repeats,"))
    times = (TimeElapsedColumn(), TextColumn("gone,"), TimeRemainingColumn(), TextColumn("to go"))

    def tell() -> None:
        if found is None:
            return
        Console().print(cost_table(found), system_table(found))
        if output is not None:
            console.print(f"{output}", soft_wrap=True)

    with Progress(*columns, *times, console=console, transient=True) as progress:
        task = progress.add_task("", total=None)

        def show(name: str, done: int, todo: int) -> None:
            progress.update(task, description=f"measuring {name}", completed=done, total=todo)

        def keep(result: BenchResult) -> None:
            nonlocal found
            found = result
            if output is not None:
                write_result(output, result)

        try:
            measure(names or list(shipped_scenarios()), overrides, repeats, show, keep)
        except (KeyboardInterrupt, ParameterError) as end:
            progress.stop()
            tell()
            if isinstance(end, ParameterError):
                raise
            console.print(f"interrupted; {'nothing was measured' if found is None else f'kept {found.progress}'}")
            raise typer.Exit(INTERRUPTED) from None
    tell()


@app.command()
def scenarios() -> None:
    """List the scenarios that come with humanwalk."""
    from rich.table import Table

    from humanwalk.choices import CONTACTS
    from humanwalk.quantity import tag_of
    from humanwalk.scenario import load_scenario, shipped_scenarios

    table = Table("scenario", "duration [s]", "speed [m/s]", "contact", "what it is")
    for name in shipped_scenarios():
        loaded = load_scenario(name)
        table.add_row(
            name,
            f"{loaded.duration:g}",
            f"{loaded.controller.commanded_speed or 0.0:g}",
            tag_of(CONTACTS, loaded.contact),
            loaded.description,
        )
    Console().print(table)


@app.command(epilog="Examples: humanwalk model --mass 55 --stature 1.60 -o small.sdf  |  humanwalk model -o human.xml")
def model(
    output: Annotated[Path, typer.Option("--output", "-o", help="SDF file to write, or MJCF where it ends on .xml.")],
    mass: Annotated[float, typer.Option(help="Body mass [kg].")] = 70.0,
    stature: Annotated[float, typer.Option(help="Standing height [m].")] = 1.75,
    look: LookOption = "person",
) -> None:
    """Write the human as an SDF model for Drake, or as an MJCF model for MuJoCo."""
    from humanwalk.body.mjcf import to_mjcf
    from humanwalk.body.plant import Subject
    from humanwalk.body.sdf import to_sdf
    from humanwalk.files import write_text
    from humanwalk.quantity import check

    _require_look(look)
    subject = Subject(mass=mass, stature=stature)
    check(subject, "subject")
    write = to_mjcf if output.suffix == ".xml" else to_sdf
    write_text(output, write(subject.skeleton, look))  # type: ignore[arg-type]
    console.print(f"{output}: 44 bodies, 42 revolute joints, {mass:g} kg, {stature:g} m")


@app.command(epilog="Example: humanwalk diagram thesis -o diagram.svg")
def diagram(
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write; svg, png or pdf by its suffix.")],
    scenario: ScenarioArgument = "thesis",
    set_: SetOption = [],  # noqa: B006
    depth: Annotated[int, typer.Option(min=0, max=5, help="How many levels of diagrams to open.")] = 1,
    every_port: Annotated[
        bool, typer.Option("--every-port", help="Draw the ports that lead nowhere, too: a plant has dozens.")
    ] = False,
) -> None:
    """Draw the block diagram of a scenario's systems."""
    from humanwalk.diagrams.walker import make_diagram
    from humanwalk.scenario import load_scenario
    from humanwalk.view.diagram_picture import draw_diagram

    draw_diagram(make_diagram(load_scenario(scenario, _overrides(set_))), output, depth, every_port)
    console.print(f"{output}")


def main() -> None:
    """Entry point; bad input is one line and exit code 2."""
    # Drake's notices (ports, half-spaces) are not for people who walk; its errors arrive as exceptions.
    logging.getLogger("drake").addFilter(lambda record: record.levelno >= logging.ERROR)
    with _own_log():
        try:
            app()
        except ParameterError as error:
            console.print(f"humanwalk: {error}", style="red", markup=False, highlight=False, soft_wrap=True)
            sys.exit(BAD_INPUT)


@contextmanager
def _own_log() -> Iterator[None]:
    """Within the block, what this package logs is a line for people."""
    log, handler = logging.getLogger("humanwalk"), logging.StreamHandler()
    handler.setFormatter(logging.Formatter("humanwalk: %(message)s"))
    log.addHandler(handler)
    # pydrake gives the root logger a handler of its own.
    log.propagate = False
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.propagate = True


def _require_look(look: str) -> None:
    from humanwalk.body.sdf import LOOKS

    if look not in LOOKS:
        raise ParameterError(f"--look {look}: unknown; allowed: {', '.join(LOOKS)}; choose one of them")


def _overrides(pairs: list[str]) -> dict[str, str]:
    overrides = {}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        if not equals or not key:
            raise ParameterError(f"--set {pair}: not FIELD=VALUE; allowed: like controller.thesis.gait.ramp.speed=1.2")
        overrides[key] = value
    return overrides
