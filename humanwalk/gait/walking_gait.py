"""Desired motion of both feet and the pelvis over time, from standing into steady walking.

Everything but the speed ramp is a function of the distance d that the pelvis has walked, so the path over ground is the
same at every speed. The foot that stands first moves back under the hip; the other makes a start swing and lands
exactly half a cycle behind it (errata E26, E32).
"""

from typing import NamedTuple

from humanwalk.gait.foot_cycle import (
    FootCycle,
    FootPathParameters,
    SwingCurve,
    start_distance,
    start_swing,
    swing_hump,
)
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.numerics.scalars import quintic_blend
from humanwalk.quantity import ParameterError, require_in_range
from humanwalk.sides import SIDES, Side


class FootTarget(NamedTuple):
    """Desired motion of one sole. Axes of the pelvis frame P: x forward, y left, z up.

    position: sole (3,) [m]; x and y from the middle between the hips, z from the ground in walking: -offset in
        standing, 0 in the stance of walking (thesis 4.2.3, E32).
    velocity: its time derivative (3,) [m/s].
    height: of the sole above the ground [m], >= 0.
    height_rate: its time derivative [m/s].
    pitch, roll: of the sole, toes down and left side up positive [rad]: its axes are R_y(pitch) R_x(roll).
    pitch_rate, roll_rate: their time derivatives [rad/s].
    phase: 0 at touchdown, below duty_factor in stance, modulo 1; nominal during the start swing.
    in_stance: whether the foot is on the ground.
    step: the foothold that the foot stands on or leaves, and the next; foothold k is k walked steps from the start.
    progress: of the swing between them, 0 in stance.
    progress_rate: its time derivative [1/s].
    """

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    height: float
    height_rate: float
    pitch: float
    pitch_rate: float
    phase: float
    in_stance: bool
    step: tuple[int, int]
    progress: float
    progress_rate: float
    roll: float = 0.0
    roll_rate: float = 0.0


class PelvisTarget(NamedTuple):
    """Desired motion of the pelvis.

    distance, speed, acceleration: forward from standing [m, m/s, m/s^2].
    drop, drop_rate, drop_acceleration: downward from standing [m, m/s, m/s^2].
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


class WalkingGait:
    """Foot and pelvis targets of a walk along +x that starts from standing at t = 0.

    Args:
        parameters: foot path.
        hip_half_width: half the distance between the hips [m], 0.02..0.3, which is the lateral position of each foot
            (E22: both programs have 0).
        ramp: speed over time.
        first_swing: side of the foot that swings first.

    Before t = 0 the body stands. The reach of the legs is not checked here, see `minimum_offset`.
    """

    def __init__(
        self, parameters: FootPathParameters, hip_half_width: float, ramp: SpeedRamp, first_swing: Side = "Right"
    ) -> None:
        require_in_range("hip_half_width", hip_half_width, "m", 0.02, 0.3)
        if first_swing not in SIDES:
            raise ParameterError(
                f'first_swing: {first_swing!r} is unknown; allowed: "Right" or "Left"; name the leg that swings first'
            )
        self.parameters, self.hip_half_width = parameters, hip_half_width
        self.ramp, self.first_swing = ramp, first_swing
        self.start_distance = start_distance(parameters)
        self._cycle, self._start = FootCycle(parameters), start_swing(parameters)

    @property
    def start_time(self) -> float:
        """Time [s] of the first touchdown; steady stepping begins."""
        return self.ramp.time_at(self.start_distance)

    def target(self, t: float) -> GaitTarget:
        """Targets at t [s]; every rate is the exact time derivative of its value."""
        pelvis = self.pelvis(t)
        return GaitTarget(t, pelvis, self._foot("Right", pelvis), self._foot("Left", pelvis))

    def pelvis(self, t: float) -> PelvisTarget:
        """Target of the pelvis at t [s].

        It sinks by the offset while the first foot swings, along a quintic of the distance.
        """
        d, speed, acceleration = self.ramp.distance(t), self.ramp.speed_at(t), self.ramp.acceleration(t)
        d0, offset = self.start_distance, self.parameters.offset
        if d >= d0:
            return PelvisTarget(d, speed, acceleration, offset, 0.0, 0.0)
        blend, slope, curvature = quintic_blend(d / d0)
        slope, curvature = slope / d0, curvature / d0**2
        drop_acceleration = offset * (curvature * speed**2 + slope * acceleration)
        return PelvisTarget(d, speed, acceleration, offset * blend, offset * slope * speed, drop_acceleration)

    def in_stance(self, side: Side, t: float) -> bool:
        """Whether a foot should be on the ground at t [s]."""
        return self._in_stance(side, self.ramp.distance(t))

    def phase(self, side: Side, t: float) -> float:
        """Phase of a foot at t [s]; see `FootTarget`."""
        return self._phase(side, self.ramp.distance(t))

    def swing_curve(self, step: tuple[int, int]) -> SwingCurve:
        """Path of the swing between two footholds, see `FootTarget`."""
        return self._start if step == (0, 1) else self._cycle.swing

    def _foot(self, side: Side, pelvis: PelvisTarget) -> FootTarget:
        d = pelvis.distance
        phase = self._phase(side, d)
        # Slopes are derivatives by d / length.
        if side == self.first_swing and d < self.start_distance:
            length = self.start_distance
            progress, progress_slope = d / length, 1.0
            (x, height), slopes = self._start.position(progress), self._start.derivative(progress)
            pitch, pitch_slope = (self.parameters.toe_drop * hump for hump in swing_hump(progress))
            step = (0, 1)
        else:
            length = self.parameters.walked_stride
            progress, progress_slope = self._cycle.progress(phase)
            (x, height), slopes = self._cycle.position(phase), self._cycle.derivative(phase)
            pitch, pitch_slope = self._cycle.pitch(phase)
            last = self._last_foothold(side, d)
            step = (max(last, 0), last + 2)
        x_rate, height_rate, pitch_rate, progress_rate = (
            slope / length * pelvis.speed for slope in (*slopes, pitch_slope, progress_slope)
        )
        z = height - self.parameters.offset + pelvis.drop
        return FootTarget(
            position=(x - 0.5 * self.parameters.step_length, self._y(side), z),
            velocity=(x_rate, 0.0, height_rate + pelvis.drop_rate),
            height=height,
            height_rate=height_rate,
            pitch=pitch,
            pitch_rate=pitch_rate,
            phase=phase,
            in_stance=self._in_stance(side, d),
            step=step,
            progress=progress,
            progress_rate=progress_rate,
        )

    def _in_stance(self, side: Side, d: float) -> bool:
        if side == self.first_swing and d < self.start_distance:
            return d <= 0.0
        return self._cycle.in_stance(self._phase(side, d))

    def _cycles(self, side: Side, d: float) -> float:
        # The foot that stands first starts halfway through its stance.
        cycles = (0.5 * self.parameters.step_length + d) / self.parameters.walked_stride
        return cycles - 0.5 if side == self.first_swing else cycles

    def _phase(self, side: Side, d: float) -> float:
        return self._cycles(side, d) % 1.0

    def _last_foothold(self, side: Side, d: float) -> int:
        """Number of the last foothold of the cycle; -1 before the first touchdown."""
        cycles = self._cycles(side, d)
        # Just below an integer, the phase may round to 1.
        begun = round(cycles - self._phase(side, d) % 1.0)
        return 2 * begun + (side == self.first_swing)

    def _y(self, side: Side) -> float:
        return self.hip_half_width if side == "Left" else -self.hip_half_width
