"""Quadratic programs, solved by DAQP."""

from __future__ import annotations

from typing import NamedTuple

import daqp
import numpy as np
from scipy.linalg.lapack import dtrtri

from humanwalk.numerics import Array

EQUALITY = 5
"""DAQP's code of an equality constraint."""
MAX_ITERATIONS = 500
"""Maximum number of changes of the active set; the programs of a walk take 8 on average, 50 at most."""


class QuadraticProgram(NamedTuple):
    """min x'Hx/2 + g'x subject to lower <= (x, A x) <= upper; equal bounds are an equality constraint.

    H: positive definite, (n, n). g: (n,). A: (rows, n). lower, upper: (n + rows,).
    """

    H: Array
    g: Array
    A: Array
    lower: Array
    upper: Array

    def solution(self) -> Array | None:
        """The solution x, or None if the solver finds none; the same program has the same solution bit by bit."""
        # DAQP ignores constraints that are NaN.
        if not all(np.isfinite(part).all() for part in self):
            return None
        # DAQP inverts its Hessian in plain loops, which takes longer than the rest of the solution. In y, where x = T y
        # and T' H T = 1, it is the identity, and the bounds of x are rows.
        T = dtrtri(np.linalg.cholesky(self.H), lower=True)[0].T
        constraints = np.vstack((T, self.A @ T))
        sense = np.multiply(self.lower == self.upper, EQUALITY, dtype=np.int32)
        y, _, flag, _ = daqp.solve(
            np.eye(len(T)), self.g @ T, constraints, self.upper, self.lower, sense, iter_limit=MAX_ITERATIONS
        )
        return T @ y if flag > 0 else None
