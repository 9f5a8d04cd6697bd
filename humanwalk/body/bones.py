"""The second look: rods from joint to joint, the joints with their axes, and the points that touch the ground.

It is made of the skeleton alone, so it shows any body as it is computed with: nothing is drawn by hand.
"""

from collections.abc import Iterator
from dataclasses import replace

from humanwalk.body.anatomy import REFERENCE_STATURE
from humanwalk.body.contact import contact_spheres
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Vector3, Weld
from humanwalk.body.visuals import SIDE_COLORS, Color, Visual, ball, capsule, ellipsoid

BONE: Color = (0.90, 0.87, 0.78)
SKULL: Color = (0.93, 0.91, 0.84)
JOINT: Color = (0.25, 0.25, 0.27)
CONTACT: Color = (0.93, 0.77, 0.15)
AXIS_COLORS: dict[str, Color] = {"x": (0.80, 0.12, 0.12), "y": (0.10, 0.55, 0.20), "z": (0.15, 0.25, 0.75)}
"""Of the axis nearest to the joint's: turning about forward, sideways and up."""

ROD_RADIUS, THIN_RADIUS, JOINT_RADIUS = 0.015, 0.006, 0.021
AXIS_RADIUS, AXIS_LENGTH = 0.005, 0.11
SHORTEST_ROD = 0.005
"""Of the reference human [m]; joints nearer to each other than the last have no rod between them."""

ORIGIN: Vector3 = (0.0, 0.0, 0.0)


def bones(skeleton: Skeleton) -> tuple[Visual, ...]:
    """Rods, joints, axes and contact points of a body, in body frames."""
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
    """A rod to every joint outboard; the last segments of a limb end at their far side."""
    color = next((color for side, color in SIDE_COLORS.items() if segment.name.startswith(side)), BONE)
    connections: list[Joint | Weld] = [*skeleton.joints, *skeleton.welds]
    outboard = [c for c in connections if c.parent == segment.name]
    for connection in outboard:
        if max(map(abs, connection.origin)) > SHORTEST_ROD * scale:
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
    # The toes' joint lies lower than the ball of the others is thick.
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
