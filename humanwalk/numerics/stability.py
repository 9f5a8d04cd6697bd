"""Largest time step at which a linear discrete update is stable."""

from collections.abc import Callable

import numpy as np

from humanwalk.numerics import Array

MIN_STEP = 1e-7
"""Lower end of the search [s]."""

EIGENVALUE_TOLERANCE = 1e-9
"""Allowed excess over 1: free motion of the floating base has eigenvalues of 1, up to rounding."""


def largest_stable_step(update: Callable[[float], Array], upper: float = 0.1) -> float:
    """Largest step h at which every eigenvalue of update(h) lies in the unit disc, by bisection.

    Args:
        update: Matrix A(h) of the discrete update x' = A(h) x, shape (m, m). If it is stable at a step, it is stable
            at all shorter ones.
        upper: Upper end of the search [s].

    Returns:
        Step [s], at most 1 % shorter than the largest stable one.
    """

    def is_stable(h: float) -> bool:
        return bool(np.abs(np.linalg.eigvals(update(h))).max() <= 1.0 + EIGENVALUE_TOLERANCE)

    low, high = MIN_STEP, upper
    if is_stable(high):
        return high
    while high / low > 1.01:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low


def round_down(step: float) -> float:
    """Round a step [s] down to two digits, so that the step in an error message is accepted."""
    digit = 10.0 ** (np.floor(np.log10(step)) - 1)
    return float(digit * np.floor(step / digit * (1 + 1e-12)))


def round_up(value: float) -> float:
    """Round a positive value up to two digits, so that the lower bound in an error message is accepted."""
    digit = 10.0 ** (np.floor(np.log10(value)) - 1)
    return float(digit * np.ceil(value / digit * (1 - 1e-12)))
