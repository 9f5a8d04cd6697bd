"""The path of the center of pressure (CoP) under a foot, stance by stance, in the frame of its footprint.

The footprint is the pose of the sole while the foot is flat. It does not move when the heel rises, so that a CoP that
stays under the toes stays in place.
"""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from humanwalk.body import Side
from humanwalk.measures.events import CONTACT_OFF_N, FootEvents
from humanwalk.measures.orientation import sole_rotation
from humanwalk.measures.signals import matrix
from humanwalk.numerics import Array

FOOT_FLAT = 20.0
"""Time of the footprint [% of the gait cycle]: the middle of the time in which people's feet are flat on
the ground, from 10 to 31 % (Perry, Burnfield 2010, chapter 2)."""

ROLL = (10.0, 55.0)
"""Part of the gait cycle in which people's CoP moves from the heel to the toes [%]: before, the heel lands; after, the
weight is on the other foot."""


def cop_paths(signals: pa.Table, side: Side, foot: FootEvents) -> list[Array]:
    """CoP of every whole stride while the foot is loaded with more than CONTACT_OFF_N.

    Returns:
        For each stride an array of rows (gait cycle [%], forward of the ankle [m], left of it [m]), shape (n, 3).
    """
    name = side.lower()
    cop = matrix(signals, [f"{name}_foot.cop_{axis}_m" for axis in "xyz"])
    sole = matrix(signals, [f"{name}_sole.{axis}_m" for axis in "xyz"])
    loaded = foot.contact & (signals[f"{name}_foot.force_z_N"].to_numpy() > CONTACT_OFF_N)
    turn, paths = sole_rotation(signals, side), []
    for a, b in foot.strides:
        cycle = 100.0 * (foot.time[a:b] - foot.time[a]) / (foot.time[b] - foot.time[a])
        flat = a + int(np.argmin(np.abs(cycle - FOOT_FLAT)))
        place = turn[flat].inv().apply(cop[a:b] - sole[flat])
        paths.append(np.column_stack([cycle, place[:, :2]])[loaded[a:b]])
    return paths


def backward_travel(path: Array) -> float:
    """Greatest distance by which the CoP falls back behind its foremost place so far, during ROLL [m].

    Args:
        path: One of `cop_paths`, shape (n, 3).
    """
    begin, end = ROLL
    forward = path[(path[:, 0] >= begin) & (path[:, 0] <= end), 1]
    return float((np.maximum.accumulate(forward) - forward).max(initial=0.0))


def backward_travels(paths: Sequence[Array]) -> Array:
    """`backward_travel` of every path [m], shape (strides,)."""
    return np.array([backward_travel(path) for path in paths])
