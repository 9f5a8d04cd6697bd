"""Contact geometry of the feet: two alternative sets of collision shapes under each foot, and the points of the soles.

The point set is six small spheres per foot, the hydroelastic set three compliant boxes. Both are in the model file,
distinguished by `POINT_SET` and `HYDRO_SET` in their names; a diagram filters out the set that it does not use, or both
if the thesis' contact law acts on the lower faces of the boxes. The lowest points of all shapes are on the sole plane.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Skeleton
from humanwalk.numerics import Array
from humanwalk.sides import SIDES, Side

POINT_SET = "_point_"
"""Part of the name of every collision shape of the point-contact set."""
HYDRO_SET = "_hydro_"
"""Part of the name of every collision shape of the hydroelastic set."""

FRICTION = 0.7
"""Coulomb coefficient of the soles, static and dynamic: that of two soles on each other (thesis 2.5)."""
HYDRO_RESOLUTION = 0.05
"""Mesh resolution hint of the soles [m]; Drake ignores it for boxes."""

SOLE_GRID = (2, 2)
"""Numbers of points along x and y of the lower face of each box, for the asperity law: its corners (our choice). A
finer grid is softer at its rim, and tilts far before the center of pressure reaches it (docs/contact.md)."""

SPHERE_RADIUS = 0.012
"""Radius of the contact spheres of the reference human [m]."""
SOLE_THICKNESS = 0.02
"""Height of the hydroelastic boxes of the reference human [m]."""


@dataclass(frozen=True)
class SolePart:
    """The sole below one body of a foot of the reference human; x is measured from the ankle joint.

    Attributes:
        name: Part of the foot.
        body: Body name without the leg, e.g. `FootToes`.
        x: Rear and front end [m].
        width: Width [m].
        spheres_x: Position of the two contact spheres [m].
        spheres_half_gap: Distance of the spheres from the middle of the foot [m].
    """

    name: str
    body: str
    x: tuple[float, float]
    width: float
    spheres_x: float
    spheres_half_gap: float


SOLE_PARTS = (
    SolePart("heel", "Ankle", (-0.055, 0.06), 0.070, -0.043, 0.028),
    SolePart("ball", "FootMiddle", (0.06, 0.149), 0.095, 0.130, 0.035),
    SolePart("toe", "FootToes", (0.149, 0.211), 0.095, 0.189, 0.035),
)


@dataclass(frozen=True)
class ContactSphere:
    """A point-contact sphere: center in the body frame p_BoS_B [m] and radius [m]."""

    name: str
    body: str
    center: Vector3
    radius: float


@dataclass(frozen=True)
class ContactBox:
    """A compliant box: center in the body frame p_BoS_B [m] and edges along x, y, z [m]."""

    name: str
    body: str
    center: Vector3
    size: Vector3


@dataclass(frozen=True)
class SolePatch:
    """A flat part of one body's sole, represented by contact points.

    Attributes:
        body: Body name.
        p_BoQ_B: Contact points [m], shape (k, 3).
        area: Area of each point [m2], shape (k,).
    """

    body: str
    p_BoQ_B: Array
    area: Array


@dataclass(frozen=True)
class SoleExtent:
    """The rectangle of a flat sole, relative to the ankle above it.

    Attributes:
        back, front: Distances of heel and toe end behind and ahead of the ankle [m].
        half_width: Distance of either side [m].
    """

    back: float
    front: float
    half_width: float


def sole_extent(skeleton: Skeleton) -> SoleExtent:
    """Return the rectangle around a sole with straight toes, of the smaller foot if they differ."""
    sizes = [skeleton.size(f"{side}Leg_Ankle") for side in SIDES]
    length, width = min(size[0] for size in sizes), min(size[1] for size in sizes)
    back, front = -SOLE_PARTS[0].x[0] * length, SOLE_PARTS[-1].x[1] * length
    return SoleExtent(back, front, 0.5 * width * max(part.width for part in SOLE_PARTS))


def contact_spheres(skeleton: Skeleton) -> tuple[ContactSphere, ...]:
    """Return the point set: medial and lateral spheres below heel, ball and toes of both feet."""
    spheres = []
    for side in SIDES:
        length, width, height = skeleton.size(f"{side}Leg_Ankle")
        radius = SPHERE_RADIUS * height
        leftward = 1.0 if side == "Left" else -1.0
        for part in SOLE_PARTS:
            for place, outward in (("medial", -1.0), ("lateral", 1.0)):
                y = leftward * outward * part.spheres_half_gap * width
                body = f"{side}Leg_{part.body}"
                center = _in_body(skeleton, side, body, (part.spheres_x * length, y, radius))
                spheres.append(ContactSphere(f"{side}Leg{POINT_SET}{part.name}_{place}", body, center, radius))
    return tuple(spheres)


def contact_boxes(skeleton: Skeleton) -> tuple[ContactBox, ...]:
    """Return the hydroelastic set: one box below hindfoot, midfoot and toes of both feet."""
    boxes = []
    for side in SIDES:
        length, width, thickness = skeleton.size(f"{side}Leg_Ankle")
        height = SOLE_THICKNESS * thickness
        for part in SOLE_PARTS:
            back, front = part.x[0] * length, part.x[1] * length
            body = f"{side}Leg_{part.body}"
            center = _in_body(skeleton, side, body, ((back + front) / 2, 0.0, height / 2))
            size = (front - back, part.width * width, height)
            boxes.append(ContactBox(f"{side}Leg{HYDRO_SET}{part.name}", body, center, size))
    return tuple(boxes)


def sole_patches(skeleton: Skeleton, side: Side) -> tuple[SolePatch, ...]:
    """Return the polygonal contact surface of a foot (thesis 2.4.2): the lower faces of its boxes."""
    return tuple(
        rectangle_patch(box.body, box.center, box.size, SOLE_GRID)
        for box in contact_boxes(skeleton)
        if box.name.startswith(side)
    )


def rectangle_patch(body: str, center: Vector3, size: Vector3, grid: tuple[int, int]) -> SolePatch:
    """Return the lower face of a box: a grid of points from rim to rim, each with the area around it.

    Args:
        body: Body of the box.
        center: Center of the box in the body frame [m].
        size: Edges along the body's x, y, z [m].
        grid: Numbers of points along x and y, at least 2.
    """
    (x, along), (y, across) = (
        _rim_to_rim(middle, edge, n) for middle, edge, n in zip(center[:2], size[:2], grid, strict=True)
    )
    bottom = center[2] - 0.5 * size[2]
    return SolePatch(body, np.array([(a, b, bottom) for a in x for b in y]), np.outer(along, across).ravel())


def _rim_to_rim(middle: float, edge: float, n: int) -> tuple[Array, Array]:
    """Points along an edge from end to end, and the length around each, which is half at both ends; shape (n,) each."""
    length = np.full(n, edge / (n - 1))
    length[[0, -1]] *= 0.5
    return middle + edge * np.linspace(-0.5, 0.5, n), length


def _in_body(skeleton: Skeleton, side: Side, body: str, p_SoleP: Vector3) -> Vector3:
    """Convert a point relative to the sole below the ankle to the body frame."""
    offset = skeleton.origins[body] - skeleton.origins[f"{side}Leg_Ankle"]
    x, y, z = p_SoleP - offset
    return (float(x), float(y), float(z - skeleton.ankle_height(side)))
