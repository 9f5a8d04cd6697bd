"""A face: a flat part of the ground over a rectangle of the level plane, large enough or not for a sole."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix

Color = tuple[float, float, float]
"""Red, green and blue, 0 to 1."""

ENDLESS = 10_000.0
"""Half of the length of a face that has no end [m]; solids have none longer."""


class Face(NamedTuple):
    """The plane z = intercept + gradient . (x, y) over a rectangle with edges along x and y, in W.

    Attributes:
        lower, upper: Corners (x, y) of the rectangle [m]; `ENDLESS` away where it has no end.
        intercept: Height of the plane above the origin of W [m].
        gradient: Slopes of the plane along x and y.
        friction: Coulomb coefficient between sole and ground.
        color: For pictures.
    """

    lower: tuple[float, float]
    upper: tuple[float, float]
    intercept: float
    gradient: tuple[float, float]
    friction: float
    color: Color

    @property
    def is_level(self) -> bool:
        """Whether the normal is vertical."""
        return self.gradient == (0.0, 0.0)

    @property
    def normal(self) -> Array:
        """Upward unit normal, shape (3,)."""
        a, b = self.gradient
        return np.array((-a, -b, 1.0)) / math.sqrt(1.0 + a * a + b * b)

    @property
    def R_SW(self) -> Array:
        """Axes of the face, shape (3, 3); see `Terrain.axes`."""
        return np.eye(3) if self.is_level else surface_axes(self.normal)

    @property
    def corners(self) -> Array:
        """Corners in W [m], counterclockwise from `lower`, shape (4, 3)."""
        (x0, y0), (x1, y1) = self.lower, self.upper
        xy = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1)))
        return np.column_stack((xy, self.height(xy)))

    @property
    def lowest(self) -> float:
        """Height of the lowest corner [m]."""
        return float(self.corners[:, 2].min())

    def covers_as(self, other: "Face") -> bool:
        """Whether another face has the same rectangle: the same face, perhaps with another belief about its plane."""
        return self.lower == other.lower and self.upper == other.upper

    def height(self, xy: Array) -> Array:
        """Height of the plane [m] at points xy [m], within the face or not; shape (...) for (..., 2)."""
        height: Array = self.intercept + xy @ np.array(self.gradient)
        return height

    def margin(self, xy: Array) -> Array:
        """Distance of points xy [m] from the nearest edge on the level plane [m], negative outside; (...) for (..., 2).

        A sole lies on the face if the smallest margin of its corners is positive.
        """
        margin: Array = np.minimum(xy - np.array(self.lower), np.array(self.upper) - xy).min(axis=-1)
        return margin

    def moved(self, x: float, z: float) -> "Face":
        """The face moved by x along the course and z upward [m]."""
        (x0, y0), (x1, y1) = self.lower, self.upper
        return self._replace(
            lower=(x0 + x, y0), upper=(x1 + x, y1), intercept=self.intercept + z - self.gradient[0] * x
        )

    def tiles(self, size: float) -> list[list["Face"]]:
        """The face cut into equal rectangles of edges up to `size` [m]: rows along y, one behind another."""
        xs, ys = (
            np.linspace(low, high, 1 + math.ceil((high - low) / size - 1e-9)).tolist()
            for low, high in zip(self.lower, self.upper, strict=True)
        )
        return [[self._replace(lower=(x0, y0), upper=(x1, y1)) for y0, y1 in pairwise(ys)] for x0, x1 in pairwise(xs)]


def surface_axes(normal: Array) -> Array:
    """Return R_SW of a surface from its upward normal of any length; shape (..., 3, 3) for (..., 3)."""
    z = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    x = np.stack((z[..., 2], np.zeros_like(z[..., 0]), -z[..., 0]), axis=-1)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack((x, np.matvec(cross_matrix(z), x), z), axis=-2)
