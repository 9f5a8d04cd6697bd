"""Trajectory of the swinging foot: over the level plane to a foothold that may move; height and pitch by splines."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity
from humanwalk.walking.motions import Cubic, PiecewiseCubic, PlanarMotion, ScalarMotion
from humanwalk.walking.walking_reference import FootState

MAX_TOE_UP = 0.442
"""Largest pitch at touchdown [rad]: that of 1.53 m/s."""


@dataclass(frozen=True)
class SwingParameters:
    """Shape of the swing."""

    lift: float = quantity(0.029, "m", 0.0, 0.3)
    """Rise of the ankle above its height at toe-off in an ordinary step."""

    mid_height: float = quantity(0.48, "", 0.2, 1.0)
    """Height of the ankle at half of the swing, relative to its apex at a quarter. In people, whose ankle rises at
    heel-off, it is 0.5 (docs/likeness_trials.md, "Do torques as a task and people's swing help?")."""

    late_height: float = quantity(0.173, "", 0.0, 1.0)
    """The same at three quarters of the swing; in people 0.2."""

    early_pitch: float = quantity(-0.004, "", -0.5, 0.5)
    """Pitch at a quarter of the swing, from 0 at toe-off to 1 at touchdown. The toes point down while the knee flexes;
    in people it is -0.14 at a slow and 0.04 at a free speed."""

    mid_pitch: float = quantity(0.437, "", 0.0, 1.0)
    """The same at half of the swing; in people 0.39 at a slow and 0.46 at a free speed."""

    late_pitch: float = quantity(0.84, "", 0.0, 1.5)
    """The same at three quarters of the swing; in people 0.87."""

    clearance: float = quantity(0.09, "m", 0.0, 0.3)
    """Minimum rise of the ankle above its height in standing: a foot that leaves the ground flat would scuff."""

    toe_up: float = quantity(0.288, "rad s/m", 0.0, 0.6)
    """Pitch at touchdown per forward speed, toes up: 23 degrees at 1.4 m/s."""

    heel_height: float = quantity(0.0, "", 0.0, 1.0)
    """Share of the height that the ankle of a foot on its heel has above that of a flat foot, at touchdown. With 0 the
    heel of a pitched foot meets the ground before the end of the swing, while it is fast."""

    landing_sink_rate: float = quantity(0.127, "m/s", 0.0, 0.5)
    """Downward speed of the ankle at the planned touchdown, at `free_speed` and faster."""

    slow_landing_sink_rate: float = quantity(0.3, "m/s", 0.0, 0.5)
    """The same at `slow_speed` and slower; in between it is interpolated. A foot that sinks slower near the ground
    meets it before the planned touchdown (docs/likeness_trials.md, "How should a foot land in a slow walk?")."""

    slow_speed: float = quantity(0.9, "m/s", 0.0, 5.0)
    """Forward speed at and below which the ankle sinks at `slow_landing_sink_rate`."""

    free_speed: float = quantity(1.2, "m/s", 0.0, 5.0)
    """Forward speed at and above which the ankle sinks at `landing_sink_rate`; greater than `slow_speed`."""

    push_off: float = quantity(8.4, "1/m", 0.0, 30.0)
    """Horizontal acceleration at toe-off, per squared speed of the walk."""

    landing_speed_ratio: float = quantity(0.61, "", 0.0, 1.0)
    """Horizontal speed at touchdown, relative to the speed of the walk."""

    landing_deceleration: float = quantity(21.0, "1/s", 0.0, 50.0)
    """Horizontal deceleration at touchdown, per speed of the walk."""

    landing_depth: float = quantity(0.003, "m", 0.0, 0.05)
    """Depth below the ground at which the trajectory ends, so that the swing ends by contact."""

    flat_rise: float = quantity(0.1, "m", 0.01, 1.0)
    """Height of a step from which on the foot lands flat; on stairs people land on the ball or the whole sole."""

    jerk_limit: float = quantity(6000.0, "m/s3", 100.0, 1e5)
    """Bound on the third derivative of the position, so that a foothold that jumps does not jerk the leg."""

    def __post_init__(self) -> None:
        """Raise ParameterError if the speeds between which the sink rate changes are not in order."""
        if not self.slow_speed < self.free_speed:
            raise ParameterError(
                f"slow_speed: {self.slow_speed:g} is too fast; allowed: below free_speed, {self.free_speed:g} m/s; "
                "lower it, or raise free_speed"
            )

    def rolling_share(self, rise: float) -> float:
        """Share of the touchdown pitch for a step onto ground that is `rise` [m] above the plane of the stance foot."""
        return max(1.0 - abs(rise) / self.flat_rise, 0.0)

    def descent_share(self, rise: float) -> float:
        """How much of a step down a step is, 0 to 1; `rise` as in `rolling_share`."""
        return 1.0 - self.rolling_share(min(rise, 0.0))

    def raising_share(self, height: float) -> float:
        """How much of a step up a swing is that raises the foot by a height [m]: 0 to half of `flat_rise`, then to 1.

        With less than half, feet leave stepping stones of unequal heights too steeply (docs/balance_trials.md, "Which
        rules does uneven ground need?").
        """
        return clip(2.0 * height / self.flat_rise - 1.0, 0.0, 1.0)

    def touchdown_pitch(self, speed: float) -> float:
        """Pitch at touchdown, toes up [rad], at a forward speed [m/s]."""
        return min(self.toe_up * max(speed, 0.0), MAX_TOE_UP)

    def sink_rate(self, speed: float) -> float:
        """Downward speed of the ankle at the planned touchdown [m/s], at a forward speed [m/s]."""
        rates = (self.slow_landing_sink_rate, self.landing_sink_rate)
        return float(np.interp(speed, (self.slow_speed, self.free_speed), rates))

    def toe_off_acceleration(self, velocity: complex) -> complex:
        """Horizontal acceleration at toe-off [m/s2] for a velocity of the walk [m/s]."""
        return self.push_off * abs(velocity) * velocity

    def landing(self, foothold: complex, velocity: complex) -> PlanarMotion:
        """Horizontal motion at touchdown for a velocity of the walk [m/s]."""
        return PlanarMotion(foothold, self.landing_speed_ratio * velocity, -self.landing_deceleration * velocity)


@dataclass(frozen=True)
class SwingProfile:
    """Height of the ankle and pitch of the foot over the progress from 0 at toe-off to 1 at touchdown.

    Their accelerations are continuous: a jump in them would be a jump in the moments of ankle, knee and hip.
    """

    height: PiecewiseCubic
    """Of the ankle [m]."""

    pitch: PiecewiseCubic
    """Toes down positive [rad]."""

    @staticmethod
    def from_toe_off(
        foot: FootState,
        flat_height: float,
        toe_up: float,
        sink_rate: float,
        duration: float,
        parameters: SwingParameters,
        sole: SoleExtent,
    ) -> "SwingProfile":
        """The profile that continues the motion of a foot at toe-off.

        Args:
            foot: The foot at toe-off.
            flat_height: Height of the ankle if the foot stood flat there [m].
            toe_up: Pitch at touchdown, toes up positive [rad].
            sink_rate: Downward speed of the ankle at touchdown [m/s].
            duration: Duration of the swing [s].
            parameters: Shape of the swing.
            sole: Extent of the sole.
        """
        landing = flat_height - parameters.landing_depth + parameters.heel_height * sole.back * math.sin(toe_up)
        apex = max(foot.height + parameters.lift, flat_height + parameters.clearance)
        inner = flat_height + np.array((1.0, parameters.mid_height, parameters.late_height)) * (apex - flat_height)
        heights = np.array((foot.height, *inner, landing))
        shape = np.array((0.0, parameters.early_pitch, parameters.mid_pitch, parameters.late_pitch, 1.0))
        pitches = foot.pitch + shape * (-toe_up - foot.pitch)
        points = np.column_stack((heights, pitches))
        quarter = duration / (len(points) - 1)
        first = quarter * np.array((foot.height_rate, foot.pitch_rate))
        last = quarter * np.array((-sink_rate, 0.0))
        spline = CubicSpline(np.arange(len(points)), points, bc_type=((1, first), (1, last)))
        curves = spline.c[::-1].transpose(2, 1, 0).tolist()
        return SwingProfile(*(PiecewiseCubic(tuple(Cubic(*piece) for piece in curve)) for curve in curves))

    def lowest(self, progress: float, flat_height: float, sole: SoleExtent) -> float:
        """Height of the lowest point of the sole above the ground [m]; see `from_toe_off`."""
        height, pitch = self.at(progress)
        sine = math.sin(pitch.value)
        return height.value - flat_height - max(sole.front * sine, -sole.back * sine)

    def at(self, progress: float) -> tuple[ScalarMotion, ScalarMotion]:
        """Height and pitch with their derivatives by the progress, which is clipped to [0, 1]."""
        return self.height.at(progress), self.pitch.at(progress)
