"""The reference human as data: 44 bodies and 42 revolute joints, 70 kg and 1.75 m.

Masses and shapes of legs, arms, pelvis and ribs are the thesis' (Tables 3.1 and 3.2, with errata E2 and E3). Chosen
here is what the thesis leaves open: the 20.28 kg that it does not assign to a body (erratum E29), the joint centers
(E30), the welded body (E17), the order of the axes and the ranges of motion. Legs and arms are defined for the right
side and mirrored.
"""

import math
from collections.abc import Sequence

from humanwalk.body.shapes import Box, Cylinder, Vector3
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Weld

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
OURS = "our estimate"
AAOS_ADDUCTION = f"{AAOS}; adduction 30 is {OURS}"
LUNGE = (
    "AAOS down; up 35 and not AAOS' 20, which is measured unloaded: the thesis' level foot takes 28 degrees in stance, "
    "and the weight-bearing lunge test finds 35 to 45 (Bennell et al. 1998, from memory)"
)

# Sources of torque limits.
LEG_STRENGTH = (
    "rounded human strength, our choice; order of magnitude from memory of the maximum voluntary "
    "torques at hip, knee and ankle in Anderson et al. (2007), J Biomech 40:3105-3113"
)
STRENGTH = "plausible human strength, our choice"

X: Vector3 = (1.0, 0.0, 0.0)
Y: Vector3 = (0.0, 1.0, 0.0)
Z: Vector3 = (0.0, 0.0, 1.0)
MINUS_X: Vector3 = (-1.0, 0.0, 0.0)
MINUS_Y: Vector3 = (0.0, -1.0, 0.0)
HERE: Vector3 = (0.0, 0.0, 0.0)

# A joint by name, motion, axis, origin in the parent [m], range [deg] with source, and torque limit [N m] with source.
JointRow = tuple[str, str, Vector3, Vector3, tuple[float, float, str], tuple[float, str]]

PELVIS = Segment("Pelvis", Box(0.17291, 0.322739, 0.211809), 7.56, (0, 0, 0.036), TABLE_3_1)

CONNECTOR_ACROSS = Cylinder(0.0285715, 0.0503935, "y")
CONNECTOR_ALONG = Cylinder(0.0285715, 0.0503935, "x")

# Hip (flexion, abduction, rotation), knee, ankle (three), mid-foot, toes.
RIGHT_LEG = (
    Segment("RightLeg_HipPart1", CONNECTOR_ACROSS, 0.2, HERE, AS_ANKLE),
    Segment("RightLeg_HipPart2", CONNECTOR_ALONG, 0.2, HERE, AS_ANKLE),
    Segment("RightLeg_Femur_Thigh", Cylinder(0.0721932, 0.474971), 7.84, (0, 0, -0.2121), TABLE_3_2),
    Segment("RightLeg_Tibia", Cylinder(0.0546879, 0.439767), 3.08, (0, 0, -0.219884), TABLE_3_2),
    Segment("RightLeg_Ankle_Part1", CONNECTOR_ACROSS, 0.2, HERE, TABLE_3_2),
    Segment("RightLeg_Ankle_Part2", Cylinder(0.0285717, 0.0503935, "x"), 0.2, HERE, TABLE_3_2),
    Segment("RightLeg_Ankle", Cylinder(0.0479659, 0.12771, "x"), 0.2, (0.009, 0, -0.020034), TABLE_3_2),
    Segment("RightLeg_FootMiddle", Box(0.0889482, 0.095017, 0.0636254), 0.41, (0.044474, 0, -0.003187), TABLE_3_1),
    Segment("RightLeg_FootToes", Box(0.0624232, 0.100962, 0.035185), 0.25, (0.031212, 0, 0), TABLE_3_1),
)
RIGHT_LEG_JOINTS: tuple[JointRow, ...] = (
    ("RightLegFemurMotion", "hip flexion", MINUS_Y, (0, -0.0875, 0), (-30, 120, AAOS), (250, LEG_STRENGTH)),
    ("RightLegFemurSideMotion", "hip abduction", MINUS_X, HERE, (-30, 45, AAOS), (200, LEG_STRENGTH)),
    ("RightLegFemurTwistMotion", "hip internal rotation", Z, HERE, (-45, 45, AAOS), (150, LEG_STRENGTH)),
    ("RightLegTibiaMotion", "knee flexion", Y, (0, 0, -0.4242), (0, 135, AAOS), (250, LEG_STRENGTH)),
    ("RightLegAnkleMotion", "ankle dorsiflexion", MINUS_Y, (0, 0, -0.439767), (-50, 35, LUNGE), (200, LEG_STRENGTH)),
    ("RightLegAnkleRollMotion", "ankle inversion", X, HERE, (-15, 35, AAOS), (120, STRENGTH)),
    ("RightLegAnkleTwistMotion", "toe-in", Z, HERE, (-20, 20, OURS), (80, STRENGTH)),
    ("RightLegFootMiddleMotion", "mid-foot dorsiflexion", MINUS_Y, (0.06, 0, -0.033), (-10, 10, OURS), (120, STRENGTH)),
    ("RightLegFootToesMotion", "toe extension", MINUS_Y, (0.089, 0, -0.017408), (-45, 70, AAOS), (60, STRENGTH)),
)

