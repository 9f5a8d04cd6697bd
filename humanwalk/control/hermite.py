"""Cubic Hermite interpolation of a state between two samples."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

BEFORE, BETWEEN, AFTER = slice(0, 2), slice(2, 6), slice(6, 8)
"""Rows of a piece's coefficients."""


@dataclass(frozen=True)
class HermitePiece:
    """The cubic that has the positions and the velocities of two samples; outside them it goes on straight.

    Its coefficients are worked out once for the many times at which it is asked.

    Attributes:
        t0, t1: times of the samples [s]. With t1 <= t0 only the second counts.
        rows: coefficients of powers of time, shape (8, m), the constant ones first: of t - t0 before t0 and between
            the samples, of t - t1 after t1.
    """

    t0: float
    t1: float
    rows: Array

    @staticmethod
    def between(t0: float, x0: Array, t1: float, x1: Array) -> "HermitePiece":
        """The piece between two samples [q; v], shape (2n,) each, whose value is such a state."""
        samples = np.concatenate((x0, x1))
        return HermitePiece(t0, t1, _basis(t1 - t0).dot(samples.reshape(4, -1)).reshape(8, -1))

    def mapped(self, linear: Callable[[Array], Array], constant: Array | None = None) -> "HermitePiece":
        """The piece of a function of the value: linear, which is given many values in rows, plus a constant (m,)."""
        rows = linear(self.rows)
        if constant is not None:
            for some in (BEFORE, BETWEEN, AFTER):
                rows[some.start] += constant
        return HermitePiece(self.t0, self.t1, rows)

    def at(self, t: float) -> Array:
        """Value at t [s], shape (m,); of a state its v is the time derivative of its q."""
        if t >= self.t1:
            straight, s = self.rows[AFTER], t - self.t1
        elif t <= self.t0:
            straight, s = self.rows[BEFORE], t - self.t0
        else:
            s = t - self.t0
            # A third of the time of the operator @.
            value: Array = np.array((1.0, s, s * s, s * s * s)).dot(self.rows[BETWEEN])
            return value
        later: Array = straight[0] + s * straight[1]
        return later


@lru_cache(maxsize=64)
def _basis(h: float) -> Array:
    """The matrix that takes q0, v0, q1, v1 of samples h [s] apart to a piece's rows, of q and v by turns; (16, 4)."""
    q0, v0, q1, v1 = np.eye(4)
    still = np.zeros(4)
    bend = twist = still
    if h > 0.0:
        chord = (q1 - q0) / h
        bend, twist = (3.0 * chord - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * chord) / (h * h)
    before, after = (q0, v0, v0, still), (q1, v1, v1, still)
    cubic = (q0, v0, v0, 2.0 * bend, bend, 3.0 * twist, twist, still)
    return np.array((*before, *cubic, *after))
