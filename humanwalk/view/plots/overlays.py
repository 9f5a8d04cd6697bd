"""Curves of several runs in one figure."""

from collections.abc import Callable, Sequence
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import Side
from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import ANGLES, JOINTS, over_strides
from humanwalk.measures.events import FootEvents
from humanwalk.measures.walk_measures import Walk
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import LABEL_SIZE, TICK_SIZE, curve, label, level, new_figure

RUN_COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#999999")
"""Distinct in color blindness: Okabe and Ito (2008)."""

Overlay = Callable[[Sequence[Run], Sequence[str]], Figure | None]
"""Function of runs and their names that draws a figure; None if no run has data for it."""


def gait_cycle_angles(runs: Sequence[Run], names: Sequence[str]) -> Figure | None:
    """Hip, knee and ankle over the gait cycle, the mean of all steady strides of both legs [deg]."""
    figure = new_figure("Hip, knee and ankle over the gait cycle, mean of both legs", 3.0, columns=3, sharex=True)
    for axes, joint in zip(figure.axes, JOINTS, strict=True):
        angle = ANGLES[joint]
        level(axes, 0.0)
        for walk, name, color in _walks(runs, names):
            _mean_curve(axes, walk.strides(joint), name, color)
        axes.set_title(joint, fontsize=LABEL_SIZE, pad=3)
        label(axes, "gait cycle [%]", f"{angle.positive} [deg]")
    return _with_legend(figure)


def ground_reaction(runs: Sequence[Run], names: Sequence[str]) -> Figure | None:
    """Vertical ground reaction force over the gait cycle, the mean of all steady strides of both legs [BW]."""
    figure = new_figure("Vertical ground reaction force over the gait cycle, mean of both legs", 3.0)
    (axes,) = figure.axes
    for walk, name, color in _walks(runs, names):
        _mean_curve(axes, walk.each(partial(_vertical_force, walk)), name, color)
    label(axes, "gait cycle [%]", "force [body weight]")
    return _with_legend(figure)


def forward_velocity(runs: Sequence[Run], names: Sequence[str]) -> Figure | None:
    """Forward velocity of the center of mass over time [m/s]."""
    figure = new_figure("Forward velocity of the center of mass", 3.0)
    (axes,) = figure.axes
    for run, name, color in _each(runs, names):
        curve(axes, run.time, run["com.velocity_x"], color=color, label=name, linewidth=0.9)
    label(axes, "time [s]", "velocity [m/s]")
    return _with_legend(figure)


OVERLAYS: dict[str, Overlay] = {
    "gait_cycle_angles": gait_cycle_angles,
    "ground_reaction": ground_reaction,
    "forward_velocity": forward_velocity,
}
"""Figures of several runs by name."""


def _each(runs: Sequence[Run], names: Sequence[str]) -> list[tuple[Run, str, str]]:
    """Each run with its label and color."""
    # A legend of matplotlib leaves labels out that begin with an underscore.
    labels = [f" {name}" if name.startswith("_") else name for name in names]
    return list(zip(runs, labels, RUN_COLORS[: len(runs)], strict=True))


def _walks(runs: Sequence[Run], names: Sequence[str]) -> list[tuple[Walk, str, str]]:
    """The steady part of each run with physics, with its label and color."""
    return [
        (Walk.of(run.signals, run.scenario), name, color)
        for run, name, color in _each(runs, names)
        if run.scenario.controller.physics
    ]


def _vertical_force(walk: Walk, side: Side, foot: FootEvents) -> Array:
    """Vertical ground reaction force over the strides of a leg [BW], shape (strides, 101)."""
    return over_strides(foot, walk.signals[f"{side.lower()}_foot.force_z_N"].to_numpy() / (walk.mass * GRAVITY))


def _mean_curve(axes: Axes, strides: Array, name: str, color: str) -> None:
    """Draw the mean over strides, shape (strides, 101), if there are any."""
    if len(strides):
        curve(axes, CYCLE, strides.mean(axis=0), color=color, label=name)


def _with_legend(figure: Figure) -> Figure | None:
    handles, _ = figure.axes[0].get_legend_handles_labels()
    if not handles:
        return None
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=TICK_SIZE)
    return figure
