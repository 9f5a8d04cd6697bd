"""Cubic Hermite interpolation of a state between two samples."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def hermite_between(t0: float, x0: Array, t1: float, x1: Array, t: float) -> Array:
    """State [q; v] at t from the states at t0 < t1: the cubic that has both positions and both velocities.

    Args:
        t0, t1: times of the samples [s]. With t1 <= t0 only the second counts.
        x0, x1: [q; v], shape (2n,) each.
        t: time [s]; outside the samples q moves on with the velocity of the nearer one.

    Returns:
        [q; v] with v the time derivative of q, shape (2n,).
    """
    n = x0.size // 2
    h = t1 - t0
    if t >= t1 or h <= 0.0:
        late = x1.copy()
        late[:n] += (t - t1) * x1[n:]
        return late
    if t <= t0:
        early = x0.copy()
        early[:n] += (t - t0) * x0[n:]
        return early
    u = (t - t0) / h
    rest = 1.0 - u
    x = np.empty_like(x0)
    q0, v0, q1, v1 = x0[:n], x0[n:], x1[:n], x1[n:]
    way = q1 - q0
    x[:n] = q0 + (u * u * (3.0 - 2.0 * u)) * way + (h * u * rest) * (rest * v0 - u * v1)
    x[n:] = (6.0 * u * rest / h) * way + (rest * (1.0 - 3.0 * u)) * v0 + (u * (3.0 * u - 2.0)) * v1
    return x
