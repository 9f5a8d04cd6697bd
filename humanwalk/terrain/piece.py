"""The protocol of the pieces of a course: flat faces over a rectangle, which begin at the origin and go forward."""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from humanwalk.quantity import ParameterError, quantity
from humanwalk.terrain.face import Color, Face

Interval = tuple[float, float]

MAX_FACES = 2000
"""Largest number of faces of a course; Drake takes five seconds to register as many solids, and twice for 1.5 times."""


@dataclass(frozen=True)
class Piece:
    """A piece of a course; a new kind is a dataclass with `faces`, and its tag in `PIECES`.

    It begins at x = 0, z = 0 and is symmetric to y = 0; the course moves it to its place.
    """

    friction_coefficient: float = quantity(0.7, "", 0.05, 1.3)
    """Coulomb coefficient between sole and ground, static and dynamic: 0.7 (thesis 2.5), 0.1 on ice."""

    color: ClassVar[Color] = (0.86, 0.87, 0.86)
    """For pictures."""

    def faces(self, width: float) -> list[Face]:
        """Return faces that cover the piece without gap or overlap, over y from -width / 2 to width / 2.

        Raises:
            ParameterError: The piece is not possible.
        """
        raise NotImplementedError

    @property
    def end_height(self) -> float:
        """Height of the middle of its end, where the next piece begins [m]."""
        return 0.0

    def face(self, x: Interval, y: Interval, height: float, gradient: tuple[float, float] = (0.0, 0.0)) -> Face:
        """A face of this piece over x and y [m], whose plane is at `height` above the origin [m]."""
        return Face((x[0], y[0]), (x[1], y[1]), height, gradient, self.friction_coefficient, self.color)

    def across(self, x: Interval, width: float, height: float) -> Face:
        """A level face over x and the whole width [m], at a height [m]."""
        return self.face(x, (-0.5 * width, 0.5 * width), height)


def intervals(length: float, size: float, begin: float = 0.0) -> list[Interval]:
    """Cut a length into equal intervals as near to a size as possible, from `begin` on [m]."""
    edges = begin + np.linspace(0.0, length, 1 + max(1, round(length / size)))
    return list(pairwise(edges.tolist()))


def require_few_faces(number: int, field: str, fix: str) -> None:
    """Raise ParameterError, before they are made, if a piece has more than `MAX_FACES` faces because of a field."""
    if number > MAX_FACES:
        raise ParameterError(f"{field}: {number} faces; allowed: up to {MAX_FACES} in a course; {fix}")
