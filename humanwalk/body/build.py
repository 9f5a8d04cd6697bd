"""The skeleton of a person from the segments that gait laboratories define.

Bodies, joints, ranges of motion and sources are those of the reference human; lengths, masses, centers of mass and
moments of inertia are the person's. Where several bodies form one segment (`REGION_BODIES`), in neutral standing they
have its mass, its center of mass and its moments of inertia together.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from humanwalk.body.anatomy import human
from humanwalk.body.de_leva import Sex
from humanwalk.body.growth import ADULT_AGE
from humanwalk.body.regions import ANKLE_HEIGHT, TRUNK, WIDTHS, Region, Regions, regions
from humanwalk.body.shapes import Measured, Vector3
from humanwalk.body.skeleton import REFERENCE_MASS, REFERENCE_STATURE, Segment, Skeleton
from humanwalk.body_units import BodyScale, scaled
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES, Side

SOURCE = "de Leva 1996, Table 4; children after Jensen 1989; or measured"


SHOULDERS = ("Scapula", "Thoracic_1_3")
"""Bodies whose look reaches to the shoulder joints."""


@dataclass(frozen=True)
class Share:
    """A body's part of the segment that it belongs to.

    Attributes:
        mass: Share of the segment's mass.
        fitted: Whether its center of mass and its inertia are chosen such that those of the segment are met; else they
            are those of the reference human's body, scaled.
    """

    mass: float
    fitted: bool = False


CONNECTOR = Share(0.024)
"""Connector of hip or shoulder, 0.2 of about 8 kg as in the reference human, so that its inertia suits the solver."""

REGION_BODIES: dict[str, dict[str, Share]] = {
    "head": {"Cervical_5_7": Share(0.1), "Cervical_3_4_Axis": Share(0.1), "Head": Share(0.8, fitted=True)},
    "upper_trunk": {
        **{f"Thoracic_{levels}": Share(0.045) for levels in ("10_12", "7_9", "4_6", "1_3")},
        "Scapula": Share(0.056),
        **{f"{side}Arm_ShoulderPart{i}": Share(0.014) for side in SIDES for i in (1, 2)},
        "Ribs": Share(0.708, fitted=True),
    },
    "middle_trunk": {
        f"Lumbar_{level}": Share(parts / 12.0, fitted=True)
        for level, parts in zip((6, 5, 4, 3, 2, 1), (1, 2, 3, 3, 2, 1), strict=True)
    },
    "lower_trunk": {
        **{f"{side}Leg_HipPart{i}": CONNECTOR for side in SIDES for i in (1, 2)},
        "Pelvis": Share(1.0 - 4.0 * CONNECTOR.mass, fitted=True),
    },
}
for _side in SIDES:
    _arm, _leg, _name = f"{_side}Arm_", f"{_side}Leg_", _side.lower()
    REGION_BODIES |= {
        f"{_name}_upper_arm": {f"{_arm}Humor_Upper_Arm": Share(1.0, fitted=True)},
        f"{_name}_forearm": {f"{_arm}UlnaRadius_Forearm": Share(1.0, fitted=True)},
        f"{_name}_hand": {f"{_arm}Hand": Share(1.0, fitted=True)},
        f"{_name}_thigh": {f"{_leg}Femur_Thigh": Share(1.0, fitted=True)},
        f"{_name}_shank": {f"{_leg}Tibia": Share(1.0, fitted=True)},
        f"{_name}_foot": {
            **{f"{_leg}Ankle_Part{i}": Share(0.08) for i in (1, 2)},
            f"{_leg}Ankle": Share(0.34, fitted=True),
            f"{_leg}FootMiddle": Share(0.40, fitted=True),
            f"{_leg}FootToes": Share(0.10, fitted=True),
        },
    }
"""Bodies of every segment and their shares of its mass (our choice where there are several)."""

REFERENCE_LENGTHS = {
    "head": 0.260,
    "trunk": 0.558033,
    "upper_arm": 0.295,
    "forearm": 0.265,
    "hand": 0.1889,
    "thigh": 0.4242,
    "shank": 0.439767,
    "foot": 0.266,
}
"""Lengths of the reference human's segments [m], as `Region.length`; the hand's is that of its look."""

REFERENCE_WIDTHS = {name: share * REFERENCE_STATURE for name, share in WIDTHS.items()}
"""Widths of the reference human's segments [m], as `Region.width`."""

HEEL = 0.055 / REFERENCE_LENGTHS["foot"]
"""Distance of the heel behind the ankle joint, share of the foot's length."""

