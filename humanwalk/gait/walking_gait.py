"""Where both feet and the pelvis should be, at any time, from standing into steady walking.

Everything but the speed ramp is a function of the distance d that the pelvis has walked, so the
path over ground is the same at every speed. The foot that stands first goes back under the hip;
the other makes a start swing and lands exactly half a cycle behind it (errata E26, E32).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from humanwalk.gait.foot_cycle import (
    FootCycle,
    FootPathParameters,
    start_distance,
    start_swing,
    swing_hump,
)
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import quintic_blend
from humanwalk.quantity import ParameterError, require_in_range

Side = Literal["Right", "Left"]


class FootTarget(NamedTuple):
    """What one sole should do. Axes of the pelvis frame P: x forward, y left, z up.

    position: sole (3,) [m]; x and y from the middle between the hips, z from the ground as it is
        while walking: -offset in standing, 0 in the stance of walking (thesis 4.2.3, E32).
    velocity: its time derivative (3,) [m/s].
    height: of the sole above the ground [m], >= 0.
    height_rate: its time derivative [m/s].
    pitch: of the sole about y, toes down positive [rad].
    pitch_rate: its time derivative [rad/s].
    phase: 0 at touchdown, below duty_factor in stance, modulo 1; of the foot that swings first it
        is nominal during the start swing.
    in_stance: whether the foot is on the ground.
    """

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    height: float
    height_rate: float
    pitch: float
    pitch_rate: float
    phase: float
    in_stance: bool


class PelvisTarget(NamedTuple):
    """What the pelvis should do.

    distance, speed, acceleration: walked forward from standing [m, m/s, m/s^2].
    drop, drop_rate, drop_acceleration: how much lower than in standing [m, m/s, m/s^2].
    """

    distance: float
    speed: float
    acceleration: float
    drop: float
    drop_rate: float
    drop_acceleration: float


class GaitTarget(NamedTuple):
    """Targets of pelvis and feet at one time [s]."""

    time: float
    pelvis: PelvisTarget
    right: FootTarget
    left: FootTarget


@dataclass(frozen=True)
class Footstep:
    """One stance of one foot: where over ground (3,) [m] (x from the start) and when [s].

    touchdown is 0 for the two feet that stand at the start; lift_off is inf if the speed never
    gets there.
    """

    side: Side
    position: Array
    touchdown: float
    lift_off: float


class WalkingGait:
    """Foot and pelvis targets of a walk along +x that starts from standing at t = 0.

    Args:
        parameters: foot path.
        hip_half_width: half the distance between the hips [m], 0.02..0.3; the side of each foot
            (E22: both programs have 0).
        ramp: speed over time.
        first_swing: side that swings first.

    Before t = 0 the man stands. Whether the legs can reach is for the inverse kinematics to say;
    see `minimum_offset`.
    """

    def __init__(
        self,
        parameters: FootPathParameters,
        hip_half_width: float,
        ramp: SpeedRamp,
        first_swing: Side = "Right",
    ) -> None:
        require_in_range("hip_half_width", hip_half_width, "m", 0.02, 0.3)
        if first_swing not in ("Right", "Left"):
            raise ParameterError(
                f'first_swing: {first_swing!r} is unknown; allowed: "Right" or "Left"; name the leg that swings first'
            )
        self.parameters = parameters
        self.hip_half_width = hip_half_width
        self.ramp = ramp
        self.first_swing = first_swing
        self.start_distance = start_distance(parameters)
        self._cycle = FootCycle(parameters)
        self._start = start_swing(parameters)

    @property
    def start_time(self) -> float:
        """Time [s] of the first touchdown; steady stepping begins."""
        return self.ramp.time_at(self.start_distance)

    def target(self, t: float) -> GaitTarget:
        """Targets at t [s]; every rate is the exact time derivative of its twin."""
        pelvis = self.pelvis(t)
        return GaitTarget(t, pelvis, self._foot("Right", pelvis), self._foot("Left", pelvis))

    def pelvis(self, t: float) -> PelvisTarget:
        """Target of the pelvis at t [s].

        It sinks by the offset while the first foot swings, along a quintic of the distance.
        """
        d, speed, acceleration = (
            self.ramp.distance(t),
            self.ramp.speed_at(t),
            self.ramp.acceleration(t),
        )
        d0, offset = self.start_distance, self.parameters.offset
        if d >= d0:
            return PelvisTarget(d, speed, acceleration, offset, 0.0, 0.0)
        blend, slope, curvature = quintic_blend(d / d0)
        slope, curvature = slope / d0, curvature / d0**2
        return PelvisTarget(
            d,
            speed,
            acceleration,
            offset * blend,
            offset * slope * speed,
            offset * (curvature * speed**2 + slope * acceleration),
        )

    def in_stance(self, side: Side, t: float) -> bool:
        """Whether a foot should be on the ground at t [s]."""
        return self._in_stance(side, self.ramp.distance(t))

    def phase(self, side: Side, t: float) -> float:
        """Phase of a foot at t [s]; see `FootTarget`."""
        return self._phase(side, self.ramp.distance(t))

    def footsteps(self, until: float) -> list[Footstep]:
        """The stances that begin before `until` [s], in the order of touchdown.

        The first two are the standing feet, the one that swings first leading.
        """
        return list(self._footsteps(until))

    def _footsteps(self, until: float) -> Iterator[Footstep]:
        p = self.parameters
        swing, stand = self.first_swing, self._other(self.first_swing)
        time = self.ramp.time_at
        yield Footstep(swing, np.array([0.0, self._y(swing), 0.0]), 0.0, 0.0)
        yield Footstep(stand, np.array([0.0, self._y(stand), 0.0]), 0.0, time(p.step_length / 2))
        count, side, walked = 1, swing, self.start_distance
        while time(walked) < until:
            place = np.array([count * p.walked_step, self._y(side), 0.0])
            yield Footstep(side, place, time(walked), time(walked + p.step_length))
            count, side, walked = count + 1, self._other(side), walked + p.walked_step

    def _foot(self, side: Side, pelvis: PelvisTarget) -> FootTarget:
        d = pelvis.distance
        phase = self._phase(side, d)
        if side == self.first_swing and d < self.start_distance:
            tau = d / self.start_distance
            (x, height), slopes = self._start.position(tau), self._start.derivative(tau)
            x_slope, height_slope = (slope / self.start_distance for slope in slopes)
            hump, hump_slope = swing_hump(tau)
            pitch = self.parameters.toe_drop * hump
            pitch_slope = self.parameters.toe_drop * hump_slope / self.start_distance
        else:
            (x, height), slopes = self._cycle.position(phase), self._cycle.derivative(phase)
            x_slope, height_slope = (slope / self.parameters.walked_stride for slope in slopes)
            pitch, pitch_slope = self._cycle.pitch(phase)
            pitch_slope /= self.parameters.walked_stride
        height_rate = height_slope * pelvis.speed
        return FootTarget(
            position=(
                x - 0.5 * self.parameters.step_length,
                self._y(side),
                height - self.parameters.offset + pelvis.drop,
            ),
            velocity=(x_slope * pelvis.speed, 0.0, height_rate + pelvis.drop_rate),
            height=height,
            height_rate=height_rate,
            pitch=pitch,
            pitch_rate=pitch_slope * pelvis.speed,
            phase=phase,
            in_stance=self._in_stance(side, d),
        )

    def _in_stance(self, side: Side, d: float) -> bool:
        if side == self.first_swing and d < self.start_distance:
            return d <= 0.0
        return self._cycle.in_stance(self._phase(side, d))

    def _phase(self, side: Side, d: float) -> float:
        # The foot that stands first starts half-way through its stance.
        cycles = (0.5 * self.parameters.step_length + d) / self.parameters.walked_stride
        return (cycles - 0.5 if side == self.first_swing else cycles) % 1.0

    def _y(self, side: Side) -> float:
        return self.hip_half_width if side == "Left" else -self.hip_half_width

    @staticmethod
    def _other(side: Side) -> Side:
        return "Left" if side == "Right" else "Right"
