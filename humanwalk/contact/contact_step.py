"""One step of the asperity law on the bodies of the feet, implicit in their velocities.

The law is stiff: on toes of 0.25 kg it would diverge as an explicit force at steps above 0.04 ms. It is therefore
evaluated at the end of the step. With the mobility G = J (M + D)^-1 J' of the bodies that touch (D: what the joints'
implicit laws add), their velocities V, and the law's linearization F = F0 - B V,

    V(t + h) = V(t) + h a + h G F,    a = (V(t) - V(t - h)) / h - G F(t - h),

is a linear system for V(t + h); a is the acceleration by everything but the contact in the last step. The law with all
its bounds is then evaluated at this velocity.

Joints between the bodies leave them fewer than 6 degrees of freedom each. So the unknown is not V(t + h) but
z = h Z' (F(t - h) - F), with G = Z Z' and one column of Z for each degree of freedom: 16 for the six bodies of the
feet. Its matrix 1 / h + Z' B Z is symmetric and positive definite.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import Context
from scipy.linalg.lapack import dposv

from humanwalk.contact.asperity import (
    AsperityParameters,
    friction_bound,
    friction_force,
    limit_ratio,
    norm,
    normal_force,
    point_damping,
    point_stiffness,
)
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix
from humanwalk.terrain import Terrain

MAX_PASSES = 10
"""Solutions of one step at most; sticking and steady sliding take one, a change between them two or three."""

FULL_PASSES = 3
"""Passes after which each goes only half the way: points that press in every other pass would alternate forever."""

GRIP_TOLERANCE = 0.25
"""Relative change of a grip that requires another pass."""

MOBILITY_MARGIN = 1.25
"""Factor on the mobility: one that is a tenth too small makes a step of 1 ms unstable, one that is too large delays the
forces. With 1.5 a walk at 2 ms swerves (docs/contact.md)."""


class ContactMemory(NamedTuple):
    """What one step passes to the next, of b bodies with k points each, n = b k together.

    Attributes:
        anchor: Anchors of the points' springs, p_WA [m], shape (n, 3).
        load: Running mean of the normal force [N], 0 in the air; shape (n,).
        grip: Fraction of its linear force that the bounds left to each point, 1 while it presses and sticks, 0 in the
            air; along the surface's x, y and normal, shape (n, 3).
        V: Spatial velocities of the bodies [rad/s, m/s], shape (6 b,).
        F: Spatial forces of the contact on the bodies at their origins [N m, N], shape (6 b,).
    """

    anchor: Array
    load: Array
    grip: Array
    V: Array
    F: Array

    @staticmethod
    def untouched(p_WQ: Array, V: Array) -> "ContactMemory":
        """Memory of points (n, 3) without a contact so far, on bodies with the velocities V (6 b,)."""
        return ContactMemory(p_WQ, np.zeros(len(p_WQ)), np.zeros_like(p_WQ), V, np.zeros_like(V))


class Contacts(NamedTuple):
    """All contacts at the end of a step, of n points.

    Attributes:
        p_WQ: Points [m], shape (n, 3).
        f_S: Force on each point along the surface's x, y and normal [N], shape (n, 3).
        R_SW: Axes of the surface at each point, shape (n, 3, 3).
        memory: For the next step.
    """

    p_WQ: Array
    f_S: Array
    R_SW: Array
    memory: ContactMemory

    @property
    def f_W(self) -> Array:
        """Force on each point in W [N], shape (n, 3)."""
        force: Array = np.vecmat(self.f_S, self.R_SW)
        return force

    def __deepcopy__(self, memo: object) -> Self:
        """Return the object itself, which is never changed; Drake copies abstract values often."""
        return self


class ContactStep:
    """The asperity law on b bodies with k points each over one step, n = b k together."""

    def __init__(self, parameters: AsperityParameters, terrain: Terrain, area: Array, step: float) -> None:
        """Initialize the step.

        Args:
            parameters: Of the law.
            terrain: The ground.
            area: Area of the points [m2], shape (b, k).
            step: h [s].
        """
        self._parameters, self._terrain, self._step = parameters, terrain, step
        self._area, self._bodies = area.ravel(), len(area)
        self._K = point_stiffness(parameters, self._area)
        self._C, self._C_rising = (point_damping(parameters, self._area, rising) for rising in (False, True))
        self._pressure = np.outer(self._area, (0.0, 0.0, parameters.normal_pressure))

    def __call__(
        self, p_WB: Array, p_WQ: Array, V: Array, memory: ContactMemory, mobility: Array, time: float
    ) -> Contacts:
        """Return the contacts at the end of the step.

        Args:
            p_WB: Origins of the bodies [m], shape (b, 3).
            p_WQ: Points of one body after the other [m], shape (n, 3).
            V: Spatial velocities of the bodies at their origins, in W [rad/s, m/s], shape (6 b,).
            memory: Of the last step.
            mobility: Z, in W at the origins, see `mobility_factor`, shape (6 b, rank); with zeros the law is explicit.
            time: [s].
        """
        parameters, h, K, C, b = self._parameters, self._step, self._K, self._C, self._bodies
        height, R_SW, mu = self._terrain.nearest(p_WQ)
        e = np.matvec(R_SW, p_WQ - memory.anchor)
        e[:, 2] = height
        r = (p_WQ.reshape(b, -1, 3) - p_WB[:, None]).reshape(-1, 3)
        J = point_jacobians(r, R_SW).reshape(b, -1, 6)
        # Velocities of the points at the end of the step with the contact forces of the last step, and what z takes.
        v_last = (J @ (2.0 * V - memory.V).reshape(b, 6, 1)).reshape(-1, 3)
        Y = (J @ mobility.reshape(b, 6, -1)).reshape(p_WQ.size, -1)
        z = z_last = memory.F @ mobility
        f0, grip, identity = self._pressure - K * e, memory.grip, np.eye(len(z)) / h
        for passes in range(MAX_PASSES):
            # The linear law f0 - B v, multiplied by the grip that each point is assumed to have.
            B = C + h * K
            matrix = Y.T @ ((grip * B).reshape(-1, 1) * Y) + identity
            _, solved, _ = dposv(matrix, z_last + (grip * (B * v_last - f0)).ravel() @ Y)
            z = solved if passes < FULL_PASSES else 0.5 * (z + solved)
            v = v_last - (Y @ z).reshape(-1, 3)

            # The law with its bounds at the end of the step.
            if parameters.separation_damping != 1.0:
                C = np.where(v > 0.0, self._C_rising, self._C)
            end = e + h * v
            linear = self._pressure - K * end - C * v
            f_n = normal_force(parameters, linear[:, 2], end[:, 2])
            load = parameters.averaging * memory.load + (1.0 - parameters.averaging) * f_n
            bound = friction_bound(parameters, mu, f_n, load, self._area, time)
            f_t, kept = friction_force(parameters, K[:, :2] * end[:, :2], linear[:, :2], bound)

            # Another pass if other points press or slide than was assumed.
            assumed, sticks = grip, limit_ratio(norm(f_t), norm(linear[:, :2]))
            grip = in_rows(sticks[:, None], f_n != 0.0)
            if (np.abs(grip - assumed) <= GRIP_TOLERANCE * assumed).all():
                break
        f_S = in_rows(f_t, f_n)
        # The anchors stay behind the points by the stretch that the springs keep.
        dragged = np.vecmat(end[:, :2] * (1.0 - kept)[:, None] - e[:, :2], R_SW[:, :2])
        F = (f_S.reshape(b, 1, -1) @ J).ravel()
        return Contacts(p_WQ, f_S, R_SW, ContactMemory(p_WQ + dragged, load * (f_n != 0.0), grip, V, F))


def in_rows(tangential: Array, normal: Array) -> Array:
    """Return n points' values along the surface, shape (n, 2) or (n, 1), and along its normal, (n,), as (n, 3)."""
    rows = np.empty((len(normal), 3))
    rows[:, :2], rows[:, 2] = tangential, normal
    return rows


