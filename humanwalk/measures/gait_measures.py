"""Measures of the gait itself, from the forces on the feet; each has one definition, the one of its docstring.

A foot lands and lifts by its vertical force, with hysteresis and without bounces (`measures.foot_contact`). Of a foot:
a stride goes from its touchdown to its next; a step ends with its touchdown and begins with the other foot's last one
before; a stance goes from touchdown to liftoff. Lengths are along x, the way of the walk.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import other_side
from humanwalk.measures.effort import joint_work
from humanwalk.measures.events import foot_contact
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array, Mask


@dataclass(frozen=True)
class Footfalls:
    """When one foot was on the ground, in rows of the record.

    Attributes:
        touchdowns: first rows of contact, but for a contact that the record begins with.
        liftoffs: first rows of flight.
        contact: whether the foot is on the ground, shape (rows,).
    """

    touchdowns: npt.NDArray[np.int_]
    liftoffs: npt.NDArray[np.int_]
    contact: Mask

    @property
    def strides(self) -> list[tuple[int, int]]:
        """Rows of touchdown and next touchdown."""
        return list(pairwise(self.touchdowns.tolist()))

    @property
    def stances(self) -> list[tuple[int, int]]:
        """Rows of touchdown and liftoff, of whole stances."""
        lifts = [self.liftoffs[self.liftoffs > down] for down in self.touchdowns]
        return [(int(down), int(after[0])) for down, after in zip(self.touchdowns, lifts, strict=True) if after.size]


def footfalls(signals: pa.Table, side: Side, begin: float = 0.0) -> Footfalls:
    """Events of one foot from a time [s] on."""
    contact = foot_contact(signals, side)
    change = np.diff(contact.astype(int))
    counted = signals[TIME].to_numpy()[1:] >= begin
    return Footfalls(
        touchdowns=np.flatnonzero((change > 0) & counted) + 1,
        liftoffs=np.flatnonzero((change < 0) & counted) + 1,
        contact=contact,
    )


def gait_measures(signals: pa.Table, begin: float) -> dict[str, Any]:
    """All gait measures of a record from a time [s] on, ready for JSON; means over steps or strides, null without."""
    feet = {side: footfalls(signals, side, begin) for side in SIDES}
    return {
        "strides": {side.lower(): len(foot.strides) for side, foot in feet.items()},
        "stride_time_s": _each(feet, lambda side: stride_times(signals, feet[side])),
        "stride_length_m": _each(feet, lambda side: stride_lengths(signals, side, feet[side])),
        "step_time_s": _each(feet, lambda side: step_times(signals, feet[side], feet[other_side(side)])),
        "step_length_m": _each(feet, lambda side: step_lengths(signals, side, feet[side])),
        "step_width_m": _each(feet, lambda side: step_widths(signals, side, feet[side])),
        "stance_share": _each(feet, lambda side: stance_shares(signals, feet[side])),
        "double_support_share": _each(feet, lambda side: double_support_shares(feet[side], feet[other_side(side)])),
        "cadence_1_min": cadence(signals, feet),
        "stride_speed_m_s": stride_speed(signals, feet),
        "cop_excursion_m": {
            axis: _each(feet, lambda side, axis=axis: cop_excursions(signals, side, feet[side], axis)) for axis in "xy"
        },
        "joint_work_J": joint_work(signals, feet["Right"].touchdowns),
    }


def stride_times(signals: pa.Table, foot: Footfalls) -> Array:
    """Duration of every stride [s]."""
    return np.diff(_time(signals)[foot.touchdowns])


def stride_lengths(signals: pa.Table, side: Side, foot: Footfalls) -> Array:
    """Advance of the sole from touchdown to touchdown [m]."""
    return np.diff(_sole(signals, side, "x")[foot.touchdowns])


def step_times(signals: pa.Table, foot: Footfalls, other: Footfalls) -> Array:
    """Time from the other foot's last touchdown to this foot's [s]."""
    time = _time(signals)
    before = [other.touchdowns[other.touchdowns < row] for row in foot.touchdowns]
    return np.array(
        [time[row] - time[rows[-1]] for row, rows in zip(foot.touchdowns, before, strict=True) if rows.size]
    )


def step_lengths(signals: pa.Table, side: Side, foot: Footfalls) -> Array:
    """How far this sole is in front of the other one at its touchdown [m]."""
    return (_sole(signals, side, "x") - _sole(signals, other_side(side), "x"))[foot.touchdowns]


def step_widths(signals: pa.Table, side: Side, foot: Footfalls) -> Array:
    """How far the soles are apart sideways at this foot's touchdown [m]; negative if they are crossed."""
    outward = 1.0 if side == "Left" else -1.0
    return outward * (_sole(signals, side, "y") - _sole(signals, other_side(side), "y"))[foot.touchdowns]


def stance_shares(signals: pa.Table, foot: Footfalls) -> Array:
    """Share of every stride until the foot lifts."""
    time, lift = _time(signals), dict(foot.stances)
    return np.array([(time[lift[a]] - time[a]) / (time[b] - time[a]) for a, b in foot.strides if a in lift])


def double_support_shares(foot: Footfalls, other: Footfalls) -> Array:
    """Share of every stride in which both feet are on the ground."""
    return np.array([float((foot.contact & other.contact)[a:b].mean()) for a, b in foot.strides])


def cadence(signals: pa.Table, feet: dict[Side, Footfalls]) -> float | None:
    """Steps of both feet per minute, from the first to the last touchdown."""
    rows = np.sort(np.concatenate([foot.touchdowns for foot in feet.values()]))
    if rows.size < 2:
        return None
    time = _time(signals)
    return float(60.0 * (rows.size - 1) / (time[rows[-1]] - time[rows[0]]))


def stride_speed(signals: pa.Table, feet: dict[Side, Footfalls]) -> float | None:
    """Length of all strides by their time [m/s]."""
    length = sum(stride_lengths(signals, side, foot).sum() for side, foot in feet.items())
    time = sum(stride_times(signals, foot).sum() for foot in feet.values())
    return float(length / time) if time > 0 else None


def cop_excursions(signals: pa.Table, side: Side, foot: Footfalls, axis: str) -> Array:
    """Range of the centre of pressure under the foot over every whole stance, along x or y [m]."""
    cop = signals[f"{side.lower()}_foot.cop_{axis}_m"].to_numpy()
    loaded = signals[f"{side.lower()}_foot.loaded"].to_numpy() > 0.5
    stances = [cop[a:b][loaded[a:b]] for a, b in foot.stances]
    return np.array([np.ptp(stance) for stance in stances if stance.size])


def _time(signals: pa.Table) -> Array:
    time: Array = signals[TIME].to_numpy()
    return time


def _sole(signals: pa.Table, side: Side, axis: str) -> Array:
    place: Array = signals[f"{side.lower()}_sole.{axis}_m"].to_numpy()
    return place


def _each(feet: dict[Side, Footfalls], measure: Any) -> dict[str, float | None]:
    """Mean of a measure for each foot."""
    found = {side.lower(): measure(side) for side in feet}
    return {side: float(values.mean()) if values.size else None for side, values in found.items()}
