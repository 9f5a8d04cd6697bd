"""Pushes of the body as data."""

import math
from dataclasses import dataclass, replace

from humanwalk.body.limbs import CHEST
from humanwalk.numerics.random_stream import RandomStream
from humanwalk.quantity import ParameterError, quantity

ROUNDING = 1e-9
"""Rounding error of simulated times [s]. It must not make a push a step longer or shorter."""

MIN_RANDOM_INTERVAL = 0.1
"""Smallest mean time between random pushes [s]: the duration of a push."""


@dataclass(frozen=True)
class Push:
    """A constant force at the center of mass of one body for a short time."""

    time: float = quantity(5.0, "s", 0.0, 3600.0)
    """When the force begins."""

    duration: float = quantity(0.1, "s", 0.001, 60.0)
    """How long it lasts. It is rounded to whole steps of the simulation, at least one; the impulse is kept."""

    impulse: float = quantity(30.0, "N s", 0.0, 1000.0)
    """Force times duration."""

    direction: float = quantity(0.0, "rad", -2.0 * math.pi, 2.0 * math.pi)
    """Direction of the force in the horizontal plane: 0 along x, pi/2 to the left."""

    body: str = CHEST
    """Name of the body."""

    @property
    def force(self) -> tuple[float, float, float]:
        """The force in W [N]."""
        size = self.impulse / self.duration
        return (size * math.cos(self.direction), size * math.sin(self.direction), 0.0)

    def in_steps(self, step: float) -> "Push":
        """The push with the same impulse that lasts a whole number of steps [s], at least one."""
        return replace(self, duration=max(round(self.duration / step), 1) * step)

    def is_active(self, time: float) -> bool:
        """Whether the force acts at a time [s]."""
        return -ROUNDING <= time - self.time < self.duration - ROUNDING


@dataclass(frozen=True)
class PushParameters:
    """Pushes at given times, and pushes in random directions at random times."""

    given: tuple[Push, ...] = ()
    """Pushes at given times."""

    random_interval: float = quantity(0.0, "s", 0.0, 600.0)
    """Mean time between random pushes, which are drawn from the scenario's seed; 0 for none."""

    random_impulse: float = quantity(20.0, "N s", 0.0, 1000.0)
    """Largest impulse of a random push; impulses are uniformly distributed from 0."""

    random_until: float = quantity(60.0, "s", 0.0, 3600.0)
    """End of the random pushes."""

    def __post_init__(self) -> None:
        """Raise ParameterError for random pushes without number."""
        if 0.0 < self.random_interval < MIN_RANDOM_INTERVAL:
            raise ParameterError(
                f"random_interval: {self.random_interval:g} is out of range; allowed: 0, or {MIN_RANDOM_INTERVAL:g} to "
                "600 s; write a longer interval, or 0 for none"
            )


def all_pushes(parameters: PushParameters, seed: int) -> tuple[Push, ...]:
    """The given pushes, then the random ones drawn from `seed`."""
    drawn = []
    if parameters.random_interval > 0.0:
        random = RandomStream.PUSHES.of(seed)
        time = random.exponential(parameters.random_interval)
        while time < parameters.random_until:
            impulse, direction = random.uniform(0.0, parameters.random_impulse), random.uniform(-math.pi, math.pi)
            drawn.append(Push(time=time, impulse=impulse, direction=direction))
            time += random.exponential(parameters.random_interval)
    return (*parameters.given, *drawn)
