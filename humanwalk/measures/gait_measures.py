"""Spatiotemporal measures of gait from the events of the feet (`humanwalk.measures.events`).

A stride of a foot lasts from a touchdown to its next one. A step ends with a touchdown of the foot and begins with the
last touchdown of the other foot. A stance lasts from touchdown to toe-off. Lengths are along the heading of the
commanded path beside the walker (`humanwalk.measures.path`), widths to its left.
"""

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import TypedDict

import numpy as np
import pyarrow as pa

from humanwalk.measures.effort import JointWork, joint_work
from humanwalk.measures.events import FootEvents, events_of
from humanwalk.measures.path import horizontal
from humanwalk.numerics import Array, Mask
from humanwalk.sides import OUTWARD, SIDES, Side, other_side


class OfFeet(TypedDict):
    """A number for each foot, None where it has no step or stride."""

    right: float | None
    left: float | None


class Strides(TypedDict):
    """Number of strides of each foot."""

    right: int
    left: int


class CopExcursion(TypedDict):
    """Range of the center of pressure along the heading, x, and to its left, y."""

    x: OfFeet
    y: OfFeet


class GaitMeasures(TypedDict):
    """Means over the steps, strides or stances of each foot; keys carry their units."""

    strides: Strides
    stride_time_s: OfFeet
    stride_length_m: OfFeet
    step_time_s: OfFeet
    step_length_m: OfFeet
    step_width_m: OfFeet
    stance_share: OfFeet
    double_support_share: OfFeet
    cadence_1_min: float | None
    stride_speed_m_s: float | None
    cop_excursion_m: CopExcursion
    joint_work_J: dict[str, JointWork] | None


def gait_measures(signals: pa.Table, counted: Mask, facing: Array) -> GaitMeasures:
    """All gait measures of a record.

    Args:
        signals: the record.
        counted: whether a row counts, shape (rows,).
        facing: heading at every row, see `Directions`.
    """
    feet = {side: events_of(signals, side, counted) for side in SIDES}
    return {
        "strides": {"right": len(feet["Right"].strides), "left": len(feet["Left"].strides)},
        "stride_time_s": _means(lambda side: stride_times(feet[side])),
        "stride_length_m": _means(lambda side: stride_lengths(signals, side, feet[side], facing)),
        "step_time_s": _means(lambda side: step_times(feet[side], feet[other_side(side)])),
        "step_length_m": _means(lambda side: step_lengths(signals, side, feet[side], facing)),
        "step_width_m": _means(lambda side: step_widths(signals, side, feet[side], facing)),
        "stance_share": _means(lambda side: stance_shares(feet[side])),
        "double_support_share": _means(lambda side: double_support_shares(feet[side], feet[other_side(side)])),
        "cadence_1_min": cadence(feet),
        "stride_speed_m_s": stride_speed(signals, feet, facing),
        "cop_excursion_m": {
            "x": _means(lambda side: cop_excursions(signals, side, feet[side], facing).real),
            "y": _means(lambda side: cop_excursions(signals, side, feet[side], facing).imag),
        },
        "joint_work_J": joint_work(signals, feet["Right"].strides),
    }


def stride_times(foot: FootEvents) -> Array:
    """Duration of every stride [s]."""
    return np.array([foot.time[b] - foot.time[a] for a, b in foot.strides])


def stride_lengths(signals: pa.Table, side: Side, foot: FootEvents, facing: Array) -> Array:
    """Advance of the sole from touchdown to touchdown, along the mean heading of both [m]."""
    begin, end = np.array(foot.strides, dtype=int).reshape(-1, 2).T
    sole, mean = _sole(signals, side), facing[begin] + facing[end]
    return _relative(sole[end] - sole[begin], mean / np.abs(mean)).real


def step_times(foot: FootEvents, other: FootEvents) -> Array:
    """Time from the other foot's last touchdown to this foot's [s]."""
    before = np.searchsorted(other.touchdowns, foot.touchdowns)
    steps = [(other.touchdowns[k - 1], down) for k, down in zip(before, foot.touchdowns, strict=True) if k > 0]
    return np.array([foot.time[b] - foot.time[a] for a, b in steps if foot.counted[a:b].all()])


def step_lengths(signals: pa.Table, side: Side, foot: FootEvents, facing: Array) -> Array:
    """How far this sole is in front of the other one at its touchdown [m]."""
    return _steps(signals, side, foot, facing).real


def step_widths(signals: pa.Table, side: Side, foot: FootEvents, facing: Array) -> Array:
    """How far the soles are apart sideways at this foot's touchdown [m]; negative if they are crossed."""
    return OUTWARD[side] * _steps(signals, side, foot, facing).imag


def stance_shares(foot: FootEvents) -> Array:
    """Duration of stance as a share of every stride."""
    time, toe_off = foot.time, dict(foot.stances)
    return np.array([(time[toe_off[a]] - time[a]) / (time[b] - time[a]) for a, b in foot.strides if a in toe_off])


def double_support_shares(foot: FootEvents, other: FootEvents) -> Array:
    """Share of every stride in which both feet are on the ground."""
    return np.array([float((foot.contact & other.contact)[a:b].mean()) for a, b in foot.strides])


def cadence(feet: Mapping[Side, FootEvents]) -> float | None:
    """Steps of both feet per minute."""
    time, counted = feet["Right"].time, feet["Right"].counted
    downs = np.sort(np.concatenate([foot.touchdowns for foot in feet.values()]))
    times = [time[b] - time[a] for a, b in pairwise(downs) if counted[a:b].all()]
    return float(60.0 / np.mean(times)) if times else None


def stride_speed(signals: pa.Table, feet: dict[Side, FootEvents], facing: Array) -> float | None:
    """Length of all strides by their time [m/s]."""
    length = sum(stride_lengths(signals, side, foot, facing).sum() for side, foot in feet.items())
    time = sum(stride_times(foot).sum() for foot in feet.values())
    return float(length / time) if time > 0 else None


def cop_excursions(signals: pa.Table, side: Side, foot: FootEvents, facing: Array) -> Array:
    """Range of the center of pressure under the foot in every whole stance [m]: along the heading + i to its left."""
    cop = signals[f"{side.lower()}_foot.cop_x_m"].to_numpy() + 1j * signals[f"{side.lower()}_foot.cop_y_m"].to_numpy()
    loaded = signals[f"{side.lower()}_foot.loaded"].to_numpy() > 0.5
    stances = [_relative(cop[a:b][loaded[a:b]], facing[a]) for a, b in foot.stances]
    return np.array([complex(np.ptp(stance.real), np.ptp(stance.imag)) for stance in stances if stance.size])


def _steps(signals: pa.Table, side: Side, foot: FootEvents, facing: Array) -> Array:
    """Place of this sole relative to the other one at its touchdown [m]."""
    apart = _sole(signals, side) - _sole(signals, other_side(side))
    return _relative(apart[foot.touchdowns], facing[foot.touchdowns])


def _sole(signals: pa.Table, side: Side) -> Array:
    return horizontal(signals, f"{side.lower()}_sole")


def _relative(vectors: Array, directions: Array | complex) -> Array:
    """Vectors of the level plane relative to directions of length 1: along + i left."""
    relative: Array = vectors * np.conj(directions)
    return relative


def of_feet(value: Callable[[Side], float | None]) -> OfFeet:
    """A number for each foot."""
    return {"right": value("Right"), "left": value("Left")}


def _means(measure: Callable[[Side], Array]) -> OfFeet:
    return of_feet(lambda side: float(values.mean()) if (values := measure(side)).size else None)
