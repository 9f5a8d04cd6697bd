"""Walking speed: a linear ramp from zero, then constant (thesis 4.2.3, erratum E26)."""

import math
from dataclasses import dataclass

from humanwalk.quantity import check, quantity


@dataclass(frozen=True)
class SpeedRamp:
    """Speed of the pelvis over time: 0 before t = 0, linear up to `duration`, then `speed`."""

    speed: float = quantity(1.4, "m/s", 0.0, 3.0)
    """Speed after the ramp: 1.4 in the thesis; with 0 the body stands."""

    duration: float = quantity(1.0, "s", 0.0, 60.0)
    """Duration of the ramp. 0 starts at full speed, with a jump of the velocities."""

    def __post_init__(self) -> None:
        check(self)

    def distance(self, t: float) -> float:
        """Distance at t [s]: [m]."""
        if t <= 0.0:
            return 0.0
        if t < self.duration:
            return 0.5 * self.speed * t * t / self.duration
        return self.speed * (t - 0.5 * self.duration)

    def speed_at(self, t: float) -> float:
        """Speed at t [s]: [m/s]."""
        if t < 0.0:
            return 0.0
        return self.speed * t / self.duration if t < self.duration else self.speed

    def acceleration(self, t: float) -> float:
        """Acceleration at t [s], right-sided: [m/s^2]."""
        return self.speed / self.duration if 0.0 <= t < self.duration else 0.0

    def time_at(self, distance: float) -> float:
        """Time [s] at which the distance [m] is reached; inf if never."""
        if distance <= 0.0:
            return 0.0
        if self.speed == 0.0:
            return math.inf
        ramped = 0.5 * self.speed * self.duration
        if distance < ramped:
            return math.sqrt(2.0 * distance * self.duration / self.speed)
        return distance / self.speed + 0.5 * self.duration
