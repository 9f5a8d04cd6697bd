"""Commands that show and analyze a run: replay, video, snapshot, plot, report, export."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from humanwalk.cli.common import INTERRUPTED, SHOW, OverwriteOption, app, console, counted_progress, stdout
from humanwalk.files import require_new, require_replaceable

RunArgument = Annotated[Path, typer.Argument(help="Folder of a run.")]
ViewOption = Annotated[
    str, typer.Option(help="follow, side (from the right), front, above, or orbit (around the walker).")
]


@app.command(
    rich_help_panel=SHOW, epilog="Examples: humanwalk replay runs/thesis  |  humanwalk replay runs/walk runs/brisk"
)
def replay(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN [RUN]", help="Folder of a run; two play together.")],
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port of the page; 0 for a free one.", show_default=False)
    ] = 0,
) -> None:
    """Serve the replay of one run, or of two together, on this machine only, and open it in the browser.

    A run that was walked with --no-replay gets its page from its signals.
    """
    from humanwalk.view.serve import serve_replay

    serve_replay(runs, open_browser=browser, console=console, port=port)


@app.command(
    rich_help_panel=SHOW,
    epilog="Examples: humanwalk video runs/thesis -o walk.mp4  |  "
    "humanwalk video runs/thesis -o slow.webp --speed 0.25 --to 2",
)
def video(
    run: RunArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Video to write; mp4, gif or webp by its suffix.")],
    fps: Annotated[float, typer.Option(help="Frames per second of the video.")] = 30.0,
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Size of the picture in pixels.")] = "1280x720",
    view: ViewOption = "follow",
    speed: Annotated[float, typer.Option(help="Seconds of walking per second of video.")] = 1.0,
    from_: Annotated[float, typer.Option("--from", help="Begin at this time of the run [s].")] = 0.0,
    to: Annotated[float | None, typer.Option(help="End at this time of the run [s]. Default: its end.")] = None,
    overwrite: OverwriteOption = False,
) -> None:
    """Render the replay of a run as a video, frame by frame, in a headless browser."""
    from humanwalk.view.video import VideoParameters, parse_size, record_video

    require_new(output, overwrite)
    width, height = parse_size(size)
    parameters = VideoParameters(fps, speed, width, height, view, from_, to)  # type: ignore[arg-type]
    with _rendering() as show:
        frames = record_video(run, output, parameters, show)
    console.print(f"{output}: {frames} frames, {frames / fps:.2f} s", soft_wrap=True)


@app.command(
    rich_help_panel=SHOW, epilog="Example: humanwalk snapshot runs/thesis --times 3.0,3.1,3.2,3.3 -o strip.png"
)
def snapshot(
    run: RunArgument,
    times: Annotated[str, typer.Option(help="Times [s], separated by commas.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="PNG picture to write.")],
    size: Annotated[str, typer.Option(metavar="WIDTHxHEIGHT", help="Size of one frame in pixels.")] = "320x480",
    view: ViewOption = "side",
    overwrite: OverwriteOption = False,
) -> None:
    """Render selected frames side by side."""
    from humanwalk.view.video import parse_size, parse_times, write_snapshot

    require_new(output, overwrite)
    width, height = parse_size(size)
    with _rendering() as show:
        write_snapshot(run, output, parse_times(times), width, height, view, show)  # type: ignore[arg-type]
    console.print(f"{output}", soft_wrap=True)


@contextmanager
def _rendering() -> Iterator[Callable[[int, int], None]]:
    """A progress bar for frames, set by the number of rendered and of all frames; handles Ctrl-C."""
    with counted_progress("frames") as progress:
        task = progress.add_task("starting the browser", total=None)

        def show(done: int, frames: int) -> None:
            progress.update(
                task, description="rendering" if done < frames else "encoding", completed=done, total=frames
            )

        try:
            yield show
        except KeyboardInterrupt:
            progress.stop()
            console.print("interrupted; nothing was written")
            raise typer.Exit(INTERRUPTED) from None


@app.command(
    rich_help_panel=SHOW, epilog="Example: humanwalk plot runs/thesis --only figure_5_08 --only support --format pdf"
)
def plot(
    run: RunArgument,
    only: Annotated[
        list[str], typer.Option(metavar="NAME", help="Name of a plot, or its beginning; can be given several times.")
    ] = [],  # noqa: B006
    format_: Annotated[str, typer.Option("--format", help="png, svg or pdf.")] = "png",
) -> None:
    """Write the plots of a run again, all or selected ones, also in another format."""
    from humanwalk.run.folder import Run
    from humanwalk.view.plots import write_plots

    with console.status("drawing"):
        written = write_plots(Run.open(run), only, format_)
    for path in written:
        console.print(f"{path}", soft_wrap=True)
    if not written:
        console.print(f"{run}: the run has no data for the selected plots", soft_wrap=True)


@app.command(
    rich_help_panel=SHOW,
    epilog="Examples: humanwalk report runs/walk  |  humanwalk report runs/walk --json > walk.json",
)
def report(
    run: Annotated[Path, typer.Argument(help="Folder of a run that walks straight ahead.")],
    json_: Annotated[
        bool, typer.Option("--json", help="Print the values of every stride instead of the tables; write no page.")
    ] = False,
) -> None:
    """Compare with human gait, stride by stride, and write report.html into the run folder."""
    import json

    from humanwalk.run.folder import Run
    from humanwalk.view.report import REPORT, compare_run, terminal_tables, to_json, write_report

    opened = Run.open(run)
    if not json_:
        require_replaceable(opened.path / REPORT)
    with console.status("comparing with human gait"):
        comparison = compare_run(opened)
    if json_:
        print(json.dumps(to_json(comparison), indent=2, allow_nan=False))
        return
    with console.status("drawing"):
        path = write_report(opened, comparison)
    for table in terminal_tables(comparison):
        stdout.print(table)
    console.print(f"{path}", soft_wrap=True)


@app.command(
    rich_help_panel=SHOW,
    epilog="Examples: humanwalk export runs/thesis --to opensim  |  humanwalk export runs/thesis --to c3d -o lab",
)
def export(
    run: RunArgument,
    to: Annotated[str, typer.Option("--to", help="opensim, c3d, csv or mat.")],
    folder: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Folder to write into. Default: one in the run's, named by the format, whose files are replaced.",
        ),
    ] = None,
    overwrite: OverwriteOption = False,
) -> None:
    """Write a run for another program: OpenSim, motion-capture software, a spreadsheet, MATLAB."""
    from humanwalk.exchange import export_run, forces_left_out
    from humanwalk.run.folder import Run

    opened = Run.open(run)
    with console.status("writing"):
        written = export_run(opened, to, folder, overwrite=overwrite)
    for path in written:
        console.print(f"{path}", soft_wrap=True)
    for force in forces_left_out(opened, to):
        console.print(f"{force}: not in these files; inverse dynamics will find it as residual forces", soft_wrap=True)
