"""The commanded velocity over time: target speeds at given times, approached at bounded rates."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity


@dataclass(frozen=True)
class Command:
    """Commanded speeds along the walker's heading [m/s] and turn rate [rad/s]; left is positive."""

    forward: float = 0.0
    sideways: float = 0.0
    turn: float = 0.0

    @property
    def velocity(self) -> complex:
        """Forward + i sideways [m/s]."""
        return complex(self.forward, self.sideways)


@dataclass(frozen=True)
class CommandPoint:
    """Target speeds along the walker's heading from a given time on."""

    time: float = quantity(0.0, "s", 0.0, 3600.0)
    """When the speeds begin to change towards these."""

    forward: float = quantity(0.0, "m/s", -1.5, 3.0)
    sideways: float = quantity(0.0, "m/s", -1.0, 1.0)
    """To the left."""

    turn: float = quantity(0.0, "rad/s", -2.0, 2.0)
    """To the left."""


TESTED = {
    "forward": ("m/s", ((-0.5, 0.0), (0.3, 1.4))),
    "sideways": ("m/s", ((-0.3, 0.3),)),
    "turn": ("rad/s", ((-0.4, 0.4),)),
}
"""Unit and tested ranges of each commanded speed: the tables of docs/balance.md."""


@dataclass(frozen=True)
class CommandParameters:
    """The command over time; zero before the first point."""

    points: tuple[CommandPoint, ...] = (CommandPoint(time=1.0, forward=1.0),)
    """Sorted by time."""

    acceleration: float = quantity(0.4, "m/s2", 0.01, 5.0)
    """Rate at which the speeds change."""

    turn_acceleration: float = quantity(0.5, "rad/s2", 0.01, 10.0)
    """Rate at which the turn rate changes."""

    def __post_init__(self) -> None:
        times = [point.time for point in self.points]
        for earlier, later in pairwise(times):
            if later <= earlier:
                raise ParameterError(
                    f"points: time {later:g} comes after {earlier:g}; allowed: increasing times; sort the points"
                )

    @property
    def greatest_forward(self) -> float:
        """Greatest forward speed of a point, backward ones by their size [m/s]; 0 without points."""
        return max((point.forward for point in self.points), key=abs, default=0.0)

    def points_at_speed(self, speed: float) -> tuple[CommandPoint, ...]:
        """The points with another greatest forward speed [m/s], the others in proportion.

        Points without any forward speed all get the new one; without points there is one at 1 s.
        """
        greatest = self.greatest_forward
        points = self.points or CommandParameters.points
        return tuple(
            replace(point, forward=speed * (point.forward / greatest if greatest else 1.0)) for point in points
        )

    @property
    def untested(self) -> tuple[str, ...]:
        """Commanded speeds beyond the tested ranges, one line each."""
        return tuple(
            f"commanded {name} {getattr(point, name):g} {unit} at {point.time:g} s is not tested; tested: "
            f"{' and '.join(f'{low:g} to {high:g}' for low, high in ranges)} {unit} (docs/balance.md)"
            for point in self.points
            for name, (unit, ranges) in TESTED.items()
            if not any(low <= getattr(point, name) <= high for low, high in ranges)
        )


class CommandProfile:
    """The command as a piecewise linear function of time."""

    def __init__(self, parameters: CommandParameters) -> None:
        points = parameters.points
        times = [point.time for point in points]
        self._forward = _ramps(times, [point.forward for point in points], parameters.acceleration)
        self._sideways = _ramps(times, [point.sideways for point in points], parameters.acceleration)
        self._turn = _ramps(times, [point.turn for point in points], parameters.turn_acceleration)

    def at(self, time: float) -> Command:
        """The command at a time [s]."""
        return Command(*(float(np.interp(time, *ramps)) for ramps in (self._forward, self._sideways, self._turn)))

    def over(self, times: Array) -> tuple[Array, Array, Array]:
        """Forward and sideways speed [m/s] and turn rate [rad/s] at times [s]; each of the shape of `times`."""
        return np.interp(times, *self._forward), np.interp(times, *self._sideways), np.interp(times, *self._turn)


def _ramps(times: list[float], targets: list[float], rate: float) -> tuple[Array, Array]:
    """Breakpoints (times, values) of a function that moves from 0 towards each target at a constant rate."""
    knots, values = [0.0], [0.0]
    for time, target in zip(times, targets, strict=True):
        start = float(np.interp(time, knots, values))
        # A point may interrupt the ramp of the point before it.
        kept = sum(knot < time for knot in knots)
        knots = [*knots[:kept], time, time + abs(target - start) / rate]
        values = [*values[:kept], start, target]
    return np.array(knots), np.array(values)
