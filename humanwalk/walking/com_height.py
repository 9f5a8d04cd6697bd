"""Height of the center of mass above the ground under the support: a mean, and an arc over each stance leg."""

import math
from dataclasses import dataclass

from humanwalk.quantity import quantity
from humanwalk.walking.motions import ScalarMotion

RISE_SHARE, DESCENT_SHARE = 0.6, 0.8
"""Shares of the height of a step up and of one down by which the longer leg limits the center of mass (our choice)."""


@dataclass(frozen=True)
class ComHeight:
    """Height of the center of mass."""

    walking: float = quantity(1.006, "", 0.8, 1.05)
    """Height at the top of the arcs in walking, relative to the height with straight legs, of the default man. That of
    other bodies follows from their proportions (`motion.walking_posture`)."""

    standing: float = quantity(0.985, "", 0.8, 1.0)
    """The same in quiet standing."""

    fast_speed: float = quantity(1.45, "m/s", 0.0, 5.0)
    """Forward speed above which the mean height is lower. Before a long step the stop of the knee's range brakes the
    swinging leg otherwise (docs/decisions/0050-fast-walks.md)."""

    lowering_per_speed: float = quantity(0.06, "s", 0.0, 0.5)
    """Decrease of the mean height per speed above `fast_speed`."""

    time_constant: float = quantity(0.25, "s", 0.02, 2.0)
    """Time constant of the mean height."""

    amplitude: float = quantity(0.0215, "1/m", 0.0, 0.15)
    """Amplitude of the arcs per squared step length, to which the drop between two straight legs is proportional: 1 /
    (16 l) with legs of length l, 0.072 1/m."""

    delay: float = quantity(0.021, "s", -0.3, 0.3)
    """Time from touchdown to the lowest height."""

    lowering_time_constant: float = quantity(0.08, "s", 0.02, 2.0)
    """Time constant of the mean height while a distant foothold requires a lower one."""

    lowering_speed: float = quantity(0.6, "m/s", 0.05, 2.0)
    """Speed at which the mean height decreases before a step down: as late as possible, since the body is still behind
    the ball of the foot at first, and an ankle that bends no further would stop it there."""

    free_reach: float = quantity(0.4, "m", 0.0, 1.0)
    """Forward distance of a foothold from the center of mass that is reached without lowering it: the feet roll over
    heel and ball."""

    free_spread: float = quantity(0.1, "m", 0.0, 0.5)
    """The same sideways: about half the distance of the hips."""

    heel_rise: float = quantity(0.03, "m", 0.0, 0.2)
    """Length that a leg gains when its heel rises (our choice)."""

    def arc_amplitude(self, speed: float, step: float) -> float:
        """Amplitude of the arcs [m] at a forward speed [m/s] with steps of a duration [s]."""
        return self.amplitude * (speed * step) ** 2

    def mean(self, speed: float, step: float, standing: float) -> float:
        """Mean height in a level walk [m].

        Args:
            speed: Forward speed [m/s].
            step: Duration of a step [s].
            standing: Height of the center of mass with straight legs [m].
        """
        lowering = self.lowering_per_speed * max(speed - self.fast_speed, 0.0)
        return self.walking * standing - self.arc_amplitude(speed, step) - lowering

    def max_com_height_for_reach(self, reach: complex, leg: float, standing: float) -> float:
        """Largest height of the center of mass above a foothold that a straight leg reaches [m].

        Args:
            reach: Foothold relative to the center of mass, along and across the heading [m].
            leg: Distance of hip and ankle of a straight leg [m].
            standing: Height of the center of mass with straight legs [m].
        """
        forward = max(abs(reach.real) - self.free_reach, 0.0)
        sideways = max(abs(reach.imag) - self.free_spread, 0.0)
        return standing - leg + math.sqrt(max(leg**2 - forward**2 - sideways**2, 0.0))

    def max_for_step(self, rise: float, rolling: float, standing: float) -> float:
        """Largest height of the center of mass above the support [m] in a step up or down.

        At touchdown the support is half-way between the feet: the leg behind, or the one ahead in a step down, is
        longer by half of the rise, and somewhat more because it is not below the body.

        Args:
            rise: Height of the next foothold above the stance foot [m].
            rolling: Share of the ordinary heel-off before touchdown.
            standing: Height of the center of mass with straight legs [m].
        """
        return standing + rolling * self.heel_rise - max(RISE_SHARE * rise, -DESCENT_SHARE * rise)

    def before_descent(self, descent: float, remaining: float) -> float:
        """Height by which the center of mass may still be higher than the foothold requires at touchdown [m].

        Args:
            descent: How much of a step down the step is, 0 to 1.
            remaining: Time until touchdown [s].
        """
        # A critically damped mean height follows a limit that sinks with this delay.
        delay = 2.0 * self.lowering_time_constant
        return descent * self.lowering_speed * max(remaining - delay, 0.0)

    def approach(self, height: float, rate: float, goal: float, max_height: float) -> float:
        """Acceleration of the mean height [m/s2], critically damped.

        Args:
            height: Mean height [m].
            rate: Its rate [m/s].
            goal: Desired height [m].
            max_height: Largest height from which the foothold is within reach [m].
        """
        time = self.time_constant if goal <= max_height else self.lowering_time_constant
        return (min(goal, max_height) - height) / time**2 - 2.0 * rate / time

    def arc(self, since_touchdown: float, step: float, speed: float) -> ScalarMotion:
        """Height above the mean, at a time since touchdown [s] in steps of a duration [s], at a forward speed [m/s]."""
        amplitude, rate = self.arc_amplitude(speed, step), 2.0 * math.pi / step
        angle = rate * (since_touchdown - self.delay)
        cosine, sine = amplitude * math.cos(angle), amplitude * math.sin(angle)
        return ScalarMotion(-cosine, rate * sine, rate**2 * cosine)
