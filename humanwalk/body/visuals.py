"""The look `person`: a clothed person made of rounded primitives in the body frames.

The primitives fit the reference human and take the size of each segment; they have neither mass nor contact. Limbs are
defined for the right side and mirrored. Balls at knees and elbows close the gaps of bent limbs. Left is orange and
right is blue (shoes, sleeve cuffs, trouser stripes).
"""

import math
from collections.abc import Iterator

from humanwalk.body.anatomy import human
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.visual import SIDE_COLORS, Color, Visual, ball, capsule, ellipsoid

SKIN: Color = (0.87, 0.68, 0.56)
LIPS: Color = (0.73, 0.45, 0.40)
HAIR: Color = (0.20, 0.13, 0.09)
EYE_WHITE: Color = (0.96, 0.96, 0.95)
IRIS: Color = (0.16, 0.22, 0.28)
SHIRT: Color = (0.70, 0.76, 0.79)
TROUSERS: Color = (0.24, 0.30, 0.41)
BELT: Color = (0.10, 0.08, 0.07)
SOLE: Color = (0.30, 0.31, 0.33)


def visuals(skeleton: Skeleton) -> tuple[Visual, ...]:
    """Return all primitives of a body, in body frames, each with the size of its segment."""
    paired = [*_right_trunk_half(), *_right_face_half(), *_right_leg(), *_right_arm()]
    middle = [*_trunk(), *_head(), *(_long_hair() if skeleton.long_hair else ())]
    parts = (*middle, *paired, *(v.mirrored() for v in paired))
    shown = (v for v in parts if v.part not in skeleton.segment(v.body).hidden)
    return (*(v.scaled(skeleton.size(v.body)) for v in shown), *(v for s in skeleton.segments for v in s.drawn))


CHEST_RADII: Vector3 = (0.116, 0.168, 0.185)
CHEST_CENTER = 0.035
"""Chest of the reference human: half-axes, and height of the middle above the body's joint [m]."""


def _trunk() -> Iterator[Visual]:
    """Pelvis in trousers, belt, abdomen and chest in a shirt."""
    yield ellipsoid("Pelvis", "hips", (-0.005, 0, 0.02), (0.112, 0.166, 0.125), TROUSERS)
    yield ellipsoid("Pelvis", "crotch", (0.0, 0, -0.035), (0.09, 0.085, 0.07), TROUSERS)
    yield ellipsoid("Pelvis", "belt", (-0.002, 0, 0.088), (0.108, 0.153, 0.024), BELT)
    yield ellipsoid("Pelvis", "buckle", (0.104, 0, 0.088), (0.008, 0.02, 0.014), SHIRT)
    # Tall and overlapping, so that the waist is smooth both upright and bent.
    for level in (6, 5, 4, 3, 2, 1):
        radii = (0.106, 0.150 - 0.001 * level, 0.14 if level == 6 else 0.17)
        yield ellipsoid(f"Lumbar_{level}", "waist", (0.0, 0, 0.022), radii, SHIRT)
    yield ellipsoid("Thoracic_10_12", "waist", (0.0, 0, 0.02), (0.110, 0.155, 0.17), SHIRT)
    yield ellipsoid("Ribs", "chest", (0.0, 0, CHEST_CENTER), CHEST_RADII, SHIRT)
    yield ellipsoid("Thoracic_4_6", "chest", (0.0, 0, 0.02), (0.108, 0.168, 0.13), SHIRT)
    yield ellipsoid("Thoracic_1_3", "chest", (-0.005, 0, -0.015), (0.098, 0.16, 0.085), SHIRT)
    yield ellipsoid("Scapula", "yoke", (-0.008, 0, -0.010), (0.078, 0.238, 0.058), SHIRT)
    yield ellipsoid("Thoracic_1_3", "collar", (0.0, 0, 0.062), (0.066, 0.070, 0.022), SHIRT)


def _right_trunk_half() -> Iterator[Visual]:
    yield ellipsoid("Pelvis", "right_buttock", (-0.042, -0.072, -0.018), (0.085, 0.085, 0.095), TROUSERS)
    yield ellipsoid("Thoracic_1_3", "right_slope", (-0.012, -0.095, 0.012), (0.062, 0.150, 0.048), SHIRT, (0.33, 0, 0))
    yield ellipsoid("Scapula", "right_cap", (-0.004, -0.178, -0.014), (0.060, 0.095, 0.056), SHIRT, (0.25, 0, 0))


