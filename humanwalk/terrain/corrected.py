"""A ground that is another one plus a smooth correction of its height."""

from typing import Protocol

import numpy as np

from humanwalk.numerics import Array
from humanwalk.terrain.face import Face, surface_axes
from humanwalk.terrain.terrain import Ground


class CorrectedGround(Ground, Protocol):
    """A ground with a correction; its faces have the rectangles of the other one's, and its friction.

    Attributes:
        base: The other ground.
    """

    base: Ground

    def correction(self, xy: Array) -> tuple[Array, Array]:
        """Return height [m] and slopes to be added at points xy [m]; shapes (...) and (..., 2) for (..., 2)."""

    def height(self, xy: Array) -> Array:
        height: Array = self.base.height(xy) + self.correction(xy)[0]
        return height

    def axes(self, xy: Array) -> Array:
        normal = self.base.axes(xy)[..., 2, :]
        gradient = self.correction(xy)[1] - normal[..., :2] / normal[..., 2:]
        return surface_axes(np.concatenate((-gradient, np.ones((*xy.shape[:-1], 1))), axis=-1))

    def friction(self, xy: Array) -> Array:
        return self.base.friction(xy)

    def face_at(self, xy: Array) -> Face:
        return self._tangent(self.base.face_at(xy), xy)

    def faces_near(self, xy: Array, distance: float) -> tuple[Face, ...]:
        faces = self.base.faces_near(xy, distance)
        return tuple(self._tangent(face, np.clip(xy, face.lower, face.upper)) for face in faces)

    def _tangent(self, face: Face, xy: Array) -> Face:
        """A face with the correction at a point of it."""
        height, slopes = self.correction(xy)
        a, b = (slope + added for slope, added in zip(face.gradient, slopes.tolist(), strict=True))
        intercept = float(face.height(xy) + height) - a * float(xy[0]) - b * float(xy[1])
        return face._replace(intercept=intercept, gradient=(a, b))
