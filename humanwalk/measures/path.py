"""The path that a command describes over the ground: directions along it, and the distance of a walk from it.

Points and directions of the level plane are complex numbers x + iy.
"""

from typing import NamedTuple

import numpy as np
import pyarrow as pa
from scipy.integrate import cumulative_trapezoid
from scipy.spatial import KDTree

from humanwalk.body import Side
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array, Mask
from humanwalk.walking.command import CommandParameters, CommandProfile

TICK = 0.01
"""Time step in which the command is integrated [s]."""

SPACING = 0.002
"""Distance between two points of the path [m], which adds at most 0.05 mm to a distance of 1 cm."""

AHEAD = 1.0
"""Time by which the path continues beyond the end of the record [s]: the walker may be ahead of the command."""


PER_SECOND = 0.1
"""Distance that counts as much as a second when the place of the path beside the walker is sought [m/s]: a place that
the path passes again half a minute later is 3 m from itself."""


class Directions(NamedTuple):
    """Directions of the commanded path beside the walker at every row of a record, of length 1, (rows,) each.

    Attributes:
        facing: heading of the walker.
        travel: of the commanded motion; in standing of the next one, or of the last one. 0 if none is commanded.
    """

    facing: Array
    travel: Array


def path_directions(signals: pa.Table, command: CommandParameters | None) -> Directions:
    """Directions at every row of a record; along x for a walk without a command."""
    ahead = np.ones(signals.num_rows, dtype=complex)
    if command is None:
        return Directions(ahead, ahead)
    com = horizontal(signals, "com")
    time = np.arange(0.0, float(signals[TIME][-1].as_py()) + AHEAD, TICK)
    velocity, heading, position = _motion(command, time)
    # A whole turn is exactly one: straight walks keep their directions to the last bit.
    facing = np.where(heading == 0.0, 1.0, np.exp(1j * heading))
    travel = np.zeros_like(facing)
    (moving,) = np.nonzero(velocity)
    if moving.size:
        velocity = velocity[moving[np.searchsorted(moving, np.arange(time.size)).clip(max=moving.size - 1)]]
        travel = facing * velocity / np.abs(velocity)
    places = np.column_stack((position.real, position.imag, PER_SECOND * time))
    measured = com - com[0]
    _, beside = KDTree(places).query(
        np.column_stack((measured.real, measured.imag, PER_SECOND * signals[TIME].to_numpy()))
    )
    return Directions(facing[beside], travel[beside])


def horizontal(signals: pa.Table, point: str) -> Array:
    """A point of a record over the level plane [m], complex, (rows,)."""
    place: Array = signals[f"{point}.x_m"].to_numpy() + 1j * signals[f"{point}.y_m"].to_numpy()
    return place


def fore_aft_force(signals: pa.Table, side: Side, facing: Array) -> Array:
    """Force of the ground on a foot along the heading of the walk [N], shape (rows,)."""
    x, y = (signals[f"{side.lower()}_foot.force_{axis}_N"].to_numpy() for axis in "xy")
    along: Array = ((x + 1j * y) * np.conj(facing)).real
    return along


def distance_along(signals: pa.Table, rows: Mask, directions: Array) -> float:
    """Distance that the center of mass moves along directions in the chosen rows [m]."""
    moves = np.diff(horizontal(signals, "com")[rows])
    return float((moves * directions[rows][:-1].conj()).real.sum())


def path_deviation(signals: pa.Table, rows: Mask, command: CommandParameters | None) -> float | None:
    """Greatest horizontal distance of the center of mass from the commanded path, at whatever time [m].

    The path begins under the first center of mass of the record, along x.

    Args:
        signals: the record.
        rows: rows of the record that count.
        command: None for a walk without a command.
    """
    if command is None or not rows.any():
        return None
    com = matrix(signals, ["com.x_m", "com.y_m"])
    path = com[0] + commanded_path(command, float(signals[TIME][-1].as_py()) + AHEAD)
    distances, _ = KDTree(path).query(com[rows])
    return float(distances.max())


def commanded_path(command: CommandParameters, duration: float) -> Array:
    """Points of the path from the origin, initially along x [m], shape (n, 2): the integral of the command."""
    time = np.arange(0.0, duration, TICK)
    velocity, _, position = _motion(command, time)
    length = cumulative_trapezoid(np.abs(velocity), time, initial=0.0)
    points = np.interp(np.arange(0.0, length[-1] + SPACING, SPACING), length, position)
    return np.column_stack([points.real, points.imag])


def _motion(command: CommandParameters, time: Array) -> tuple[Array, Array, Array]:
    """Velocity relative to the heading [m/s], heading [rad] and place [m] of the command at times [s], (n,) each."""
    forward, sideways, turn = CommandProfile(command).over(time)
    velocity = forward + 1j * sideways
    heading = cumulative_trapezoid(turn, time, initial=0.0)
    return velocity, heading, cumulative_trapezoid(velocity * np.exp(1j * heading), time, initial=0.0)
