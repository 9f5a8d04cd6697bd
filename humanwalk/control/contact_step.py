"""One step of the asperity law on the bodies of a foot, implicit in their velocities.

The law is stiff: under toes of 0.25 kg it would diverge as an explicit force at steps above 0.04 ms. So it is
evaluated at the end of the step, where the bodies will be then. With the mobility G = J (M + D)^-1 J' of the
bodies that touch (D: what the joints add implicitly), their velocities V, and the law's linearisation F = F0 - B V,

    V(t + h) = V(t) + h a + h G F,    a = (V(t) - V(t - h)) / h - G F(t - h),

is one linear system for V(t + h); a is what everything but the contact did in the last step. The law with all its
bounds is then evaluated at that velocity.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import Context
from scipy.linalg import block_diag

from humanwalk.control.asperity import (
    AsperityParameters,
    friction_coefficient,
    friction_force,
    normal_damping,
    normal_force,
    share,
)
from humanwalk.control.ground import Ground
from humanwalk.control.ground_force import friction_use, moments
from humanwalk.control.stability import largest_stable_step

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

MOST_PASSES = 10
"""How often a step is solved at most; sticking and steady sliding take one pass, a change between them two or three."""

WHOLE_PASSES = 3
"""Passes after which one goes only half the way: points that press in one pass and not in the next would alternate."""

GRIP_TOLERANCE = 0.25
"""Relative change of a grip that is worth another pass."""

LONGEST_STEP = 0.002
"""No longer step is called stable [s]: from 3 ms on a block that lands on a slope may be thrown off, which no
linearisation at rest shows."""

MOBILITY_MARGIN = 1.5
"""Factor on the mobility: one that is a tenth too small would make a step of 1 ms unstable, one that is twice too great
only lets the forces lag a little."""

CROSS = np.cross(np.eye(3)[:, None], np.eye(3)).transpose(1, 2, 0).reshape(3, 9)
"""a CROSS, as a matrix (3, 3) times r, is r x a."""


@dataclass(frozen=True)
class ContactMemory:
    """What one step leaves to the next, of b bodies with k points each.

    Attributes:
        anchor: where each point's spring is fastened, p_WA [m], shape (b, k, 3).
        load: running mean of the normal force [N], shape (b, k).
        grip: share of the linear friction that Coulomb's bound left, 1 while it sticks; shape (b, k).
        V: velocities of the bodies [rad/s, m/s], shape (b, 6).
        F: spatial forces of the contact on the bodies at their origins [N m, N], shape (b, 6).
    """

    anchor: Array
    load: Array
    grip: Array
    V: Array
    F: Array

    @staticmethod
    def fresh(p_WQ: Array, V: Array) -> ContactMemory:
        """Of points, shape (b, k, 3), that have touched nothing yet, on bodies with velocities V, shape (b, 6)."""
        return ContactMemory(p_WQ, np.zeros(p_WQ.shape[:2]), np.ones(p_WQ.shape[:2]), V, np.zeros_like(V))


@dataclass(frozen=True)
class Contacts:
    """All contacts at one time; of b bodies with k points each.

    Attributes:
        force_S: force on each point along the axes of the surface [N], shape (b, k, 3).
        bound: mu f_n, what friction may reach [N], shape (b, k).
        depth: below the surface [m], negative above it; shape (b, k).
        X: Jacobians of the points, see `point_jacobians`.
        held: stretch of the asperity springs [m], complex, shape (b, k).
        p_WB: origins of the bodies [m], shape (b, 3).
        R_SW: axes of the surface, see `Ground`.
        memory: for the next step.
    """

    force_S: Array
    bound: Array
    depth: Array
    X: Array
    held: Complex
    p_WB: Array
    R_SW: Array
    memory: ContactMemory

    @property
    def force(self) -> Array:
        """On each point, in W [N], shape (b, k, 3)."""
        force: Array = np.vecmat(self.force_S, self.R_SW)
        return force

    @property
    def normal(self) -> Array:
        """Force on each point along the surface's normal [N], shape (b, k)."""
        return self.force_S[..., 2]

    @property
    def friction(self) -> Complex:
        """Force on each point along the surface [N], shape (b, k)."""
        return _along(self.force_S)

    def total(self, bodies: slice) -> tuple[Array, Array]:
        """Force on some of the bodies [N] and its moment about the world's origin [N m], in W, shape (3,) each."""
        F = self.memory.F[bodies]
        f = F[:, 3:]
        return f.sum(axis=0), F[:, :3].sum(axis=0) + moments(self.p_WB[bodies], f)

    def friction_use(self, bodies: slice) -> float:
        """Friction on some of the bodies as a share of the most that the ground could give; 0 without contact."""
        along = self.force_S * (1.0, 1.0, 0.0)
        friction = np.vecmat(along, self.R_SW)[bodies].sum(axis=(0, 1))
        return friction_use(friction, float(self.bound[bodies].sum()))

    @property
    def stretch(self) -> Array:
        """Of the asperity springs [m], shape (b, k)."""
        return np.abs(self.held)

    @property
    def slip(self) -> Array:
        """Speed along the surface of the points that press on it [m/s], 0 for the others; shape (b, k)."""
        velocity = (self.X @ self.memory.V[..., None]).reshape(self.force_S.shape)
        return np.abs(_along(velocity)) * (self.normal > 0.0)

    def __deepcopy__(self, memo: object) -> Self:
        """Itself: Drake copies abstract values often, and nothing in here ever changes."""
        return self


