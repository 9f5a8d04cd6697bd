"""The way that the command lays over the ground, and the speed that brings the walker back to it.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.walking.command import Command

SLOW = 0.1
"""Below this speed [m/s] a walker turns with the command, wherever on the path he is."""

SPACING = 0.05
"""Way between two places that are remembered [m]."""

REMEMBERED = 40
"""Number of these places: the last two metres."""


class Place(NamedTuple):
    """A place on the path: position [m], heading there [rad], turn rate there [rad/s], way since the start [m]."""

    position: complex
    heading: float
    turn: float = 0.0
    way: float = 0.0

    def advanced(self, command: Command, dt: float) -> Place:
        """Where a command leads in `dt`: a piece of an arc, told by its middle heading."""
        turn = command.turn * dt
        step = command.velocity * dt * cmath.exp(1j * (self.heading + 0.5 * turn))
        return Place(self.position + step, self.heading + turn, command.turn, self.way + abs(command.velocity) * dt)

    def towards(self, other: Place, share: float) -> Place:
        """On the straight line to another place, which is near."""
        return Place(
            self.position + share * (other.position - self.position),
            self.heading + share * (other.heading - self.heading),
            other.turn,
            self.way + share * (other.way - self.way),
        )


@dataclass(frozen=True)
class CommandedPath:
    """The last two metres of the path: places `SPACING` apart, and at the end where the command has come to."""

    places: tuple[Place, ...]

    @staticmethod
    def begin(position: complex, heading: float) -> CommandedPath:
        """The path of a walker who stands [m, rad]."""
        return CommandedPath((Place(position, heading),))

    @property
    def end(self) -> Place:
        """Where the command has come to."""
        return self.places[-1]

    def advanced(self, command: Command, dt: float) -> CommandedPath:
        """The path `dt` later."""
        end = self.end.advanced(command, dt)
        *kept, last = self.places
        if not kept or last.way - kept[-1].way >= SPACING:
            kept = [*kept, last][-REMEMBERED:]
        return CommandedPath((*kept, end))

    def beside(self, walker: complex, command: Command) -> Place:
        """The place that is nearest to a walker; past the end, where the command leads."""
        speed = abs(command.velocity)
        if speed < SLOW:
            return self.end
        direction = command.velocity / speed * cmath.exp(1j * self.end.heading)
        ahead = ((walker - self.end.position) / direction).real
        nearest = self.end.advanced(command, max(ahead, 0.0) / speed)
        for a, b in pairwise(self.places):
            way = b.position - a.position
            share = clip(((walker - a.position) / way).real, 0.0, 1.0) if way else 0.0
            place = a.towards(b, share)
            if abs(place.position - walker) < abs(nearest.position - walker):
                nearest = place
        return nearest

    def moved(self, way: complex) -> CommandedPath:
        """The path somewhere else [m]."""
        return CommandedPath(tuple(place._replace(position=place.position + way) for place in self.places))


@dataclass(frozen=True)
class PathFollowing:
    """How the walker keeps to its path: sideways to its lane, and along it to where the command has come to."""

    lane_gain: float = quantity(0.9, "1/s", 0.0, 2.0)
    """Speed across the path per distance from it."""

    lane_speed_limit: float = quantity(0.1, "m/s", 0.0, 0.5)
    """Greatest such speed."""

    pace_gain: float = quantity(0.3, "1/s", 0.0, 2.0)
    """Speed along the path per distance behind the commanded place: so the mean speed is the commanded one."""

    behind: float = quantity(0.25, "s", 0.0, 1.0)
    """The walker's own place is so far behind the commanded one: a step keeps the speed that was commanded as it began,
    half a step ago in the mean. Who ran after that too would overshoot where the command stops."""

    pace_speed_limit: float = quantity(0.2, "m/s", 0.0, 1.0)
    """Greatest such speed."""

    def correction(self, path: CommandedPath, beside: Place, walker: complex, command: Command) -> complex:
        """Speed that is added to the commanded one, seen along the heading beside the walker [m/s].

        Args:
            path: what was commanded.
            beside: its place beside the walker.
            walker: his place [m].
            command: now.
        """
        aside = (beside.position - walker) / cmath.exp(1j * beside.heading)
        correction = _bounded(self.lane_gain * aside, self.lane_speed_limit)
        if command.velocity:
            speed = abs(command.velocity)
            pace = self.pace_gain * (path.end.way - beside.way - self.behind * speed)
            correction += clip(pace, -self.pace_speed_limit, self.pace_speed_limit) * command.velocity / speed
        return correction

    def leashed(self, path: CommandedPath, beside: Place) -> CommandedPath:
        """The path, not farther ahead or behind than the pace makes up for: who was held up does not run after it."""
        if self.pace_gain == 0.0:
            return path
        gap = path.end.position - beside.position
        leash = self.pace_speed_limit / self.pace_gain
        return path.moved(_bounded(gap, leash) - gap)


def _bounded(vector: complex, limit: float) -> complex:
    return vector if abs(vector) <= limit else vector * (limit / abs(vector))
