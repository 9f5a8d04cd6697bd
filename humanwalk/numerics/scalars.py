"""Small functions of one number."""

import math


def clip(x: float, low: float, high: float) -> float:
    """`x`, kept within two bounds."""
    return min(max(x, low), high)


def wrapped(angle: float) -> float:
    """The same angle in [-pi, pi] [rad]."""
    return math.remainder(angle, 2.0 * math.pi)


def blend(s: float) -> tuple[float, float]:
    """A quintic from 0 at s = 0 to 1 at s = 1 with its slope; it rests at both ends and beyond."""
    s = clip(s, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)) ** 2
