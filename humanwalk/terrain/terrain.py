"""The protocol of all terrains: a surface z = height(x, y) with axes and friction, which adds its solids to a plant."""

from collections.abc import Callable
from typing import Protocol

import numpy as np
from pydrake.geometry import ProximityProperties
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array

GroundProperties = Callable[[float], ProximityProperties]
"""Function that returns the contact properties of the ground for a friction coefficient between sole and ground."""


class Terrain(Protocol):
    """A surface fixed in the world W, with one height above every point xy of the plane z = 0.

    Plant, start posture, monitor, planner, whole-body program, foot forces and pictures take the ground from here.
    """

    def height(self, xy: Array) -> Array:
        """Return the height of the surface [m] at points xy [m]; shape (...) for (..., 2)."""

    def axes(self, xy: Array) -> Array:
        """Return R_SW of the surface at points xy [m]; shape (..., 3, 3) for (..., 2).

        Its rows are the surface's axes in W: x (in the world's xz plane), y, and the upward normal.
        """

    def friction(self, xy: Array) -> Array:
        """Return the Coulomb coefficient between sole and ground at points xy [m]; shape (...) for (..., 2)."""

    def add_to(self, plant: MultibodyPlant, properties: GroundProperties) -> None:
        """Register the geometry for contact and for pictures with a plant that is not finalized."""


def surface_axes(normal: Array) -> Array:
    """Return R_SW of a surface from its upward normal of any length; shape (..., 3, 3) for (..., 3)."""
    z = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    x = np.stack((z[..., 2], np.zeros_like(z[..., 0]), -z[..., 0]), axis=-1)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack((x, np.cross(z, x), z), axis=-2)


def height_at(terrain: Terrain, point: complex) -> float:
    """Return the height [m] of a terrain at a point x + iy [m]."""
    return float(terrain.height(np.array((point.real, point.imag))))
