"""Figures 5.8 to 5.21: knee, ankle and feet over time, in the thesis' units (degrees, N m, centimetres)."""

from collections.abc import Callable
from functools import partial
from math import inf

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from humanwalk.body import Side
from humanwalk.measures.events import events_of
from humanwalk.measures.signals import TIME
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import DESIRED, SIDE, Array, curve, label, legend, level, new_figure, shade

Plot = Callable[[Run], Figure | None]

CM_PER_M = 100.0
FIRST_SECONDS = 4.0
"""Length of Figures 5.8 to 5.11 [s]; the others show the whole run, 15 s in the thesis."""
FOOT_HEIGHT_CM = 12.0
"""Height of the swinging foot that chapter 5 reports (E9)."""
LATERAL_THRESHOLD_CM = 0.5
"""Sideways motion of the foot that chapter 5 allows (Figure 5.17, E25)."""

TIME_LABEL = "time [s]"
KNEE, ANKLE = "LegTibiaMotion", "LegAnkleMotion"
MOTIONS = {KNEE: ("knee", "flexion positive"), ANKLE: ("ankle", "dorsiflexion positive")}


def _enough(time: Array) -> bool:
    return time.size >= 2


def _shown(run: Run, until: float) -> npt.NDArray[np.bool_]:
    shown: npt.NDArray[np.bool_] = run.signals[TIME].to_numpy() <= until
    return shown


def joint_angle(run: Run, number: str, side: Side, motion: str, until: float = inf) -> Figure | None:
    """Angle of a knee or an ankle and its desired one [deg]; None for a run of fewer than two samples.

    Args:
        run: what is shown.
        number: of the thesis' figure.
        side, motion: which joint; KNEE or ANKLE.
        until: end of the stretch that is shown [s].
    """
    rows = _shown(run, until)
    time = run.signals[TIME].to_numpy()[rows]
    if not _enough(time):
        return None
    joint = f"{side}{motion}"
    name, positive = MOTIONS[motion]
    figure = new_figure(f"Figure {number}  {side} {name} angle and desired angle{_stretch(until)}")
    (axes,) = figure.axes
    _mark_stance(run, figure, side, rows, until)
    angle, desired = (
        np.degrees(run.signals[f"{joint}.{which}"].to_numpy()[rows]) for which in ("angle_rad", "desired_angle_rad")
    )
    # The two may well be one: the desired angle is a broad band behind the angle.
    curve(axes, time, desired, color=DESIRED, label="desired", linewidth=3.0 * _width(until))
    curve(axes, time, angle, color=SIDE[side], label="angle", linewidth=_width(until))
    label(axes, TIME_LABEL, f"{name} angle [deg]\n{positive}")
    legend(axes)
    return figure


def joint_torque(run: Run, number: str, side: Side, motion: str, until: float = inf) -> Figure | None:
    """Torque of a knee's or an ankle's actuator [N m]; arguments as for `joint_angle`."""
    rows = _shown(run, until)
    time = run.signals[TIME].to_numpy()[rows]
    if not _enough(time):
        return None
    name, positive = MOTIONS[motion]
    figure = new_figure(f"Figure {number}  {side} {name} torque{_stretch(until)}")
    (axes,) = figure.axes
    _mark_stance(run, figure, side, rows, until)
    torque = run.signals[f"{side}{motion}.torque_N_m"].to_numpy()[rows]
    curve(axes, time, torque, color=SIDE[side], label="torque", linewidth=_width(until))
    label(axes, TIME_LABEL, f"{name} torque [N m]\n{positive}")
    if until < inf:
        legend(axes)
    return figure


def foot_position(run: Run, number: str, side: Side, axis: str) -> Figure | None:
    """One coordinate of a sole in the world over the whole run [cm]; None for fewer than two samples.

    z comes with the height that the thesis reports, y with its threshold around the line on which the foot started.
    """
    time = run.signals[TIME].to_numpy()
    if not _enough(time):
        return None
    position = CM_PER_M * run.signals[f"{side.lower()}_sole.{axis}_m"].to_numpy()
    what, axis_label = {
        "x": ("forward", "forward x [cm]"),
        "y": ("sideways", "sideways y [cm]\nleft positive"),
        "z": ("height", "height z [cm]"),
    }[axis]
    caption = " (the thesis captions it Z, erratum E25)" if number == "5.17" else ""
    figure = new_figure(f"Figure {number}  {side} foot {axis.upper()}, {what}{caption}")
    (axes,) = figure.axes
    curve(axes, time, position, color=SIDE[side], linewidth=0.9, label="sole")
    if axis == "z":
        level(axes, position[0] + FOOT_HEIGHT_CM, "thesis: about 12 cm (erratum E9)")
    if axis == "y":
        level(axes, position[0])
        level(axes, position[0] - LATERAL_THRESHOLD_CM, "thesis: within ±0.5 cm of where it started")
        level(axes, position[0] + LATERAL_THRESHOLD_CM, "_")
    label(axes, TIME_LABEL, axis_label)
    if axis != "x":
        legend(axes)
    return figure


def _stretch(until: float) -> str:
    return f", first {until:g} s" if until < inf else ", whole run"


def _width(until: float) -> float:
    return 1.3 if until < inf else 0.8


def _mark_stance(run: Run, figure: Figure, side: Side, rows: npt.NDArray[np.bool_], until: float) -> None:
    # Over a whole run the bands would be too many to read.
    if until < inf:
        time = run.signals[TIME].to_numpy()[rows]
        shade(figure.axes[0], time, events_of(run.signals, side).contact[rows], f"{side.lower()} foot on the ground")


THESIS_PLOTS: dict[str, Plot] = {
    "figure_5_08_right_knee_angle": partial(joint_angle, number="5.8", side="Right", motion=KNEE, until=FIRST_SECONDS),
    "figure_5_09_right_knee_torque": partial(
        joint_torque, number="5.9", side="Right", motion=KNEE, until=FIRST_SECONDS
    ),
    "figure_5_10_right_ankle_angle": partial(
        joint_angle, number="5.10", side="Right", motion=ANKLE, until=FIRST_SECONDS
    ),
    "figure_5_11_right_ankle_torque": partial(
        joint_torque, number="5.11", side="Right", motion=ANKLE, until=FIRST_SECONDS
    ),
    "figure_5_12_right_foot_x": partial(foot_position, number="5.12", side="Right", axis="x"),
    "figure_5_13_right_foot_z": partial(foot_position, number="5.13", side="Right", axis="z"),
    "figure_5_14_right_foot_y": partial(foot_position, number="5.14", side="Right", axis="y"),
    "figure_5_15_left_foot_x": partial(foot_position, number="5.15", side="Left", axis="x"),
    "figure_5_16_left_foot_z": partial(foot_position, number="5.16", side="Left", axis="z"),
    "figure_5_17_left_foot_y": partial(foot_position, number="5.17", side="Left", axis="y"),
    "figure_5_18_right_knee_angle_whole_run": partial(joint_angle, number="5.18", side="Right", motion=KNEE),
    "figure_5_19_right_knee_torque_whole_run": partial(joint_torque, number="5.19", side="Right", motion=KNEE),
    "figure_5_20_right_ankle_angle_whole_run": partial(joint_angle, number="5.20", side="Right", motion=ANKLE),
    "figure_5_21_right_ankle_torque_whole_run": partial(joint_torque, number="5.21", side="Right", motion=ANKLE),
}