FIGURE: dict[Sex, dict[str, tuple[float, float]]] = {
    "male": {},
    "female": {
        "Pelvis": (1.02, 1.08),
        "Lumbar_6": (0.96, 0.96),
        **{f"Lumbar_{level}": (0.92, 0.89) for level in (5, 4, 3, 2, 1)},
        "Thoracic_10_12": (0.93, 0.91),
        "Ribs": (0.98, 0.96),
        "Thoracic_4_6": (0.98, 0.97),
        "Thoracic_1_3": (0.95, 0.98),
        "Scapula": (0.92, 0.98),
    },
}
"""Depth and width of the look of a trunk relative to a man's of equal girth (our choice); 1 where not named."""


def person(sex: Sex, segments: Regions) -> Skeleton:
    """Return the skeleton of a person.

    Args:
        sex: For the look.
        segments: Every segment; see `humanwalk.body.regions.region_names`.

    Raises:
        ParameterError: A segment's mass distribution is impossible.
    """
    hips = [hip_height(segments, side) for side in SIDES]
    stature, mass = standing_height(segments), math.fsum(segment.mass for segment in segments.values())
    length_factor, mass_factor = stature / REFERENCE_STATURE, mass / REFERENCE_MASS
    reference = human()
    bones = {body: _bone(region, segments) for region, bodies in REGION_BODIES.items() for body in bodies}
    flesh = {body: _flesh(body, region, sex, segments) for region, bodies in REGION_BODIES.items() for body in bodies}
    shares = {body: (region, share) for region, bodies in REGION_BODIES.items() for body, share in bodies.items()}

    def grown(segment: Segment) -> Segment:
        region, share = shares[segment.name]
        kx, ky, kz = (math.sqrt(moment / segment.mass) * length_factor for moment in segment.inertia)
        along, across, up = flesh[segment.name]
        depth, width, height = segment.shape.extent.tolist()
        return replace(
            segment,
            shape=Measured(_product((depth, width, height), flesh[segment.name]), (kx, ky, kz)),
            mass=share.mass * segments[region].mass,
            com=_product(segment.com, bones[segment.name]),
            source=SOURCE,
            proportions=(along / length_factor, across / length_factor, up / length_factor),
        )

    body = Skeleton(
        segments=tuple(map(grown, reference.segments)),
        joints=tuple(
            replace(joint.scaled(length_factor, mass_factor), origin=_product(joint.origin, bones[joint.parent]))
            for joint in reference.joints
        ),
        welds=tuple(replace(weld, origin=_product(weld.origin, bones[weld.parent])) for weld in reference.welds),
        root_height=max(hips),
        raised=(max(hips) - hips[0], max(hips) - hips[1]),
        long_hair=sex == "female",
        flesh=scaled(reference.flesh, BodyScale(length_factor, mass_factor)),
    )
    fitted: dict[str, Segment] = {}
    for region, center in _centers(body, segments).items():
        fitted |= _fitted(body, region, segments[region], *center)
    body = replace(body, segments=tuple(fitted[segment.name] for segment in body.segments))
    head = body.segment("Head")
    assert isinstance(head.shape, Measured)
    depth, width, _ = head.shape.size
    # The stature of a skeleton is the upper end of the head's extent.
    height = 2.0 * (stature - float(body.origins["Head"][2]) - head.com[2])
    head = replace(head, shape=replace(head.shape, size=(depth, width, height)))
    return replace(body, segments=tuple(head if s.name == "Head" else s for s in body.segments))


def hip_height(segments: Regions, side: Side) -> float:
    """Return the height of a hip joint above its sole in standing [m]."""
    thigh, shank = (segments[f"{side.lower()}_{name}"].length for name in ("thigh", "shank"))
    # The ankle height h is a share a of the stature: h = a (rest + legs + h).
    rest = math.fsum(segments[name].length for name in ("head", *TRUNK))
    legs = max(math.fsum(segments[f"{s.lower()}_{name}"].length for name in ("thigh", "shank")) for s in SIDES)
    return thigh + shank + ANKLE_HEIGHT * (rest + legs) / (1.0 - ANKLE_HEIGHT)


def standing_height(segments: Regions) -> float:
    """Return the stature of a person by the lengths of the segments [m]."""
    above_hips = math.fsum(segments[name].length for name in ("head", *TRUNK))
    return above_hips + max(hip_height(segments, side) for side in SIDES)


def mass_properties(skeleton: Skeleton, bodies: Iterable[str]) -> tuple[float, Array, Array]:
    """Return mass [kg], center of mass p_WC [m] and moments of inertia of some bodies in neutral standing.

    The moments are those about the axes x, y, z through the center [kg m2], shape (3,).
    """
    parts = [skeleton.segment(body) for body in bodies]
    masses = np.array([part.mass for part in parts])
    places = np.array([skeleton.origins[part.name] + part.com for part in parts])
    mass = math.fsum(masses)
    center = masses @ places / mass
    squares = np.square(places - center)
    parallel_axes = masses @ (squares.sum(axis=1, keepdims=True) - squares)
    return mass, center, np.sum([part.inertia for part in parts], axis=0) + parallel_axes


