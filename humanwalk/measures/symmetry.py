"""Differences between the right and the left leg in steady walking, by the symmetry index of each measure.

The index is that of Robinson, Herzog and Nigg (1987), J. Manipulative Physiol. Ther. 10(4) 172-176:
2 (right - left) / (right + left), in percent; 0 for a symmetric walk, positive where the right leg's value is greater.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.measures.curves import JOINTS, over_strides
from humanwalk.measures.events import FootEvents
from humanwalk.measures.gait_measures import (
    stance_shares,
    step_lengths,
    step_times,
    step_widths,
)
from humanwalk.measures.walk_measures import MOMENT_PEAKS, Walk
from humanwalk.numerics import Array
from humanwalk.sides import other_side


def symmetry_index(right: float | None, left: float | None) -> float | None:
    """Symmetry index of two values of equal sign [%], from -200 to 200; None where it is not defined."""
    if right is None or left is None:
        return None
    have_one_sign = right * left >= 0.0 and right + left != 0.0
    return 200.0 * (right - left) / (right + left) if have_one_sign else None


@dataclass(frozen=True)
class Asymmetry:
    """A measure of both legs.

    Attributes:
        unit: of the values.
        right, left: means over the steps, strides or stances of each leg; NaN without any.
    """

    unit: str
    right: float
    left: float

    @property
    def index(self) -> float | None:
        """Symmetry index [%]."""
        return symmetry_index(self.right, self.left) if np.isfinite((self.right, self.left)).all() else None


OfFoot = Callable[[Walk, Side, FootEvents], Array]


def _range_of(joint: str) -> OfFoot:
    def of_foot(walk: Walk, side: Side, foot: FootEvents) -> Array:
        return np.ptp(walk.strides_of(joint, side), axis=1)

    return of_foot


def _peak_of(curve: str, sign: float) -> OfFoot:
    def of_foot(walk: Walk, side: Side, foot: FootEvents) -> Array:
        return (sign * walk.strides_of(curve, side)).max(axis=1)

    return of_foot


def _peak_force(walk: Walk, side: Side, foot: FootEvents) -> Array:
    return over_strides(foot, walk.forces[side]).max(axis=1)


MEASURES_OF_LEGS: dict[str, tuple[str, OfFoot]] = {
    "step time": ("s", lambda walk, side, foot: step_times(foot, walk.feet[other_side(side)])),
    "step length": ("m", lambda walk, side, foot: step_lengths(walk.signals, side, foot, walk.facing)),
    "step width": ("m", lambda walk, side, foot: step_widths(walk.signals, side, foot, walk.facing)),
    "stance, share of the stride": ("", lambda walk, side, foot: stance_shares(foot)),
    "peak vertical force": ("BW", _peak_force),
    **{f"{joint} range of motion": ("deg", _range_of(joint)) for joint in JOINTS},
    **{
        f"{joint} peak {sense} moment": ("N m/kg", _peak_of(f"{joint} moment", sign))
        for joint, sense, sign in MOMENT_PEAKS
    },
    **{f"{joint} peak power": ("W/kg", _peak_of(f"{joint} power", 1.0)) for joint in JOINTS},
    **{f"{joint} peak absorbed power": ("W/kg", _peak_of(f"{joint} power", -1.0)) for joint in JOINTS},
}
"""Unit of each measure, and its values in the steps, strides or stances of a leg."""


def asymmetries(walk: Walk) -> Mapping[str, Asymmetry]:
    """Return every measure of both legs, by name."""
    found = {}
    for name, (unit, of_foot) in MEASURES_OF_LEGS.items():
        values = [of_foot(walk, side, walk.feet[side]) for side in SIDES]
        right, left = (float(value.mean()) if value.size else np.nan for value in values)
        found[name] = Asymmetry(unit, right, left)
    return found
