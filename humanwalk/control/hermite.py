"""Cubic Hermite interpolation of a state between two samples."""

import numpy as np

from humanwalk.numerics import Array


def hermite(t: float, t0: float, x0: Array, t1: float, x1: Array) -> Array:
    """Interpolate a state between two samples, with a first-order hold before the first and after the second.

    The position is the cubic that has the positions and the velocities of both samples; the velocity is its
    derivative.

    Args:
        t: time of the result [s].
        t0, t1: times of the samples [s]; with t1 <= t0 only the second sample is used.
        x0, x1: samples [q; v], shape (2n,) each.

    Returns:
        [q; v] at t, shape (2n,).
    """
    n = x1.size // 2
    q0, v0, q1, v1 = x0[:n], x0[n:], x1[:n], x1[n:]
    if t1 <= t0:
        return np.concatenate((q1 + (t - t1) * v1, v1))
    h = t1 - t0
    inside = min(max(t, t0), t1)
    s = (inside - t0) / h
    q = (1 + 2 * s) * (1 - s) ** 2 * q0 + s**2 * (3 - 2 * s) * q1 + h * s * (1 - s) * ((1 - s) * v0 - s * v1)
    v = 6 * s * (1 - s) / h * (q1 - q0) + (1 - s) * (1 - 3 * s) * v0 + s * (3 * s - 2) * v1
    return np.concatenate((q + (t - inside) * v, v))
