"""The way that the command lays over the ground, and the speed that brings the walker back to it.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

from humanwalk.control.command import Command
from humanwalk.control.scalars import clip
from humanwalk.quantity import quantity

SLOW = 0.1
"""Below this speed [m/s] a walker turns with the command, wherever on the path he is."""


@dataclass(frozen=True)
class PathFollowing:
    """How the walker keeps to its path: sideways to its lane, and along it to where the command has come to."""

    lane_gain: float = quantity(0.5, "1/s", 0.0, 2.0)
    """Sideways speed per distance from the path."""

    lane_speed_limit: float = quantity(0.1, "m/s", 0.0, 0.5)
    """Greatest such sideways speed."""

    pace_gain: float = quantity(0.3, "1/s", 0.0, 2.0)
    """Forward speed per distance behind the commanded place: so the mean speed is the commanded one."""

    pace_speed_limit: float = quantity(0.2, "m/s", 0.0, 1.0)
    """Greatest such forward speed."""

    def correction(self, path: CommandedPath, beside: CommandedPath, place: complex) -> complex:
        """Speed that is added to the commanded one, seen along the heading beside the walker [m/s].

        Args:
            path: where the command has come to.
            beside: where that was beside the walker.
            place: of the walker [m].
        """
        behind = (path.position - place) / cmath.exp(1j * path.heading)
        aside = (beside.position - place) / cmath.exp(1j * beside.heading)
        return complex(
            clip(self.pace_gain * behind.real, -self.pace_speed_limit, self.pace_speed_limit),
            clip(self.lane_gain * aside.imag, -self.lane_speed_limit, self.lane_speed_limit),
        )

    def leashed(self, path: CommandedPath, place: complex) -> CommandedPath:
        """The path, not farther ahead or behind than the pace makes up for: who was held up does not run after it."""
        if self.pace_gain == 0.0:
            return path
        u = cmath.exp(1j * path.heading)
        behind = (path.position - place) / u
        leash = self.pace_speed_limit / self.pace_gain
        return CommandedPath(path.position + u * (clip(behind.real, -leash, leash) - behind.real), path.heading)


@dataclass(frozen=True)
class CommandedPath:
    """Where the command has come to [m], and where it heads [rad]."""

    position: complex
    heading: float

    def beside(self, place: complex, command: Command) -> CommandedPath:
        """Where it was beside a walker who is behind, or will be: on an arc, the way heads elsewhere there."""
        speed = abs(command.speed)
        if speed < SLOW:
            return self
        behind = (self.position - place) / cmath.exp(1j * self.heading)
        along = (behind * command.speed.conjugate()).real / speed
        return self.advanced(command, -along / speed)

    def advanced(self, command: Command, dt: float) -> CommandedPath:
        """The same `dt` later: a piece of an arc, told by its middle heading."""
        turn = command.turn * dt
        way = command.speed * dt * cmath.exp(1j * (self.heading + 0.5 * turn))
        return CommandedPath(self.position + way, self.heading + turn)
