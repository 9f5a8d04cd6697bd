"""Functions of one number: bounds, angles, blending."""

import math
from typing import overload

from humanwalk.numerics import Array


def clip(x: float, low: float, high: float) -> float:
    """`x` limited to [low, high]."""
    return min(max(x, low), high)


def wrapped(angle: float) -> float:
    """Equivalent angle from -pi to pi [rad]."""
    return math.remainder(angle, 2.0 * math.pi)


@overload
def quintic_blend(s: float) -> tuple[float, float, float]: ...
@overload
def quintic_blend(s: Array) -> tuple[Array, Array, Array]: ...
def quintic_blend(s: float | Array) -> tuple[float | Array, ...]:
    """10 s^3 - 15 s^4 + 6 s^5 and its first two derivatives, for s in [0, 1]: from 0 to 1, at rest at both ends."""
    rest = 1.0 - s
    return (s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * rest) ** 2, 60.0 * s * rest * (rest - s))
