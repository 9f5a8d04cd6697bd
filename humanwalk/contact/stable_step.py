"""The largest step at which the implicit contact step is stable under a body that stands."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import block_diag

from humanwalk.contact.contact_step import body_mobility, point_jacobians
from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step

MAX_STEP = 0.001
"""No longer step is accepted [s]. At 1.5 ms the ankle of a light child oscillates when few points of the foot touch the
ground, which no linearization in standing shows (docs/contact.md)."""


def patch_impedance(r: Array, area: Array, R_SW: Array, normal: float, tangential: float) -> Array:
    """Return the spatial stiffness (or damping) of patches with all their points in sticking contact.

    Args:
        r: Points from the origins of their bodies, in W [m], shape (b, k, 3).
        area: Area of the points [m2], shape (b, k).
        R_SW: Axes of the surface, shape (3, 3).
        normal: Stiffness or damping per area along the normal [N/m3 or N s/m3].
        tangential: The same along the surface.

    Returns:
        [angular; translational] at the origins in W, block diagonal, shape (6 b, 6 b).
    """
    X = point_jacobians(r, np.broadcast_to(R_SW, (*r.shape, 3)))
    weights = area[..., None] * (tangential, tangential, normal)
    matrix: Array = block_diag(*np.einsum("bkia,bki,bkic->bac", X, weights, X))
    return matrix


def largest_contact_step(
    M: Array,
    J: Array,
    stiffness: Array,
    damping: Array,
    joint_law: Callable[[float], tuple[Array, Array]],
    joint_stiffness: Array,
) -> float:
    """Return the largest step [s] up to MAX_STEP at which a body on sticking patches stays bounded, linearized at rest.

    The plant's step is (M + D) v' = (M - E) v - h Kp q + h J' F, q' = q + h v'; F is that of `ContactStep`.

    Args:
        M: Mass matrix, shape (nv, nv).
        J: Jacobians of the bodies that touch, shape (m, nv).
        stiffness: Of the contact, K, see `patch_impedance`, shape (m, m).
        damping: Of the contact, C, likewise.
        joint_law: D and E of the joints' law at a step h, shape (nv,) each.
        joint_stiffness: Kp, shape (nv,).
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

    return largest_stable_step(update, MAX_STEP)
