"""The linear inverted pendulum and its divergent component of motion (DCM).

A point of the level plane is a complex number x + iy [m]; multiplication by exp(ia) rotates it by the angle a. With the
center of mass c at a constant height h above the zero-moment point z, c'' = w^2 (c - z), w = sqrt(g / h). The DCM
xi = c + c'/w diverges from the zero-moment point, xi' = w (xi - z), and the center of mass converges to the DCM
(Hof 2008; Takenaka et al. 2009; Englsberger et al. 2015).

A body with angular momentum L about its center of mass obeys the same equations with the centroidal moment pivot in the
place of z: the point where a line through the center of mass along the ground force meets the ground (Popovic, Goswami,
Herr 2005). For walking along x it is ahead of the zero-moment point by L_y' over the vertical force.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from humanwalk.body import Side
from humanwalk.quantity import GRAVITY
from humanwalk.sides import other_side


def natural_frequency(height: float) -> float:
    """w = sqrt(g / h) [1/s] of a pendulum of height h [m]."""
    return math.sqrt(GRAVITY / height)


def divergent_component(com: complex, velocity: complex, frequency: float) -> complex:
    """xi = c + c'/w [m]."""
    return com + velocity / frequency


class ZmpSegment(NamedTuple):
    """A zero-moment point that moves along a line at constant speed.

    Attributes:
        start, end: Where it begins and ends [m].
        duration: [s], not negative.
    """

    start: complex
    end: complex
    duration: float

    def at(self, t: float) -> complex:
        """The zero-moment point t [s] after the start; constant before the start and after the end."""
        if self.duration <= 0.0:
            return self.end
        return self.start + (self.end - self.start) * min(max(t / self.duration, 0.0), 1.0)

    def moved(self, by: complex, direction: complex = 1.0) -> ZmpSegment:
        """The segment turned into a direction, a unit vector, and moved."""
        return ZmpSegment(direction * self.start + by, direction * self.end + by, self.duration)

    def remainder(self, t: float) -> ZmpSegment:
        """The part of the segment from t [s] after the start."""
        return ZmpSegment(self.at(t), self.end, max(self.duration - max(t, 0.0), 0.0))

    def forward(self, xi: complex, frequency: float) -> complex:
        """DCM at the end from the DCM at the start."""
        x = frequency * self.duration
        return self.end + (xi - self.start) * math.exp(x) - (self.end - self.start) * _mean_growth(x)

    def backward(self, xi: complex, frequency: float) -> complex:
        """DCM at the start from the DCM at the end; the inverse of `forward`."""
        x = frequency * self.duration
        return self.start + (xi - self.end) * math.exp(-x) + (self.end - self.start) * _mean_growth(-x)


def _mean_growth(x: float) -> float:
    """(exp(x) - 1) / x; 1 at x = 0."""
    return math.expm1(x) / x if x != 0.0 else 1.0


def forward(segments: tuple[ZmpSegment, ...], xi: complex, frequency: float) -> complex:
    """DCM at the end of consecutive segments from the DCM at their start."""
    for segment in segments:
        xi = segment.forward(xi, frequency)
    return xi


def backward(segments: tuple[ZmpSegment, ...], xi: complex, frequency: float) -> complex:
    """DCM at the start of consecutive segments from the DCM at their end."""
    for segment in reversed(segments):
        xi = segment.backward(xi, frequency)
    return xi


def com_after(duration: float, com: complex, xi: complex, zmp: complex, frequency: float) -> complex:
    """Center of mass after a duration [s] with a constant zero-moment point [m]."""
    growth = math.exp(frequency * max(duration, 0.0))
    half = 0.5 * (xi - zmp)
    return zmp + (com - zmp - half) / growth + half * growth


def remainder(segments: tuple[ZmpSegment, ...], t: float) -> tuple[ZmpSegment, ...]:
    """The part of consecutive segments from t [s] after their start; at least a part of the last one."""
    first, *others = segments
    if others and t >= first.duration:
        return remainder(tuple(others), t - first.duration)
    return (first.remainder(t), *others)


