"""Cubic Hermite interpolation of a state between two samples."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from humanwalk.numerics import Array

ROWS = 6
"""Number of rows of a piece."""


@dataclass(frozen=True)
class HermitePiece:
    """The cubic that has the positions and the velocities of two samples; outside them it goes on straight.

    Its coefficients are worked out once for the many times at which it is asked.

    Attributes:
        t0, t1: times of the samples [s], t0 <= t1.
        rows: coefficients, shape (ROWS, m): the value is their sum, weighted by `weights`. Only the first is of a
            constant.
    """

    t0: float
    t1: float
    rows: Array

    @staticmethod
    def between(t0: float, x0: Array, t1: float, x1: Array) -> "HermitePiece":
        """The piece between two samples [q; v], shape (2n,) each, whose value is such a state.

        With t1 <= t0 only the second counts.
        """
        if t1 <= t0:
            t0, x0 = t1, x1
        samples = np.concatenate((x0, x1))
        return HermitePiece(t0, t1, basis(t1 - t0).dot(samples.reshape(4, -1)).reshape(ROWS, -1))

    def mapped(self, linear: Callable[[Array], Array], constant: Array | None = None) -> "HermitePiece":
        """The piece of a function of the value: linear, which is given many values in rows, plus a constant (m,)."""
        rows = linear(self.rows)
        if constant is not None:
            rows[0] += constant
        return HermitePiece(self.t0, self.t1, rows)

    def at(self, t: float) -> Array:
        """Value at t [s], shape (m,); of a state its v is the time derivative of its q."""
        # A third of the time of the operator @.
        value: Array = np.array(weights(t, self.t0, self.t1)).dot(self.rows)
        return value


def weights(
    t: Any, t0: Any, t1: Any, smaller: Callable[[Any, Any], Any] = min, larger: Callable[[Any, Any], Any] = max
) -> tuple[Any, ...]:
    """Weights of a piece's rows at t [s]: powers of the time since t0 up to t1, then times before t0 and after t1.

    Of numbers, or of Drake's symbolic expressions with its min and max.
    """
    s = smaller(larger(t, t0), t1) - t0
    return 1.0, s, s * s, s * s * s, smaller(t - t0, 0.0), larger(t - t1, 0.0)


@lru_cache(maxsize=64)
def basis(h: float) -> Array:
    """The matrix that takes q0, v0, q1, v1 of samples h [s] apart to a piece's rows, of q and v by turns; (12, 4)."""
    q0, v0, q1, v1 = np.eye(4)
    still = bend = twist = np.zeros(4)
    if h > 0.0:
        chord = (q1 - q0) / h
        bend, twist = (3.0 * chord - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * chord) / (h * h)
    return np.array((q0, v0, v0, 2.0 * bend, bend, 3.0 * twist, twist, still, v0, still, v1, still))