def _fitted(body: Skeleton, name: str, region: Region, axis: int, position: float) -> dict[str, Segment]:
    """Bodies of a region, with center of mass and moments of inertia such that together they have the region's.

    Args:
        body: The skeleton, whose bodies have their masses and places.
        name: Name of the region.
        region: Its measures.
        axis: Axis along which it is long.
        position: Its center of mass on this axis in neutral standing [m].
    """
    shares = REGION_BODIES[name]
    parts = {part: body.segment(part) for part in shares}
    free = math.fsum(share.mass for share in shares.values() if share.fitted)
    _, center, _ = mass_properties(body, shares)
    shift = np.zeros(3)
    shift[axis] = (position - center[axis]) / free
    for part, share in shares.items():
        if share.fitted:
            x, y, z = (np.array(parts[part].com) + shift).tolist()
            parts[part] = replace(parts[part], com=(x, y, z))
    moved = replace(body, segments=tuple(parts.get(segment.name, segment) for segment in body.segments))
    _, _, together = mass_properties(moved, shares)
    own = sum((parts[part].inertia for part, share in shares.items() if share.fitted), np.zeros(3))
    rest = region.mass * np.square(region.gyration) - (together - own)
    if min(rest) <= 0.0 or max(rest) >= rest.sum() - max(rest):
        raise ParameterError(
            f"{name}: {region.mass:.3g} kg cannot have the moments of inertia of a length of {region.length:.3g} m and "
            f"a width of {region.width:.3g} m; allowed: each more than 0 and less than the sum of the others; correct "
            "its length, width or mass"
        )
    kx, ky, kz = np.sqrt(rest / (free * region.mass)).tolist()
    for part, share in shares.items():
        shape = parts[part].shape
        if share.fitted and isinstance(shape, Measured):
            parts[part] = replace(parts[part], shape=replace(shape, gyration=(kx, ky, kz)))
    return parts


def _centers(body: Skeleton, segments: Regions) -> dict[str, tuple[int, float]]:
    """By region the axis along which it is long, and its center of mass on that axis in neutral standing [m]."""
    centers, top = {}, body.root_height
    for name in (*reversed(TRUNK), "head"):
        top += segments[name].length
        centers[name] = (2, top - segments[name].com)
    for name, bodies in REGION_BODIES.items():
        if name not in centers:
            x, _, z = body.origins[next(iter(bodies))].tolist()
            region = segments[name]
            foot = name.endswith("foot")
            centers[name] = (0, x + region.com - HEEL * region.length) if foot else (2, z - region.com)
    return centers


def _bone(name: str, segments: Regions) -> Vector3:
    """Lengths along x, y, z of a region's bodies relative to the reference human's."""
    region = segments[name]
    if name in TRUNK:
        up = math.fsum(segments[part].length for part in TRUNK) / REFERENCE_LENGTHS["trunk"]
        return (up, region.width / REFERENCE_WIDTHS[name], up)
    limb = name.partition("_")[2] or name
    up = region.length / REFERENCE_LENGTHS[limb]
    if limb != "foot":
        return (up, up, up)
    return (up, region.width / REFERENCE_WIDTHS[limb], standing_height(segments) / REFERENCE_STATURE)


def _flesh(body: str, name: str, sex: Sex, segments: Regions) -> Vector3:
    """Size along x, y, z of what surrounds a body relative to the reference human's."""
    along, across, up = _bone(name, segments)
    if name in TRUNK:
        mass, length, usual_mass, usual_length = (
            math.fsum(getattr(region[part], quantity) for part in TRUNK)
            for region in (segments, _average_man())
            for quantity in ("mass", "length")
        )
        girth = math.sqrt(mass / usual_mass * usual_length / length)
        depth, width = FIGURE[sex].get(body, (1.0, 1.0))
        # Shoulders end at their joints, however heavy the person is.
        return (depth * girth, width * (across if body in SHOULDERS else girth), up)
    if name.endswith("foot"):
        return (along, across, up)
    girth = segments[name].width / _average_man()[name].width
    return (girth, girth, up)


def _product(v: Vector3, factors: Vector3) -> Vector3:
    return (v[0] * factors[0], v[1] * factors[1], v[2] * factors[2])


@cache
def _average_man() -> Regions:
    """The man that the look fits: the mass and stature of the reference human, de Leva's proportions."""
    return regions("male", ADULT_AGE, REFERENCE_MASS, REFERENCE_STATURE)