# Six lumbar and four thoracic levels. The thesis names ten back bodies with one axis each. Here four flex, three bend
# sideways and three turn, so that their sums are the AAOS thoracolumbar ranges 80/25, 35 and 45 degrees.
LUMBAR, THORACIC = Cylinder(0.13, 0.03), Cylinder(0.05, 0.0695)
BACK = (
    Segment("Lumbar_6", LUMBAR, 1.77, (0, 0, 0.015), LEFT_OVER),
    Segment("Lumbar_5", LUMBAR, 1.73, (0, 0, 0.015), LEFT_OVER),
    Segment("Lumbar_4", LUMBAR, 1.70, (0, 0, 0.015), LEFT_OVER),
    Segment("Lumbar_3", LUMBAR, 1.67, (0, 0, 0.015), LEFT_OVER),
    Segment("Lumbar_2", LUMBAR, 1.63, (0, 0, 0.015), LEFT_OVER),
    Segment("Lumbar_1", LUMBAR, 1.60, (0, 0, 0.015), LEFT_OVER),
    Segment("Thoracic_10_12", THORACIC, 0.645, (0, 0, 0.03475), VERT_SHARE),
    Segment("Thoracic_7_9", THORACIC, 0.645, (0, 0, 0.03475), VERT_SHARE),
    Segment("Thoracic_4_6", THORACIC, 0.645, (0, 0, 0.03475), VERT_SHARE),
    Segment("Thoracic_1_3", THORACIC, 0.645, (0, 0, 0.03475), VERT_SHARE),
)
PITCH, ROLL, YAW = (-6.25, 20, AAOS_SHARE), (-35 / 3, 35 / 3, AAOS_SHARE), (-15, 15, AAOS_SHARE)
BACK_JOINTS: tuple[JointRow, ...] = (
    ("Lumbar_6_Motion", "lumbar flexion", Y, (0, 0, 0.100033), PITCH, (200, STRENGTH)),
    ("Lumbar_5_Motion", "lumbar bending to the right", X, (0, 0, 0.03), ROLL, (200, STRENGTH)),
    ("Lumbar_4_Motion", "lumbar flexion", Y, (0, 0, 0.03), PITCH, (200, STRENGTH)),
    ("Lumbar_3_Motion", "lumbar bending to the right", X, (0, 0, 0.03), ROLL, (200, STRENGTH)),
    ("Lumbar_2_Motion", "lumbar flexion", Y, (0, 0, 0.03), PITCH, (200, STRENGTH)),
    ("Lumbar_1_Motion", "lumbar turning to the left", Z, (0, 0, 0.03), YAW, (200, STRENGTH)),
    ("Thoracic_10_12_Motion", "thoracic turning to the left", Z, (0, 0, 0.03), YAW, (150, STRENGTH)),
    ("Thoracic_7_9_Motion", "thoracic flexion", Y, (0, 0, 0.0695), PITCH, (150, STRENGTH)),
    ("Thoracic_4_6_Motion", "thoracic bending to the right", X, (0, 0, 0.0695), ROLL, (150, STRENGTH)),
    ("Thoracic_1_3_Motion", "thoracic turning to the left", Z, (0, 0, 0.0695), YAW, (150, STRENGTH)),
)

RIBS = Segment("Ribs", Cylinder(0.18, 0.30), 10.0, (0, 0, 0.0385), TABLE_3_2)
SHOULDER_GIRDLE = (Segment("Scapula", Box(0.06, 0.34, 0.10), 0.8, (0, 0, -0.0005), LEFT_OVER),)
SHOULDER_GIRDLE_JOINTS: tuple[JointRow, ...] = (
    ("Scapula_Motion", "shoulder girdle turning to the left", Z, HERE, (-15, 15, OURS), (80, STRENGTH)),
)