class PerStance(NamedTuple):
    """A quantity of the step on the left foot and of the step on the right foot."""

    left: complex
    right: complex

    def on(self, stance: Side) -> complex:
        """The value for a stance foot."""
        return self.left if stance == "Left" else self.right


class PeriodicGait(NamedTuple):
    """A walk that repeats itself every two steps, rotated by twice `turn`.

    A step begins at touchdown. In double support the zero-moment point moves from the old to the new stance foot, in
    single support along the stance foot. The centroidal moment pivot is ahead of it by -`pivot` at the beginning and
    +`pivot` at the end of single support, linearly between: while a leg swings, its angular momentum first falls and
    then rises, in double support the legs exchange it. All points are relative to the nominal zero-moment point at the
    beginning of single support, x along the heading of the stance foot.

    Attributes:
        displacement: From each stance foot to the next foothold [m]; the two differ in a sideways walk.
        turn: Change of the heading from step to step [rad].
        roll: Displacement of the zero-moment point in single support [m].
        double_support, single_support: Durations [s].
        pivot: Greatest distance of the centroidal moment pivot from the zero-moment point [m].
        hold: Last part of single support, in which the zero-moment point does not move any more [s].
    """

    displacement: PerStance
    turn: float
    roll: complex
    double_support: float
    single_support: float
    pivot: complex = 0.0
    hold: float = 0.0

    @property
    def step(self) -> float:
        """Duration of a step [s]."""
        return self.double_support + self.single_support

    @property
    def pivot_end(self) -> complex:
        """The centroidal moment pivot at the end of single support; at its beginning it is at -`pivot` [m]."""
        return self.roll + self.pivot

    def segments(self, stance: Side) -> tuple[ZmpSegment, ...]:
        """The centroidal moment pivot in double and single support of one step."""
        old_end = (self.pivot_end - self.displacement.on(other_side(stance))) * cmath.exp(-1j * self.turn)
        return (
            ZmpSegment(old_end, -self.pivot, self.double_support),
            *self.along_foot,
        )

    @property
    def along_foot(self) -> tuple[ZmpSegment, ...]:
        """The centroidal moment pivot in single support."""
        if self.hold <= 0.0:
            return (ZmpSegment(-self.pivot, self.pivot_end, self.single_support),)
        # Where the zero-moment point stops, the pivot still has to move on by what is left of its way.
        held = self.pivot_end - 2.0 * self.pivot * self.hold / self.single_support
        return (
            ZmpSegment(-self.pivot, held, self.single_support - self.hold),
            ZmpSegment(held, self.pivot_end, self.hold),
        )

    def end_offsets(self, frequency: float) -> PerStance:
        """DCM at the end of each step, for which the walk is periodic.

        With u = exp(i turn) and a = exp(-w T), the end b of a step and the end b' of the next one obey
        b = d + u (s' + a b'), where s' is the DCM at the start of the next step for b' = 0: two linear equations.
        """
        u = cmath.exp(1j * self.turn)
        ua = u * math.exp(-frequency * self.step)
        left = self.displacement.left + u * backward(self.segments("Right"), 0.0, frequency)
        right = self.displacement.right + u * backward(self.segments("Left"), 0.0, frequency)
        return PerStance(left=(left + ua * right) / (1.0 - ua**2), right=(right + ua * left) / (1.0 - ua**2))

    def end_offset(self, stance: Side, frequency: float, *following: PeriodicGait) -> complex:
        """DCM at the end of a step on a stance foot, relative to it [m].

        Args:
            stance: The stance foot.
            frequency: Natural frequency of the pendulum [1/s].
            following: The gaits of the next steps, the last one of all steps after them; without any, this one.
        """
        if all(gait == self for gait in following):
            return self.end_offsets(frequency).on(stance)
        after, *others = following
        other = other_side(stance)
        exchange = self.segments(other)[0]._replace(end=-after.pivot, duration=after.double_support)
        start = backward((exchange, *after.along_foot), after.end_offset(other, frequency, *others), frequency)
        return self.displacement.on(stance) + cmath.exp(1j * self.turn) * start
