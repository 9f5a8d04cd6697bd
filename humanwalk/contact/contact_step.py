"""One step of the asperity law on the bodies of a foot, implicit in their velocities.

The law is stiff: under toes of 0.25 kg it would diverge as an explicit force at steps above 0.04 ms. So it is
evaluated at the end of the step, where the bodies will be then. With the mobility G = J (M + D)^-1 J' of the
bodies that touch (D: what the joints add implicitly), their velocities V, and the law's linearisation F = F0 - B V,

    V(t + h) = V(t) + h a + h G F,    a = (V(t) - V(t - h)) / h - G F(t - h),

is one linear system for V(t + h); a is what everything but the contact did in the last step. The law with all its
bounds is then evaluated at that velocity.

Feet whose bodies are connected by joints move in fewer ways than 6 a body. So the unknown is not V(t + h) but
z = h Z' (F(t - h) - F), with G = Z Z' and a column of Z for each way: 16 numbers for the six bodies of the feet, and a
matrix 1 / h + Z' B Z that is symmetric and positive.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import Context
from scipy.linalg import block_diag
from scipy.linalg.lapack import dposv, dpstrf

from humanwalk.contact.asperity import (
    ZERO,
    AsperityParameters,
    friction_bound,
    friction_force,
    normal_force,
    point_damping,
    point_stiffness,
    share,
)
from humanwalk.contact.ground_force import friction_use, moments
from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step
from humanwalk.terrain.ground import Ground

Complex = npt.NDArray[np.complex128]

MOST_PASSES = 10
"""How often a step is solved at most; sticking and steady sliding take one pass, a change between them two or three."""

WHOLE_PASSES = 3
"""Passes after which one goes only half the way: points that press in one pass and not in the next would alternate."""

GRIP_TOLERANCE = np.array(0.25)
"""Relative change of a grip that is worth another pass."""

LONGEST_STEP = 0.002
"""No longer step is called stable [s]: from 3 ms on a block that lands on a slope may be thrown off, which no
linearisation at rest shows."""

MOBILITY_MARGIN = 1.5
"""Factor on the mobility: one that is a tenth too small would make a step of 1 ms unstable, one that is twice too great
only lets the forces lag a little."""

RANK_TOLERANCE = 1e-12
"""What is left of a mobility, relative to its greatest element, that counts as nothing."""

ALONG = np.array(1.0 + 1.0j)
"""Makes a number a vector along the surface that has it as x and as y."""


class ContactMemory(NamedTuple):
    """What one step leaves to the next, of b bodies with k points each, n = b k together.

    Attributes:
        anchor: where each point's spring is fastened, p_WA [m], shape (n, 3).
        load: running mean of the normal force [N], 0 in the air; shape (n,).
        grip: share of its linear force that the bounds left to each point, 1 while it presses and sticks, 0 in the air;
            x and y of each point first, then the normals, shape (3 n,).
        V: velocities of the bodies [rad/s, m/s], shape (6 b,).
        F: spatial forces of the contact on the bodies at their origins [N m, N], shape (6 b,).
    """

    anchor: Array
    load: Array
    grip: Array
    V: Array
    F: Array

    @staticmethod
    def fresh(p_WQ: Array, V: Array) -> ContactMemory:
        """Of points, shape (n, 3), that have touched nothing yet, on bodies with velocities V, shape (6 b,)."""
        return ContactMemory(p_WQ, np.zeros(len(p_WQ)), np.zeros(p_WQ.size), V, np.zeros_like(V))


class Contacts(NamedTuple):
    """All contacts at one time; of b bodies with k points each, n = b k together.

    Attributes:
        friction: force on each point along the surface [N], complex, shape (n,).
        normal: force on each point along the surface's normal [N], shape (n,).
        bound: mu f_n, what friction may reach [N], shape (n,).
        height: above the surface [m], negative below it; shape (n,).
        held: stretch of the asperity springs [m], complex, shape (n,).
        p_WB: origins of the bodies [m], shape (b, 3).
        p_WQ: points [m], shape (n, 3).
        R_SW: axes of the surface, see `Ground`.
        memory: for the next step.
    """

    friction: Complex
    normal: Array
    bound: Array
    height: Array
    held: Complex
    p_WB: Array
    p_WQ: Array
    R_SW: Array
    memory: ContactMemory

    @property
    def force(self) -> Array:
        """On each point, in W [N], shape (n, 3)."""
        return _in_world(self.R_SW, self.friction) + self.normal[:, None] * self.R_SW[..., 2, :]

    def total(self, bodies: slice) -> tuple[Array, Array]:
        """Force on some of the bodies [N] and its moment about the world's origin [N m], in W, shape (3,) each."""
        F = self.memory.F.reshape(-1, 6)[bodies]
        f = F[:, 3:]
        return f.sum(axis=0), F[:, :3].sum(axis=0) + moments(self.p_WB[bodies], f)

    def friction_use(self, bodies: slice) -> float:
        """Friction on some of the bodies as a share of the most that the ground could give; 0 without contact."""
        b = len(self.p_WB)
        friction, bound = _in_world(self.R_SW, self.friction).reshape(b, -1, 3), self.bound.reshape(b, -1)
        return friction_use(friction[bodies].sum(axis=(0, 1)), float(bound[bodies].sum()))

    @property
    def stretch(self) -> Array:
        """Of the asperity springs [m], shape (n,)."""
        return np.abs(self.held)

    @property
    def slip(self) -> Array:
        """Speed along the surface of the points that press on it [m/s], 0 for the others; shape (n,)."""
        b, V = len(self.p_WB), self.memory.V.reshape(-1, 1, 6)
        velocity = V[..., 3:] + np.cross(V[..., :3], self.p_WQ.reshape(b, -1, 3) - self.p_WB[:, None])
        along = np.matvec(self.R_SW, velocity.reshape(-1, 3))[:, :2]
        slip: Array = np.hypot(*along.T) * (self.normal > 0.0)
        return slip

    def __deepcopy__(self, memo: object) -> Self:
        """Itself: Drake copies abstract values often, and nothing in here ever changes."""
        return self