# Two neck bodies and the head, which turns on the axis with C1.
NECK = (
    Segment("Cervical_5_7", Cylinder(0.055, 0.055), 0.5, (0, 0, 0.0275), LEFT_OVER),
    Segment("Cervical_3_4_Axis", Cylinder(0.055, 0.06), 0.5, (0, 0, 0.03), LEFT_OVER),
    Segment("Head", Cylinder(0.077, 0.2275), 4.2, (0.01, 0, 0.03125), LEFT_OVER),
)
NECK_JOINTS: tuple[JointRow, ...] = (
    ("Cervical_5_7_Motion", "neck flexion", Y, (0, 0, 0.0695), (-45, 45, AAOS), (40, STRENGTH)),
    ("Cervical_3_4_Axis_Motion", "neck bending to the right", X, (0, 0, 0.055), (-45, 45, AAOS), (40, STRENGTH)),
    ("Head_Motion", "head turning to the left", Z, (0, 0, 0.06), (-60, 60, AAOS), (20, STRENGTH)),
)

# Shoulder (flexion, abduction, rotation), elbow and wrist, which has one axis (erratum E20).
RIGHT_ARM = (
    Segment("RightArm_ShoulderPart1", CONNECTOR_ACROSS, 0.2, HERE, AS_ANKLE),
    Segment("RightArm_ShoulderPart2", CONNECTOR_ALONG, 0.2, HERE, AS_ANKLE),
    Segment("RightArm_Humor_Upper_Arm", Cylinder(0.0499598, 0.35071), 2.24, (0, 0, -0.1475), TABLE_3_2),
    Segment("RightArm_UlnaRadius_Forearm", Cylinder(0.0453482, 0.292366), 1.26, (0, 0, -0.1325), TABLE_3_2),
    Segment("RightArm_Hand", Box(0.0788498, 0.040807, 0.096334), 0.4, (0, 0, -0.048167), TABLE_3_1),
)
RIGHT_ARM_JOINTS: tuple[JointRow, ...] = (
    ("RightArmShoulderMotion", "shoulder flexion", MINUS_Y, (0, -0.23, -0.0205), (-60, 180, AAOS), (80, STRENGTH)),
    ("RightArmShoulderSideMotion", "shoulder abduction", MINUS_X, HERE, (-30, 180, AAOS_ADDUCTION), (80, STRENGTH)),
    ("RightArmShoulderTwistMotion", "shoulder internal rotation", Z, HERE, (-90, 70, AAOS), (80, STRENGTH)),
    ("RightArmElbowMotion", "elbow flexion", MINUS_Y, (0, 0, -0.295), (0, 150, AAOS), (60, STRENGTH)),
    ("RightArmWristMotion", "wrist palmar flexion", X, (0, 0, -0.265), (-70, 80, AAOS), (20, STRENGTH)),
)


def human() -> Skeleton:
    """The reference human: an adult man of 70 kg and 1.75 m, standing on z = 0."""
    leg = _chain("Pelvis", RIGHT_LEG, RIGHT_LEG_JOINTS)
    arm = _chain("Scapula", RIGHT_ARM, RIGHT_ARM_JOINTS)
    branches: list[tuple[Segment, Joint | Weld]] = [
        *leg,
        *((segment.mirrored(), joint.mirrored()) for segment, joint in leg),
        *_chain("Pelvis", BACK, BACK_JOINTS),
        (RIBS, Weld("Thoracic_7_9", "Ribs", HERE)),
        *_chain("Thoracic_1_3", SHOULDER_GIRDLE, SHOULDER_GIRDLE_JOINTS),
        *_chain("Thoracic_1_3", NECK, NECK_JOINTS),
        *arm,
        *((segment.mirrored(), joint.mirrored()) for segment, joint in arm),
    ]
    return Skeleton(
        segments=(PELVIS, *(segment for segment, _ in branches)),
        joints=tuple(joint for _, joint in branches if isinstance(joint, Joint)),
        welds=tuple(weld for _, weld in branches if isinstance(weld, Weld)),
        root_height=HIP_HEIGHT,
    )


def _chain(parent: str, segments: Sequence[Segment], joints: Sequence[JointRow]) -> list[tuple[Segment, Joint]]:
    """Segments with their inboard joints, each on the segment before it, the first on `parent`."""
    chain = []
    for segment, (name, motion, axis, origin, (low, high, range_source), effort) in zip(segments, joints, strict=True):
        limits = (math.radians(low), math.radians(high))
        joint = Joint(
            *(name, motion, parent, segment.name, axis, origin, limits, range_source, *effort), ROTOR_INERTIA, DAMPING
        )
        chain.append((segment, joint))
        parent = segment.name
    return chain
