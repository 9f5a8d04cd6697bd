"""The largest step at which a linear discrete update stays bounded."""

from collections.abc import Callable

import numpy as np

from humanwalk.numerics import Array

SHORTEST_STEP = 1e-7
"""Nothing shorter is looked for [s]."""

ROUNDING = 1e-9
"""How far above 1 an eigenvalue counts as 1: free motion of the floating base has eigenvalues of exactly 1."""


def largest_stable_step(update: Callable[[float], Array], upper: float = 0.1) -> float:
    """Largest step h [s] up to `upper` at which every eigenvalue of update(h) lies in the unit disc, to 1 %.

    Args:
        update: matrix of the discrete update x' = A(h) x, shape (m, m), stable for every step below a stable one.
        upper: longest step that is looked at [s].
    """

    def is_stable(h: float) -> bool:
        return bool(np.abs(np.linalg.eigvals(update(h))).max() <= 1.0 + ROUNDING)

    low, high = SHORTEST_STEP, upper
    if is_stable(high):
        return high
    while high / low > 1.01:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low


def round_down(step: float) -> float:
    """A step [s] to two digits, rounded down, so that the step a message names is one that is accepted."""
    digit = 10.0 ** (np.floor(np.log10(step)) - 1)
    return float(digit * np.floor(step / digit * (1 + 1e-12)))