def point_jacobians(r: Array, R_SW: Array) -> Array:
    """From [angular; translational] velocities of bodies in W to those of points at r from their origins, in S.

    Args:
        r: In W [m], shape (..., 3).
        R_SW: Axes of the surface, shape (..., 3, 3).

    Returns:
        Rows [r x axis, axis] for the three axes of each point, shape (..., 3, 6).
    """
    return np.concatenate((-R_SW @ cross_matrix(r), R_SW), axis=-1)


def body_jacobians(plant: MultibodyPlant, context: Context, bodies: Sequence[RigidBody]) -> Array:
    """Stacked Jacobians of the bodies' [angular; translational] velocities at their origins, in W, shape (6 b, nv)."""
    world = plant.world_frame()
    frames, kV, origin = [body.body_frame() for body in bodies], JacobianWrtVariable.kV, np.zeros(3)
    return np.vstack([plant.CalcJacobianSpatialVelocity(context, kV, frame, origin, world, world) for frame in frames])


def body_mobility(M: Array, J: Array, added: Array) -> Array:
    """G = J (M + D)^-1 J', the change of body velocities by impulses on the bodies, with a margin; shape (m, m).

    Args:
        M: Mass matrix, shape (nv, nv).
        J: Stacked Jacobians of the bodies' velocities, shape (m, nv).
        added: D, what a step of the joints' law adds to the diagonal, shape (nv,).
    """
    return MOBILITY_MARGIN * J @ np.linalg.solve(M + np.diag(added), J.T)


def mobility_factor(G: Array, rank: int) -> Array:
    """Return Z with Z Z' = G and as many columns as the bodies have degrees of freedom.

    Args:
        G: Mobility of b bodies, shape (6 b, 6 b).
        rank: Number of columns; if it is less than the rank of G, the least mobile directions are left out.

    Returns:
        Shape (6 b, rank).
    """
    mobilities, directions = np.linalg.eigh(G)
    return directions[:, -rank:] * np.sqrt(np.maximum(mobilities[-rank:], 0.0))
