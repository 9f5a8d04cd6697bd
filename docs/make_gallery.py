"""Makes every picture and video of the book: python docs/make_gallery.py (a quarter of an hour), or make gallery.

With names of shots, as in `python docs/make_gallery.py walk brisk`, it makes those only. Needs the extra `video` and a
Chromium. Simulations are kept under runs/gallery: remove it to walk them again.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image
from rich.console import Console

from humanwalk.cli.walk import walk_and_write
from humanwalk.diagrams.walker import make_diagram
from humanwalk.files import make_folder
from humanwalk.run.folder import Run
from humanwalk.scenario import load_scenario
from humanwalk.view.diagram_picture import draw_diagram
from humanwalk.view.plots import PLOTS, write_gait_figures
from humanwalk.view.plots.drawing import save
from humanwalk.view.video import VideoParameters, record_video, write_snapshot

DOCS = Path(__file__).parent
GALLERY, IMAGES = DOCS / "gallery", DOCS / "images"
RUNS = Path("runs/gallery")

FIGURE_DPI = 120
STRIP_BEGIN = 6.0
"""Of the strip of one stride [s]."""

FIRST_PICTURE = VideoParameters(frame_rate=10.0, width=480, height=300, speed=4.0)
"""README's moving picture: the whole `course` in a quarter of its time."""


@dataclass(frozen=True)
class Shot:
    """A run of the gallery: a strip of one stride of steady walking, or of some instants [s], a video, and figures."""

    scenario: str
    overrides: dict[str, str] = field(default_factory=dict)
    video: VideoParameters | None = None
    figures: tuple[str, ...] = ()
    instants: tuple[float, ...] = ()


CLIP = VideoParameters(frame_rate=25.0, width=640, height=360, begin=4.0, end=8.0)
SIDE = VideoParameters(frame_rate=25.0, width=640, height=360, begin=4.0, end=8.0, view="side")

SHOTS = {
    "course": Shot(
        "course",
        video=VideoParameters(frame_rate=20.0, width=640, height=360, speed=4.0),
        # Up and down the ramps, curb, cross slope, boxes, stairs up and down, beam.
        instants=(10.0, 18.0, 24.0, 32.0, 37.0, 47.5, 53.0, 60.0),
    ),
    "walk": Shot(
        "walk",
        video=CLIP,
        figures=(
            *("gait_cycle_angles", "gait_cycle_moments", "gait_cycle_powers", "gait_cycle_pelvis"),
            *("cop_under_soles", "ground_reaction"),
        ),
    ),
    "brisk": Shot("brisk", video=SIDE, figures=("gait_cycle_angles",)),
    "push": Shot(
        "push",
        video=VideoParameters(frame_rate=25.0, width=640, height=360, begin=7.5, end=11.0, view="side"),
        instants=(7.9, 8.1, 8.2, 8.3, 8.4, 8.5, 8.8, 9.3),
    ),
    "thesis": Shot(
        "thesis",
        video=CLIP,
        figures=(
            *("gait_cycle_angles", "gait_cycle_powers", "ground_reaction", "center_of_pressure"),
            *("support_force", "joint_torques"),
        ),
    ),
    "thesis_12cm": Shot("thesis_12cm"),
    "thesis_stairs": Shot("thesis_stairs", instants=(2.9, 3.2, 3.5, 3.8, 7.6, 7.9, 8.2, 8.5)),
    "comfortable": Shot("comfortable", video=SIDE),
    "bones": Shot("thesis", {"subject.look": "bones", "duration": "8"}),
}


DIAGRAMS = {"thesis": "thesis", "balanced": "walk"}
"""A scenario of each controller that is drawn as a block diagram; all scenarios of a controller have the same wires."""


PEOPLE = {
    "woman": {"sex": "female", "mass": "60", "stature": "1.65", "loads": "[backpack]"},
    "man": {"sex": "male", "mass": "110", "stature": "1.80", "loads": "[vest, ankle_weights]"},
    "girl": {
        "sex": "female",
        "age": "10",
        "mass": "33",
        "stature": "1.40",
        "loads": "[{suitcase: {mass: 3, side: Left}}]",
    },
    "boy": {"sex": "male", "age": "6", "mass": "20", "stature": "1.10"},
}
"""Subjects that are drawn side by side: fields of `Subject`."""


def draw_people(output: Path, console: Console) -> None:
    """Draw standing subjects side by side into a PNG file."""
    stills = []
    for name, fields in PEOPLE.items():
        overrides = {f"subject.{field}": value for field, value in fields.items()} | {"duration": "0.3"}
        run, still = run_of(f"people_{name}", Shot("stand", overrides), console), RUNS / f"people_{name}.png"
        write_snapshot(run.path, still, (0.2,), 240, 400, "follow")
        # Without the time below.
        stills.append(Image.open(still).crop((0, 0, 240, 400)))
    row = Image.new("RGB", (240 * len(stills), 400))
    for place, picture in enumerate(stills):
        row.paste(picture, (240 * place, 0))
    row.save(output, optimize=True)


def run_of(name: str, shot: Shot, console: Console) -> Run:
    """The run of a shot, walked if it is not there yet."""
    folder = RUNS / name
    if folder.is_dir() and any(folder.iterdir()):
        return Run.open(folder)
    return walk_and_write(shot.scenario, shot.overrides, folder, live=False, replay=True, plots=False, console=console)


def make_shot(name: str, shot: Shot, console: Console) -> None:
    """Walk a shot, and draw its strip, video and figures."""
    run = run_of(name, shot, console)
    stride = run.summary["gait"]["stride_time_s"]["right"]
    times = shot.instants or [round(STRIP_BEGIN + share * stride, 3) for share in (0.0, 0.2, 0.4, 0.6, 0.8)]
    write_snapshot(run.path, GALLERY / f"{name}.png", times, 240, 400, "side")
    if shot.video is not None:
        record_video(run.path, GALLERY / f"{name}.mp4", shot.video)
    for plot in shot.figures:
        figure = PLOTS[plot](run)
        assert figure is not None, plot
        save(figure, GALLERY / f"{name}_{plot}.png", FIGURE_DPI)
    console.print(name)


def main(names: Sequence[str]) -> None:
    """Make the named shots, or, without a name, everything."""
    console = Console(stderr=True)
    make_folder(GALLERY)
    for name in names or SHOTS:
        make_shot(name, SHOTS[name], console)
    if names:
        return
    draw_people(IMAGES / "subjects.png", console)
    record_video(RUNS / "course", IMAGES / "walker.webp", FIRST_PICTURE)
    write_gait_figures(IMAGES / "thesis")
    for controller, scenario in DIAGRAMS.items():
        draw_diagram(make_diagram(load_scenario(scenario)), IMAGES / f"diagram_{controller}.svg")
    console.print(f"{GALLERY} and {IMAGES} are made")


if __name__ == "__main__":
    main(sys.argv[1:])
