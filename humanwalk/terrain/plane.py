"""An infinite plane through the world's origin: level ground or a slope."""

import logging
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from pydrake.geometry import Box, HalfSpace
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array
from humanwalk.quantity import quantity
from humanwalk.terrain.face import surface_axes
from humanwalk.terrain.terrain import GroundProperties, Terrain

LENGTH, WIDTH, BEHIND = 60, 10, 6
"""Length and width of the drawn floor, and the part of its length behind the origin [m]; the half-space is infinite."""

THICKNESS = 0.02
"""Thickness of the drawn floor and of its lines [m]."""

FLOOR_COLOR = np.array([0.86, 0.87, 0.86, 1.0])
LINE_COLOR = np.array([0.60, 0.62, 0.63, 1.0])
MARK_COLOR = np.array([0.36, 0.40, 0.43, 1.0])

_Box = tuple[str, tuple[float, float, float], tuple[float, float, float], Array]

LINE_WIDTH, MARK_WIDTH = 0.012, 0.03
"""Widths of the lines at every meter, and of every fifth line across the walk [m]."""


@dataclass(frozen=True)
class Plane(Terrain):
    """A plane through the origin of W, level by default."""

    slope: float = quantity(0.0, "rad", -0.5, 0.5)
    """Inclination along x, positive upward."""

    cross_slope: float = quantity(0.0, "rad", -0.5, 0.5)
    """Inclination along y, positive upward to the left."""

    friction_coefficient: float = quantity(0.7, "", 0.05, 1.3)
    """Coulomb coefficient between sole and ground, static and dynamic (thesis 2.5)."""

    @cached_property
    def _gradient(self) -> Array:
        return np.array((math.tan(self.slope), math.tan(self.cross_slope)))

    @cached_property
    def _R_SW(self) -> Array:
        return surface_axes(np.array((*-self._gradient, 1.0)))

    def height(self, xy: Array) -> Array:
        height: Array = xy @ self._gradient
        return height

    def axes(self, xy: Array) -> Array:
        axes = np.empty((*xy.shape[:-1], 3, 3))
        axes[:] = self._R_SW
        return axes

    def friction(self, xy: Array) -> Array:
        return np.full(xy.shape[:-1], self.friction_coefficient)

    def add_to(self, plant: MultibodyPlant, properties: GroundProperties) -> None:
        """Register an infinite half-space for contact, and a floor with a line at every meter for pictures."""
        X_WS = RigidTransform(RotationMatrix(self._R_SW.T), np.zeros(3))
        plant.RegisterCollisionGeometry(
            plant.world_body(), X_WS, HalfSpace(), "ground", properties(self.friction_coefficient)
        )
        for name, center, size, color in _floor():
            plant.RegisterVisualGeometry(
                plant.world_body(), X_WS @ RigidTransform(np.array(center)), Box(*size), name, color
            )


def _is_wanted(record: logging.LogRecord) -> bool:
    """Whether a message of Drake is not that half-spaces do not touch deformable bodies, of which there are none."""
    return "half spaces are not currently supported for deformable" not in record.getMessage()


# Drake gives the warning when the user's code makes a context.
logging.getLogger("drake").addFilter(_is_wanted)


def _floor() -> list[_Box]:
    """Boxes of the drawn floor in the surface frame: name, center [m], edges [m], color.

    The tops of floor and lines differ in height, because coplanar surfaces are not drawn reliably.
    """
    middle = 0.5 * LENGTH - BEHIND
    boxes: list[_Box] = [("floor", (middle, 0.0, -0.002 - 0.5 * THICKNESS), (LENGTH, WIDTH, THICKNESS), FLOOR_COLOR)]
    for y in range(-WIDTH // 2 + 1, WIDTH // 2):
        size = (LENGTH, LINE_WIDTH, THICKNESS)
        boxes.append((f"along_{y}", (middle, float(y), -0.001 - 0.5 * THICKNESS), size, LINE_COLOR))
    for x in range(1 - BEHIND, LENGTH - BEHIND):
        width, color = (MARK_WIDTH, MARK_COLOR) if x % 5 == 0 else (LINE_WIDTH, LINE_COLOR)
        boxes.append((f"meter_{x}", (float(x), 0.0, -0.5 * THICKNESS), (width, WIDTH, THICKNESS), color))
    return boxes
