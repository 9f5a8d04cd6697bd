"""Pieces of a course with steps across the whole width: stairs, curbs, obstacles and stepping stones."""

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from humanwalk.quantity import ParameterError, quantity
from humanwalk.terrain.face import Color, Face
from humanwalk.terrain.piece import Piece

Direction = Literal["up", "down"]
UPWARD: dict[Direction, float] = {"up": 1.0, "down": -1.0}


@dataclass(frozen=True)
class Stairs(Piece):
    """A flight of stairs. Every step begins with its riser; the last tread is level with the next piece."""

    color: ClassVar[Color] = (0.76, 0.70, 0.64)

    direction: Direction = "up"
    """Whether it leads up or down."""

    rise: float = quantity(0.17, "m", 0.01, 0.4)
    """Height of a step; 0.17 to 0.185 m in buildings."""

    tread: float = quantity(0.29, "m", 0.1, 2.0)
    """Depth of a step; 0.27 to 0.29 m in buildings."""

    number: int = quantity(5, "", 1, 200)
    """Number of steps."""

    def faces(self, width: float) -> list[Face]:
        rise = UPWARD[self.direction] * self.rise
        return [self.across((k * self.tread, (k + 1) * self.tread), width, (k + 1) * rise) for k in range(self.number)]

    @property
    def end_height(self) -> float:
        return self.number * UPWARD[self.direction] * self.rise


@dataclass(frozen=True)
class Curb(Piece):
    """An edge up or down, and the level ground behind it."""

    color: ClassVar[Color] = (0.70, 0.72, 0.76)

    direction: Direction = "up"
    """Whether it leads up or down."""

    height: float = quantity(0.12, "m", 0.01, 0.4)
    """Height of the edge."""

    length: float = quantity(1.5, "m", 0.1, 1000.0)
    """Length of the ground behind the edge."""

    @property
    def end_height(self) -> float:
        return UPWARD[self.direction] * self.height

    def faces(self, width: float) -> list[Face]:
        return [self.across((0.0, self.length), width, self.end_height)]


@dataclass(frozen=True)
class Obstacle(Piece):
    """Level ground with a beam across its middle, to step over."""

    beam_color: ClassVar[Color] = (0.80, 0.42, 0.24)

    height: float = quantity(0.15, "m", 0.01, 0.5)
    """Height of the beam."""

    thickness: float = quantity(0.1, "m", 0.02, 1.0)
    """Extent of the beam along x."""

    length: float = quantity(2.0, "m", 0.1, 1000.0)
    """Length of the piece; several in a row have their beams so far apart."""

    def faces(self, width: float) -> list[Face]:
        before = 0.5 * (self.length - self.thickness)
        if before <= 0.0:
            raise ParameterError(
                f"length: {self.length:g} m is too short for a beam of {self.thickness:g} m; allowed: more than the "
                "thickness; make the piece longer"
            )
        behind = before + self.thickness
        beam = self.across((before, behind), width, self.height)._replace(color=self.beam_color)
        return [self.across((0.0, before), width, 0.0), beam, self.across((behind, self.length), width, 0.0)]


@dataclass(frozen=True)
class Stones(Piece):
    """Stepping stones across the whole width, with a gap before each and after the last."""

    color: ClassVar[Color] = (0.62, 0.66, 0.60)
    gap_color: ClassVar[Color] = (0.36, 0.38, 0.40)

    stone_length: float = quantity(0.3, "m", 0.05, 5.0)
    """Extent of a stone along x; a sole of the reference human is 0.27 m long."""

    gap: float = quantity(0.2, "m", 0.02, 2.0)
    """Distance between two stones."""

    number: int = quantity(8, "", 1, 500)
    """Number of stones."""

    height: float = quantity(0.05, "m", 0.0, 0.4)
    """Heights of the stones are uniform from -height to height, drawn from the seed."""

    depth: float = quantity(0.5, "m", 0.05, 5.0)
    """Depth of the floor between the stones."""

    seed: int = quantity(0, "", 0, 2**32 - 1)
    """Of the heights."""

    def faces(self, width: float) -> list[Face]:
        heights = np.random.default_rng(self.seed).uniform(-self.height, self.height, self.number)
        faces, x, deepest = [], 0.0, -self.depth - self.height
        for height in heights.tolist():
            stone = x + self.gap
            faces.append(self.across((x, stone), width, deepest)._replace(color=self.gap_color))
            x = stone + self.stone_length
            faces.append(self.across((stone, x), width, height))
        return [*faces, self.across((x, x + self.gap), width, deepest)._replace(color=self.gap_color)]
