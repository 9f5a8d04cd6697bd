"""Joint angles and powers of the legs over a gait cycle, from touchdown to touchdown, with people's beside them."""

import csv
from functools import cache
from importlib.resources import files
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import SIDES, Side
from humanwalk.run.folder import Run
from humanwalk.run.measures import touchdowns
from humanwalk.run.plots.drawing import (
    LABEL_SIZE,
    PEOPLE,
    PEOPLE_LINE,
    SIDE,
    TICK_SIZE,
    curve,
    label,
    level,
    new_figure,
)
from humanwalk.run.signals import TIME

Array = npt.NDArray[np.float64]

CYCLE = np.linspace(0.0, 100.0, 101)
"""Where a gait cycle is drawn [%]."""

JOINTS = {
    "LegFemurMotion": ("hip", "flexion", "hip_flexion_deg"),
    "LegTibiaMotion": ("knee", "flexion", "knee_flexion_deg"),
    "LegAnkleMotion": ("ankle", "dorsiflexion", "ankle_dorsiflexion_deg"),
}
"""Joint without its side, with its name, its positive sense and the quantity of the people's data."""

PEOPLE_DATA = "models/normative_gait/schwartz2008_free_angles.csv"


@cache
def people(quantity: str) -> tuple[Array, Array, Array]:
    """Gait cycle [%], mean and standard deviation [deg] of a joint angle of able-bodied people.

    Source: Schwartz, Rozumalski, Trost (2008), free speed; see the note beside the data.
    """
    text = files("humanwalk").joinpath(PEOPLE_DATA).read_text(encoding="utf-8")
    rows = [row for row in csv.DictReader(text.splitlines()) if row["quantity"] == quantity]
    cycle, mean, sd = (np.array([float(row[key]) for row in rows]) for key in ("gait_cycle_percent", "mean", "sd"))
    return cycle, mean, sd


def over_strides(run: Run, side: Side, values: Array) -> Array | None:
    """A signal over every whole stride of a leg in steady walking, shape (strides, 101); None if there was none."""
    time = run.signals[TIME].to_numpy()
    landings = touchdowns(run.signals, side)
    landings = landings[landings >= run.summary["steady_from_s"]]
    strides = [np.interp(begin + CYCLE / 100.0 * (end - begin), time, values) for begin, end in pairwise(landings)]
    return np.array(strides) if strides else None


def gait_cycle_angles(run: Run) -> Figure | None:
    """Hip, knee and ankle over the gait cycle [deg]: the run's strides over people's; None if there was no stride.

    Lines are means, bands one standard deviation to both sides.
    """
    figure = _three_joints("Hip, knee and ankle over the gait cycle; bands: mean ± 1 standard deviation")
    for axes, (motion, (name, positive, quantity)) in zip(figure.axes, JOINTS.items(), strict=True):
        cycle, mean, sd = people(quantity)
        axes.fill_between(cycle, mean - sd, mean + sd, color=PEOPLE, linewidth=0, label="people, free speed")
        curve(axes, cycle, mean, color=PEOPLE_LINE, linewidth=0.9, linestyle="--")
        level(axes, 0.0)
        for side in SIDES:
            strides = over_strides(run, side, np.degrees(run.signals[f"{side}{motion}.angle_rad"].to_numpy()))
            if strides is None:
                return None
            _mean_and_band(axes, strides, side)
        _finish(axes, f"{name} angle [deg]\n{positive} positive", name)
    _legend(figure)
    return figure


def joint_power(run: Run) -> Figure | None:
    """Power of hip, knee and ankle per body mass over the gait cycle [W/kg]; None if there was no stride.

    Power is torque times rate of the sagittal joint: positive where the actuator drives, negative where it brakes.
    """
    mass = run.scenario.subject.mass
    figure = _three_joints("Power of hip, knee and ankle over the gait cycle; bands: ± 1 standard deviation")
    for axes, (motion, (name, *_)) in zip(figure.axes, JOINTS.items(), strict=True):
        level(axes, 0.0)
        for side in SIDES:
            torque, rate = (
                run.signals[f"{side}{motion}.{what}"].to_numpy() for what in ("torque_N_m", "velocity_rad_s")
            )
            strides = over_strides(run, side, torque * rate / mass)
            if strides is None:
                return None
            _mean_and_band(axes, strides, side)
        _finish(axes, f"{name} power [W/kg]\ndriving positive", name)
    _legend(figure)
    return figure


def _three_joints(title: str) -> Figure:
    return new_figure(title, height=2.7, columns=3, sharex=True)


def _mean_and_band(axes: Axes, strides: Array, side: Side) -> None:
    mean, sd = strides.mean(axis=0), strides.std(axis=0)
    axes.fill_between(CYCLE, mean - sd, mean + sd, color=SIDE[side], alpha=0.2, linewidth=0)
    text = f"{side.lower()}, {len(strides)} stride{'s' if len(strides) > 1 else ''}"
    # The walk is nearly symmetric: the right curve is broad enough to be seen behind the left one.
    curve(axes, CYCLE, mean, color=SIDE[side], label=text, linewidth=2.2 if side == "Right" else 0.9)


def _finish(axes: Axes, y_label: str, name: str) -> None:
    axes.set_title(name, fontsize=LABEL_SIZE, pad=3)
    axes.set_xticks([0, 50, 100])
    label(axes, "gait cycle [%]", y_label)


def _legend(figure: Figure) -> None:
    handles, _ = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=TICK_SIZE)
