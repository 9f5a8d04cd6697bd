"""The commanded velocity over time: target speeds at given times, approached at bounded rates."""

from bisect import bisect_right
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip
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

    def at_pace(self, pace: float) -> "Command":
        """The command with another forward speed, relative to this one."""
        return replace(self, forward=pace * self.forward)


@dataclass(frozen=True)
class CommandPoint:
    """Target speeds along the walker's heading from a given time on."""

    time: float = quantity(0.0, "s", 0.0, 3600.0)
    """When the speeds begin to change towards these."""

    forward: float = quantity(0.0, "m/s", -1.5, 3.0)
    """Along the heading; backward is negative."""

    sideways: float = quantity(0.0, "m/s", -1.0, 1.0)
    """To the left."""

    turn: float = quantity(0.0, "rad/s", -2.0, 2.0)
    """To the left."""


TESTED = {
    "forward": ("m/s", ((-0.5, 0.0), (0.3, 2.0))),
    "sideways": ("m/s", ((-0.3, 0.3),)),
    "turn": ("rad/s", ((-0.4, 0.4),)),
}
"""Unit and tested ranges of each commanded speed: the tables of docs/robustness.md."""


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
                    f"points: time {later:g} comes after {earlier:g}; allowed: increasing times; give each time once, "
                    "in order"
                )

    @property
    def greatest_forward(self) -> float:
        """Greatest forward speed of a point, backward ones by their size [m/s]; 0 without points."""
        return max((point.forward for point in self.points), key=abs, default=0.0)

    def points_at_speed(self, speed: float) -> tuple[CommandPoint, ...]:
        """The points with another greatest forward speed [m/s], negative for a walk backward, the others in proportion.

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
            f"{' and '.join(f'{low:g} to {high:g}' for low, high in ranges)} {unit} (docs/robustness.md)"
            for point in self.points
            for name, (unit, ranges) in TESTED.items()
            if not any(low <= getattr(point, name) <= high for low, high in ranges)
        )


@dataclass(frozen=True)
class _Ramp:
    """The part of a profile from a point on: from the command at that time toward the point's speeds."""

    time: float
    start: Command
    target: Command


class CommandProfile:
    """The command over time.

    The command at a time depends on the points up to then only, to the last bit: a profile to which points are added
    while it is followed is the same as one that had them from the beginning.
    """

    def __init__(self, parameters: CommandParameters) -> None:
        self.parameters = parameters
        self._ramps: list[_Ramp] = []
        for point in parameters.points:
            start = self.at(point.time)
            self._ramps.append(_Ramp(point.time, start, Command(point.forward, point.sideways, point.turn)))

    def at(self, time: float) -> Command:
        """The command at a time [s]."""
        ramp = self._ramp_at(time)
        if ramp is None:
            return Command()
        change = self.parameters.acceleration * (time - ramp.time)
        turn_change = self.parameters.turn_acceleration * (time - ramp.time)
        return Command(
            _toward(ramp.start.forward, ramp.target.forward, change),
            _toward(ramp.start.sideways, ramp.target.sideways, change),
            _toward(ramp.start.turn, ramp.target.turn, turn_change),
        )

    def over(self, times: Array) -> tuple[Array, Array, Array]:
        """Forward and sideways speed [m/s] and turn rate [rad/s] at times [s]; each of the shape of `times`, (n,)."""
        commands = (self.at(time) for time in times.tolist())
        speeds = np.array([(command.forward, command.sideways, command.turn) for command in commands]).reshape(-1, 3)
        return speeds[:, 0], speeds[:, 1], speeds[:, 2]

    def target_at(self, time: float) -> Command:
        """The speeds that the command changes toward, or has reached, at a time [s]."""
        ramp = self._ramp_at(time)
        return Command() if ramp is None else ramp.target

    def steered(self, time: float, target: Command) -> "CommandProfile":
        """The profile with other speeds from a time [s] on, in place of all points from then on."""
        earlier = tuple(point for point in self.parameters.points if point.time < time)
        point = CommandPoint(time, target.forward, target.sideways, target.turn)
        return CommandProfile(replace(self.parameters, points=(*earlier, point)))

    def _ramp_at(self, time: float) -> _Ramp | None:
        begun = bisect_right(self._ramps, time, key=lambda ramp: ramp.time)
        return self._ramps[begun - 1] if begun else None


def _toward(start: float, target: float, change: float) -> float:
    """A value moved from `start` toward `target`, by no more than `change`."""
    return start + clip(target - start, -change, change)
