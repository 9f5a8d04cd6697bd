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
from humanwalk.control.ground_force import friction_use
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
        normal: force on each point along the surface's normal [N], shape (b, k).
        friction: force on each point along the surface [N], complex, shape (b, k).
        bound: mu f_n, what friction may reach [N], shape (b, k).
        depth: below the surface [m], negative above it; shape (b, k).
        X: Jacobians of the points, see `point_jacobians`.
        held: stretch of the asperity springs [m], complex, shape (b, k).
        p_WB: origins of the bodies [m], shape (b, 3).
        R_SW: axes of the surface, see `Ground`.
        memory: for the next step.
    """

    normal: Array
    friction: Complex
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
        force: Array = np.vecmat(_components(self.friction, self.normal), self.R_SW)
        return force

    def total(self, bodies: slice) -> tuple[Array, Array]:
        """Force on some of the bodies [N] and its moment about the world's origin [N m], in W, shape (3,) each."""
        tau, f = np.split(self.memory.F[bodies], 2, axis=1)
        return f.sum(axis=0), (tau + np.cross(self.p_WB[bodies], f)).sum(axis=0)

    def friction_use(self, bodies: slice) -> float:
        """Friction on some of the bodies as a share of the most that the ground could give; 0 without contact."""
        friction = np.vecmat(
            _components(self.friction[bodies]),
            np.broadcast_to(self.R_SW, (*self.normal.shape, 3, 3))[bodies][..., :2, :],
        )
        return friction_use(friction.sum(axis=(0, 1)), float(self.bound[bodies].sum()))

    @property
    def stretch(self) -> Array:
        """Of the asperity springs [m], shape (b, k)."""
        return np.abs(self.held)

    @property
    def slip(self) -> Array:
        """Speed along the surface of the points that press on it [m/s], 0 for the others; shape (b, k)."""
        return np.abs(_velocities(self.X, self.memory.V)[0]) * (self.normal > 0.0)


def contact_step(
    parameters: AsperityParameters,
    ground: Ground,
    area: Array,
    p_WB: Array,
    p_WQ: Array,
    V: Array,
    memory: ContactMemory,
    mobility: Array,
    step: float,
    time: float,
) -> Contacts:
    """The contacts of b bodies with k points each.

    Args:
        parameters: of the law.
        ground: the surface.
        area: of the points [m2], shape (b, k).
        p_WB: origins of the bodies [m], shape (b, 3).
        p_WQ: points [m], shape (b, k, 3).
        V: velocities of the bodies at their origins, in W [rad/s, m/s], shape (b, 6).
        memory: what the last step left.
        mobility: G, in W at the origins, shape (6 b, 6 b); of zeros, the law is explicit.
        step: h [s].
        time: [s].
    """
    b, k = area.shape
    height, R_SW = ground(p_WQ)
    depth = -height
    X = point_jacobians(p_WQ - p_WB[:, None], R_SW)

    stretch, _ = _split(np.matvec(R_SW, p_WQ - memory.anchor))
    blocks = step * mobility.reshape(6 * b, b, 6).swapaxes(0, 1)

    # Where everything would go without this step's contact, and which points would then press.
    free = 2.0 * V - memory.V - step * (mobility @ memory.F.ravel()).reshape(b, 6)
    _, rate = _velocities(X, free)
    presses = normal_force(parameters, area, depth + step * rate, rate) != 0.0
    grip = memory.grip
    end = free.ravel()
    for place in range(MOST_PASSES):
        # The law's linearisation F0 - S v, for the points that are thought to press, with the grip that they had.
        touching = area * presses
        gripping = touching * grip
        S = np.empty((b, k, 3))
        S[..., :2] = (gripping * (parameters.velocity_stiffness + step * parameters.spring_stiffness))[..., None]
        S[..., 2] = touching * (normal_damping(parameters, rate) + step * parameters.normal_stiffness)
        f_t = -parameters.spring_stiffness * gripping * stretch
        f_n = touching * (parameters.normal_pressure + parameters.normal_stiffness * depth)
        system = (blocks @ (X.mT @ (S.reshape(b, 3 * k, 1) * X))).swapaxes(0, 1).reshape(6 * b, 6 * b)
        system.flat[:: 6 * b + 1] += 1.0
        solved = np.linalg.solve(system, free.ravel() + step * (mobility @ _wrenches(X, f_t, f_n).ravel()))
        end = solved if place < WHOLE_PASSES else 0.5 * (end + solved)

        # The law itself, there; once more if it finds other points pressing or sliding than was thought.
        velocity, rate = _velocities(X, end.reshape(b, 6))
        f_n = normal_force(parameters, area, depth + step * rate, rate)
        load = parameters.averaging * memory.load + (1.0 - parameters.averaging) * f_n
        # A load that falls faster than its mean must not leave more friction than mu times what is left of it.
        bound = friction_coefficient(parameters, f_n / area, time) * np.maximum(0.0, np.minimum(load, f_n))
        wanted = stretch + step * velocity
        f_t, held = friction_force(parameters, area, wanted, velocity, bound)
        linear = area * np.abs(parameters.spring_stiffness * wanted + parameters.velocity_stiffness * velocity)
        thought, presses = presses, f_n != 0.0
        assumed, grip = grip, np.where(presses, share(np.abs(f_t), linear), 1.0)
        if (thought == presses).all() and (np.abs(grip - assumed) <= GRIP_TOLERANCE * assumed).all():
            break
    return Contacts(
        normal=f_n,
        friction=f_t,
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
            F=_wrenches(X, f_t, f_n),
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
    X[..., :3] = np.matvec((R_SW @ CROSS).reshape(*R_SW.shape, 3), r[..., None, :])
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

    The plant's step is (M + D) v' = (M - E) v - h Kp q + h J' F, q' = q + h v'; F is that of `contact_step`.

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


def _split(vectors: Array) -> tuple[Complex, Array]:
    """Of vectors in S, shape (b, k, 3): what is along the surface, complex, and what is along its normal; (b, k)."""
    return vectors[..., :2].view(np.complex128)[..., 0], vectors[..., 2]


def _components(along: Complex, normal: Array | None = None) -> Array:
    """Vectors in S, shape (b, k, 3), or (b, k, 2) without a normal; the inverse of `_split`."""
    components: Array = np.ascontiguousarray(along)[..., None].view(np.float64)
    return components if normal is None else np.concatenate((components, normal[..., None]), axis=-1)


def _velocities(X: Array, V: Array) -> tuple[Complex, Array]:
    """Of the points, along the surface and into it, shape (b, k) each, from those of the bodies, shape (b, 6)."""
    b, rows = X.shape[:2]
    along, normal = _split((X @ V[..., None]).reshape(b, rows // 3, 3))
    return along, -normal


def _wrenches(X: Array, f_t: Complex, f_n: Array) -> Array:
    """Spatial forces at the bodies' origins in W, shape (b, 6), of forces on the points, shape (b, k)."""
    b, rows = X.shape[:2]
    wrenches: Array = (_components(f_t, f_n).reshape(b, 1, rows) @ X)[:, 0]
    return wrenches
