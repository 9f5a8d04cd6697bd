"""One visible primitive of a body's look, and the functions that make it."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from humanwalk.body.shapes import Vector3
from humanwalk.sides import Side

Color = tuple[float, float, float]
Primitive = Literal["ellipsoid", "capsule", "cylinder", "box"]

SIDE_COLORS: dict[Side, Color] = {"Right": (0.10, 0.42, 0.70), "Left": (0.87, 0.40, 0.10)}
"""Color of shoes, cuffs and stripes; blue and orange are distinct in color blindness."""


@dataclass(frozen=True)
class Visual:
    """One visible primitive.

    Attributes:
        body: Name of the segment.
        part: Part of the look, unique on its body.
        primitive: SDFormat name of the shape.
        size: Ellipsoid: three radii; box: three edges; capsule and cylinder: radius, length
            along z (a capsule's without its caps) [m].
        center: Center in the body frame [m].
        rpy: Roll, pitch, yaw in the body frame [rad].
        color: Red, green, blue, 0 to 1.
    """

    body: str
    part: str
    primitive: Primitive
    size: tuple[float, ...]
    center: Vector3
    rpy: Vector3
    color: Color

    @property
    def name(self) -> str:
        """Name in the model file, unique in the model."""
        return f"{self.body}_{self.part}"

    def mirrored(self) -> "Visual":
        """Return the left counterpart of a right part, in the color of its side."""
        x, y, z = self.center
        roll, pitch, yaw = self.rpy
        return replace(
            self,
            body=self.body.replace("Right", "Left"),
            part=self.part.replace("right", "left"),
            center=(x, -y, z),
            rpy=(-roll, pitch, -yaw),
            color=SIDE_COLORS["Left"] if self.color == SIDE_COLORS["Right"] else self.color,
        )

    def scaled(self, size: Vector3) -> "Visual":
        """Return the part on a segment that is larger along x, y, z by three factors.

        Along an edge or axis of a rotated part the factor is that of a vector in its direction.
        """
        along, across, up = size
        x, y, z = self.center
        if self.rpy == (0, 0, 0) or along == across == up:
            edges = size
        else:
            R_BV = Rotation.from_euler("xyz", self.rpy).as_matrix()
            a, b, c = np.linalg.norm(np.diag(size) @ R_BV, axis=0).tolist()
            edges = (a, b, c)
        factors = (math.sqrt(edges[0] * edges[1]), edges[2]) if self.primitive in ("capsule", "cylinder") else edges
        return replace(
            self,
            size=tuple(edge * factor for edge, factor in zip(self.size, factors, strict=True)),
            center=(x * along, y * across, z * up),
        )


def ellipsoid(body: str, part: str, center: Vector3, radii: Vector3, color: Color, rpy: Vector3 = (0, 0, 0)) -> Visual:
    """Return an ellipsoid by its center and radii."""
    return Visual(body, part, "ellipsoid", radii, center, rpy, color)


def ball(body: str, part: str, center: Vector3, radius: float, color: Color) -> Visual:
    """Return a sphere by its center and radius."""
    return ellipsoid(body, part, center, (radius, radius, radius), color)


def capsule(body: str, part: str, start: Vector3, end: Vector3, radius: float, color: Color) -> Visual:
    """Return a rounded rod by the centers of its two caps."""
    dx, dy, dz = (a - b for a, b in zip(start, end, strict=True))
    length = math.hypot(dx, dy, dz)
    # Pitch and yaw that rotate the z axis to the rod.
    rpy = (0.0, math.atan2(math.hypot(dx, dy), dz), math.atan2(dy, dx))
    center = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, (start[2] + end[2]) / 2)
    return Visual(body, part, "capsule", (radius, length), center, rpy, color)
