"""The path that the command describes over the ground, and the velocity that returns the walker to it.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.walking.command import Command

SAME_DISTANCE = 1e-9
"""Difference of distances that comes from rounding [m]."""

STORED_TURN = 0.1
"""Turn between two stored places of a path that turns on the spot, or nearly so [rad] (our choice)."""

STORED_PLACES = 40
"""Number of stored places: the last two meters of the reference body, if it does not turn on the spot."""


class Place(NamedTuple):
    """A place on the path.

    Attributes:
        position: [m].
        heading: Heading of the path [rad].
        turn: Turn rate [rad/s].
        distance: Length of the path from the start [m].
    """

    position: complex
    heading: float
    turn: float = 0.0
    distance: float = 0.0

    def advanced(self, command: Command, dt: float) -> Place:
        """The place that a command leads to in `dt` [s], along the chord of the arc."""
        turn = command.turn * dt
        step = command.velocity * dt * cmath.exp(1j * (self.heading + 0.5 * turn))
        distance = self.distance + abs(command.velocity) * dt
        return Place(self.position + step, self.heading + turn, command.turn, distance)

    def is_beyond(self, stored: Place, spacing: float) -> bool:
        """Whether the path has moved on or turned since a stored place: between stored places it is nearly straight."""
        return self.distance - stored.distance >= spacing or abs(self.heading - stored.heading) >= STORED_TURN

    def interpolated(self, end: Place, fraction: float) -> Place:
        """The place at a fraction of the line to the next place."""
        return Place(
            self.position + fraction * (end.position - self.position),
            self.heading + fraction * (end.heading - self.heading),
            end.turn,
            self.distance + fraction * (end.distance - self.distance),
        )


@dataclass(frozen=True)
class CommandedPath:
    """The last part of the path.

    Attributes:
        places: Places `spacing` or a turn of `STORED_TURN` apart; the last one is the commanded place.
        spacing: Distance between two stored places [m].
        min_speed: See `PathFollowing`.
    """

    places: tuple[Place, ...]
    spacing: float
    min_speed: float

    @property
    def end(self) -> Place:
        """The commanded place."""
        return self.places[-1]

    def advanced(self, command: Command, dt: float) -> CommandedPath:
        """The path `dt` [s] later."""
        end = self.end.advanced(command, dt)
        *stored, last = self.places
        if not stored or last.is_beyond(stored[-1], self.spacing):
            stored = [*stored, last][-STORED_PLACES:]
        return replace(self, places=(*stored, end))

    def nearest(self, position: complex, command: Command) -> Place:
        """The place of the path that is nearest to a position; beyond its end, the path continues along the command.

        It is the first one from the end on: a path that turns back passes near its earlier places again.
        """
        speed = abs(command.velocity)
        if speed < self.min_speed:
            return self.end
        direction = command.velocity / speed * cmath.exp(1j * self.end.heading)
        ahead = ((position - self.end.position) / direction).real
        nearest = self.end.advanced(command, max(ahead, 0.0) / speed)
        distance = abs(nearest.position - position)
        for a, b in pairwise(reversed(self.places)):
            place = _nearest_between(b, a, position)
            change = abs(place.position - position) - distance
            if change > SAME_DISTANCE:
                break
            # Of the places of a turn on the spot the last one counts.
            if change < -SAME_DISTANCE:
                nearest, distance = place, distance + change
        return nearest

    def shifted(self, displacement: complex) -> CommandedPath:
        """The path, displaced [m]."""
        places = (place._replace(position=place.position + displacement) for place in self.places)
        return replace(self, places=tuple(places))


@dataclass(frozen=True)
class PathFollowing:
    """Lane keeping across the path, and pace keeping along it."""

    lane_gain: float = quantity(0.9, "1/s", 0.0, 2.0)
    """Speed across the path per distance from it."""

    lane_speed_limit: float = quantity(0.1, "m/s", 0.0, 0.5)
    """Largest speed across the path."""

    pace_gain: float = quantity(0.3, "1/s", 0.0, 2.0)
    """Speed along the path per distance behind the nominal place, so that the mean speed is the commanded one."""

    lag: float = quantity(0.6, "s", 0.0, 1.0)
    """Time by which the nominal place is behind the commanded one: the first step begins after the weight shift, and a
    step keeps the speed that was commanded when it began. With 0.25 s a walker that starts to 1.4 m/s reaches 1.49 m/s
    (docs/decisions/0058-path-after-the-start.md)."""

    pace_speed_limit: float = quantity(0.2, "m/s", 0.0, 1.0)
    """Largest speed along the path."""

    min_speed: float = quantity(0.1, "m/s", 0.01, 1.0)
    """Commanded speed below which the walker turns with the command instead of with the path."""

    spacing: float = quantity(0.05, "m", 0.01, 0.5)
    """Distance between two stored places of the path."""

    def begin(self, position: complex, heading: float) -> CommandedPath:
        """The path of a standing walker."""
        return CommandedPath((Place(position, heading),), self.spacing, self.min_speed)

    def correction(self, path: CommandedPath, nearest: Place, position: complex, command: Command) -> complex:
        """Velocity to be added to the commanded one, relative to the heading of the nearest place [m/s].

        Args:
            path: The path.
            nearest: Its place nearest to the walker.
            position: Position of the walker [m].
            command: The current command.
        """
        offset = (nearest.position - position) / cmath.exp(1j * nearest.heading)
        correction = _limited(self.lane_gain * offset, self.lane_speed_limit)
        if command.velocity:
            speed = abs(command.velocity)
            pace = self.pace_gain * (path.end.distance - nearest.distance - self.lag * speed)
            correction += clip(pace, -self.pace_speed_limit, self.pace_speed_limit) * command.velocity / speed
        return correction

    def limit_lead(self, path: CommandedPath, nearest: Place, command: Command) -> CommandedPath:
        """The path, displaced so that its end is at most as far ahead as the pace can make up for.

        A walker that was held up does not have to catch up with the command.

        Args:
            path: The path.
            nearest: Its place nearest to the walker.
            command: The current command.
        """
        if self.pace_gain == 0.0:
            return path
        lead = path.end.position - nearest.position
        limit = self.lag * abs(command.velocity) + self.pace_speed_limit / self.pace_gain
        return path.shifted(_limited(lead, limit) - lead)


def _nearest_between(a: Place, b: Place, position: complex) -> Place:
    """The place on the line from one place to the next that is nearest to a position."""
    line = b.position - a.position
    return a.interpolated(b, clip(((position - a.position) / line).real, 0.0, 1.0) if line else 0.0)


def _limited(vector: complex, limit: float) -> complex:
    return vector if abs(vector) <= limit else vector * (limit / abs(vector))
