"""The protocols of the ground: a surface z = height(x, y) with axes and friction; a terrain also has solids."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np
from pydrake.geometry import ProximityProperties
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array
from humanwalk.terrain.face import ENDLESS, Face

GroundProperties = Callable[[float], ProximityProperties]
"""Function that returns the contact properties of the ground for a friction coefficient between sole and ground."""

SAMPLE_SPACING = 0.01
"""Distance of the points at which `highest_along` takes the height [m], half the thinnest obstacle."""


class Surface(NamedTuple):
    """The surface nearest to n points.

    Attributes:
        distance: Of the points from the surface along its normal [m], negative inside the ground, shape (n,).
        R_SW: Axes of the surface, its normal last, shape (n, 3, 3).
        friction: Coulomb coefficient between sole and surface, shape (n,).
    """

    distance: Array
    R_SW: Array
    friction: Array


class Touch(NamedTuple):
    """What a foot that should stand on the ground feels.

    Attributes:
        foot: Index of its anchor.
        heel: Middle of the heel's lower end in W [m], shape (3,).
        forward, normal: Axes of the sole in W, shape (3,) each.
        pressure: Center of pressure on the sole in W [m], shape (3,); None without load.
        pressure_ahead: Distance of the center of pressure ahead of the ankle [m].
        planned_ahead: The same of the center of pressure that was planned [m].
        is_rolling: Whether the heel is to be up, so that the sole does not show the slope.
        is_still: Whether the foot does not turn, between landing and heel-off.
    """

    foot: int
    heel: Array
    forward: Array
    normal: Array
    pressure: Array | None
    pressure_ahead: float
    planned_ahead: float
    is_rolling: bool
    is_still: bool


class Ground(Protocol):
    """A surface with one height above every point xy of the plane z = 0, in W.

    Planner and whole-body program take the ground from here; `walking/knowledge.py` has what they know of it.
    """

    def height(self, xy: Array) -> Array:
        """Return the height of the surface [m] at points xy [m]; shape (...) for (..., 2)."""

    def axes(self, xy: Array) -> Array:
        """Return R_SW of the surface at points xy [m]; shape (..., 3, 3) for (..., 2).

        Its rows are the surface's axes in W: x (in the world's xz plane), y, and the upward normal.
        """

    def friction(self, xy: Array) -> Array:
        """Return the Coulomb coefficient between sole and ground at points xy [m]; shape (...) for (..., 2)."""

    def face_at(self, xy: Array) -> Face:
        """Return the face that contains a point xy [m], shape (2,); here the tangent plane, without end."""
        n_x, n_y, n_z = self.axes(xy)[2].tolist()
        gradient = (-n_x / n_z, -n_y / n_z)
        intercept = float(self.height(xy)) - gradient[0] * float(xy[0]) - gradient[1] * float(xy[1])
        end = (ENDLESS, ENDLESS)
        return Face((-ENDLESS, -ENDLESS), end, intercept, gradient, float(self.friction(xy)), (0.86, 0.87, 0.86))

    def faces_near(self, xy: Array, distance: float) -> tuple[Face, ...]:
        """Return the faces that have a point within a distance of xy [m], shape (2,), along x and along y."""
        return (self.face_at(xy),)

    @property
    def unseen(self) -> float:
        """Height by which the true ground may stand out of this one [m]: swinging feet are lifted by so much more."""
        return 0.0

    def felt(self, touches: Sequence[Touch], dt: float) -> "Ground":
        """Return the ground corrected by what the feet feel within `dt` [s]; here itself, for it is exact."""
        return self


class Terrain(Ground, Protocol):
    """A ground fixed in the world, with solids: plant, start posture, monitor, foot forces and pictures have it."""

    def add_to(self, plant: MultibodyPlant, properties: GroundProperties) -> None:
        """Register the geometry for contact and for pictures with a plant that is not finalized."""

    def nearest(self, p_W: Array) -> Surface:
        """Return the surface nearest to points p_W [m], shape (n, 3); here the one below or above, without walls."""
        xy = p_W[:, :2]
        R_SW = self.axes(xy)
        return Surface((p_W[:, 2] - self.height(xy)) * R_SW[:, 2, 2], R_SW, self.friction(xy))

    @property
    def faces(self) -> tuple[Face, ...]:
        """Faces that a map of the ground shows in their colors; none where it is uniform."""
        return ()


def highest_along(ground: Ground, path: Array, half_width: float) -> float:
    """Return the greatest height [m] of the ground under a strip, such as the one that a swinging foot crosses.

    Args:
        ground: The ground.
        path: Points of the middle line of the strip [m], shape (n, 2), n >= 2.
        half_width: Distance of the strip's edges from its middle line [m].
    """
    points = []
    for start, end in pairwise(path):
        length = float(np.hypot(*(end - start)))
        along = (end - start) / max(length, SAMPLE_SPACING)
        s = np.linspace(-half_width, length + half_width, 2 + int((length + 2.0 * half_width) / SAMPLE_SPACING))
        c = np.linspace(-half_width, half_width, 2 + int(2.0 * half_width / SAMPLE_SPACING))
        normal = np.array((-along[1], along[0]))
        points.append((start + s[:, None, None] * along + c[:, None] * normal).reshape(-1, 2))
    return float(ground.height(np.concatenate(points)).max())
