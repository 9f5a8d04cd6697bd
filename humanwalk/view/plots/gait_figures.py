"""Figures 4.2 to 4.7: the two foot paths of the thesis' programs, in centimeters."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import Side
from humanwalk.files import make_folder
from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.splines import CubicHermite
from humanwalk.gait.thesis_path import LegPath, thesis_path
from humanwalk.view.plots.drawing import (
    INK,
    REFERENCE,
    SIDE,
    TICK_SIZE,
    curve,
    label,
    legend,
    level,
    new_figure,
    save,
    true_proportions,
)

STEP_LENGTH_CM, STEP_HEIGHT_CM, OFFSET_CM = 50.0, 20.0, 5.0
POINT_SPACING_CM = 1.4
"""Path length of 0.01 s at 1.4 m/s (appendices A and B)."""

SMALL_DPI = 120
"""Resolution: these pictures are part of the documentation, and should be small."""
HEIGHT = 3.4
"""Height of a figure in inches: fits a step at equal scales."""

PATH_SIDE: dict[LegPath, Side] = {"forward": "Right", "backward": "Left"}
"""The right leg swings first, and its path is the forward one."""
START_SEGMENTS: dict[LegPath, int] = {"forward": 2, "backward": 1}
CYCLE_SEGMENTS: dict[LegPath, int] = {"forward": 13, "backward": 12}


def cycle_figure(path: LegPath, number: str) -> Figure:
    """One closed cycle with its control points and the triangle that defines them (Eq 4-22)."""
    start = START_SEGMENTS[path]
    cycle = _spline(path).position(np.arange(start, start + CYCLE_SEGMENTS[path] + 1))
    figure = new_figure(f"Figure {number}  {path.capitalize()} path of one cycle with its control points", HEIGHT)
    (axes,) = figure.axes
    triangle = np.array([(0.0, 0.0), (STEP_LENGTH_CM / 2, STEP_HEIGHT_CM), (STEP_LENGTH_CM, 0.0), (0.0, 0.0)])
    curve(axes, *triangle.T, color=REFERENCE, linewidth=0.9, linestyle="--", label="triangle, Eq 4-22")
    _draw_segments(axes, path, start, start + CYCLE_SEGMENTS[path], label="Hermite spline")
    axes.plot(*cycle[1:].T, "o", markersize=4, color=SIDE[PATH_SIDE[path]], label="control points, in their order")
    middle = np.array([STEP_LENGTH_CM / 2, STEP_HEIGHT_CM / 3])
    for place, point in enumerate(cycle[1:], start=1):
        outward = 9.0 * (point - middle) / np.linalg.norm(point - middle) if point[1] > 0.0 else (0.0, -9.0)
        axes.annotate(
            str(place), point, outward, textcoords="offset points", fontsize=TICK_SIZE - 1, ha="center", va="center"
        )
    _finish(figure)
    return figure


def start_figure(path: LegPath, number: str) -> Figure:
    """Start from standing and steady cycle in one curve."""
    start = START_SEGMENTS[path]
    figure = new_figure(f"Figure {number}  {path.capitalize()} start and steady cycle in one curve", HEIGHT)
    (axes,) = figure.axes
    _draw_segments(axes, path, start, start + CYCLE_SEGMENTS[path], label="steady cycle")
    _draw_segments(axes, path, 0, start, label="start", color=INK, linewidth=1.8)
    axes.plot(*_spline(path).position(np.zeros(1)).T, "s", markersize=5, color=INK, label="standing, (L/2, -offset)")
    _finish(figure)
    return figure


def resampled_figure(path: LegPath, number: str) -> Figure:
    """Start and two cycles as points of equal spacing, the intended walk at constant speed (E16)."""
    spline = _spline(path)
    points = ArcLength(spline).resample(POINT_SPACING_CM)
    title = f"Figure {number}  {path.capitalize()} plot: start and two cycles, a point every 1.4 cm of path"
    figure = new_figure(title, HEIGHT)
    (axes,) = figure.axes
    _draw_segments(axes, path, 0, spline.segments, label="path", linewidth=0.6)
    text = f"{len(points)} points, 0.01 s apart at 1.4 m/s"
    axes.plot(*points.T, ".", markersize=3.5, color=SIDE[PATH_SIDE[path]], label=text)
    _finish(figure)
    return figure


GAIT_FIGURES: dict[str, Callable[[], Figure]] = {
    "figure_4_02_forward_path": partial(cycle_figure, "forward", "4.2"),
    "figure_4_03_forward_start": partial(start_figure, "forward", "4.3"),
    "figure_4_04_backward_path": partial(cycle_figure, "backward", "4.4"),
    "figure_4_05_backward_start": partial(start_figure, "backward", "4.5"),
    "figure_4_06_forward_plot": partial(resampled_figure, "forward", "4.6"),
    "figure_4_07_backward_plot": partial(resampled_figure, "backward", "4.7"),
}


def write_gait_figures(folder: Path) -> list[Path]:
    """Write Figures 4.2 to 4.7 as PNG into a folder, which is created if missing; returns the files.

    Raises:
        ParameterError: A file cannot be written.
    """
    make_folder(folder)
    return [save(draw(), folder / f"{name}.png", SMALL_DPI) for name, draw in GAIT_FIGURES.items()]


def _spline(path: LegPath) -> CubicHermite:
    return thesis_path(path, STEP_LENGTH_CM, STEP_HEIGHT_CM, OFFSET_CM)


def _draw_segments(axes: Axes, path: LegPath, first: int, last: int, **style: Any) -> None:
    points = _spline(path).position(np.linspace(first, last, 100 * (last - first) + 1))
    curve(axes, *points.T, **{"color": SIDE[PATH_SIDE[path]]} | style)


def _finish(figure: Figure) -> None:
    (axes,) = figure.axes
    level(axes, 0.0)
    axes.margins(0.08, 0.12)
    true_proportions(figure)
    label(axes, "forward x [cm]", "height y [cm]")
    legend(axes)
