"""Torques of the leg joints over a stride, and tracking errors of all joints."""

import re
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import SIDES, human
from humanwalk.body.limbs import LEGS
from humanwalk.measures.events import events_of
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import (
    LABEL_SIZE,
    REFERENCE,
    SIDE,
    TICK_SIZE,
    WIDTH,
    curve,
    label,
    legend,
    level,
    new_figure,
)


def joint_torques(run: Run) -> Figure | None:
    """Torque of every leg joint over the last whole stride of each leg [N m]; None if there was no stride."""
    strides = {side: events_of(run.signals, side).touchdown_times[-2:] for side in SIDES}
    if any(stride.size < 2 for stride in strides.values()):
        return None
    joints = {side: (*leg.chain, leg.midfoot, leg.toes) for side, leg in LEGS.items()}
    figure = new_figure(
        "Torques of the leg joints over the last stride, from touchdown", height=4.6, rows=3, columns=3, sharex=True
    )
    for place, axes in enumerate(figure.axes):
        level(axes, 0.0)
        for side in SIDES:
            begin, end = strides[side]
            rows = (run.time >= begin) & (run.time <= end)
            percent = 100.0 * (run.time[rows] - begin) / (end - begin)
            torque = run[f"{joints[side][place]}.torque"][rows]
            curve(axes, percent, torque, color=SIDE[side], label=side.lower(), linewidth=WIDTH[side])
        axes.set_title(human().joint(joints["Right"][place]).motion, fontsize=LABEL_SIZE, pad=3)
        label(axes, "stride [%]" if place >= 6 else "", "torque [N m]" if place % 3 == 0 else "")
    figure.align_ylabels()
    handles = figure.axes[0].get_lines()[1:]
    figure.legend(handles=handles, loc="upper right", ncols=2, frameon=False, fontsize=TICK_SIZE, borderpad=0.1)
    return figure


def tracking_error(run: Run) -> Figure | None:
    """Rms difference of desired and actual angle of every joint in steady walking [deg]; None if there is none."""
    errors = {name: np.degrees(error) for name, error in run.summary["tracking_error_rad"].items() if error is not None}
    right, left = ([name for name in errors if name.startswith(side)] for side in SIDES)
    trunk = [name for name in errors if not name.startswith(SIDES)]
    if not errors:
        return None
    figure = new_figure(
        "Tracking error in steady walking, rms of desired minus actual angle", height=3.6, columns=2, sharex=True
    )
    limb_axes, trunk_axes = figure.axes
    for side, names, shift in zip(SIDES, (right, left), (-0.2, 0.2), strict=True):
        bars = [errors[name] for name in names]
        limb_axes.barh(np.arange(len(bars)) + shift, bars, height=0.38, color=SIDE[side], label=side.lower())
    _ticks(limb_axes, [human().joint(name).motion for name in right])
    trunk_axes.barh(np.arange(len(trunk)), [errors[name] for name in trunk], height=0.6, color=REFERENCE)
    bodies = [human().joint(name).child for name in trunk]
    _ticks(trunk_axes, [re.sub(r"(?<=\d)_(?=\d)", "–", body).replace("_", " ") for body in bodies])
    legend(limb_axes)
    return figure


def _ticks(axes: Axes, names: Sequence[str]) -> None:
    axes.set_yticks(np.arange(len(names)), names)
    axes.tick_params(axis="y", length=0, labelsize=TICK_SIZE)
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    label(axes, "rms error [deg]", "")
