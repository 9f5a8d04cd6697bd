"""Quadratic programs of accelerations and contact forces, solved by DAQP."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import daqp
import numpy as np
from scipy.linalg.lapack import dpotrf, dtrtri

from humanwalk.numerics import Array

EQUALITY = 5
"""DAQP's code of an equality constraint."""
MAX_ITERATIONS = 500
"""Maximum number of changes of the active set; the programs of a walk take 8 on average, 50 at most."""


class QuadraticProgram(NamedTuple):
    """min a'Ha/2 + g'a + f'f/2 subject to lower <= (f, a, A a + B f) <= upper; equal bounds are an equality constraint.

    H: (m, m). g: (m,). A: (rows, m). B: (rows, k). lower, upper: (k + m + rows,).
    """

    H: Array
    g: Array
    A: Array
    B: Array
    lower: Array
    upper: Array

    def solution(self) -> tuple[Array, Array] | None:
        """The solution a and f, or None if the solver finds none; the same program has the same solution bit by bit."""
        # DAQP would invert H in plain loops, which takes longer than the rest of the solution. With H = U'U and y = U a
        # the cost is y'y/2 plus linear terms; the bounds of a become rows, those of f remain bounds of variables.
        U, undefined = dpotrf(self.H.T, clean=1)
        if undefined:
            return None
        to_a, _ = dtrtri(U, overwrite_c=1)
        (rows, m), k = self.A.shape, self.B.shape[1]
        constraints, cost = np.zeros((m + rows, k + m)), np.zeros(k + m)
        constraints[:m, k:] = to_a
        constraints[m:, :k] = self.B
        np.matmul(self.A, to_a, out=constraints[m:, k:])
        np.matmul(self.g, to_a, out=cost[k:])
        # DAQP ignores constraints that are NaN.
        if not math.isfinite(np.vdot(constraints, constraints) + cost @ cost + self.lower @ self.upper):
            return None
        kind = np.multiply(self.lower == self.upper, EQUALITY, dtype=np.int32)
        identity = _identity(k + m)
        x, _, flag, _ = daqp.solve(identity, cost, constraints, self.upper, self.lower, kind, iter_limit=MAX_ITERATIONS)
        return (to_a @ x[k:], x[:k]) if flag > 0 else None


@cache
def _identity(size: int) -> Array:
    return np.eye(size)
