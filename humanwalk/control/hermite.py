"""Cubic Hermite interpolation of a state between two samples."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class HermitePiece:
    """The cubic that has the positions and the velocities of two samples; outside them it goes on straight.

    Its coefficients are worked out once for the many times at which it is asked.

    Attributes:
        t0, t1: times of the samples [s]. With t1 <= t0 only the second counts.
        x0, x1: states [q; v] of the samples, shape (2n,) each.
        coefficients: of the powers 0 to 3 of t - t0, shape (4, 2n).
    """

    t0: float
    x0: Array
    t1: float
    x1: Array
    coefficients: Array

    @staticmethod
    def between(t0: float, x0: Array, t1: float, x1: Array) -> "HermitePiece":
        """The piece between two samples."""
        n = x0.size // 2
        coefficients = np.zeros((4, x0.size))
        h = t1 - t0
        if h > 0.0:
            q0, v0, q1, v1 = x0[:n], x0[n:], x1[:n], x1[n:]
            chord = (q1 - q0) / h
            bend, twist = (3.0 * chord - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * chord) / (h * h)
            coefficients[:, :n] = q0, v0, bend, twist
            coefficients[:3, n:] = v0, 2.0 * bend, 3.0 * twist
        return HermitePiece(t0, x0, t1, x1, coefficients)

    def at(self, t: float) -> Array:
        """State [q; v] at t [s], shape (2n,), v the time derivative of q."""
        if t >= self.t1:
            return _straight_on(self.x1, t - self.t1)
        if t <= self.t0:
            return _straight_on(self.x0, t - self.t0)
        s = t - self.t0
        state: Array = np.array((1.0, s, s * s, s * s * s)) @ self.coefficients
        return state


def _straight_on(x: Array, elapsed: float) -> Array:
    n = x.size // 2
    later = x.copy()
    later[:n] += elapsed * x[n:]
    return later
