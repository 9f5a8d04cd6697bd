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
    h, inside = t1 - t0, min(max(t, t0), t1)
    s = (inside - t0) / h if h > 0 else 1.0
    slope = 6 * s * (1 - s) / h if h > 0 else 0.0
    # Factors of q0, v0, q1, v1 in q and in v.
    q = ((1 + 2 * s) * (1 - s) ** 2, h * s * (1 - s) ** 2, s**2 * (3 - 2 * s), -h * s**2 * (1 - s))
    v = (-slope, (1 - s) * (1 - 3 * s), slope, s * (3 * s - 2))
    factors = np.array((q, v))
    factors[0] += (t - inside) * factors[1]
    return (factors @ np.concatenate((x0, x1)).reshape(4, -1)).ravel()
