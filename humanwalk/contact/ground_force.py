"""From the forces at single contacts to what a force plate under each foot would show."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from humanwalk.numerics import Array

UNLOADED_N = 1.0
"""Vertical force below which a foot counts as unloaded: its centre of pressure would be noise."""


class FootForce(NamedTuple):
    """Ground reaction on one foot, in the world frame W.

    Attributes:
        f_W: force [N], three numbers.
        p_WCop: centre of pressure on the ground plane [m], three numbers; zero while unloaded.
        free_moment: torque about the vertical through the centre of pressure [N m]; zero while unloaded.
        loaded: whether the vertical force exceeds UNLOADED_N.
    """

    f_W: Sequence[float] | Array
    p_WCop: Sequence[float]
    free_moment: float
    loaded: bool

    @property
    def vector(self) -> tuple[float, ...]:
        """All of it in the order above, loaded as 1 or 0; eight numbers."""
        return (*self.f_W, *self.p_WCop, self.free_moment, float(self.loaded))


def foot_force(f_W: Sequence[float] | Array, tau_Wo: Sequence[float] | Array, ground_height: float = 0.0) -> FootForce:
    """Centre of pressure and free moment of a foot's whole contact wrench.

    Taken from the wrench and not from the centroid of a contact patch, which is another point (drake#22440).

    Args:
        f_W: sum of the contact forces on the foot [N], three numbers.
        tau_Wo: their moment about the world origin [N m], three numbers.
        ground_height: height of the level ground [m].
    """
    f_x, f_y, f_z = f_W
    tau_x, tau_y, tau_z = tau_Wo
    if f_z <= UNLOADED_N:
        return FootForce(f_W, (0.0, 0.0, 0.0), 0.0, False)
    # On the plane z = ground_height the moment about the CoP has no horizontal part (Winter 2009, section 5.2.9).
    x = (-tau_y + ground_height * f_x) / f_z
    y = (tau_x + ground_height * f_y) / f_z
    return FootForce(f_W, (x, y, ground_height), tau_z - (x * f_y - y * f_x), True)


def friction_use(f_t: Sequence[float] | Array, bound: float) -> float:
    """How much of the friction that the ground could give is used: 1 where the foot slides; 0 while unloaded.

    Args:
        f_t: force along the ground [N], two or three numbers.
        bound: the most that it can be, mu times the normal force [N].
    """
    return math.hypot(*f_t) / bound if bound > UNLOADED_N else 0.0


def moments(points: Array, forces: Array) -> Array:
    """Sum of the cross products of rows, shape (3,); numpy's own cross takes many times as long."""
    S = points.T @ forces
    return np.array([S[1, 2] - S[2, 1], S[2, 0] - S[0, 2], S[0, 1] - S[1, 0]])
