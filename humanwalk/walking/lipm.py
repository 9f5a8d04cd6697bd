"""The linear inverted pendulum on level ground, told by its divergent component of motion (DCM).

A point of the ground plane is a complex number x + iy [m], and a turn by the angle a is a product with exp(ia).
With the centre of mass c at constant height h and the zero-moment point z, c'' = w^2 (c - z), w = sqrt(g / h). The
DCM xi = c + c'/w runs away from the zero-moment point, xi' = w (xi - z); the rest of the motion follows by itself
(Hof 2008; Takenaka et al. 2009; Englsberger et al. 2015).
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

GRAVITY = 9.81
"""[m/s2]"""


def natural_frequency(height: float) -> float:
    """w = sqrt(g / h) [1/s] of a pendulum of height h [m]."""
    return math.sqrt(GRAVITY / height)


def divergent_component(com: complex, velocity: complex, frequency: float) -> complex:
    """xi = c + c'/w [m]."""
    return com + velocity / frequency


class ZmpSegment(NamedTuple):
    """The zero-moment point on a straight line at constant speed.

    start, end: where it is at the beginning and at the end [m].
    duration: [s], not negative.
    """

    start: complex
    end: complex
    duration: float

    def at(self, t: float) -> complex:
        """Zero-moment point at t [s] after the beginning, which is kept between the two ends."""
        if self.duration <= 0.0:
            return self.end
        return self.start + (self.end - self.start) * min(max(t / self.duration, 0.0), 1.0)

    def rest(self, t: float) -> ZmpSegment:
        """What is left of the segment after t [s]."""
        return ZmpSegment(self.at(t), self.end, max(self.duration - max(t, 0.0), 0.0))

    def forward(self, xi: complex, frequency: float) -> complex:
        """DCM at the end from the DCM at the beginning."""
        x = frequency * self.duration
        return self.end + (xi - self.start) * math.exp(x) - (self.end - self.start) * _mean_growth(x)

    def backward(self, xi: complex, frequency: float) -> complex:
        """DCM at the beginning from the DCM at the end; the inverse of `forward`."""
        x = frequency * self.duration
        return self.start + (xi - self.end) * math.exp(-x) + (self.end - self.start) * _mean_growth(-x)


def _mean_growth(x: float) -> float:
    """(exp(x) - 1) / x, also where x is next to nothing."""
    return math.expm1(x) / x if x != 0.0 else 1.0


def forward(segments: tuple[ZmpSegment, ...], xi: complex, frequency: float) -> complex:
    """DCM at the end of consecutive segments from the DCM at their beginning."""
    for segment in segments:
        xi = segment.forward(xi, frequency)
    return xi


def backward(segments: tuple[ZmpSegment, ...], xi: complex, frequency: float) -> complex:
    """DCM at the beginning of consecutive segments from the DCM at their end."""
    for segment in reversed(segments):
        xi = segment.backward(xi, frequency)
    return xi


def carried(com: complex, xi: complex, zmp: complex, duration: float, frequency: float) -> complex:
    """Centre of mass after a duration [s] over a zero-moment point that stays [m]."""
    growth = math.exp(frequency * max(duration, 0.0))
    half = 0.5 * (xi - zmp)
    return zmp + (com - zmp - half) / growth + half * growth


class HalfSteps(NamedTuple):
    """Something for the step that stands on the left foot and the one that stands on the right."""

    left: complex
    right: complex


class PeriodicGait(NamedTuple):
    """A walk that repeats itself every two steps, turned by twice `turn`.

    A step begins when a foot lands: the zero-moment point goes to it from the old foot (double support), and along
    it (single support). Each step is seen from its own stance foot: origin there, x along its heading.

    displacement: from each stance foot to the next foothold [m]; its two values may differ, so that the walk goes
        sideways and keeps its width.
    turn: of the heading from step to step [rad].
    roll_start, roll_end: zero-moment point at the beginning and end of single support, from the stance foot [m].
    double_support, single_support: durations [s].
    """

    displacement: HalfSteps
    turn: float
    roll_start: complex
    roll_end: complex
    double_support: float
    single_support: float

    def segments(self, stance_is_left: bool) -> tuple[ZmpSegment, ZmpSegment]:
        """The zero-moment point of one step, seen from its stance foot."""
        back = self.displacement.right if stance_is_left else self.displacement.left
        old_end = (self.roll_end - back) * cmath.exp(-1j * self.turn)
        return (
            ZmpSegment(old_end, self.roll_start, self.double_support),
            ZmpSegment(self.roll_start, self.roll_end, self.single_support),
        )

    def end_offsets(self, frequency: float) -> HalfSteps:
        """DCM at the end of each step, seen from its stance foot: the only ones with which the walk repeats itself.

        With a = exp(-w T), the end b of a step and the end b' of the next obey b = d + exp(i turn) (s' + a b'),
        where s' is the beginning of the next step for b' = 0; two such equations are solved for both ends.
        """
        turn = cmath.exp(1j * self.turn)
        gain = turn * math.exp(-frequency * (self.double_support + self.single_support))
        from_left = self.displacement.left + turn * backward(self.segments(False), 0.0, frequency)
        from_right = self.displacement.right + turn * backward(self.segments(True), 0.0, frequency)
        return HalfSteps(
            left=(from_left + gain * from_right) / (1.0 - gain**2),
            right=(from_right + gain * from_left) / (1.0 - gain**2),
        )
