"""A body as data: segments, the joints between them, and the tree that they form.

The frame of every segment is at its inboard joint, parallel to the world frame W (x forward, y left, z up) in neutral
standing, where all joint angles are zero and both soles are on z = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from humanwalk.body.flesh import Flesh
from humanwalk.body.shapes import Shape, Vector3
from humanwalk.body.visual import Visual
from humanwalk.body_units import BodyScale, scaled
from humanwalk.numerics import Array
from humanwalk.quantity import require_in_range
from humanwalk.sides import SIDES, Side

REFERENCE_MASS = 70.0
"""Body mass of the reference human [kg] (thesis 3.3.1)."""
REFERENCE_STATURE = 1.75
"""Stature of the reference human [m] (thesis 3.3.1)."""

MASS_RANGE_KG = (12.0, 200.0)
"""From a slight child of six years to what scales and shoes are made for (our choice)."""
STATURE_RANGE_M = (1.0, 2.2)
"""From a short child of six years to the tallest adults but for gigantism (our choice)."""


@dataclass(frozen=True)
class Segment:
    """One rigid body.

    Attributes:
        name: The thesis' name of the body, e.g. `RightLeg_Tibia`.
        shape: Distribution of the mass about its center.
        mass: Mass [kg].
        com: Center of mass in the body frame, p_BoBcm_B [m].
        source: Source of shape and mass.
        proportions: Size along x, y, z of what surrounds the joints (skin, soles, markers), relative to the same
            segment of the reference human of equal stature.
        drawn: What is drawn in every look in addition, for loads and devices.
        hidden: Parts of the look `person` that are not drawn.
    """

    name: str
    shape: Shape
    mass: float
    com: Vector3
    source: str
    proportions: Vector3 = (1.0, 1.0, 1.0)
    drawn: tuple[Visual, ...] = ()
    hidden: tuple[str, ...] = ()

    @property
    def inertia(self) -> Array:
        """Principal moments of inertia about the center of mass, I_BBcm_B [kg m2], shape (3,)."""
        return self.shape.inertia(self.mass)

    def mirrored(self) -> Segment:
        """Return the left counterpart of a right segment, mirrored in the plane y = 0."""
        x, y, z = self.com
        return replace(self, name=_left_name(self.name), com=(x, -y + 0.0, z))

    def scaled(self, length: float, mass: float) -> Segment:
        """Return the segment with its lengths and its mass multiplied by two factors."""
        return replace(self, shape=self.shape.scaled(length), mass=self.mass * mass, com=_times(self.com, length))


@dataclass(frozen=True)
class Joint:
    """One actuated revolute joint.

    Attributes:
        name: The thesis' name of the motion, e.g. `RightLegTibiaMotion`.
        motion: Name of the motion to positive angles, e.g. "knee flexion".
        parent: Name of the segment inboard of the joint.
        child: Name of the segment outboard; its frame's origin lies on the joint axis.
        axis: Unit vector of the axis, in parent and child frame alike.
        origin: Origin of the child frame in the parent frame, p_PC [m].
        range_rad: Lower and upper limit of the angle [rad].
        range_source: Source of the range.
        effort_limit_N_m: Largest actuator torque [N m].
        effort_source: Source of the torque limit.
        rotor_inertia: Reflected inertia of the actuator, gear ratio 1 [kg m2].
        damping: Viscous damping of the joint [N m s/rad].
        stiffness: Of a passive spring [N m/rad].
        rest_angle: Angle at which the spring is relaxed [rad].
    """

    name: str
    motion: str
    parent: str
    child: str
    axis: Vector3
    origin: Vector3
    range_rad: tuple[float, float]
    range_source: str
    effort_limit_N_m: float
    effort_source: str
    rotor_inertia: float
    damping: float
    stiffness: float = 0.0
    rest_angle: float = 0.0

    def mirrored(self) -> Joint:
        """Return the left counterpart of a right joint, positive in the same anatomical direction.

        A rotation axis is a pseudovector: mirrored in y = 0 it keeps y and reverses x and z.
        """
        x, y, z = self.origin
        ax, ay, az = self.axis
        return replace(
            self,
            name=_left_name(self.name),
            parent=_left_name(self.parent),
            child=_left_name(self.child),
            axis=(-ax + 0.0, ay, -az + 0.0),
            origin=(x, -y + 0.0, z),
        )

    def scaled(self, length: float, mass: float) -> Joint:
        """Return the joint of a body with lengths and masses multiplied by two factors.

        Torques are proportional to m L and times to sqrt(L), so that a scaled body uses the same fraction of its torque
        limits at the same Froude number. Angles do not change.
        """
        return replace(
            self,
            origin=_times(self.origin, length),
            effort_limit_N_m=self.effort_limit_N_m * mass * length,
            rotor_inertia=self.rotor_inertia * mass * length**2,
            damping=self.damping * mass * length**1.5,
            stiffness=self.stiffness * mass * length,
        )


@dataclass(frozen=True)
class Weld:
    """A rigid connection of two segments.

    Attributes:
        parent: Name of the inboard segment.
        child: Name of the outboard segment.
        origin: Origin of the child frame in the parent frame, p_PC [m].
    """

    parent: str
    child: str
    origin: Vector3

    @property
    def name(self) -> str:
        """Name of the weld in a model file."""
        return f"{self.child}_Weld"

    def scaled(self, length: float) -> Weld:
        """Return the weld with its lengths multiplied by a factor."""
        return replace(self, origin=_times(self.origin, length))


@dataclass(frozen=True)
class Skeleton:
    """A tree of segments on a free-floating root.

    Attributes:
        segments: The bodies, parents before children; the first is the floating root (`Pelvis`).
        joints: The revolute joints, in the order of their child segments.
        welds: The rigid connections.
        root_height: Height of the root frame in neutral standing [m].
        raised: Height of the soles above the ground in neutral standing, right and left [m]: 0 but for a shorter leg.
        long_hair: Whether the look `person` has long hair.
        flesh: What gives way in contact.
    """

    segments: tuple[Segment, ...]
    joints: tuple[Joint, ...]
    welds: tuple[Weld, ...]
    root_height: float
    raised: tuple[float, float] = (0.0, 0.0)
    long_hair: bool = False
    flesh: Flesh = Flesh()

    def __post_init__(self) -> None:
        """Check that the segments form a tree.

        Raises:
            ValueError: A segment other than the root has no inboard joint, or one whose parent is listed after it.
        """
        seen: set[str] = set()
        for segment in self.segments:
            inboard = self._inboard_by_child.get(segment.name)
            if segment.name in seen or (bool(seen) and (inboard is None or inboard.parent not in seen)):
                raise ValueError(
                    f"segments: '{segment.name}' must come once, after the parent that a joint or "
                    "weld connects it to; reorder the segments or add the joint"
                )
            seen.add(segment.name)

    @cached_property
    def _inboard_by_child(self) -> dict[str, Joint | Weld]:
        inboards: list[Joint | Weld] = [*self.joints, *self.welds]
        return {inboard.child: inboard for inboard in inboards}

    @cached_property
    def _segment_by_name(self) -> dict[str, Segment]:
        return {s.name: s for s in self.segments}

    @cached_property
    def _joint_by_name(self) -> dict[str, Joint]:
        return {j.name: j for j in self.joints}

    def segment(self, name: str) -> Segment:
        """Return a segment by its name; raise KeyError for an unknown name."""
        return self._segment_by_name[name]

    def joint(self, name: str) -> Joint:
        """Return a revolute joint by its name; raise KeyError for an unknown name."""
        return self._joint_by_name[name]

    def inboard(self, segment_name: str) -> Joint | Weld | None:
        """Return the inboard joint or weld of a segment; None for the floating root."""
        return self._inboard_by_child.get(segment_name)

    def tree(self) -> Iterator[tuple[Segment, Joint | Weld | None]]:
        """Yield every segment with its inboard joint or weld, parents first."""
        return ((s, self.inboard(s.name)) for s in self.segments)

    @cached_property
    def origins(self) -> dict[str, Array]:
        """Origin of every body frame in neutral standing, p_WB [m], shape (3,) each."""
        origins: dict[str, Array] = {}
        for segment, inboard in self.tree():
            if inboard is None:
                origins[segment.name] = np.array([0.0, 0.0, self.root_height])
            else:
                origins[segment.name] = origins[inboard.parent] + np.array(inboard.origin)
        return origins

    @property
    def total_mass(self) -> float:
        """Body mass [kg]."""
        return math.fsum(s.mass for s in self.segments)

    @property
    def com(self) -> Array:
        """Center of mass in neutral standing, p_WC [m], shape (3,)."""
        moment = sum((s.mass * (self.origins[s.name] + s.com) for s in self.segments), np.zeros(3))
        return np.asarray(moment / self.total_mass, dtype=np.float64)

    @property
    def stature(self) -> float:
        """Height of the vertex (top of the head's solid) in neutral standing [m]."""
        head = self.segment("Head")
        return float(self.origins["Head"][2] + head.com[2] + head.shape.extent[2] / 2.0)

    @property
    def hip_height(self) -> float:
        """Height of the hip joints in neutral standing [m]."""
        return float(self.origins["RightLeg_Femur_Thigh"][2])

    @property
    def leg_length(self) -> float:
        """Distance from hip to ankle joint along the straight leg, the shorter one if they differ [m]."""
        return min(self.hip_height - float(self.origins[f"{side}Leg_Ankle"][2]) for side in SIDES)

    def ankle_height(self, side: Side) -> float:
        """Height of an ankle joint above the sole [m]."""
        return float(self.origins[f"{side}Leg_Ankle"][2]) - self.raised[SIDES.index(side)]

    def size(self, segment_name: str) -> Vector3:
        """Size along x, y, z of what surrounds a segment, relative to the reference human of 1.75 m."""
        return _times(self.segment(segment_name).proportions, self.stature / REFERENCE_STATURE)

    @property
    def hip_half_width(self) -> float:
        """Distance of each hip joint from the plane of symmetry [m]."""
        return float(self.origins["LeftLeg_Femur_Thigh"][1])

    def scaled(self, mass: float, stature: float) -> Skeleton:
        """Return the skeleton with another body mass [kg] and stature [m].

        All lengths are multiplied by one factor and all masses by another; inertias are then proportional to m L2,
        torque limits to m L (see `Joint.scaled`), and soles sink in by the same share of their length.

        Raises:
            ParameterError: `mass` is outside `MASS_RANGE_KG`, or `stature` outside `STATURE_RANGE_M`.
        """
        require_in_range("mass", mass, "kg", *MASS_RANGE_KG)
        require_in_range("stature", stature, "m", *STATURE_RANGE_M)
        length_factor, mass_factor = stature / self.stature, mass / self.total_mass
        right, left = self.raised
        return replace(
            self,
            segments=tuple(s.scaled(length_factor, mass_factor) for s in self.segments),
            joints=tuple(j.scaled(length_factor, mass_factor) for j in self.joints),
            welds=tuple(w.scaled(length_factor) for w in self.welds),
            root_height=self.root_height * length_factor,
            raised=(right * length_factor, left * length_factor),
            flesh=scaled(self.flesh, BodyScale(length_factor, mass_factor)),
        )


def _left_name(name: str) -> str:
    return name.replace("Right", "Left")


def _times(v: Vector3, factor: float) -> Vector3:
    return (v[0] * factor, v[1] * factor, v[2] * factor)
