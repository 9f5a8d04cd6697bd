"""How high the centre of mass is carried: in an arc over each stance leg, as people vault over it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from humanwalk.quantity import quantity


@dataclass(frozen=True)
class ComHeight:
    """Height of the centre of mass."""

    walking: float = quantity(0.997, "", 0.8, 1.0)
    """Height at the top of the arcs in walking, as a share of the height in straight standing."""

    standing: float = quantity(0.985, "", 0.8, 1.0)
    """The same in quiet standing."""

    time: float = quantity(0.25, "s", 0.02, 2.0)
    """Time constant with which the mean height changes."""

    amplitude: float = quantity(0.009, "m", 0.0, 0.05)
    """Of the arcs at 1 m/s, with the square of the speed, as the drop between two straight legs grows with the step."""

    lowest: float = quantity(0.03, "s", -0.3, 0.3)
    """The height is lowest this long after a touchdown."""

    free_reach: float = quantity(0.4, "m", 0.0, 1.0)
    """A foothold this far before or behind the body needs no lower one: feet roll over heel and ball."""

    free_spread: float = quantity(0.1, "m", 0.0, 1.0)
    """And this far beside it: about half the distance of the hips."""

    stretch_time: float = quantity(0.08, "s", 0.02, 2.0)
    """Time constant with which the body goes down for a foothold that is farther."""

    def below_top(self, speed: float) -> float:
        """How far the mean of the arcs is below their top at a forward speed [m]."""
        return self.amplitude * speed**2

    def highest_for(self, reach: complex, leg: float, standing: float) -> float:
        """The greatest height from which a straight leg reaches a foothold [m].

        Args:
            reach: the foothold, seen from the centre of mass along the heading [m].
            leg: distance of hip and ankle of a straight leg [m].
            standing: height of the centre of mass in straight standing [m].
        """
        forward = max(abs(reach.real) - self.free_reach, 0.0)
        sideways = max(abs(reach.imag) - self.free_spread, 0.0)
        return standing - leg + math.sqrt(max(leg**2 - forward**2 - sideways**2, 0.0))

    def approach(
        self, height: float, rate: float, goal: float, dt: float, stretched: bool
    ) -> tuple[float, float, float]:
        """The mean height `dt` later, its rate, and its acceleration until then [m, m/s, m/s2]."""
        time = self.stretch_time if stretched else self.time
        acceleration = (goal - height) / time**2 - 2.0 * rate / time
        rate += dt * acceleration
        return height + dt * rate, rate, acceleration

    def arc(self, since_touchdown: float, step: float, speed: float) -> tuple[float, float, float]:
        """Height above the mean, with rate and acceleration [m, m/s, m/s2].

        Args:
            since_touchdown: [s].
            step: duration of a step [s].
            speed: forward [m/s].
        """
        amplitude, rate = self.below_top(speed), 2.0 * math.pi / step
        angle = rate * (since_touchdown - self.lowest)
        return (
            -amplitude * math.cos(angle),
            amplitude * rate * math.sin(angle),
            amplitude * rate**2 * math.cos(angle),
        )
