"""The ground as a function: how far points are above it, and where its surface faces there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from humanwalk.numerics import Array

HEIGHT_SPACING = 1e-4
"""Over which the slope of a height function is taken [m]."""


class Ground(Protocol):
    """A fixed surface in W."""

    def __call__(self, p_WQ: Array) -> tuple[Array, Array]:
        """Height of points above the surface along its normal, and the surface's axes there.

        Args:
            p_WQ: points [m], shape (..., 3).

        Returns:
            Height [m], negative below the surface, shape (...); rotation R_SW whose rows are the surface's axes x and y
            and its normal, shape (3, 3), or (..., 3, 3) where they differ from point to point.
        """


class PlaneGround:
    """A plane at a distance from the world's origin."""

    def __init__(self, normal: Sequence[float] = (0.0, 0.0, 1.0), distance: float = 0.0) -> None:
        """Make the plane.

        Args:
            normal: looks up, of any length, shape (3,).
            distance: of the plane from Wo along the normal [m].
        """
        self._R_SW = surface_axes(np.asarray(normal, dtype=float))
        self._normal, self._distance = self._R_SW[2], np.array(distance)

    def __call__(self, p_WQ: Array) -> tuple[Array, Array]:
        return p_WQ.dot(self._normal) - self._distance, self._R_SW


@dataclass(frozen=True)
class HeightGround:
    """z = h(x, y), for slopes that change little over the depth of a contact."""

    h: Callable[[Array, Array], Array]
    """Height of the surface [m] over x and y [m], element-wise."""

    def __call__(self, p_WQ: Array) -> tuple[Array, Array]:
        x, y, z = np.moveaxis(p_WQ, -1, 0)
        e = HEIGHT_SPACING
        slope_x = (self.h(x + e, y) - self.h(x - e, y)) / (2.0 * e)
        slope_y = (self.h(x, y + e) - self.h(x, y - e)) / (2.0 * e)
        R_SW = surface_axes(np.stack((-slope_x, -slope_y, np.ones_like(z)), axis=-1))
        return (z - self.h(x, y)) * R_SW[..., 2, 2], R_SW


def surface_axes(normal: Array) -> Array:
    """R_SW of a surface with a normal that looks up: its x lies above the world's; shapes (..., 3), (..., 3, 3)."""
    z = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    x = np.stack((z[..., 2], np.zeros_like(z[..., 0]), -z[..., 0]), axis=-1)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack((x, np.cross(z, x), z), axis=-2)
