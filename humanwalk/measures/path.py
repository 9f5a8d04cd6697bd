"""Distance of a walk from the path that its command describes over the ground."""

import numpy as np
import pyarrow as pa
from scipy.integrate import cumulative_trapezoid
from scipy.spatial import KDTree

from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array, Mask
from humanwalk.walking.command import CommandParameters, CommandProfile

TICK = 0.01
"""Time step in which the command is integrated [s]."""

SPACING = 0.002
"""Distance between two points of the path [m], which adds at most 0.05 mm to a distance of 1 cm."""

AHEAD = 1.0
"""Time by which the path continues beyond the end of the record [s]: the walker may be ahead of the command."""


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
    forward, sideways, turn = CommandProfile(command).over(time)
    heading = cumulative_trapezoid(turn, time, initial=0.0)
    position = cumulative_trapezoid((forward + 1j * sideways) * np.exp(1j * heading), time, initial=0.0)
    length = cumulative_trapezoid(np.hypot(forward, sideways), time, initial=0.0)
    points = np.interp(np.arange(0.0, length[-1] + SPACING, SPACING), length, position)
    return np.column_stack([points.real, points.imag])
