"""The look `bones`: rods from joint to joint, the joints with their axes, and the contact spheres of the feet.

It is drawn from the skeleton alone, so that it shows the geometry of the computed body.
"""

from collections.abc import Iterator
from dataclasses import replace

from humanwalk.body.contact import contact_spheres
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import REFERENCE_STATURE, Joint, Segment, Skeleton, Weld
from humanwalk.body.visual import SIDE_COLORS, Color, Visual, ball, capsule, ellipsoid

BONE: Color = (0.90, 0.87, 0.78)
SKULL: Color = (0.93, 0.91, 0.84)
JOINT: Color = (0.25, 0.25, 0.27)
CONTACT: Color = (0.93, 0.77, 0.15)
AXIS_COLORS: dict[str, Color] = {"x": (0.80, 0.12, 0.12), "y": (0.10, 0.55, 0.20), "z": (0.15, 0.25, 0.75)}
"""Color of the axis that is closest to the joint's."""

ROD_RADIUS, THIN_RADIUS, JOINT_RADIUS = 0.015, 0.006, 0.021
AXIS_RADIUS, AXIS_LENGTH = 0.005, 0.11
MIN_ROD = 0.005
"""Radii and lengths of the reference human [m]; joints closer than `MIN_ROD` have no rod between them."""

ORIGIN: Vector3 = (0.0, 0.0, 0.0)


def bones(skeleton: Skeleton) -> tuple[Visual, ...]:
    """Return rods, joints, axes and contact spheres of a body, in body frames."""
    scale = skeleton.stature / REFERENCE_STATURE
    return tuple(
        visual
        for segment in skeleton.segments
        for visual in (
            *_rods(skeleton, segment, scale),
            *_joint(skeleton, segment, scale),
            *_contacts(skeleton, segment, scale),
        )
    )


def _rods(skeleton: Skeleton, segment: Segment, scale: float) -> Iterator[Visual]:
    """Yield a rod to every outboard joint, or through the center of mass of the last segment of a limb."""
    color = next((color for side, color in SIDE_COLORS.items() if segment.name.startswith(side)), BONE)
    connections: list[Joint | Weld] = [*skeleton.joints, *skeleton.welds]
    outboard = [c for c in connections if c.parent == segment.name]
    for connection in outboard:
        if max(map(abs, connection.origin)) > MIN_ROD * scale:
            yield capsule(segment.name, f"rod_{connection.child}", ORIGIN, connection.origin, ROD_RADIUS * scale, color)
    if outboard:
        return
    x, y, z = segment.com
    width, depth, height = (0.5 * extent for extent in segment.shape.extent)
    if segment.name == "Head":
        yield capsule(segment.name, "rod", ORIGIN, (x, y, z), ROD_RADIUS * scale, color)
        yield ellipsoid(segment.name, "skull", (x, y, z), (width, depth, height), SKULL)
    else:
        yield capsule(segment.name, "rod", ORIGIN, (2.0 * x, 2.0 * y, 2.0 * z), ROD_RADIUS * scale, color)


def _joint(skeleton: Skeleton, segment: Segment, scale: float) -> Iterator[Visual]:
    joint = skeleton.inboard(segment.name)
    if not isinstance(joint, Joint):
        return
    # The toes' joint is closer to the ground than the radius of the other joints.
    radius = min(JOINT_RADIUS * scale, float(skeleton.origins[segment.name][2]))
    yield ball(segment.name, "joint", ORIGIN, radius, JOINT)
    x, y, z = (0.5 * AXIS_LENGTH * scale * component for component in joint.axis)
    nearest = max("xyz", key=lambda axis: abs(joint.axis["xyz".index(axis)]))
    rod = capsule(segment.name, "axis", (-x, -y, -z), (x, y, z), AXIS_RADIUS * scale, AXIS_COLORS[nearest])
    yield replace(rod, primitive="cylinder")


def _contacts(skeleton: Skeleton, segment: Segment, scale: float) -> Iterator[Visual]:
    for sphere in contact_spheres(skeleton):
        if sphere.body == segment.name:
            yield ball(segment.name, f"{sphere.name}_contact", sphere.center, sphere.radius, CONTACT)
            yield capsule(segment.name, f"{sphere.name}_rod", ORIGIN, sphere.center, THIN_RADIUS * scale, BONE)
