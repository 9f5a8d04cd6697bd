"""What the walker is asked for over time: target speeds from given times on, approached at a bounded rate."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from humanwalk.quantity import ParameterError, quantity


@dataclass(frozen=True)
class Command:
    """What the walker is asked for, seen along its own heading: speeds [m/s] and turn rate [rad/s]."""

    forward: float = 0.0
    sideways: float = 0.0
    turn: float = 0.0

    @property
    def speed(self) -> complex:
        """Forward and sideways as one complex number."""
        return complex(self.forward, self.sideways)


@dataclass(frozen=True)
class CommandPoint:
    """Target speeds, seen along the walker's heading, from a time on."""

    time: float = quantity(0.0, "s", 0.0, 3600.0)
    """When the speeds begin to change towards these."""

    forward: float = quantity(0.0, "m/s", -1.5, 3.0)
    sideways: float = quantity(0.0, "m/s", -1.0, 1.0)
    """To the left."""

    turn: float = quantity(0.0, "rad/s", -2.0, 2.0)
    """To the left."""


@dataclass(frozen=True)
class CommandParameters:
    """The command over time; standing before the first point."""

    points: tuple[CommandPoint, ...] = (CommandPoint(time=1.0, forward=1.0),)
    """In the order of their times."""

    acceleration: float = quantity(0.4, "m/s2", 0.01, 5.0)
    """Rate at which speeds change."""

    turn_acceleration: float = quantity(0.5, "rad/s2", 0.01, 10.0)
    """Rate at which the turn rate changes."""

    def __post_init__(self) -> None:
        times = [point.time for point in self.points]
        for earlier, later in pairwise(times):
            if later <= earlier:
                raise ParameterError(
                    f"points: time {later:g} comes after {earlier:g}; allowed: growing times; sort the points"
                )


class CommandProfile:
    """The command as a function of time, piecewise linear."""

    def __init__(self, parameters: CommandParameters) -> None:
        self._knots = []
        for quantity_, rate in (
            ("forward", parameters.acceleration),
            ("sideways", parameters.acceleration),
            ("turn", parameters.turn_acceleration),
        ):
            times, values = [0.0], [0.0]
            for point in parameters.points:
                value = float(np.interp(point.time, times, values))
                # A point may come before the change that the one before it began is over.
                kept = [i for i, t in enumerate(times) if t < point.time]
                times, values = [times[i] for i in kept], [values[i] for i in kept]
                target = getattr(point, quantity_)
                times += [point.time, point.time + abs(target - value) / rate]
                values += [value, target]
            self._knots.append((np.array(times), np.array(values)))

    @property
    def knots(self) -> list[float]:
        """Times between which everything that is commanded changes at constant rates; at least two [s]."""
        times = sorted({float(time) for times, _ in self._knots for time in times})
        # Two that differ by rounding are one.
        apart = [time for time, before in zip(times, [-1.0, *times], strict=False) if time > before + 1e-9]
        return [*apart, apart[-1] + 1.0]

    def at(self, time: float) -> Command:
        """The command at a time [s]."""
        return Command(*(float(np.interp(time, times, values)) for times, values in self._knots))
