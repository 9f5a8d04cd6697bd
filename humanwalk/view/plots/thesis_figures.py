"""Figures 5.8 to 5.21: knee, ankle and feet over time, in the thesis' units (degrees, N m, centimeters)."""

import itertools
from collections.abc import Callable
from functools import partial
from math import inf

import numpy as np
from matplotlib.figure import Figure

from humanwalk.body import SIDES, Side
from humanwalk.choices import ThesisController
from humanwalk.measures.curves import joint_signal
from humanwalk.measures.events import events_of
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import DESIRED, SIDE, curve, label, legend, level, new_figure, shade

Plot = Callable[[Run], Figure | None]

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


def joint_figure(run: Run, number: str, side: Side, joint: str, quantity: str, until: float = inf) -> Figure | None:
    """Actual and desired angle [deg], or actuator torque [N m], of a joint; None for a run of fewer than two samples.

    Args:
        number: Number of the thesis' figure.
        side, joint: Which joint; knee or ankle.
        quantity: "angle" or "torque".
        until: End of the part that is shown [s].
    """
    rows = run.time <= until
    time = run.time[rows]
    if time.size < 2:
        return None
    part, width = (f"first {until:g} s", 1.3) if until < inf else ("whole run", 0.8)
    what = {"angle": "angle and desired angle", "torque": "torque"}[quantity]
    figure = new_figure(_title(run, number, f"{side} {joint} {what}, {part}"))
    (axes,) = figure.axes
    # Over a whole run the bands would be too many to read.
    if until < inf:
        shade(axes, time, events_of(run.signals, side).contact[rows], f"{side.lower()} foot on the ground")
    unit, column = {"angle": ("deg", "angle_rad"), "torque": ("N m", "torque_N_m")}[quantity]
    values = joint_signal(run.signals, joint, side, column)[rows]
    if quantity == "angle":
        # The two may coincide: the desired angle is a wide band behind the angle.
        desired = np.degrees(joint_signal(run.signals, joint, side, "desired_angle_rad")[rows])
        curve(axes, time, desired, color=DESIRED, label="desired", linewidth=3.0 * width)
        values = np.degrees(values)
    curve(axes, time, values, color=SIDE[side], label=quantity, linewidth=width)
    label(axes, TIME_LABEL, f"{joint} {quantity} [{unit}]\n{POSITIVE[joint]}")
    if until < inf or quantity == "angle":
        legend(axes)
    return figure


def foot_position(run: Run, number: str, side: Side, axis: str) -> Figure | None:
    """One coordinate of a sole in W over the whole run [cm]; None for fewer than two samples.

    For the thesis' walk, z has the height that the thesis reports, and y its threshold about the initial y.
    """
    if run.time.size < 2:
        return None
    position = 100.0 * run[f"{side.lower()}_sole.{axis}"]
    what, axis_label = AXES[axis]
    caption = " (the thesis captions it Z, erratum E25)" if number == "5.17" and _is_thesis(run) else ""
    figure = new_figure(_title(run, number, f"{side} foot {axis.upper()}, {what}{caption}"))
    (axes,) = figure.axes
    curve(axes, run.time, position, color=SIDE[side], linewidth=0.9, label="sole")
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


def _leg_joints(first: int, until: float, ending: str = "") -> dict[str, Plot]:
    """Figures of the right knee's and ankle's angle and torque, numbered from 5.`first` on."""
    shown = itertools.product(("knee", "ankle"), ("angle", "torque"))
    return {
        f"figure_5_{number:02d}_right_{joint}_{quantity}{ending}": partial(
            joint_figure, number=f"5.{number}", side="Right", joint=joint, quantity=quantity, until=until
        )
        for number, (joint, quantity) in enumerate(shown, start=first)
    }


def _feet(first: int) -> dict[str, Plot]:
    """Figures of the coordinates of both feet, numbered from 5.`first` on, in the thesis' order."""
    return {
        f"figure_5_{number}_{side.lower()}_foot_{axis}": partial(
            foot_position, number=f"5.{number}", side=side, axis=axis
        )
        for number, (side, axis) in enumerate(itertools.product(SIDES, "xzy"), start=first)
    }


THESIS_PLOTS = _leg_joints(8, FIRST_SECONDS) | _feet(12) | _leg_joints(18, inf, "_whole_run")
"""Figures 5.8 to 5.21 by name."""