def _head() -> Iterator[Visual]:
    """Neck, skull, face and hair; the vertex is the highest point of the hair."""
    yield capsule("Cervical_5_7", "neck", (-0.006, 0, -0.03), (0, 0, 0.055), 0.052, SKIN)
    yield capsule("Cervical_3_4_Axis", "neck", (0, 0, 0), (0.004, 0, 0.06), 0.051, SKIN)
    yield ellipsoid("Head", "skull", (0.008, 0, 0.048), (0.090, 0.075, 0.092), SKIN)
    yield ellipsoid("Head", "face", (0.030, 0, 0.020), (0.070, 0.067, 0.105), SKIN)
    yield ellipsoid("Head", "chin", (0.054, 0, -0.060), (0.028, 0.034, 0.026), SKIN)
    yield ellipsoid("Head", "nose", (0.103, 0, 0.005), (0.015, 0.011, 0.013), SKIN)
    yield ellipsoid("Head", "nose_bridge", (0.098, 0, 0.022), (0.009, 0.0075, 0.028), SKIN, (0, -0.25, 0))
    yield ellipsoid("Head", "mouth", (0.0890, 0, -0.032), (0.006, 0.021, 0.0055), LIPS)
    yield ellipsoid("Head", "hair", (-0.012, 0, 0.060), (0.094, 0.081, 0.083), HAIR)
    yield ellipsoid("Head", "hair_top", (0.012, 0, 0.085), (0.085, 0.075, 0.060), HAIR)
    yield ellipsoid("Head", "hair_back", (-0.032, 0, 0.022), (0.066, 0.073, 0.075), HAIR)


def _long_hair() -> Iterator[Visual]:
    """A pony tail."""
    yield ball("Head", "hair_knot", (-0.104, 0, 0.075), 0.032, HAIR)
    yield ellipsoid("Head", "hair_tail", (-0.122, 0, -0.005), (0.028, 0.032, 0.090), HAIR, (0, 0.12, 0))


def _right_face_half() -> Iterator[Visual]:
    yield ball("Head", "right_eye", (0.0815, -0.030, 0.026), 0.0130, EYE_WHITE)
    yield ball("Head", "right_iris", (0.0888, -0.0303, 0.026), 0.0065, IRIS)
    yield ellipsoid("Head", "right_lid", (0.0818, -0.030, 0.0345), (0.0133, 0.0145, 0.0085), SKIN)
    yield ellipsoid("Head", "right_brow", (0.0895, -0.031, 0.046), (0.006, 0.018, 0.0035), HAIR, (0.1, 0, -0.35))
    yield ellipsoid("Head", "right_ear", (0.006, -0.076, 0.008), (0.018, 0.009, 0.030), SKIN, (0, -0.15, 0.3))


def _right_leg() -> Iterator[Visual]:
    """Trouser leg from hip to ankle and a shoe in three parts."""
    reference = human()
    knee = reference.joint("RightLegTibiaMotion").origin
    ankle = reference.joint("RightLegAnkleMotion").origin
    side = SIDE_COLORS["Right"]

    thigh = "RightLeg_Femur_Thigh"
    yield ellipsoid(thigh, "hip", (0.0, 0.004, -0.005), (0.090, 0.084, 0.095), TROUSERS)
    yield from _striped(thigh, "thigh", (0.004, 0.006, -0.14), (0.086, 0.079, 0.22))
    yield from _striped(thigh, "lower_thigh", (0.003, 0.004, -0.28), (0.067, 0.063, 0.195))
    yield ball(thigh, "knee", knee, 0.056, TROUSERS)

    shank = "RightLeg_Tibia"
    yield ellipsoid(shank, "knee", (0.003, 0, -0.01), (0.056, 0.055, 0.075), TROUSERS)
    yield from _striped(shank, "calf", (-0.010, 0, -0.13), (0.060, 0.055, 0.20))
    yield from _striped(shank, "lower_shank", (-0.005, 0, -0.21), (0.052, 0.050, 0.18))
    yield Visual(shank, "hem", "cylinder", (0.043, 0.165), (-0.002, 0, -0.3225), (0, 0, 0), TROUSERS)
    yield capsule(shank, "hem_stripe", (-0.002, -0.0385, -0.26), (-0.002, -0.0385, -0.398), 0.0065, side)
    yield capsule(shank, "ankle", (-0.002, 0, -0.36), ankle, 0.035, SKIN)

    heel, middle, toes = "RightLeg_Ankle", "RightLeg_FootMiddle", "RightLeg_FootToes"
    yield ellipsoid(heel, "shoe", (-0.006, 0, -0.021), (0.047, 0.036, 0.045), side)
    yield ellipsoid(heel, "tongue", (0.026, 0, -0.014), (0.052, 0.035, 0.038), side, (0, 0.5, 0))
    yield ellipsoid(middle, "shoe", (0.012, 0, 0.002), (0.085, 0.041, 0.033), side, (0, 0.17, 0))
    yield ellipsoid(middle, "ball", (0.07, 0, -0.012), (0.048, 0.045, 0.0225), side)
    yield ellipsoid(toes, "shoe", (0.012, 0, 0.0015), (0.0475, 0.0435, 0.0185), side)
    ground = {body: -reference.origins[body][2] for body in (heel, middle, toes)}
    yield from _sole(heel, ground[heel], ((-0.021, 0.034),), ((-0.021, 0.064, 0.066),))
    yield from _sole(middle, ground[middle], ((0.072, 0.045),), ((-0.01, 0.02, 0.068), (0.02, 0.07, 0.084)))
    yield from _sole(toes, ground[toes], ((0.0205, 0.0415),), ((0.0, 0.0205, 0.083),))
    crease = (-ground[toes] - 0.0005, 0.06)
    yield Visual(toes, "crease", "cylinder", crease, (0, 0, 0), (math.pi / 2, 0, 0), SOLE)


