"""Angles, powers and torques of the joints over a stride, with those of human gait, and their tracking errors."""

import re
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import SIDES, Side, human
from humanwalk.body.limbs import LEGS
from humanwalk.measures.events import events_of
from humanwalk.measures.human_likeness import ANGLES, CYCLE, JOINTS, joint_signal, over_strides, people
from humanwalk.numerics import Array
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import (
    LABEL_SIZE,
    PEOPLE,
    PEOPLE_LINE,
    REFERENCE,
    SIDE,
    TICK_SIZE,
    curve,
    label,
    legend,
    level,
    new_figure,
)

WIDTH: dict[Side, float] = {"Right": 2.2, "Left": 0.9}
"""Widths of curves: the walk is nearly symmetric, and the right one has to be visible behind the left one."""


def gait_cycle_angles(run: Run) -> Figure | None:
    """Hip, knee and ankle over the gait cycle [deg]: the run's strides over human gait; None without a stride.

    Lines are means, bands one standard deviation to both sides.
    """
    return _over_people(run, "Hip, knee and ankle", ("hip", "knee", "ankle"))


def gait_cycle_pelvis(run: Run) -> Figure | None:
    """Tilt, obliquity and rotation of the pelvis over the gait cycle [deg], drawn as `gait_cycle_angles` are."""
    return _over_people(run, "Pelvis", ("pelvis tilt", "pelvis obliquity", "pelvis rotation"))


def _over_people(run: Run, what: str, names: Sequence[str]) -> Figure | None:
    figure = _three(f"{what} over the gait cycle; bands: mean ± 1 standard deviation")
    for axes, name in zip(figure.axes, names, strict=True):
        angle = ANGLES[name]
        cycle, mean, sd = people(angle.people)
        axes.fill_between(cycle, mean - sd, mean + sd, color=PEOPLE, linewidth=0, label="human, free speed")
        curve(axes, cycle, mean, color=PEOPLE_LINE, linewidth=0.9, linestyle="--")
        level(axes, 0.0)
        for side in SIDES:
            if not _mean_and_band(axes, run, side, angle.of(run.signals, side)):
                return None
        _finish(axes, f"{name} angle [deg]\n{angle.positive} positive", name)
    _legend(figure)
    return figure


def joint_power(run: Run) -> Figure | None:
    """Power of hip, knee and ankle per body mass over the gait cycle [W/kg]; None without a stride.

    Power is torque times rate of the sagittal joint: positive where the actuator drives, negative where it brakes.
    """
    mass = run.scenario.subject.mass
    figure = _three("Power of hip, knee and ankle over the gait cycle; bands: ± 1 standard deviation")
    for axes, name in zip(figure.axes, JOINTS, strict=True):
        level(axes, 0.0)
        for side in SIDES:
            torque, rate = (joint_signal(run.signals, name, side, what) for what in ("torque_N_m", "velocity_rad_s"))
            if not _mean_and_band(axes, run, side, torque * rate / mass):
                return None
        _finish(axes, f"{name} power [W/kg]\ndriving positive", name)
    _legend(figure)
    return figure


def _three(title: str) -> Figure:
    return new_figure(title, height=2.7, columns=3, sharex=True)


def _mean_and_band(axes: Axes, run: Run, side: Side, values: Array) -> bool:
    """Draw a signal over the strides of a leg in steady walking; False if there is none."""
    begin = run.scenario.controller.steady_from(run.scenario.subject)
    strides = over_strides(events_of(run.signals, side, begin), values)
    if not len(strides):
        return False
    mean, sd = strides.mean(axis=0), strides.std(axis=0)
    axes.fill_between(CYCLE, mean - sd, mean + sd, color=SIDE[side], alpha=0.2, linewidth=0)
    text = f"{side.lower()}, {len(strides)} stride{'s' if len(strides) > 1 else ''}"
    curve(axes, CYCLE, mean, color=SIDE[side], label=text, linewidth=WIDTH[side])
    return True


def _finish(axes: Axes, y_label: str, name: str) -> None:
    axes.set_title(name, fontsize=LABEL_SIZE, pad=3)
    axes.set_xticks([0, 50, 100])
    label(axes, "gait cycle [%]", y_label)


def _legend(figure: Figure) -> None:
    handles, _ = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=TICK_SIZE)


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
