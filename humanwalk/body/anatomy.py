"""The reference human as data: 44 bodies and 42 revolute joints, 70 kg and 1.75 m.

Masses and shapes of legs, arms, pelvis and ribs are the thesis' (Tables 3.1 and 3.2, with errata E2 and E3). Chosen
here is what the thesis leaves open: the 20.28 kg that it does not assign to a body (erratum E29), the joint centers
(E30), the welded body (E17), the order of the axes and the ranges of motion. Legs and arms are defined for the right
side and mirrored.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from humanwalk.body.shapes import Box, Cylinder
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Vector3, Weld

REFERENCE_MASS = 70.0
"""Body mass of the reference human [kg] (thesis 3.3.1)."""
REFERENCE_STATURE = 1.75
"""Stature of the reference human [m] (thesis 3.3.1)."""

ROTOR_INERTIA = 0.01
"""Reflected rotor inertia of every actuator [kg m2] (our choice). Without it explicit torques diverge on the connector
bodies of 0.2 kg, with their own inertia of 1e-4 kg m2."""
DAMPING = 0.1
"""Viscous damping of every joint [N m s/rad]: passive tissue, our choice of a small value."""

HIP_HEIGHT = 0.4242 + 0.439767 + 0.068
"""Thigh + shank + ankle above the sole [m]: .533 of stature (Winter .530). The thesis' 47.5 cm femur is the whole bone,
not the distance between joints (erratum E30)."""

# Sources of masses and shapes.
TABLE_3_1 = "thesis Table 3.1"
TABLE_3_2 = "thesis Table 3.2"
AS_ANKLE = "chosen equal to the ankle parts of thesis Table 3.2; the thesis gives no figure (E29)"
LEFT_OVER = "share of the 20.28 kg that the thesis does not place (E29)"
VERT_SHARE = "a quarter of 'vert' 2.58 kg, read as the four thoracic groups together (E29)"

# Sources of ranges of motion.
AAOS = "AAOS, The Clinical Measurement of Joint Motion"
AAOS_SHARE = "equal share of the AAOS thoracolumbar range"
OUR_ESTIMATE = "our estimate"
LOADED_ANKLE = (
    "AAOS down; up 35 and not AAOS' 20, which is measured unloaded: the thesis' level foot takes 28 degrees in stance, "
    "and the weight-bearing lunge test finds 35 to 45 (Bennell et al. 1998, from memory)"
)

# Sources of torque limits.
LEG_STRENGTH = (
    "rounded human strength, our choice; order of magnitude from memory of the maximum voluntary "
    "torques at hip, knee and ankle in Anderson et al. (2007), J Biomech 40:3105-3113"
)
OUR_STRENGTH = "plausible human strength, our choice"

X: Vector3 = (1.0, 0.0, 0.0)
Y: Vector3 = (0.0, 1.0, 0.0)
Z: Vector3 = (0.0, 0.0, 1.0)
MINUS_X: Vector3 = (-1.0, 0.0, 0.0)
MINUS_Y: Vector3 = (0.0, -1.0, 0.0)
HERE: Vector3 = (0.0, 0.0, 0.0)

Branch = tuple[Segment, Joint | Weld]


class _Range(NamedTuple):
    low_deg: float
    high_deg: float
    source: str


class _Effort(NamedTuple):
    limit_N_m: float
    source: str


def human() -> Skeleton:
    """The reference human: an adult man of 70 kg and 1.75 m, standing on z = 0."""
    pelvis = Segment("Pelvis", Box(0.17291, 0.322739, 0.211809), 7.56, (0, 0, 0.036), TABLE_3_1)
    leg, arm = _right_leg(), _right_arm()
    branches = [*leg, *_mirrored(leg), *_trunk(), *_head_and_neck(), *arm, *_mirrored(arm)]
    return Skeleton(
        segments=(pelvis, *(segment for segment, _ in branches)),
        joints=tuple(joint for _, joint in branches if isinstance(joint, Joint)),
        welds=tuple(weld for _, weld in branches if isinstance(weld, Weld)),
        root_height=HIP_HEIGHT,
    )


def _right_leg() -> list[Branch]:
    """Hip (flexion, abduction, rotation), knee, ankle (three), mid-foot, toes."""
    across = Cylinder(0.0285715, 0.0503935, "y")
    along = Cylinder(0.0285715, 0.0503935, "x")
    ankle_along = Cylinder(0.0285717, 0.0503935, "x")
    hind_foot = Cylinder(0.0479659, 0.12771, "x")
    mid_foot = Box(0.0889482, 0.095017, 0.0636254)
    return [
        _joined(
            Segment("RightLeg_HipPart1", across, 0.2, HERE, AS_ANKLE),
            "RightLegFemurMotion",
            "hip flexion",
            parent="Pelvis",
            axis=MINUS_Y,
            origin=(0, -0.0875, 0),
            range_=_Range(-30, 120, AAOS),
            effort=_Effort(250, LEG_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_HipPart2", along, 0.2, HERE, AS_ANKLE),
            "RightLegFemurSideMotion",
            "hip abduction",
            parent="RightLeg_HipPart1",
            axis=MINUS_X,
            origin=HERE,
            range_=_Range(-30, 45, AAOS),
            effort=_Effort(200, LEG_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_Femur_Thigh", Cylinder(0.0721932, 0.474971), 7.84, (0, 0, -0.2121), TABLE_3_2),
            "RightLegFemurTwistMotion",
            "hip internal rotation",
            parent="RightLeg_HipPart2",
            axis=Z,
            origin=HERE,
            range_=_Range(-45, 45, AAOS),
            effort=_Effort(150, LEG_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_Tibia", Cylinder(0.0546879, 0.439767), 3.08, (0, 0, -0.219884), TABLE_3_2),
            "RightLegTibiaMotion",
            "knee flexion",
            parent="RightLeg_Femur_Thigh",
            axis=Y,
            origin=(0, 0, -0.4242),
            range_=_Range(0, 135, AAOS),
            effort=_Effort(250, LEG_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_Ankle_Part1", across, 0.2, HERE, TABLE_3_2),
            "RightLegAnkleMotion",
            "ankle dorsiflexion",
            parent="RightLeg_Tibia",
            axis=MINUS_Y,
            origin=(0, 0, -0.439767),
            range_=_Range(-50, 35, LOADED_ANKLE),
            effort=_Effort(200, LEG_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_Ankle_Part2", ankle_along, 0.2, HERE, TABLE_3_2),
            "RightLegAnkleRollMotion",
            "ankle inversion",
            parent="RightLeg_Ankle_Part1",
            axis=X,
            origin=HERE,
            range_=_Range(-15, 35, AAOS),
            effort=_Effort(120, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_Ankle", hind_foot, 0.2, (0.009, 0, -0.020034), TABLE_3_2),
            "RightLegAnkleTwistMotion",
            "toe-in",
            parent="RightLeg_Ankle_Part2",
            axis=Z,
            origin=HERE,
            range_=_Range(-20, 20, OUR_ESTIMATE),
            effort=_Effort(80, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_FootMiddle", mid_foot, 0.41, (0.044474, 0, -0.003187), TABLE_3_1),
            "RightLegFootMiddleMotion",
            "mid-foot dorsiflexion",
            parent="RightLeg_Ankle",
            axis=MINUS_Y,
            origin=(0.06, 0, -0.033),
            range_=_Range(-10, 10, OUR_ESTIMATE),
            effort=_Effort(120, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightLeg_FootToes", Box(0.0624232, 0.100962, 0.035185), 0.25, (0.031212, 0, 0), TABLE_3_1),
            "RightLegFootToesMotion",
            "toe extension",
            parent="RightLeg_FootMiddle",
            axis=MINUS_Y,
            origin=(0.089, 0, -0.017408),
            range_=_Range(-45, 70, AAOS),
            effort=_Effort(60, OUR_STRENGTH),
        ),
    ]


def _trunk() -> list[Branch]:
    """Six lumbar and four thoracic levels, ribs and shoulder girdle.

    The thesis names ten back bodies with one axis each. Here four flex, three bend sideways and
    three turn, so that their sums are the AAOS thoracolumbar ranges 80/25, 35 and 45 degrees.
    """
    pitch = ("flexion", Y, _Range(-6.25, 20, AAOS_SHARE))
    roll = ("bending to the right", X, _Range(-35 / 3, 35 / 3, AAOS_SHARE))
    yaw = ("turning to the left", Z, _Range(-15, 15, AAOS_SHARE))

    back: list[Branch] = []
    parent, rise = "Pelvis", 0.100033
    lumbar_masses = (1.77, 1.73, 1.70, 1.67, 1.63, 1.60)
    for level, mass, (what, axis, range_) in zip(
        (6, 5, 4, 3, 2, 1), lumbar_masses, (pitch, roll, pitch, roll, pitch, yaw), strict=True
    ):
        name = f"Lumbar_{level}"
        back.append(
            _joined(
                Segment(name, Cylinder(0.13, 0.03), mass, (0, 0, 0.015), LEFT_OVER),
                f"{name}_Motion",
                f"lumbar {what}",
                parent=parent,
                axis=axis,
                origin=(0, 0, rise),
                range_=range_,
                effort=_Effort(200, OUR_STRENGTH),
            )
        )
        parent, rise = name, 0.03
    for levels, (what, axis, range_) in zip(("10_12", "7_9", "4_6", "1_3"), (yaw, pitch, roll, yaw), strict=True):
        name = f"Thoracic_{levels}"
        back.append(
            _joined(
                Segment(name, Cylinder(0.05, 0.0695), 0.645, (0, 0, 0.03475), VERT_SHARE),
                f"{name}_Motion",
                f"thoracic {what}",
                parent=parent,
                axis=axis,
                origin=(0, 0, rise),
                range_=range_,
                effort=_Effort(150, OUR_STRENGTH),
            )
        )
        parent, rise = name, 0.0695
    ribs = Segment("Ribs", Cylinder(0.18, 0.30), 10.0, (0, 0, 0.0385), TABLE_3_2)
    shoulder_girdle = _joined(
        Segment("Scapula", Box(0.06, 0.34, 0.10), 0.8, (0, 0, -0.0005), LEFT_OVER),
        "Scapula_Motion",
        "shoulder girdle turning to the left",
        parent="Thoracic_1_3",
        axis=Z,
        origin=HERE,
        range_=_Range(-15, 15, OUR_ESTIMATE),
        effort=_Effort(80, OUR_STRENGTH),
    )
    return [*back, (ribs, Weld("Thoracic_7_9", "Ribs", HERE)), shoulder_girdle]


def _head_and_neck() -> list[Branch]:
    """Two neck bodies (flexion, side bending) and the head, which turns on the axis with C1."""
    return [
        _joined(
            Segment("Cervical_5_7", Cylinder(0.055, 0.055), 0.5, (0, 0, 0.0275), LEFT_OVER),
            "Cervical_5_7_Motion",
            "neck flexion",
            parent="Thoracic_1_3",
            axis=Y,
            origin=(0, 0, 0.0695),
            range_=_Range(-45, 45, AAOS),
            effort=_Effort(40, OUR_STRENGTH),
        ),
        _joined(
            Segment("Cervical_3_4_Axis", Cylinder(0.055, 0.06), 0.5, (0, 0, 0.03), LEFT_OVER),
            "Cervical_3_4_Axis_Motion",
            "neck bending to the right",
            parent="Cervical_5_7",
            axis=X,
            origin=(0, 0, 0.055),
            range_=_Range(-45, 45, AAOS),
            effort=_Effort(40, OUR_STRENGTH),
        ),
        _joined(
            Segment("Head", Cylinder(0.077, 0.2275), 4.2, (0.01, 0, 0.03125), LEFT_OVER),
            "Head_Motion",
            "head turning to the left",
            parent="Cervical_3_4_Axis",
            axis=Z,
            origin=(0, 0, 0.06),
            range_=_Range(-60, 60, AAOS),
            effort=_Effort(20, OUR_STRENGTH),
        ),
    ]


def _right_arm() -> list[Branch]:
    """Shoulder (flexion, abduction, rotation), elbow and wrist, which has one axis (erratum E20)."""
    across = Cylinder(0.0285715, 0.0503935, "y")
    along = Cylinder(0.0285715, 0.0503935, "x")
    return [
        _joined(
            Segment("RightArm_ShoulderPart1", across, 0.2, HERE, AS_ANKLE),
            "RightArmShoulderMotion",
            "shoulder flexion",
            parent="Scapula",
            axis=MINUS_Y,
            origin=(0, -0.23, -0.0205),
            range_=_Range(-60, 180, AAOS),
            effort=_Effort(80, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightArm_ShoulderPart2", along, 0.2, HERE, AS_ANKLE),
            "RightArmShoulderSideMotion",
            "shoulder abduction",
            parent="RightArm_ShoulderPart1",
            axis=MINUS_X,
            origin=HERE,
            range_=_Range(-30, 180, f"{AAOS}; adduction 30 is {OUR_ESTIMATE}"),
            effort=_Effort(80, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightArm_Humor_Upper_Arm", Cylinder(0.0499598, 0.35071), 2.24, (0, 0, -0.1475), TABLE_3_2),
            "RightArmShoulderTwistMotion",
            "shoulder internal rotation",
            parent="RightArm_ShoulderPart2",
            axis=Z,
            origin=HERE,
            range_=_Range(-90, 70, AAOS),
            effort=_Effort(80, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightArm_UlnaRadius_Forearm", Cylinder(0.0453482, 0.292366), 1.26, (0, 0, -0.1325), TABLE_3_2),
            "RightArmElbowMotion",
            "elbow flexion",
            parent="RightArm_Humor_Upper_Arm",
            axis=MINUS_Y,
            origin=(0, 0, -0.295),
            range_=_Range(0, 150, AAOS),
            effort=_Effort(60, OUR_STRENGTH),
        ),
        _joined(
            Segment("RightArm_Hand", Box(0.0788498, 0.040807, 0.096334), 0.4, (0, 0, -0.048167), TABLE_3_1),
            "RightArmWristMotion",
            "wrist palmar flexion",
            parent="RightArm_UlnaRadius_Forearm",
            axis=X,
            origin=(0, 0, -0.265),
            range_=_Range(-70, 80, AAOS),
            effort=_Effort(20, OUR_STRENGTH),
        ),
    ]


def _joined(
    segment: Segment,
    name: str,
    motion: str,
    *,
    parent: str,
    axis: Vector3,
    origin: Vector3,
    range_: _Range,
    effort: _Effort,
) -> Branch:
    return segment, Joint(
        name=name,
        motion=motion,
        parent=parent,
        child=segment.name,
        axis=axis,
        origin=origin,
        range_rad=(math.radians(range_.low_deg), math.radians(range_.high_deg)),
        range_source=range_.source,
        effort_limit_N_m=effort.limit_N_m,
        effort_source=effort.source,
        rotor_inertia=ROTOR_INERTIA,
        damping=DAMPING,
    )


def _mirrored(limb: list[Branch]) -> list[Branch]:
    return [(segment.mirrored(), joint.mirrored()) for segment, joint in limb if isinstance(joint, Joint)]
