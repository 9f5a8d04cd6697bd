"""Ground reaction of a foot from the forces at its contacts, as a force plate under the foot would measure it."""

import math
from typing import NamedTuple

import numpy as np

from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix
from humanwalk.terrain import Terrain

UNLOADED_N = 1.0
"""Normal force up to which a foot counts as unloaded: its center of pressure would be noise."""


class FootForce(NamedTuple):
    """Ground reaction on one foot.

    Attributes:
        f_W: Force in W [N], shape (3,).
        p_WCop: Center of pressure on the plane tangent to the terrain [m], shape (3,); zero while unloaded.
        free_moment: Moment about the surface normal through the center of pressure [N m]; zero while unloaded.
        loaded: Whether the normal force exceeds `UNLOADED_N`.
        friction_use: Tangential force over friction coefficient times normal force; zero while unloaded.
    """

    f_W: Array
    p_WCop: Array
    free_moment: float
    loaded: bool
    friction_use: float

    @property
    def vector(self) -> Array:
        """Force, center of pressure, free moment, loaded (1 or 0); shape (8,). `FootForces` reads it."""
        return np.array((*self.f_W, *self.p_WCop, self.free_moment, self.loaded))


class FootForces(NamedTuple):
    """Ground reactions on the right and the left foot, from a port of 16 numbers.

    Attributes:
        f_W: Force in W [N], shape (2, 3).
        p_WCop: Center of pressure in W [m], shape (2, 3); zero while unloaded.
        free_moment: Moment about the surface normal through the center of pressure [N m], shape (2,).
        loaded: 1 for a loaded foot, else 0, shape (2,).
    """

    f_W: Array
    p_WCop: Array
    free_moment: Array
    loaded: Array

    @staticmethod
    def of(values: Array) -> "FootForces":
        """The reactions from the output `foot_forces`, shape (16,): `FootForce.vector` of both feet."""
        feet = values.reshape(2, 8)
        return FootForces(feet[:, :3], feet[:, 3:6], feet[:, 6], feet[:, 7])


NO_FORCE = FootForce(np.zeros(3), np.zeros(3), 0.0, False, 0.0)
"""Ground reaction on a foot in the air."""


def foot_force(p_WQ: Array, f_W: Array, terrain: Terrain, m_W: Array | float = 0.0) -> FootForce:
    """Return the ground reaction on a foot that is touched at k points.

    The center of pressure comes from the whole wrench, not from the centroid of a contact patch, which is another
    point (drake#22440).

    Args:
        p_WQ: Contact points [m], shape (k, 3).
        f_W: Force on the foot at each point [N], shape (k, 3).
        terrain: The ground; its tangent plane is taken below the mean of the points, weighted by force.
        m_W: Moment on the foot at each point [N m], shape (k, 3).
    """
    f_total = f_W.sum(axis=0)
    unloaded = FootForce(f_total, *NO_FORCE[1:])
    weight = np.linalg.norm(f_W, axis=1)
    total = weight.sum()
    if total <= UNLOADED_N:
        return unloaded
    p_WS = weight @ p_WQ / total
    p_WS[2] = terrain.height(p_WS[:2])
    R_SW = terrain.axes(p_WS[:2])
    f_x, f_y, f_n = R_SW @ f_total
    if f_n <= UNLOADED_N:
        return unloaded
    m_x, m_y, m_n = R_SW @ (np.matvec(cross_matrix(p_WQ - p_WS), f_W) + m_W).sum(axis=0)
    # The moment about the center of pressure has no tangential component (Winter 2009, section 5.2.9).
    x, y = -m_y / f_n, m_x / f_n
    return FootForce(
        f_W=f_total,
        p_WCop=p_WS + np.array((x, y, 0.0)) @ R_SW,
        free_moment=m_n - (x * f_y - y * f_x),
        loaded=True,
        friction_use=math.hypot(f_x, f_y) / (float(terrain.friction(p_WS[:2])) * f_n),
    )
