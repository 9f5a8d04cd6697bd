"""Quadratic programs of accelerations and contact forces, solved by DAQP."""

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
        # DAQP ignores constraints that are NaN.
        if not all(np.isfinite(part).all() for part in self):
            return None
        # DAQP inverts its Hessian in plain loops, which takes longer than the rest of the solution. In y, where a = T y
        # and T' H T = 1, it is the identity; the bounds of a become rows, those of f remain bounds of variables.
        T = dtrtri(np.linalg.cholesky(self.H), lower=True)[0].T
        m, k = self.H.shape[0], self.B.shape[1]
        constraints = np.zeros((m + len(self.A), k + m))
        constraints[:m, k:], constraints[m:, :k], constraints[m:, k:] = T, self.B, self.A @ T
        cost = np.concatenate((np.zeros(k), self.g @ T))
        sense = np.multiply(self.lower == self.upper, EQUALITY, dtype=np.int32)
        x, _, flag, _ = daqp.solve(
            np.eye(k + m), cost, constraints, self.upper, self.lower, sense, iter_limit=MAX_ITERATIONS
        )
        return (T @ x[k:], x[:k]) if flag > 0 else None
