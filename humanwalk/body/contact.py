"""Contact geometry of the feet: six small spheres under each, and the flat sole that the thesis' contact law acts on.

The spheres are in the model file, for Drake's point and hydroelastic contact. Their lowest points and the flat sole are
on the sole plane.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.body.flesh import Flesh
from humanwalk.body.model_text import number
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Skeleton
from humanwalk.numerics import Array
from humanwalk.sides import OUTWARD, SIDES, Side

SOLE_SET = "_sole_"
"""Part of the name of every sphere, and of no other collision shape."""

FRICTION = 0.7
"""Coulomb coefficient of the soles, static and dynamic: that of two soles on each other (thesis 2.5)."""

MESH_EDGE = 0.5
"""Length of the edges of a sphere's hydroelastic mesh, relative to its radius. With 1 the lowest point would be the
corner of a polyhedron, and a sphere would sink 1.6 times as deep; with 0.25 a walk takes 1.6 times as long."""

SOLE_GRID = (2, 2)
"""Numbers of points along x and y of each part of a sole, for the asperity law: its corners (our choice). A finer grid
is softer at its rim, and tilts far before the center of pressure reaches it (docs/contact.md)."""

SPHERE_RADIUS = 0.012
"""Radius of the contact spheres of the reference human [m]."""


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
    """A sphere under a foot: center in the body frame p_BoS_B [m] and radius [m]."""

    name: str
    body: str
    center: Vector3
    radius: float


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
    """Return the medial and lateral spheres below heel, ball and toes of both feet."""
    spheres = []
    for side in SIDES:
        length, width, height = skeleton.size(f"{side}Leg_Ankle")
        radius = SPHERE_RADIUS * height
        for part in SOLE_PARTS:
            for place, outward in (("medial", -1.0), ("lateral", 1.0)):
                y = OUTWARD[side] * outward * part.spheres_half_gap * width
                body = f"{side}Leg_{part.body}"
                center = _in_body(skeleton, side, body, (part.spheres_x * length, y, radius))
                spheres.append(ContactSphere(f"{side}Leg{SOLE_SET}{part.name}_{place}", body, center, radius))
    return tuple(spheres)


def sole_properties(sphere: ContactSphere, flesh: Flesh) -> dict[str, str]:
    """Return the contact properties of a sphere as texts, by their tags in Drake's model files."""
    values = {
        "mu_static": FRICTION,
        "mu_dynamic": FRICTION,
        "hunt_crossley_dissipation": flesh.sole_dissipation,
        "relaxation_time": flesh.sole_relaxation_time,
        "point_contact_stiffness": flesh.sole_stiffness,
        "hydroelastic_modulus": flesh.sole_modulus,
        "mesh_resolution_hint": MESH_EDGE * sphere.radius,
    }
    texts = {f"drake:{name}": number(value) for name, value in values.items()}
    return {**texts, "drake:compliant_hydroelastic": ""}


def sole_patches(skeleton: Skeleton, side: Side) -> tuple[SolePatch, ...]:
    """Return the polygonal contact surface of a foot (thesis 2.4.2): a rectangle for each part of its sole."""
    length, width, _ = skeleton.size(f"{side}Leg_Ankle")
    patches = []
    for part in SOLE_PARTS:
        back, front = part.x[0] * length, part.x[1] * length
        body = f"{side}Leg_{part.body}"
        center = _in_body(skeleton, side, body, ((back + front) / 2, 0.0, 0.0))
        patches.append(rectangle_patch(body, center, (front - back, part.width * width), SOLE_GRID))
    return tuple(patches)


def rectangle_patch(body: str, center: Vector3, size: tuple[float, float], grid: tuple[int, int]) -> SolePatch:
    """Return a rectangle across the body's z: a grid of points from rim to rim, each with the area around it.

    Args:
        body: Body of the sole.
        center: Center of the rectangle in the body frame [m].
        size: Edges along the body's x and y [m].
        grid: Numbers of points along x and y, at least 2.
    """
    (x, along), (y, across) = (
        _rim_to_rim(middle, edge, n) for middle, edge, n in zip(center[:2], size, grid, strict=True)
    )
    return SolePatch(body, np.array([(a, b, center[2]) for a in x for b in y]), np.outer(along, across).ravel())


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
