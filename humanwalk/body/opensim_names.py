"""OpenSim's names and signs of the joint angles, and its axes.

They are those of the full-body model of Rajagopal et al. (2016); knee flexion is positive (negative in the older
gait2392). Joints absent from that model keep their names. The axes of OpenSim's ground are x forward, y up, z right.
"""

import numpy as np

from humanwalk.body.limbs import SPINE_PITCH_JOINTS, SPINE_ROLL_JOINTS, SPINE_YAW_JOINTS
from humanwalk.numerics import Array
from humanwalk.sides import SIDES

_RIGHT_AND_LEFT = {
    "LegFemurMotion": ("hip_flexion", 1.0),
    "LegFemurSideMotion": ("hip_adduction", -1.0),
    "LegFemurTwistMotion": ("hip_rotation", 1.0),
    "LegTibiaMotion": ("knee_angle", 1.0),
    "LegAnkleMotion": ("ankle_angle", 1.0),
    "LegAnkleRollMotion": ("subtalar_angle", 1.0),
    "LegFootToesMotion": ("mtp_angle", 1.0),
    "ArmShoulderMotion": ("arm_flex", 1.0),
    "ArmShoulderSideMotion": ("arm_add", -1.0),
    "ArmShoulderTwistMotion": ("arm_rot", 1.0),
    "ArmElbowMotion": ("elbow_flex", 1.0),
    "ArmWristMotion": ("wrist_flex", 1.0),
}

COORDINATES: dict[str, tuple[str, float]] = {
    f"{side}{motion}": (f"{coordinate}_{side[0].lower()}", sign)
    for side in SIDES
    for motion, (coordinate, sign) in _RIGHT_AND_LEFT.items()
}
"""OpenSim's coordinate of each joint, and the factor from the joint's angle to it."""

SPINE_COORDINATES: dict[str, tuple[tuple[str, ...], float]] = {
    "lumbar_extension": (SPINE_PITCH_JOINTS, -1.0),
    "lumbar_bending": (SPINE_ROLL_JOINTS, 1.0),
    "lumbar_rotation": (SPINE_YAW_JOINTS, 1.0),
}
"""OpenSim's coordinates of its single back joint: the joints whose angles they sum (exact for one axis at a time), and
the factor."""

PELVIS_ROTATIONS = ("pelvis_tilt", "pelvis_list", "pelvis_rotation")
"""Rotations of the pelvis in OpenSim's ground, about its own z, then x, then y."""
PELVIS_TRANSLATIONS = ("pelvis_tx", "pelvis_ty", "pelvis_tz")
"""Position of the pelvis' origin, midway between the hip joints, in OpenSim's ground."""

R_OW: Array = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From W (x forward, y left, z up) to OpenSim's ground O (x forward, y up, z right)."""
