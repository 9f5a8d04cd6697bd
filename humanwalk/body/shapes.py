"""How mass is distributed in a body segment: a box, a circular cylinder, or measured radii of gyration.

They define inertia, not appearance: the densities of the thesis' solids are 0.2 to 1.6 g/cm3 (erratum E7).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from humanwalk.numerics import Array

Axis = Literal["x", "y", "z"]
Vector3 = tuple[float, float, float]


@dataclass(frozen=True)
class Box:
    """Uniform rectangular prism, edges parallel to the body frame.

    Attributes:
        depth: Edge along x [m].
        width: Edge along y [m].
        height: Edge along z [m].
    """

    depth: float
    width: float
    height: float

    @property
    def extent(self) -> Array:
        """Edges of the bounding box along x, y, z [m], shape (3,)."""
        return np.array([self.depth, self.width, self.height])

    def inertia(self, mass: float) -> Array:
        """Return the principal moments about the center [kg m2], shape (3,), for a mass [kg].

        m (a2 + b2) / 12; Eq 3-1 has 1/2, Table 3.1 was calculated with 1/12 (erratum E1).
        """
        squares = self.extent**2
        return mass / 12.0 * (squares.sum() - squares)

    def scaled(self, factor: float) -> "Box":
        """Return the box with every length multiplied by a factor."""
        return Box(self.depth * factor, self.width * factor, self.height * factor)


@dataclass(frozen=True)
class Cylinder:
    """Uniform circular cylinder along one axis of the body frame.

    Attributes:
        radius: Radius [m].
        length: Length along the axis [m].
        axis: Axis of the body frame that the cylinder is parallel to.
    """

    radius: float
    length: float
    axis: Axis = "z"

    @property
    def extent(self) -> Array:
        """Edges of the bounding box along x, y, z [m], shape (3,)."""
        return np.array([self.length if a == self.axis else 2.0 * self.radius for a in "xyz"])

    def inertia(self, mass: float) -> Array:
        """Return the principal moments about the center [kg m2], shape (3,), for a mass [kg].

        Axial m r2 / 2, transverse m (3 r2 + l2) / 12. Eq 3-2 is that of a thin rod; without 3 r2 two bodies of
        Table 3.2 violate the triangle inequality (errata E3, E4).
        """
        axial = mass * self.radius**2 / 2.0
        transverse = mass * (3.0 * self.radius**2 + self.length**2) / 12.0
        return np.array([axial if a == self.axis else transverse for a in "xyz"])

    def scaled(self, factor: float) -> "Cylinder":
        """Return the cylinder with every length multiplied by a factor."""
        return Cylinder(self.radius * factor, self.length * factor, self.axis)


@dataclass(frozen=True)
class Measured:
    """Mass whose principal radii of gyration were measured, parallel to the body frame.

    Attributes:
        size: Edges of the bounding box along x, y, z [m].
        gyration: Radii of gyration about x, y, z through the center of mass [m].
    """

    size: Vector3
    gyration: Vector3

    @property
    def extent(self) -> Array:
        """Edges of the bounding box along x, y, z [m], shape (3,)."""
        return np.array(self.size)

    def inertia(self, mass: float) -> Array:
        """Return the principal moments about the center of mass, m k2 [kg m2], shape (3,), for a mass [kg]."""
        return mass * np.square(self.gyration)

    def scaled(self, factor: float) -> "Measured":
        """Return the distribution with every length multiplied by a factor."""
        x, y, z = self.size
        kx, ky, kz = self.gyration
        return Measured((x * factor, y * factor, z * factor), (kx * factor, ky * factor, kz * factor))


Shape = Box | Cylinder | Measured
