"""A scalar quantity together with its first two time derivatives."""

from __future__ import annotations

from typing import NamedTuple

from humanwalk.numerics.scalars import clip, quintic_blend


class ScalarMotion(NamedTuple):
    """Value, rate and acceleration of a height [m] or an angle [rad]."""

    value: float = 0.0
    rate: float = 0.0
    acceleration: float = 0.0

    def plus(self, other: ScalarMotion) -> ScalarMotion:
        """The sum of two motions."""
        return ScalarMotion(self.value + other.value, self.rate + other.rate, self.acceleration + other.acceleration)

    def time_scaled(self, factor: float) -> ScalarMotion:
        """The same motion when its time, or the variable it depends on, advances by `factor` per second."""
        return ScalarMotion(self.value, factor * self.rate, factor**2 * self.acceleration)


def blend(start: float, end: float, time: float, duration: float) -> ScalarMotion:
    """Quintic motion from `start` to `end` within a duration; at rest before and after."""
    s, slope, curvature = quintic_blend(clip(time / duration, 0.0, 1.0))
    change = end - start
    return ScalarMotion(start + change * s, change * slope / duration, change * curvature / duration**2)
