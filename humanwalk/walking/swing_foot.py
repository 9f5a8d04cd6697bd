"""The foot in the air: towards a foothold that may move, over a Hermite spline of height and pitch."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from humanwalk.gait.splines import CubicHermite, hermite_tangents
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity

HEIGHT_SHAPE = (1.0, 0.6, 0.27)
"""Height of the ankle at the three quarters within the swing, as a share of its apex: people's foot rises with the
heel that leaves and is low again by the middle of the swing."""

PITCH_BLEND = (0.0, -0.1, 0.36, 0.87, 1.0)
"""Share of the pitch's way at the quarters of the swing: toes still point down while the knee bends (people's whole
foot: 0.1, 0.5, 0.9)."""

BRISKEST = 1.7
"""Speed from which the foot lands no steeper [m/s]."""


@dataclass(frozen=True)
class SwingParameters:
    """Shape of the swing."""

    lift: float = quantity(0.045, "m", 0.0, 0.3)
    """Rise of the ankle above where it leaves the ground; the heel-off before adds to it."""

    clearance: float = quantity(0.09, "m", 0.0, 0.3)
    """The ankle rises at least this far above where it is in standing: a foot that leaves flat would scuff."""

    toe_up: float = quantity(0.26, "rad s/m", 0.0, 0.6)
    """Pitch of the foot at heel strike, per speed forward up to `BRISKEST`."""

    landing_speed: float = quantity(0.05, "m/s", 0.0, 0.5)
    """Downward speed of the ankle at the planned touchdown."""

    landing_depth: float = quantity(0.003, "m", 0.0, 0.03)
    """How far below the ground the swing aims, so that it ends by touching."""

    push_off: float = quantity(8.6, "1/m", 0.0, 30.0)
    """Acceleration of the foot over ground as it leaves, per squared speed of the walk."""

    landing_pace: float = quantity(0.55, "", 0.0, 1.0)
    """Speed of the foot over ground at touchdown, as a share of that of the walk."""

    landing_brake: float = quantity(22.0, "1/s", 0.0, 50.0)
    """Deceleration of the foot over ground at touchdown, per speed of the walk: it is on its way until it lands."""

    jerk_limit: float = quantity(6000.0, "m/s3", 500.0, 50000.0)
    """Bound on the third derivative of the foot's way over ground: a foothold that jumps does not jerk the leg."""

    def heel_strike(self, speed: float) -> float:
        """Pitch at touchdown, toes up positive [rad], at a forward speed [m/s]."""
        return self.toe_up * clip(speed, 0.0, BRISKEST)

    def leaving(self, pace: complex) -> complex:
        """Acceleration over ground of the foot that leaves [m/s2], at a velocity of the walk [m/s]."""
        return self.push_off * abs(pace) * pace


class PlanarMotion(NamedTuple):
    """Position, velocity and acceleration of a point over ground, complex [m, m/s, m/s2]."""

    position: complex
    velocity: complex = 0.0
    acceleration: complex = 0.0

    def towards(self, goal: PlanarMotion, remaining: float, dt: float, jerk_limit: float) -> PlanarMotion:
        """The motion `dt` later on the quintic that comes to `goal` in `remaining` seconds.

        The quintic is made anew at every call, so that the goal may move; its jerk is bounded.
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

    def with_sideways_of(self, other: PlanarMotion, heading: float) -> PlanarMotion:
        """This motion along a heading [rad], and another's across it."""
        u = cmath.exp(1j * heading)

        def mixed(along: complex, across: complex) -> complex:
            return u * complex((along / u).real, (across / u).imag)

        return PlanarMotion(
            mixed(self.position, other.position),
            mixed(self.velocity, other.velocity),
            mixed(self.acceleration, other.acceleration),
        )


class HeightAndPitch(NamedTuple):
    """Height of the ankle [m] and pitch of the foot [rad, toes down positive] with rates and accelerations."""

    height: float
    height_rate: float
    height_acceleration: float
    pitch: float
    pitch_rate: float
    pitch_acceleration: float


class Cubic(NamedTuple):
    """a + b s + c s^2 + d s^3."""

    a: float
    b: float
    c: float
    d: float

    def at(self, s: float, rate: float) -> tuple[float, float, float]:
        """Value, and the first two derivatives by time while s grows at a rate [1/s]."""
        a, b, c, d = self
        return (
            a + s * (b + s * (c + s * d)),
            rate * (b + s * (2.0 * c + 3.0 * d * s)),
            rate * rate * (2.0 * c + 6.0 * d * s),
        )


@dataclass(frozen=True)
class SwingProfile:
    """Height and pitch of a swinging foot over its progress from 0 at lift-off to 1 at touchdown."""

    pieces: tuple[tuple[Cubic, Cubic], ...]
    """Height and pitch over equal shares of the progress."""

    duration: float

    @staticmethod
    def from_lift_off(
        height: float,
        height_rate: float,
        pitch: float,
        pitch_rate: float,
        ground: float,
        toe_up: float,
        duration: float,
        parameters: SwingParameters,
    ) -> SwingProfile:
        """The profile that carries on from a foot as it is at lift-off.

        Args:
            height, height_rate: of the ankle [m, m/s].
            pitch, pitch_rate: of the foot [rad, rad/s].
            ground: height of the ankle over which the foot stands flat [m].
            toe_up: pitch at touchdown, toes up positive [rad].
            duration: of the swing [s].
            parameters: its shape.
        """
        apex = max(height + parameters.lift, ground + parameters.clearance)
        heights = np.array(
            (height, *(ground + np.array(HEIGHT_SHAPE) * (apex - ground)), ground - parameters.landing_depth)
        )
        pitches = pitch + np.array(PITCH_BLEND) * (-toe_up - pitch)
        points = np.column_stack((heights, pitches))
        tangents = hermite_tangents(points)
        quarter = duration / (len(points) - 1)
        tangents[0] = height_rate * quarter, pitch_rate * quarter
        tangents[-1] = -parameters.landing_speed * quarter, 0.0
        coefficients = CubicHermite(points, tangents).coefficients.tolist()
        return SwingProfile(tuple((Cubic(*height), Cubic(*pitch)) for height, pitch in coefficients), duration)

    def at(self, progress: float) -> HeightAndPitch:
        """The profile at a progress in [0, 1]; beyond, it stays at its ends' values."""
        u = clip(progress, 0.0, 1.0) * len(self.pieces)
        i = min(int(u), len(self.pieces) - 1)
        rate = len(self.pieces) / self.duration
        height, pitch = self.pieces[i]
        return HeightAndPitch(*height.at(u - i, rate), *pitch.at(u - i, rate))
