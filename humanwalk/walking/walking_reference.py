"""What the step planner knows of the body, and what it asks of the whole-body program.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Self

from humanwalk.body import Side
from humanwalk.walking.lipm import GRAVITY
from humanwalk.walking.swing_foot import PlanarMotion


class Phase(Enum):
    """What the walker is at."""

    STAND = 0
    WEIGHT_SHIFT = 1
    DOUBLE_SUPPORT = 2
    SINGLE_SUPPORT = 3


class FootTask(Enum):
    """What a foot is at."""

    FLAT = 0
    HEEL_STRIKE = 1
    HEEL_OFF = 2
    SWING = 3


@dataclass(frozen=True)
class FootState:
    """A foot as it is. Its frame sits at the ankle, parallel to the world when it stands flat and faces +x.

    position, velocity: of the ankle over ground, complex [m, m/s].
    height, height_rate: of the ankle [m, m/s].
    yaw, pitch, pitch_rate: [rad, rad/s], toes down positive.
    force: vertical force from the ground [N].
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
    """What the planner knows of the body: time [s], centre of mass over ground and above it [m, m/s], the feet."""

    time: float
    com: complex
    com_velocity: complex
    com_height: float
    right: FootState
    left: FootState

    def foot(self, side: Side) -> FootState:
        """One foot."""
        return self.right if side == "Right" else self.left


@dataclass(frozen=True)
class FootReference:
    """What a foot should do.

    task: see `FootTask`; it says which of the others count.
    load: largest share of its strength that the foot may press with, 0 to 1.
    position, height: of the ankle over ground and above it, with rates and accelerations (swing).
    yaw, pitch: of the foot; the rates and accelerations are the pitch's.
    toes: extension of the toes and its rate.
    """

    task: FootTask
    load: float
    yaw: float
    position: PlanarMotion = PlanarMotion(0.0)
    height: tuple[float, float, float] = (0.0, 0.0, 0.0)
    pitch: tuple[float, float, float] = (0.0, 0.0, 0.0)
    toes: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class WalkingReference:
    """What the body should do now.

    phase, phase_time: what the walker is at, and for how long [s].
    zmp: zero-moment point [m].
    dcm, dcm_reference: measured and nominal [m], for records.
    com_height: of the center of mass, with rate and acceleration [m, m/s, m/s2].
    ground_height: of the ground under the support [m].
    right, left: the feet.
    pelvis_yaw, chest_yaw: [rad].
    shoulder_flexion, elbow_flexion: angle and rate of right, then left [rad, rad/s].
    foothold: where the swinging foot's ankle is going [m].
    """

    phase: Phase
    phase_time: float
    zmp: complex
    dcm: complex
    dcm_reference: complex
    com_height: tuple[float, float, float]
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
        """One foot."""
        return self.right if side == "Right" else self.left


def other(side: Side) -> Side:
    """The other side."""
    return "Left" if side == "Right" else "Right"


def com_acceleration(com: complex, zmp: complex, com_height: float, vertical_acceleration: float) -> complex:
    """Acceleration of the center of mass over ground that puts the zero-moment point at `zmp` [m/s2].

    Args:
        com, zmp: over the level plane [m].
        com_height: of the center of mass above the zero-moment point [m].
        vertical_acceleration: of the center of mass [m/s2].
    """
    return (GRAVITY + vertical_acceleration) / com_height * (com - zmp)
