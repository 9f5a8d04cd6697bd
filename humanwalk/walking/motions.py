"""Motions: a number, or a point of the level plane, with its first two time derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
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


class Cubic(NamedTuple):
    """a + b s + c s^2 + d s^3."""

    a: float
    b: float
    c: float
    d: float

    def at(self, s: float) -> ScalarMotion:
        """Value and the first two derivatives by s."""
        a, b, c, d = self
        return ScalarMotion(a + s * (b + s * (c + s * d)), b + s * (2.0 * c + 3.0 * d * s), 2.0 * c + 6.0 * d * s)


class PiecewiseCubic(NamedTuple):
    """Cubics over equal parts of a progress from 0 to 1."""

    pieces: tuple[Cubic, ...]

    @staticmethod
    def through(values: Sequence[float]) -> PiecewiseCubic:
        """The monotone spline through values at equal distances, at rest at both ends.

        Between two values it stays between them (Fritsch and Butland 1984: harmonic means of the slopes on both sides).
        """
        slopes = [after - before for before, after in pairwise(values)]
        tangents = [0.0, *(2.0 * a * b / (a + b) if a * b > 0.0 else 0.0 for a, b in pairwise(slopes)), 0.0]
        return PiecewiseCubic(
            tuple(
                Cubic(a, m, 3.0 * (b - a) - 2.0 * m - n, 2.0 * (a - b) + m + n)
                for (a, b), (m, n) in zip(pairwise(values), pairwise(tangents), strict=True)
            )
        )

    def at(self, progress: float) -> ScalarMotion:
        """Value and the derivatives by the progress, which is clipped to [0, 1]."""
        n = len(self.pieces)
        s = clip(progress, 0.0, 1.0) * n
        i = min(int(s), n - 1)
        return self.pieces[i].at(s - i).time_scaled(n)


class PlanarMotion(NamedTuple):
    """Position, velocity and acceleration of a point over the level plane, complex [m, m/s, m/s2]."""

    position: complex
    velocity: complex = 0.0
    acceleration: complex = 0.0

    def towards(self, goal: PlanarMotion, remaining: float, dt: float, jerk_limit: float) -> PlanarMotion:
        """The motion `dt` later on the quintic that reaches `goal` after `remaining` seconds.

        The jerk is that of the quintic from the current motion, up to a limit [m/s3], and constant for `dt`; the goal
        may move from call to call.
        """
        r = max(remaining, 2.0 * dt)
        jerk = 60.0 * (goal.position - self.position) / r**3
        jerk -= (36.0 * self.velocity + 24.0 * goal.velocity) / r**2
        jerk -= (9.0 * self.acceleration - 3.0 * goal.acceleration) / r
        if abs(jerk) > jerk_limit:
            jerk *= jerk_limit / abs(jerk)
        return PlanarMotion(
            self.position + dt * (self.velocity + dt * (self.acceleration / 2.0 + dt * jerk / 6.0)),
            self.velocity + dt * (self.acceleration + dt * jerk / 2.0),
            self.acceleration + dt * jerk,
        )

    def with_sideways_of(self, other: PlanarMotion, direction: complex) -> PlanarMotion:
        """This motion along a unit vector, combined with another motion across it."""
        pairs = zip(self, other, strict=True)
        parts = (complex((along / direction).real, (across / direction).imag) for along, across in pairs)
        return PlanarMotion(*(direction * part for part in parts))
