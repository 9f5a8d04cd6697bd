"""Cubic Hermite interpolation of a state between two samples."""

from collections.abc import Callable
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
        before, cubic, after: coefficients of powers of t - t0, t - t0 and t - t1, shape (2, m), (4, m), (2, m).
    """

    t0: float
    t1: float
    before: Array
    cubic: Array
    after: Array

    @staticmethod
    def between(t0: float, x0: Array, t1: float, x1: Array) -> "HermitePiece":
        """The piece between two samples [q; v], shape (2n,) each, whose value is such a state."""
        n = x0.size // 2
        q0, v0, q1, v1 = x0[:n], x0[n:], x1[:n], x1[n:]
        before, cubic, after = np.zeros((2, 2 * n)), np.zeros((4, 2 * n)), np.zeros((2, 2 * n))
        before[0], after[0] = x0, x1
        before[1, :n], after[1, :n] = v0, v1
        h = t1 - t0
        if h > 0.0:
            chord = (q1 - q0) / h
            bend, twist = (3.0 * chord - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * chord) / (h * h)
            cubic[:, :n] = q0, v0, bend, twist
            cubic[:3, n:] = v0, 2.0 * bend, 3.0 * twist
        return HermitePiece(t0, t1, before, cubic, after)

    def mapped(self, function: Callable[[Array], Array]) -> "HermitePiece":
        """The piece of an affine function of the value, which maps coefficients (k, m), the constant ones first."""
        return HermitePiece(self.t0, self.t1, function(self.before), function(self.cubic), function(self.after))

    def at(self, t: float) -> Array:
        """Value at t [s], shape (m,); of a state its v is the time derivative of its q."""
        if t >= self.t1:
            straight, s = self.after, t - self.t1
        elif t <= self.t0:
            straight, s = self.before, t - self.t0
        else:
            s = t - self.t0
            value: Array = np.array((1.0, s, s * s, s * s * s)) @ self.cubic
            return value
        later: Array = straight[0] + s * straight[1]
        return later
