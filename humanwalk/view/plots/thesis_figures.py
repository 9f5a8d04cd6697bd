"""Figures 5.8 to 5.21: knee, ankle and feet over time, in the thesis' units (degrees, N m, centimeters)."""

from collections.abc import Callable
from functools import partial
from math import inf

import numpy as np
from matplotlib.figure import Figure

from humanwalk.body import Side
from humanwalk.choices import ThesisController
from humanwalk.measures.events import events_of
from humanwalk.measures.human_likeness import joint_signal
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array, Mask
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import DESIRED, SIDE, curve, label, legend, level, new_figure, shade

Plot = Callable[[Run], Figure | None]

CM_PER_M = 100.0
FIRST_SECONDS = 4.0
"""Duration of Figures 5.8 to 5.11 [s]; the others show the whole run, 15 s in the thesis."""
FOOT_HEIGHT_CM = 12.0
"""Height of the swing foot reported in chapter 5 (E9)."""
LATERAL_THRESHOLD_CM = 0.5
"""Lateral deviation of the foot that chapter 5 allows (Figure 5.17, E25)."""

TIME_LABEL = "time [s]"
POSITIVE = {"knee": "flexion positive", "ankle": "dorsiflexion positive"}
AXES = {
    "x": ("forward", "forward x [cm]"),
    "y": ("lateral", "lateral y [cm]\nleft positive"),
    "z": ("height", "height z [cm]"),
}


def joint_angle(run: Run, number: str, side: Side, joint: str, until: float = inf) -> Figure | None:
    """Actual and desired angle of a knee or an ankle [deg]; None for a run of fewer than two samples.

    Args:
        run: What is shown.
        number: Number of the thesis' figure.
        side, joint: Which joint; knee or ankle.
        until: End of the part that is shown [s].
    """
    rows, time = _shown(run, until)
    if time.size < 2:
        return None
    figure = new_figure(_title(run, number, f"{side} {joint} angle and desired angle{_part(until)}"))
    (axes,) = figure.axes
    _mark_stance(run, figure, side, rows, until)
    angle, desired = (
        np.degrees(joint_signal(run.signals, joint, side, which)[rows]) for which in ("angle_rad", "desired_angle_rad")
    )
    # The two may coincide: the desired angle is a wide band behind the angle.
    curve(axes, time, desired, color=DESIRED, label="desired", linewidth=3.0 * _width(until))
    curve(axes, time, angle, color=SIDE[side], label="angle", linewidth=_width(until))
    label(axes, TIME_LABEL, f"{joint} angle [deg]\n{POSITIVE[joint]}")
    legend(axes)
    return figure


def joint_torque(run: Run, number: str, side: Side, joint: str, until: float = inf) -> Figure | None:
    """Torque of a knee's or an ankle's actuator [N m]; arguments as for `joint_angle`."""
    rows, time = _shown(run, until)
    if time.size < 2:
        return None
    figure = new_figure(_title(run, number, f"{side} {joint} torque{_part(until)}"))
    (axes,) = figure.axes
    _mark_stance(run, figure, side, rows, until)
    torque = joint_signal(run.signals, joint, side, "torque_N_m")[rows]
    curve(axes, time, torque, color=SIDE[side], label="torque", linewidth=_width(until))
    label(axes, TIME_LABEL, f"{joint} torque [N m]\n{POSITIVE[joint]}")
    if until < inf:
        legend(axes)
    return figure


def foot_position(run: Run, number: str, side: Side, axis: str) -> Figure | None:
    """One coordinate of a sole in W over the whole run [cm]; None for fewer than two samples.

    For the thesis' walk, z has the height that the thesis reports, and y its threshold about the initial y.
    """
    _, time = _shown(run, inf)
    if time.size < 2:
        return None
    position = CM_PER_M * run.signals[f"{side.lower()}_sole.{axis}_m"].to_numpy()
    what, axis_label = AXES[axis]
    caption = " (the thesis captions it Z, erratum E25)" if number == "5.17" and _is_thesis(run) else ""
    figure = new_figure(_title(run, number, f"{side} foot {axis.upper()}, {what}{caption}"))
    (axes,) = figure.axes
    curve(axes, time, position, color=SIDE[side], linewidth=0.9, label="sole")
    if _is_thesis(run) and axis == "z":
        level(axes, position[0] + FOOT_HEIGHT_CM, "thesis: about 12 cm (erratum E9)")
    if _is_thesis(run) and axis == "y":
        level(axes, position[0])
        level(axes, position[0] - LATERAL_THRESHOLD_CM, "thesis: within ±0.5 cm of the initial position")
        level(axes, position[0] + LATERAL_THRESHOLD_CM, "_")
    label(axes, TIME_LABEL, axis_label)
    if axis != "x":
        legend(axes)
    return figure


def _is_thesis(run: Run) -> bool:
    return isinstance(run.scenario.controller, ThesisController)


def _title(run: Run, number: str, text: str) -> str:
    """A title with the number of the thesis' figure, for a run of the thesis' walk."""
    return f"Figure {number}  {text}" if _is_thesis(run) else text


def _shown(run: Run, until: float) -> tuple[Mask, Array]:
    """Rows up to a time [s], and their times [s]."""
    time = run.time
    rows: Mask = time <= until
    return rows, time[rows]


def _part(until: float) -> str:
    return f", first {until:g} s" if until < inf else ", whole run"


def _width(until: float) -> float:
    return 1.3 if until < inf else 0.8


def _mark_stance(run: Run, figure: Figure, side: Side, rows: Mask, until: float) -> None:
    # Over a whole run the bands would be too many to read.
    if until < inf:
        time = run.signals[TIME].to_numpy()[rows]
        shade(figure.axes[0], time, events_of(run.signals, side).contact[rows], f"{side.lower()} foot on the ground")


THESIS_PLOTS: dict[str, Plot] = {
    "figure_5_08_right_knee_angle": partial(joint_angle, number="5.8", side="Right", joint="knee", until=FIRST_SECONDS),
    "figure_5_09_right_knee_torque": partial(
        joint_torque, number="5.9", side="Right", joint="knee", until=FIRST_SECONDS
    ),
    "figure_5_10_right_ankle_angle": partial(
        joint_angle, number="5.10", side="Right", joint="ankle", until=FIRST_SECONDS
    ),
    "figure_5_11_right_ankle_torque": partial(
        joint_torque, number="5.11", side="Right", joint="ankle", until=FIRST_SECONDS
    ),
    "figure_5_12_right_foot_x": partial(foot_position, number="5.12", side="Right", axis="x"),
    "figure_5_13_right_foot_z": partial(foot_position, number="5.13", side="Right", axis="z"),
    "figure_5_14_right_foot_y": partial(foot_position, number="5.14", side="Right", axis="y"),
    "figure_5_15_left_foot_x": partial(foot_position, number="5.15", side="Left", axis="x"),
    "figure_5_16_left_foot_z": partial(foot_position, number="5.16", side="Left", axis="z"),
    "figure_5_17_left_foot_y": partial(foot_position, number="5.17", side="Left", axis="y"),
    "figure_5_18_right_knee_angle_whole_run": partial(joint_angle, number="5.18", side="Right", joint="knee"),
    "figure_5_19_right_knee_torque_whole_run": partial(joint_torque, number="5.19", side="Right", joint="knee"),
    "figure_5_20_right_ankle_angle_whole_run": partial(joint_angle, number="5.20", side="Right", joint="ankle"),
    "figure_5_21_right_ankle_torque_whole_run": partial(joint_torque, number="5.21", side="Right", joint="ankle"),
}
