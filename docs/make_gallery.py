"""Makes every picture and video of the book anew: python docs/make_gallery.py (a quarter of an hour), or make gallery.

Needs the extra `video` and a Chromium. Simulations are kept under runs/gallery: remove it to walk them again.
"""

from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console

from humanwalk.diagrams.walker import make_walker
from humanwalk.run.diagram_picture import draw_diagram
from humanwalk.run.files import make_folder
from humanwalk.run.folder import Run
from humanwalk.run.plots import PLOTS, write_gait_figures
from humanwalk.run.plots.drawing import save
from humanwalk.run.video import VideoParameters, record_video, write_snapshot
from humanwalk.run.walk import walk_and_write
from humanwalk.scenario import load_scenario, shipped_scenarios

DOCS = Path(__file__).parent
GALLERY, IMAGES = DOCS / "gallery", DOCS / "images"
RUNS = Path("runs/gallery")

FIGURES = (
    "gait_cycle_angles",
    "joint_power",
    "ground_reaction",
    "centre_of_pressure",
    "support_force",
    "joint_torques",
)
FIGURE_DPI = 120

LOOP_BEGIN, LOOP_FRAMES, LOOP_LENGTH = 3.0, 57, 5.0
"""README's moving picture: six strides of the thesis' walk are 5 m, after which the grid looks the same [s, m]."""


@dataclass(frozen=True)
class Shot:
    """One run of the gallery: a video of some seconds and a strip of one stride, both in steady walking."""

    scenario: str
    overrides: dict[str, str] = field(default_factory=dict)
    video: VideoParameters | None = None
    strip_begin: float = 6.0


CLIP = VideoParameters(frame_rate=25.0, width=640, height=360, begin=4.0, end=8.0)
SIDE = VideoParameters(frame_rate=25.0, width=640, height=360, begin=4.0, end=8.0, view="side")

SHOTS = {
    "thesis": Shot("thesis", video=CLIP),
    "thesis_12cm": Shot("thesis_12cm"),
    "comfortable": Shot("comfortable", video=SIDE),
    "bones": Shot("thesis", {"subject.look": "bones", "duration": "8"}),
}


def run_of(name: str, shot: Shot, console: Console) -> Run:
    """The run of a shot, walked if it is not there yet."""
    folder = RUNS / name
    if folder.is_dir() and any(folder.iterdir()):
        return Run.open(folder)
    return walk_and_write(shot.scenario, shot.overrides, folder, live=False, replay=True, plots=False, console=console)


def main() -> None:
    """Make everything."""
    console = Console(stderr=True)
    make_folder(GALLERY)
    for name, shot in SHOTS.items():
        run = run_of(name, shot, console)
        path = run.scenario.gait.path
        stride = path.stride_time(run.scenario.gait.ramp.speed)
        times = [round(shot.strip_begin + share * stride, 3) for share in (0.0, 0.2, 0.4, 0.6, 0.8)]
        write_snapshot(run.path, GALLERY / f"{name}.png", times, 240, 400, "side")
        if shot.video is not None:
            record_video(run.path, GALLERY / f"{name}.mp4", shot.video)
        console.print(name)

    thesis = Run.open(RUNS / "thesis")
    for name in FIGURES:
        figure = PLOTS[name](thesis)
        if figure is not None:
            save(figure, GALLERY / f"{name}.png", FIGURE_DPI)
    duration = LOOP_LENGTH / thesis.scenario.gait.ramp.speed
    rate = LOOP_FRAMES / duration
    loop = VideoParameters(rate, 1.0, 480, 400, begin=LOOP_BEGIN, end=LOOP_BEGIN + (LOOP_FRAMES - 1) / rate)
    record_video(thesis.path, IMAGES / "walker.webp", loop)

    write_gait_figures(IMAGES / "thesis")
    for name in shipped_scenarios():
        draw_diagram(make_walker(load_scenario(name)), IMAGES / f"diagram_{name}.svg")
    console.print(f"{GALLERY} and {IMAGES} are made")


if __name__ == "__main__":
    main()