class ContactStep:
    """The contacts of b bodies with k points each over a step.

    Args:
        parameters: of the law.
        ground: the surface.
        area: of the points [m2], shape (b, k).
        step: h [s].
    """

    def __init__(self, parameters: AsperityParameters, ground: Ground, area: Array, step: float) -> None:
        self._parameters, self._ground, self._area, self._step = parameters, ground, area, step
        p = parameters
        # Of the law that sticks and presses, along the surface's axes: force at rest, and what a velocity adds.
        self._stiffness = area[..., None] * (p.spring_stiffness, p.spring_stiffness, p.normal_stiffness)
        damping = area[..., None] * (p.velocity_stiffness, p.velocity_stiffness, p.normal_damping)
        self._impedance = damping + step * self._stiffness
        # Written anew in every pass: allocating takes as long as adding.
        b, k = area.shape
        self._left, self._system = np.empty((b, k, 3)), np.zeros((b, 6, b, 6))
        self._blocks = np.einsum("iaib->iab", self._system)

    def __call__(
        self, p_WB: Array, p_WQ: Array, V: Array, memory: ContactMemory, mobility: Array, time: float
    ) -> Contacts:
        """The contacts at the end of the step.

        Args:
            p_WB: origins of the bodies [m], shape (b, 3).
            p_WQ: points [m], shape (b, k, 3).
            V: velocities of the bodies at their origins, in W [rad/s, m/s], shape (b, 6).
            memory: what the last step left.
            mobility: G, in W at the origins, shape (6 b, 6 b); of zeros, the law is explicit.
            time: [s].
        """
        parameters, area, step = self._parameters, self._area, self._step
        b, k = area.shape
        height, R_SW = self._ground(p_WQ)
        depth = -height
        X = point_jacobians(p_WQ - p_WB[:, None], R_SW)
        e = np.matvec(R_SW, p_WQ - memory.anchor)
        stretch = _along(e).copy()
        e[..., 2] = height - parameters.normal_pressure / parameters.normal_stiffness
        pull = -self._stiffness * e

        # Where everything would go without this step's contact.
        hG = step * mobility
        end = free = (2.0 * V - memory.V).ravel() - hG @ memory.F.ravel()
        presses, grip, impedance = memory.load > 0.0, memory.grip, self._impedance
        left = self._left
        for place in range(MOST_PASSES):
            # The law's linearisation F0 - S v, for the points that are thought to press, with the grip that they had.
            left[..., 2] = presses
            left[..., :2] = (presses * grip)[..., None]
            np.matmul(X.mT, (left * impedance).reshape(b, 3 * k, 1) * X, out=self._blocks)
            system = hG @ self._system.reshape(6 * b, 6 * b)
            system.flat[:: 6 * b + 1] += 1.0
            solved = np.linalg.solve(system, free + hG @ _wrenches(X, left * pull).ravel())
            end = solved if place < WHOLE_PASSES else 0.5 * (end + solved)

            # The law itself, there; once more if it finds other points pressing or sliding than was thought.
            v = (X @ end.reshape(b, 6, 1)).reshape(b, k, 3)
            velocity, rate = _along(v), -v[..., 2]
            f_n = normal_force(parameters, area, depth + step * rate, rate)
            load = parameters.averaging * memory.load + (1.0 - parameters.averaging) * f_n
            # A load that falls faster than its mean must not leave more friction than mu times what is left of it.
            bound = friction_coefficient(parameters, f_n / area, time) * np.maximum(0.0, np.minimum(load, f_n))
            f_t, held = friction_force(parameters, area, stretch + step * velocity, velocity, bound)
            assumed, grip = grip, share(np.abs(f_t), np.abs(_along(pull - impedance * v)))
            thought, presses = presses, f_n != 0.0
            grip[~presses] = 1.0
            if (thought == presses).all() and (np.abs(grip - assumed) <= GRIP_TOLERANCE * assumed).all():
                break
            if parameters.separation_damping != 1.0:
                impedance = self._impedance.copy()
                impedance[..., 2] = area * (normal_damping(parameters, rate) + step * parameters.normal_stiffness)
        f = np.empty((b, k, 3))
        _along(f)[...] = f_t
        f[..., 2] = f_n
        return Contacts(
            force_S=f,
            bound=bound,
            depth=depth,
            X=X,
            held=held,
            p_WB=p_WB,
            R_SW=R_SW,
            memory=ContactMemory(
                anchor=p_WQ + np.vecmat(_components(step * velocity - held), R_SW[..., :2, :]),
                load=load * presses,
                grip=grip,
                V=V,
                F=_wrenches(X, f),
            ),
        )


