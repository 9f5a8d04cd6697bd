"""What every terrain is: a surface z = height(x, y) with axes and friction, which adds its solids to a plant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from pydrake.geometry import ProximityProperties
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array

GroundProperties = Callable[[float], ProximityProperties]
"""Contact properties of the ground for a friction coefficient between sole and ground."""


class Terrain(Protocol):
    """A fixed surface in the world W; every point of the level plane has one height.

    Everything that needs the ground takes it from here: plant, start posture, monitor, planner, whole-body program,
    forces of the feet and pictures.
    """

    def height(self, xy: Array) -> Array:
        """Height of the surface [m] over points of the level plane [m]; shape (...) for (..., 2)."""

    def axes(self, xy: Array) -> Array:
        """R_SW of the surface over points of the level plane [m]; shape (..., 3, 3) for (..., 2).

        Its rows are the surface's axes in W: x (above the world's x), y, and the upward normal.
        """

    def friction(self, xy: Array) -> Array:
        """Coulomb coefficient between sole and ground over points of the level plane [m]; shape (...) for (..., 2)."""

    def add_to(self, plant: MultibodyPlant, properties: GroundProperties) -> None:
        """Register the solids that are collided and drawn with a plant that is not finalized."""


def surface_axes(normal: Array) -> Array:
    """R_SW of a surface from its upward normal, of any length; shape (..., 3, 3) for (..., 3)."""
    z = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    x = np.stack((z[..., 2], np.zeros_like(z[..., 0]), -z[..., 0]), axis=-1)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack((x, np.cross(z, x), z), axis=-2)


def height_at(terrain: Terrain, point: complex) -> float:
    """Height [m] of a terrain at a point x + iy of the level plane [m]."""
    return float(terrain.height(np.array((point.real, point.imag))))
