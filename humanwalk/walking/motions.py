"""Motions: a number, or a point of the level plane, with its first two time derivatives."""

from __future__ import annotations

import math
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


def shortest_blend(change: float, max_acceleration: float) -> float:
    """Duration [s] of the shortest blend by `change` whose acceleration, at most 10 / sqrt(3) |change| / time^2, is
    within `max_acceleration`.
    """
    return math.sqrt(10.0 / math.sqrt(3.0) * abs(change) / max_acceleration)


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
        """The motion `dt` later on the quintic that reaches `goal` after `remaining` seconds, but not before `dt`.

        The goal may move from call to call. The mean jerk during `dt` is limited [m/s3]; at the limit it is constant.
        """
        T = max(remaining, dt)
        c3, c4, c5 = self._quintic(goal, T)
        s = dt / T
        jerk = (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5)) / T**3
        if abs(jerk) > jerk_limit:
            return self.after(dt, jerk * jerk_limit / abs(jerk))
        straight = self.after(dt)
        return PlanarMotion(
            straight.position + s**3 * (c3 + s * (c4 + s * c5)),
            straight.velocity + s**2 * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)) / T,
            straight.acceleration + dt * jerk,
        )

    def way(self, goal: PlanarMotion, remaining: float, parts: int) -> list[complex]:
        """Places at equal times on the quintic that reaches `goal` after `remaining` seconds, from here to there."""
        c3, c4, c5 = self._quintic(goal, remaining)
        shares = (i / parts for i in range(parts + 1))
        return [self.after(s * remaining).position + s**3 * (c3 + s * (c4 + s * c5)) for s in shares]

    def _quintic(self, goal: PlanarMotion, T: float) -> tuple[complex, complex, complex]:
        """Coefficients of the quintic to `goal`: the motion of constant acceleration plus c3 s^3 + c4 s^4 + c5 s^5.

        s goes from 0 to 1 in the time T.
        """
        end = self.after(T)
        p, v = goal.position - end.position, T * (goal.velocity - end.velocity)
        a = T**2 * (goal.acceleration - end.acceleration)
        return 10.0 * p - 4.0 * v + 0.5 * a, -15.0 * p + 7.0 * v - a, 6.0 * p - 3.0 * v + 0.5 * a

    def after(self, time: float, jerk: complex = 0.0) -> PlanarMotion:
        """The motion a time later [s] with a constant jerk [m/s3]."""
        return PlanarMotion(
            self.position + time * (self.velocity + time * (self.acceleration / 2.0 + time * jerk / 6.0)),
            self.velocity + time * (self.acceleration + time * jerk / 2.0),
            self.acceleration + time * jerk,
        )

    def with_sideways_of(self, other: PlanarMotion, direction: complex) -> PlanarMotion:
        """This motion along a unit vector, combined with another motion across it."""
        pairs = zip(self, other, strict=True)
        parts = (complex((along / direction).real, (across / direction).imag) for along, across in pairs)
        return PlanarMotion(*(direction * part for part in parts))