def point_jacobians(r: Array, R_SW: Array) -> Array:
    """From [angular; translational] velocities of bodies in W to those of points at r from their origins, in S.

    Args:
        r: in W [m], shape (b, k, 3).
        R_SW: axes of the surface, shape (3, 3) or (b, k, 3, 3).

    Returns:
        Rows [r x axis, axis] for the three axes of each point, shape (b, 3 k, 6).
    """
    b, k = r.shape[:2]
    X = np.empty((b, k, 3, 6))
    X[..., :3] = ((R_SW @ CROSS).reshape(*R_SW.shape[:-2], 9, 3) @ r[..., None]).reshape(b, k, 3, 3)
    X[..., 3:] = R_SW
    return X.reshape(b, 3 * k, 6)


def body_jacobians(plant: MultibodyPlant, context: Context, bodies: Sequence[RigidBody]) -> Array:
    """Stacked Jacobians of the bodies' [angular; translational] velocities at their origins, in W, shape (6 b, nv)."""
    world = plant.world_frame()
    return np.vstack(
        [
            plant.CalcJacobianSpatialVelocity(
                context, JacobianWrtVariable.kV, body.body_frame(), np.zeros(3), world, world
            )
            for body in bodies
        ]
    )


def body_mobility(M: Array, J: Array, added: Array) -> Array:
    """G = J (M + D)^-1 J', how fast impulses on bodies move them, with a margin; shape (m, m).

    Args:
        M: mass matrix, shape (nv, nv).
        J: stacked Jacobians of the bodies' velocities, shape (m, nv).
        added: D, what a step of the joints' law adds to the diagonal, shape (nv,).
    """
    G: Array = MOBILITY_MARGIN * J @ np.linalg.solve(M + np.diag(added), J.T)
    return G


def patch_impedance(r: Array, area: Array, R_SW: Array, along: float, across: float) -> Array:
    """Spatial stiffness (or damping) of patches that press and stick with all their points.

    Args:
        r: points from the origins of their bodies, in W [m], shape (b, k, 3).
        area: of the points [m2], shape (b, k).
        R_SW: axes of the surface, shape (3, 3).
        along, across: per area, along the normal and along the surface [N/m3 or N s/m3].

    Returns:
        [angular; translational] at the origins in W, block diagonal, shape (6 b, 6 b).
    """
    X = point_jacobians(r, R_SW)
    weights = (area[..., None] * np.array([across, across, along])).reshape(len(r), -1, 1)
    matrix: Array = block_diag(*(X.mT @ (weights * X)))
    return matrix


def largest_contact_step(
    M: Array,
    J: Array,
    stiffness: Array,
    damping: Array,
    joint_law: Callable[[float], tuple[Array, Array]],
    joint_stiffness: Array,
    upper: float = LONGEST_STEP,
) -> float:
    """Largest step [s] at which a body that stands on sticking patches stays bounded, linearised at rest.

    The plant's step is (M + D) v' = (M - E) v - h Kp q + h J' F, q' = q + h v'; F is that of `ContactStep`.

    Args:
        M: mass matrix, shape (nv, nv).
        J: Jacobians of the bodies that touch, shape (m, nv).
        stiffness, damping: of the contact, K and C, see `patch_impedance`, shape (m, m).
        joint_law: D and E of the joints' law at a step h, shape (nv,) each.
        joint_stiffness: Kp, shape (nv,).
        upper: step beyond which nothing is looked for [s].
    """
    m, n = J.shape

    def update(h: float) -> Array:
        added, taken = joint_law(h)
        solved, G = np.linalg.inv(M + np.diag(added)), body_mobility(M, J, added)
        # The state is [q, v, V(t - h), F(t - h)]; F = -K J q - B V(t + h) and (1 + h G B) V(t + h) = free - h G K J q.
        of_free = -np.linalg.solve((np.eye(m) + h * G @ (damping + h * stiffness)).T, damping + h * stiffness).T
        F = np.hstack((-(stiffness + h * of_free @ G @ stiffness) @ J, 2.0 * of_free @ J, -of_free, -h * of_free @ G))
        v = np.hstack((-h * solved * joint_stiffness, solved @ (M - np.diag(taken)), np.zeros((n, 2 * m))))
        v += h * solved @ J.T @ F
        q = h * v
        q[:, :n] += np.eye(n)
        return np.vstack((q, v, np.hstack((np.zeros((m, n)), J, np.zeros((m, 2 * m)))), F))

    return largest_stable_step(update, upper)


def _along(vectors: Array) -> Complex:
    """What of vectors in S, shape (b, k, 3), is along the surface; a view, shape (b, k)."""
    along: Complex = vectors[..., :2].view(np.complex128)[..., 0]
    return along


def _components(along: Complex) -> Array:
    """x and y in S, shape (b, k, 2)."""
    return np.ascontiguousarray(along)[..., None].view(np.float64)


def _wrenches(X: Array, f_S: Array) -> Array:
    """Spatial forces at the bodies' origins in W, shape (b, 6), of forces on the points in S, shape (b, k, 3)."""
    b, rows = X.shape[:2]
    wrenches: Array = (f_S.reshape(b, 1, rows) @ X)[:, 0]
    return wrenches
