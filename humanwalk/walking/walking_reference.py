"""Input and output of the step planner: the measured state of the body, and the reference for the whole-body program.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad]. The frame of a foot has its
origin at the ankle, and the axes of W when the foot stands flat and faces +x.
"""

from dataclasses import dataclass
from enum import Enum
from typing import Self

from humanwalk.body import Side
from humanwalk.quantity import GRAVITY
from humanwalk.walking.motions import PlanarMotion, ScalarMotion


class Phase(Enum):
    """Phase of the walk."""

    STAND = 0
    WEIGHT_SHIFT = 1
    DOUBLE_SUPPORT = 2
    SINGLE_SUPPORT = 3


class FootTask(Enum):
    """Phase of a foot."""

    FLAT = 0
    HEEL_STRIKE = 1
    HEEL_OFF = 2
    SWING = 3


@dataclass(frozen=True)
class FootState:
    """Measured state of a foot.

    Attributes:
        position, velocity: Ankle over the level plane, complex [m, m/s].
        height, height_rate: Ankle in W [m, m/s].
        yaw, pitch, pitch_rate: Orientation of the foot relative to the axes of the terrain [rad, rad/s]; pitch is
            positive with the toes down.
        force: Vertical ground reaction force [N].
    """

    position: complex
    velocity: complex
    height: float
    height_rate: float
    yaw: float
    pitch: float
    pitch_rate: float
    force: float


@dataclass(frozen=True)
class BodyState:
    """Measured state of the body.

    Attributes:
        com, com_velocity: Center of mass over the level plane, complex [m, m/s].
        com_height: Center of mass in W [m].
        right, left: The feet.
    """

    com: complex
    com_velocity: complex
    com_height: float
    right: FootState
    left: FootState

    def foot(self, side: Side) -> FootState:
        """The foot of a side."""
        return self.right if side == "Right" else self.left


@dataclass(frozen=True)
class FootReference:
    """Reference of a foot.

    Attributes:
        task: Phase of the foot.
        load: Allowed fraction of the largest contact forces, 0 to 1.
        yaw: Yaw of the foot, relative to the axes of the terrain [rad].
        position: Ankle over the level plane (SWING only).
        height: Ankle in W [m] (SWING only).
        pitch: Pitch of the foot relative to the terrain [rad] (SWING and HEEL_OFF only).
        toes: Extension of the toes and its rate [rad, rad/s].
    """

    task: FootTask
    load: float
    yaw: float
    position: PlanarMotion = PlanarMotion(0.0)
    height: ScalarMotion = ScalarMotion()
    pitch: ScalarMotion = ScalarMotion()
    toes: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class WalkingReference:
    """Reference for one control period.

    Attributes:
        phase, phase_time: Phase of the walk and the time since it began; in single support, since touchdown [s].
        zmp: Zero-moment point [m].
        dcm, dcm_reference: Measured and nominal divergent component of motion [m], for records.
        com_height: Center of mass in W [m].
        ground_height: Ground under the support in W [m].
        right, left: The feet.
        pelvis_yaw, chest_yaw: [rad].
        shoulder_flexion: Angle and rate, of the right and of the left shoulder [rad, rad/s].
        foothold: Where the ankle of the swinging foot will be [m].
    """

    phase: Phase
    phase_time: float
    zmp: complex
    dcm: complex
    dcm_reference: complex
    com_height: ScalarMotion
    ground_height: float
    right: FootReference
    left: FootReference
    pelvis_yaw: float
    chest_yaw: float
    shoulder_flexion: tuple[tuple[float, float], tuple[float, float]]
    foothold: complex

    def __deepcopy__(self, memo: object) -> Self:
        """Return itself: Drake copies abstract values often, and the reference is immutable."""
        return self

    def foot(self, side: Side) -> FootReference:
        """The foot of a side."""
        return self.right if side == "Right" else self.left


def com_acceleration(com: complex, zmp: complex, com_height: float, vertical_acceleration: float) -> complex:
    """Horizontal acceleration of the center of mass that puts the zero-moment point at `zmp` [m/s2].

    Args:
        com, zmp: Points of the level plane [m].
        com_height: Height of the center of mass above the zero-moment point [m].
        vertical_acceleration: Acceleration of the center of mass [m/s2].
    """
    return (GRAVITY + vertical_acceleration) / com_height * (com - zmp)
