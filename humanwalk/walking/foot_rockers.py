"""How a loaded foot rolls: over the heel after touchdown, over the ball before toe-off (Perry's rockers)."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity
from humanwalk.walking.motions import ScalarMotion
from humanwalk.walking.walking_reference import FootReference, FootTask


class Rollover(NamedTuple):
    """How a foot leaves the ground at the end of its stance.

    Attributes:
        speed: Forward speed [m/s]; determines the pitch at toe-off.
        lead: Time from heel-off to touchdown of the other foot [s].
        climbing: How much of a step up or down the step is, or the next swing of the foot, 0 to 1. In such a step the
            toes stay on the ground, because their tips may be at an edge.
    """

    speed: float
    lead: float
    climbing: float


@dataclass(frozen=True)
class FootRockers:
    """Rolling over heel and ball."""

    heel: float = quantity(0.126, "s", 0.02, 0.4)
    """Time from touchdown until the foot is flat."""

    landing_load: float = quantity(0.16, "", 0.0, 1.0)
    """Least vertical force under the heel from touchdown until the foot is flat [body weights]. Without it the heel
    leaves the ground again after its impact: the planned pressure moves to the new foot over all of double support."""

    ball: float = quantity(0.22, "s", 0.0, 0.3)
    """Time from heel-off to touchdown of the other foot at `full_pitch_speed` and faster. It is shorter below, because
    a walker on its toes cannot move the zero-moment point back."""

    descent: float = quantity(0.3, "s", 0.0, 0.6)
    """The same in a step down: an ankle that bends no further does not let the body sink while the heel is down. With
    0.35 s a walker that is pushed backward has its zero-moment point on the ball for too long
    (docs/decisions/0055-slow-walks.md)."""

    unloading: float = quantity(7.0, "1/s", 0.5, 1e4)
    """Rate at which the largest vertical force under the heel falls to zero at heel-off [body weights per second].
    If the heel loses its load at once, the toes carry it until the ball is compressed (docs/likeness_trials.md, "Do
    limits of the force under the heel help?")."""

    unloading_force: float = quantity(3.0, "", 0.1, 100.0)
    """Largest vertical force on a foot that is being unloaded, in body weights per load, in a step on one face. The
    leading foot takes over before the trailing foot leaves the ground (docs/likeness_trials.md, "Do de Leva's body
    and an unloading trailing foot help?")."""

    pitch: float = quantity(1.27, "rad", 0.0, 1.7)
    """Pitch of the foot at toe-off at `full_pitch_speed` and faster. It is smaller below."""

    full_pitch_speed: float = quantity(1.36, "m/s", 0.1, 5.0)
    """Forward speed from which on the heel rises earliest and the pitch at toe-off is greatest."""

    speed_exponent: float = quantity(0.67, "", 0.0, 2.0)
    """`ball` and `pitch` are proportional to this power of the speed below `full_pitch_speed`. With 1 the ankle extends
    too little at 0.9 m/s; with 0.4 the walk is less like people's (docs/likeness_trials.md, "Should the heel-off
    depend on the speed?")."""

    late_rise: float = quantity(0.82, "", 0.0, 1.0)
    """Share of the pitch that grows with the cube of the time since heel-off; the rest grows with its square."""

    toes: float = quantity(0.73, "rad", 0.01, 1.2)
    """Largest extension of the toes in a level step: a foot that pitches further rolls over their tips
    (docs/likeness_trials.md, "Which mechanisms make the forces human?")."""

    toe_range: float = quantity(0.24, "rad", 0.01, 0.6)
    """Half the range of pitch around `toes` in which the toes begin to turn with the foot; at most `toes`. If they
    began at once, the planned forces would jump (docs/likeness_trials.md, "What helps slow walks?")."""

    min_speed: float = quantity(0.2, "m/s", 0.0, 3.0)
    """Forward speed below which the feet leave the ground flat."""

    def __post_init__(self) -> None:
        """Raise ParameterError if the toes would begin to turn before the heel rises."""
        if self.toe_range > self.toes:
            raise ParameterError(f"toe_range: {self.toe_range:g} is too large; allowed: up to toes, {self.toes:g} rad")

    def heel_rises(self, speed: float) -> bool:
        """Whether there is a heel-off at a forward speed [m/s]."""
        return speed > self.min_speed

    def lead(self, speed: float) -> float:
        """Time from heel-off to touchdown of the other foot on level ground [s]."""
        return self.ball * self._share(speed)

    def _share(self, speed: float) -> float:
        """Share of `ball` and `pitch` at a forward speed [m/s]."""
        return math.pow(clip(speed / self.full_pitch_speed, 0.0, 1.0), self.speed_exponent)

    def over_heel(self, level: float, yaw: float, R_WS: Array) -> FootReference:
        """Reference of a foot that has just landed.

        Args:
            level: How much of a level step the step is, 0 to 1; in one up or down the foot does not land on its heel.
            yaw: Yaw of the foot [rad].
            R_WS: Axes of the ground under the foot.
        """
        return FootReference(FootTask.HEEL_STRIKE, 1.0, yaw, R_WS, heel=(level * self.landing_load, math.inf))

    def before_heel_off(self, remaining: float, yaw: float, R_WS: Array, rollover: Rollover) -> FootReference:
        """Reference of a flat foot whose heel rises after a time [s].

        In a step up or down the heel keeps its load: the pressure has to stay where the foot is flat.

        Args:
            remaining: Time until heel-off [s].
            yaw: Yaw of the foot [rad].
            R_WS: Axes of the ground under the foot.
            rollover: How the foot leaves the ground.
        """
        level = 1.0 - rollover.climbing
        largest = self.unloading * remaining / level if level > 0.0 else math.inf
        return FootReference(FootTask.FLAT, 1.0, yaw, R_WS, heel=(0.0, largest))

    def over_ball(
        self, since: float, double_support: float, load: float, yaw: float, R_WS: Array, rollover: Rollover
    ) -> FootReference:
        """Reference of a foot after heel-off.

        Args:
            since: Time since heel-off [s].
            double_support: Time from touchdown of the other foot to toe-off [s].
            load: See FootReference.
            yaw: Yaw of the foot [rad].
            R_WS: Axes of the ground under the foot.
            rollover: How the foot leaves the ground.
        """
        final, duration = self.pitch * self._share(rollover.speed), rollover.lead + double_support
        s, late = min(since / duration, 1.0), self.late_rise
        value = final * s * s * (1.0 - late + late * s)
        rate = final * s * (2.0 * (1.0 - late) + 3.0 * late * s) / duration
        acceleration = final * (2.0 * (1.0 - late) + 6.0 * late * s) / duration**2
        pitch = ScalarMotion(value, rate, acceleration)
        stay = max(self.toes, final + self.toe_range)
        toes = self._toes(value, rate, (1.0 - rollover.climbing) * self.toes + rollover.climbing * stay)
        return FootReference(FootTask.HEEL_OFF, load, yaw, R_WS, pitch=pitch, toes=toes, heel=(0.0, 0.0))

    def _toes(self, pitch: float, rate: float, largest: float) -> tuple[float, float]:
        """Extension of the toes and its rate [rad, rad/s] at a pitch of the foot and its rate.

        They stay on the ground up to a pitch of `largest - toe_range`, and turn with the foot from `largest +
        toe_range` on. Between, the share of the pitch's rate with which they turn grows in proportion to the pitch.
        """
        turning = clip((pitch - largest + self.toe_range) / (2.0 * self.toe_range), 0.0, 1.0)
        extension = min(pitch, largest + self.toe_range) - self.toe_range * turning**2
        return extension, (1.0 - turning) * rate