class ContactStep:
    """The contacts of b bodies with k points each over a step, n = b k together.

    What is written anew in every step is allocated once, and all vectors of the points are in one piece, x and y of
    each point first, then the normals: with so few points it is the calls of numpy that cost, and so they cost least.

    Args:
        parameters: of the law.
        ground: the surface.
        area: of the points [m2], shape (b, k).
        step: h [s].
        rank: of the mobility, see `mobility_factor`.
    """

    def __init__(self, parameters: AsperityParameters, ground: Ground, area: Array, step: float, rank: int) -> None:
        self._parameters, self._ground, self._area = parameters, ground, area.ravel()
        K, C = point_stiffness(parameters, self._area), point_damping(parameters, self._area)
        (b, k), n = area.shape, area.size
        self._stiffness, self._at_rest, self._impedance = K, step * K, C + step * K
        self._spring = parameters.spring_stiffness * self._area
        self._pressure = np.concatenate((np.zeros(2 * n), parameters.normal_pressure * self._area))
        # numpy takes arrays quicker than Python's numbers.
        self._step, self._averaging = np.array(step), np.array(parameters.averaging)
        self._newest, self._eye = np.array(1.0 - parameters.averaging), np.eye(rank) / step

        # Where the Jacobians of the points are not 0: x, y and normal of each point, by the velocity of its own body.
        point = np.arange(n)
        rows = np.stack((2 * point, 2 * point + 1, 2 * n + point), axis=1)
        own = 6 * b * rows[..., None] + 6 * (point // k)[:, None, None] + np.arange(6)
        self._places, self._turning_places = own.ravel(), own[..., :3].ravel()
        _, R_SW = ground(np.zeros(3))
        self._X, self._k = np.zeros((3 * n, 6 * b)), k
        self._X.ravel()[self._places] = point_jacobians(np.zeros((n, 3)), R_SW).ravel()
        self._turning = point_jacobians(np.eye(3), R_SW)[..., :3].reshape(3, 9)

    def __call__(
        self, p_WB: Array, p_WQ: Array, V: Array, memory: ContactMemory, mobility: Array, time: float
    ) -> Contacts:
        """The contacts at the end of the step.

        Args:
            p_WB: origins of the bodies [m], shape (b, 3).
            p_WQ: points of one body after the other [m], shape (n, 3).
            V: velocities of the bodies at their origins, in W [rad/s, m/s], shape (6 b,).
            memory: what the last step left.
            mobility: Z, in W at the origins, see `mobility_factor`, shape (6 b, rank); of zeros, the law is explicit.
            time: [s].
        """
        parameters, n = self._parameters, len(p_WQ)
        height, R_SW = self._ground(p_WQ)
        X = self._jacobians(p_WB, p_WQ, R_SW)
        e = np.concatenate((_along(R_SW, p_WQ - memory.anchor), height))
        impedance = self._impedance
        v0, e0 = self._unloaded(e, impedance)

        # How much faster than v0 the points would get with the last step's forces, and how much each of z slows them.
        faster = X.dot(V + V - memory.V) - v0
        Y = X.dot(mobility)
        z = last = memory.F.dot(mobility)
        running, grip = self._averaging * memory.load, memory.grip
        for place in range(MOST_PASSES):
            # The linear law, for the points that are thought to press, with the grip that they had.
            weight = grip * impedance
            system = Y.T.dot(weight[:, None] * Y) + self._eye
            # Symmetric, so its transpose has the order that LAPACK may write into.
            _, solved, _ = dposv(system.T, (weight * faster).dot(Y) + last, overwrite_a=True, overwrite_b=True)
            z = solved if place < WHOLE_PASSES else 0.5 * (z + solved)
            short = Y.dot(z) - faster
            if parameters.separation_damping != 1.0:
                v = v0 - short
                impedance = self._at_rest + point_damping(parameters, self._area, v[2 * n :] > 0.0)
                v0, e0 = self._unloaded(e, impedance)
                short, faster = v0 - v, faster + (v - v0) + short

            # The law with its bounds; once more if it finds other points pressing or sliding than was thought.
            f, end = impedance * short, e0 - self._step * short
            linear, stretch = f[: 2 * n].view(complex), end[: 2 * n].view(complex)
            f_n = normal_force(parameters, f[2 * n :], end[2 * n :])
            load = running + self._newest * f_n
            bound = friction_bound(parameters, f_n, load, self._area, time)
            f_t, kept = friction_force(parameters, self._spring * stretch, linear, bound)
            assumed, grip = grip, np.empty_like(f)
            np.multiply(share(np.abs(f_t), np.abs(linear)), ALONG, out=grip[: 2 * n].view(complex))
            grip[2 * n :] = f_n != ZERO
            if not np.count_nonzero(np.abs(grip - assumed) > GRIP_TOLERANCE * assumed):
                break
        f[: 2 * n], f[2 * n :] = f_t.view(float), f_n
        held = kept * stretch
        return Contacts(
            friction=f_t,
            normal=f_n,
            bound=bound,
            height=height,
            held=held,
            p_WB=p_WB,
            p_WQ=p_WQ,
            R_SW=R_SW,
            memory=ContactMemory(
                # The anchors stay behind the points by what the springs hold.
                anchor=p_WQ + _in_world(R_SW, stretch - e[: 2 * n].view(complex) - held),
                load=load * grip[2 * n :],
                grip=grip,
                V=V,
                F=f.dot(X),
            ),
        )

    def _unloaded(self, e: Array, impedance: Array) -> tuple[Array, Array]:
        """Velocity over the step with which points at e end without a force of the linear law, and where they end."""
        v0 = (self._pressure - self._stiffness * e) / impedance
        return v0, e + self._step * v0

    def _jacobians(self, p_WB: Array, p_WQ: Array, R_SW: Array) -> Array:
        """From the bodies' velocities to those of the points along the surface's axes, shape (3 n, 6 b)."""
        r = p_WQ - p_WB.repeat(self._k, 0)
        if R_SW.ndim == 2:  # A plane's: only r changes.
            self._X.ravel()[self._turning_places] = r.dot(self._turning).ravel()
        else:
            self._X.ravel()[self._places] = point_jacobians(r, R_SW).ravel()
        return self._X


def point_jacobians(r: Array, R_SW: Array) -> Array:
    """From [angular; translational] velocities of bodies in W to those of points at r from their origins, in S.

    Args:
        r: in W [m], shape (..., 3).
        R_SW: axes of the surface, shape (3, 3) or (..., 3, 3).

    Returns:
        Rows [r x axis, axis] for the three axes of each point, shape (..., 3, 6).
    """
    X = np.empty((*r.shape, 6))
    X[..., :3], X[..., 3:] = np.cross(r[..., None, :], R_SW), R_SW
    return X


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
    _, accelerations, _ = dposv(M + np.diag(added), MOBILITY_MARGIN * J.T)
    G: Array = J @ accelerations
    return G


def mobility_factor(G: Array, rank: int) -> Array:
    """Z with Z Z' = G, of as many columns as G has a rank: bodies that joints connect move each other in fewer ways.

    Args:
        G: mobility of b bodies, shape (6 b, 6 b).
        rank: number of columns; if it is less than the rank of G, the least mobile ways are left out.

    Returns:
        Shape (6 b, rank).
    """
    Z, pivots, found, _ = dpstrf(G, tol=RANK_TOLERANCE * G.max(), lower=1)
    found = min(found, rank)
    factor = np.zeros((len(G), rank))
    factor[pivots - 1, :found] = np.tril(Z[:, :found])
    return factor


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
    weights = area[..., None] * (across, across, along)
    matrix: Array = block_diag(*np.einsum("bkia,bki,bkic->bac", X, weights, X))
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


def _along(R_SW: Array, vectors: Array) -> Array:
    """x and y in S of each of n vectors in W, shape (2 n,)."""
    R = R_SW[..., :2, :]
    along: Array = vectors.dot(R.T) if R.ndim == 2 else np.matvec(R, vectors)
    return along.ravel()


def _in_world(R_SW: Array, along: Complex) -> Array:
    """Of vectors along the surface, shape (n,), in W, shape (n, 3)."""
    R, vectors = R_SW[..., :2, :], along.view(float).reshape(-1, 2)
    world: Array = vectors.dot(R) if R.ndim == 2 else np.vecmat(vectors, R)
    return world
