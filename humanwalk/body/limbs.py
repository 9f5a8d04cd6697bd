"""Limbs as data: the joint or body of the model for each anatomical role.

Code outside `humanwalk.body` refers to joints and bodies by these roles.
"""

from dataclasses import dataclass

from humanwalk.body.anatomy import human
from humanwalk.body.shapes import Vector3
from humanwalk.sides import SIDES, Side


@dataclass(frozen=True)
class Leg:
    """One leg: names in the model of its joints, bodies and frames, from the hip outward.

    Attributes:
        side: Right or Left.
        hip_flexion, hip_abduction, hip_rotation, knee, ankle, ankle_inversion, ankle_rotation, midfoot, toes: Joints;
            positive in the direction of `Joint.motion`.
        thigh, shank, hindfoot, forefoot, toe_segment: Bodies.
        sole: Frame on the sole below the ankle, parallel to the hindfoot's.
    """

    side: Side
    hip_flexion: str
    hip_abduction: str
    hip_rotation: str
    knee: str
    ankle: str
    ankle_inversion: str
    ankle_rotation: str
    midfoot: str
    toes: str
    thigh: str
    shank: str
    hindfoot: str
    forefoot: str
    toe_segment: str
    sole: str

    @staticmethod
    def of(side: Side) -> "Leg":
        """Return the leg of a side."""
        joints = (
            *("Femur", "FemurSide", "FemurTwist", "Tibia", "Ankle", "AnkleRoll", "AnkleTwist"),
            *("FootMiddle", "FootToes"),
        )
        bodies = ("Femur_Thigh", "Tibia", "Ankle", "FootMiddle", "FootToes", "Sole")
        return Leg(side, *(f"{side}Leg{joint}Motion" for joint in joints), *(f"{side}Leg_{body}" for body in bodies))

    @property
    def chain(self) -> tuple[str, ...]:
        """The seven joints from hip to ankle, which determine the pose of the sole."""
        return (*self.hip, self.knee, *self.ankle_joints)

    @property
    def touching_bodies(self) -> tuple[str, str, str]:
        """The bodies whose capsules can touch the other leg (`contact.leg_contact`)."""
        return self.thigh, self.shank, self.hindfoot

    @property
    def hip(self) -> tuple[str, str, str]:
        """The three joints of the hip."""
        return (self.hip_flexion, self.hip_abduction, self.hip_rotation)

    @property
    def sagittal(self) -> tuple[str, str, str]:
        """The joints that move the leg forward and backward: hip, knee, ankle."""
        return (self.hip_flexion, self.knee, self.ankle)

    @property
    def ankle_joints(self) -> tuple[str, str, str]:
        """The three joints of the ankle."""
        return (self.ankle, self.ankle_inversion, self.ankle_rotation)

    @property
    def foot_joints(self) -> tuple[str, str, str]:
        """The joints that shape the foot and keep a posture in walking: ankle rotation, midfoot and toes."""
        return (self.ankle_rotation, self.midfoot, self.toes)

    @property
    def foot_bodies(self) -> tuple[str, str, str]:
        """The bodies that touch the ground, from the heel forward."""
        return (self.hindfoot, self.forefoot, self.toe_segment)


@dataclass(frozen=True)
class Arm:
    """One arm: names of its joints, from the shoulder outward; positive in the direction of `Joint.motion`."""

    side: Side
    shoulder_flexion: str
    shoulder_abduction: str
    shoulder_rotation: str
    elbow: str
    wrist: str

    @staticmethod
    def of(side: Side) -> "Arm":
        """Return the arm of a side."""
        joints = ("Shoulder", "ShoulderSide", "ShoulderTwist", "Elbow", "Wrist")
        return Arm(side, *(f"{side}Arm{joint}Motion" for joint in joints))

    @property
    def shoulder(self) -> tuple[str, str, str]:
        """The three joints of the shoulder."""
        return (self.shoulder_flexion, self.shoulder_abduction, self.shoulder_rotation)


LEGS: dict[Side, Leg] = {side: Leg.of(side) for side in SIDES}
ARMS: dict[Side, Arm] = {side: Arm.of(side) for side in SIDES}

PELVIS = "Pelvis"
"""The floating root; its frame is at hip height."""
CHEST = "Ribs"
HEAD = "Head"
HEAD_YAW = "Head_Motion"
"""Joint that turns the head; positive to the left."""


def _trunk_joints(*bodies: str, axis: Vector3 | None = None) -> tuple[str, ...]:
    return tuple(
        joint.name for joint in human().joints if joint.child.startswith(bodies) and axis in (None, joint.axis)
    )


SPINE_PITCH_JOINTS = _trunk_joints("Lumbar", "Thoracic", axis=(0.0, 1.0, 0.0))
"""Lumbar and thoracic joints that flex; positive forward."""
SPINE_ROLL_JOINTS = _trunk_joints("Lumbar", "Thoracic", axis=(1.0, 0.0, 0.0))
"""Lumbar and thoracic joints that bend sideways; positive to the right."""
SPINE_YAW_JOINTS = _trunk_joints("Lumbar", "Thoracic", axis=(0.0, 0.0, 1.0))
"""Lumbar and thoracic joints that turn; positive to the left."""

JOINT_GROUPS: dict[str, tuple[str, ...]] = {
    "hip": tuple(joint for leg in LEGS.values() for joint in leg.hip),
    "knee": tuple(leg.knee for leg in LEGS.values()),
    "ankle": tuple(joint for leg in LEGS.values() for joint in leg.ankle_joints),
    "foot": tuple(joint for leg in LEGS.values() for joint in (leg.midfoot, leg.toes)),
    "spine": _trunk_joints("Lumbar", "Thoracic"),
    "shoulder girdle": _trunk_joints("Scapula"),
    "neck": _trunk_joints("Cervical", HEAD),
    "shoulder": tuple(joint for arm in ARMS.values() for joint in arm.shoulder),
    "elbow": tuple(arm.elbow for arm in ARMS.values()),
    "wrist": tuple(arm.wrist for arm in ARMS.values()),
}
"""Every joint of the body, once, by the part of the body that it moves."""


def group_of(joint: str) -> str:
    """Return the group of `JOINT_GROUPS` that holds a joint; raise KeyError for an unknown joint."""
    return _GROUP_BY_JOINT[joint]


_GROUP_BY_JOINT = {joint: group for group, joints in JOINT_GROUPS.items() for joint in joints}
