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

    stretch: float = quantity(1.15, "", 1.0, 10.0)
    """A step longer than this times the ordinary one needs a lower body: else the leg does not reach the ground."""

    easy: float = quantity(0.5, "m", 0.0, 2.0)
    """A step that is not longer than this times `stretch` needs none, however short the ordinary one is."""

    stretch_time: float = quantity(0.08, "s", 0.02, 2.0)
    """Time constant with which the body goes down for such a step."""

    def below_top(self, speed: float) -> float:
        """How far the mean of the arcs is below their top at a forward speed [m]."""
        return self.amplitude * speed**2

    def lower_for(self, apart: float, ordinary: float, leg: float) -> float:
        """How much lower than in the ordinary walk the body must be between two feet [m].

        Args:
            apart: distance of the feet [m].
            ordinary: that of the ordinary step [m].
            leg: height of the body over straight legs that are closed [m].
        """

        def drop(distance: float) -> float:
            return leg - math.sqrt(max(leg**2 - 0.25 * distance**2, 0.0))

        return max(drop(apart) - drop(self.stretch * max(ordinary, self.easy)), 0.0)

    def approach(
        self, height: float, rate: float, goal: float, dt: float, stretched: bool = False
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