def _striped(body: str, part: str, center: Vector3, radii: Vector3) -> Iterator[Visual]:
    """A part of a trouser leg with a stripe on its outer side.

    The stripe is the same ellipsoid, narrowed and moved outward, so that it follows the leg.
    """
    yield ellipsoid(body, part, center, radii, TROUSERS)
    outward = (center[0], center[1] - 0.0025, center[2])
    narrow = (0.030, radii[1], radii[2] - 0.002)
    yield ellipsoid(body, f"{part}_stripe", outward, narrow, SIDE_COLORS["Right"])


def _sole(
    body: str, ground: float, rounds: tuple[tuple[float, float], ...], slabs: tuple[tuple[float, float, float], ...]
) -> Iterator[Visual]:
    """Part of a shoe sole: round ends (x, radius) and slabs (back, front, width) on the ground."""
    thickness = 0.020
    z = ground + thickness / 2
    for i, (x, radius) in enumerate(rounds):
        yield Visual(body, f"sole_end_{i}", "cylinder", (radius, thickness), (x, 0, z), (0, 0, 0), SOLE)
    for i, (back, front, width) in enumerate(slabs):
        size = (front - back, width, thickness)
        yield Visual(body, f"sole_{i}", "box", size, ((back + front) / 2, 0, z), (0, 0, 0), SOLE)


def _right_arm() -> Iterator[Visual]:
    """Short sleeve with a cuff in the color of the side, bare arm, hand with fingers and thumb."""
    reference = human()
    elbow = reference.joint("RightArmElbowMotion").origin
    wrist = reference.joint("RightArmWristMotion").origin
    side = SIDE_COLORS["Right"]

    upper = "RightArm_Humor_Upper_Arm"
    yield ellipsoid(upper, "shoulder", (0, 0.018, -0.014), (0.059, 0.056, 0.062), SHIRT)
    yield ellipsoid(upper, "sleeve", (0, 0.008, -0.07), (0.055, 0.052, 0.125), SHIRT)
    yield Visual(upper, "cuff", "cylinder", (0.0505, 0.02), (0, 0.006, -0.125), (0, 0, 0), side)
    yield ellipsoid(upper, "biceps", (0.004, 0.003, -0.15), (0.046, 0.043, 0.14), SKIN)
    yield capsule(upper, "arm", (0, 0, -0.18), elbow, 0.036, SKIN)
    yield ball(upper, "elbow", elbow, 0.0385, SKIN)

    fore = "RightArm_UlnaRadius_Forearm"
    yield ellipsoid(fore, "forearm", (0.001, 0, -0.075), (0.043, 0.041, 0.13), SKIN)
    yield ellipsoid(fore, "lower_forearm", (0, 0, -0.16), (0.033, 0.030, 0.14), SKIN)
    yield ellipsoid(fore, "wrist", wrist, (0.028, 0.023, 0.03), SKIN)

    hand = "RightArm_Hand"
    yield ellipsoid(hand, "wrist", (0, 0, -0.005), (0.027, 0.022, 0.03), SKIN)
    yield ellipsoid(hand, "palm", (0, 0.001, -0.052), (0.042, 0.018, 0.052), SKIN)
    fingers = (("little", -0.029, 0.046), ("ring", -0.010, 0.062), ("middle", 0.009, 0.067), ("index", 0.028, 0.058))
    for finger, x, length in fingers:
        knuckle = (0.95 * x, 0.002, -0.088)
        bend = (x, 0.008, -0.088 - 0.55 * length)
        tip = (0.95 * x, 0.022, -0.088 - length)
        yield capsule(hand, f"{finger}_root", knuckle, bend, 0.0092, SKIN)
        yield capsule(hand, f"{finger}_tip", bend, tip, 0.0085, SKIN)
    yield capsule(hand, "thumb_root", (0.022, 0.004, -0.022), (0.046, 0.014, -0.058), 0.012, SKIN)
    yield capsule(hand, "thumb_tip", (0.046, 0.014, -0.058), (0.050, 0.020, -0.086), 0.0098, SKIN)
