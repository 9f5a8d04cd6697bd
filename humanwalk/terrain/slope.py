"""Pieces of a course that are one plane: level ground, and ramps."""

import math
from dataclasses import dataclass
from typing import ClassVar

from humanwalk.quantity import quantity
from humanwalk.terrain.face import Color, Face
from humanwalk.terrain.piece import Piece


@dataclass(frozen=True)
class Flat(Piece):
    """Level ground."""

    length: float = quantity(2.0, "m", 0.1, 1000.0)
    """Its length."""

    def faces(self, width: float) -> list[Face]:
        return [self.across((0.0, self.length), width, 0.0)]


@dataclass(frozen=True)
class Slope(Piece):
    """A plane that goes up, down or across."""

    color: ClassVar[Color] = (0.82, 0.78, 0.66)

    slope: float = quantity(0.0873, "rad", -0.5, 0.5)
    """Inclination along x, positive upward: 5 degrees are 0.0873 rad."""

    length: float = quantity(3.0, "m", 0.1, 1000.0)
    """Its length on the level plane."""

    cross_slope: float = quantity(0.0, "rad", -0.5, 0.5)
    """Inclination along y, positive upward to the left. The middle line is level with the neighboring pieces."""

    def faces(self, width: float) -> list[Face]:
        gradient = (math.tan(self.slope), math.tan(self.cross_slope))
        return [self.face((0.0, self.length), (-0.5 * width, 0.5 * width), 0.0, gradient)]

    @property
    def end_height(self) -> float:
        return self.length * math.tan(self.slope)
