"""Input and output of the step planner: the measured state of the body, and the reference for the whole-body program.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad]. The frame of a foot has its
origin at the ankle, and the axes of W when the foot stands flat and faces +x.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Self

import numpy as np

from humanwalk.body import Side
from humanwalk.contact.ground_force import FootForces
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import GRAVITY
from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.motions import PlanarMotion, ScalarMotion

Vector = Sequence[float]


class Phase(Enum):
    """Phase of the walk."""

    STAND = 0
    WEIGHT_SHIFT = 1
    DOUBLE_SUPPORT = 2
    SINGLE_SUPPORT = 3

    @property
    def is_stepping(self) -> bool:
        """Whether it is double or single support of a step."""
        return self in (Phase.DOUBLE_SUPPORT, Phase.SINGLE_SUPPORT)


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
        forward, normal: Axes of the sole in W, shape (3,) each.
        pressure: Center of pressure in W [m], shape (3,).
    """

    position: complex
    velocity: complex
    height: float
    height_rate: float
    yaw: float
    pitch: float
    pitch_rate: float
    force: float
    forward: Array = field(default_factory=lambda: np.eye(3)[0])
    normal: Array = field(default_factory=lambda: np.eye(3)[2])
    pressure: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def ankle(self) -> Array:
        """The ankle in W [m], shape (3,)."""
        return np.array((self.position.real, self.position.imag, self.height))


@dataclass(frozen=True)
class BodyState:
    """Measured state of the body.

    Attributes:
        com, com_velocity: Center of mass over the level plane, complex [m, m/s].
        com_height: Center of mass in W [m].
        right, left: The feet.
        arm_freedom: Swing of the right and the left arm relative to that of a free arm; less with a load in the hand.
    """

    com: complex
    com_velocity: complex
    com_height: float
    right: FootState
    left: FootState
    arm_freedom: tuple[float, float] = (1.0, 1.0)

    def foot(self, side: Side) -> FootState:
        """The foot of a side."""
        return self.right if side == "Right" else self.left

    def load_share(self, side: Side) -> float:
        """Share of the vertical force on both feet that the foot of a side carries; 0 in the air."""
        load = max(self.foot(side).force, 0.0)
        return load / (max(self.right.force, 0.0) + max(self.left.force, 0.0)) if load > 0.0 else 0.0

    @staticmethod
    def measured(com: Array, ankles: Array, forces: FootForces, ground: Ground) -> "BodyState":
        """Return the measured state.

        Args:
            com: Position [m] and velocity [m/s] of the center of mass in W, shape (6,).
            ankles: See `BodyObserver`, shape (2, 5, 3).
            forces: Ground reactions on the feet.
            ground: What is known of the ground.
        """
        p_W, v_W, forward_W, normal_W, w_W = ankles.swapaxes(0, 1)
        R_SW = ground.axes(p_W[:, :2])
        motions = (p_W, v_W, np.matvec(R_SW, forward_W), np.matvec(R_SW, w_W), forces.f_W[:, 2])
        axes = (forward_W, normal_W, forces.p_WCop)
        x, y, z, vx, vy, _ = com.tolist()
        right, left = map(_foot, *(part.tolist() for part in motions), *axes)
        return BodyState(complex(x, y), complex(vx, vy), z, right, left)


def _foot(
    p: Vector, v: Vector, forward_S: Vector, w_S: Vector, force: float, forward: Array, normal: Array, pressure: Array
) -> FootState:
    """A foot from position and velocity of its ankle in W, x axis and angular velocity in the axes of the ground."""
    yaw = math.atan2(forward_S[1], forward_S[0])
    return FootState(
        position=complex(p[0], p[1]),
        velocity=complex(v[0], v[1]),
        height=p[2],
        height_rate=v[2],
        yaw=yaw,
        pitch=math.asin(clip(-forward_S[2], -1.0, 1.0)),
        pitch_rate=math.cos(yaw) * w_S[1] - math.sin(yaw) * w_S[0],
        force=force,
        forward=forward,
        normal=normal,
        pressure=pressure,
    )


@dataclass(frozen=True)
class FootReference:
    """Reference of a foot.

    Attributes:
        task: Phase of the foot.
        load: Allowed fraction of the largest contact forces, 0 to 1.
        yaw: Yaw of the foot, relative to R_WS [rad].
        R_WS: Axes of the ground under the foot in W, the normal last, shape (3, 3); in swing, of a plane that turns
            from one foothold to the next.
        position: Ankle over the level plane (SWING only).
        height: Ankle in W [m] (SWING only).
        pitch: Pitch of the foot relative to R_WS [rad] (SWING and HEEL_OFF only).
        toes: Extension of the toes and its rate [rad, rad/s].
        heel: Least and largest vertical force under the heel [body weights].
        force: Largest vertical force per load [body weights].
    """

    task: FootTask
    load: float
    yaw: float
    R_WS: Array = field(default_factory=lambda: np.eye(3))
    position: PlanarMotion = PlanarMotion(0.0)
    height: ScalarMotion = ScalarMotion()
    pitch: ScalarMotion = ScalarMotion()
    toes: tuple[float, float] = (0.0, 0.0)
    heel: tuple[float, float] = (0.0, math.inf)
    force: float = math.inf


@dataclass(frozen=True)
class WalkingReference:
    """Reference for one control period.

    Attributes:
        phase, phase_time: Phase of the walk and the time since it began; in single support, since touchdown [s].
        zmp: Zero-moment point [m].
        pivot: Centroidal moment pivot, which determines the acceleration of the center of mass [m].
        dcm, dcm_reference: Measured and nominal divergent component of motion [m].
        com_height: Center of mass in W [m].
        ground_height: Ground under the zero-moment point in W [m].
        right, left: The feet.
        pelvis_yaw, chest_yaw: [rad].
        pelvis_roll: Left side up positive [rad].
        shoulder_flexion: Angle and rate, of the right and of the left shoulder [rad, rad/s].
        head_yaw: Angle and rate of the head relative to the chest [rad, rad/s].
        foothold: Where the ankle of the swinging foot will be [m].
        step_duration: From touchdown to touchdown of the other foot [s].
        stance: The stance foot of the step.
        speed: Commanded forward speed of the step [m/s].
        ground: What is known of the ground.
    """

    phase: Phase
    phase_time: float
    zmp: complex
    pivot: complex
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
    step_duration: float = math.inf
    head_yaw: tuple[float, float] = (0.0, 0.0)
    stance: Side = "Left"
    speed: float = 0.0
    ground: Ground = Plane()
    pelvis_roll: float = 0.0

    def __deepcopy__(self, memo: object) -> Self:
        """Return itself: Drake copies abstract values often, and the reference is immutable."""
        return self

    def foot(self, side: Side) -> FootReference:
        """The foot of a side."""
        return self.right if side == "Right" else self.left

    @property
    def dcm_error(self) -> float:
        """Distance of the divergent component of motion from its nominal place [m]."""
        return abs(self.dcm - self.dcm_reference)

    @property
    def is_stepping(self) -> bool:
        """Whether the walker is in double or single support of a step."""
        return self.phase.is_stepping

    def gait_phase(self, side: Side) -> float:
        """Phase of the gait cycle of a foot: 0 at its touchdown, 1 at the next one; 0 in standing."""
        if not self.is_stepping:
            return 0.0
        half = min(0.5 * self.phase_time / self.step_duration, 0.5)
        return half if side == self.stance else half + 0.5


def com_acceleration(com: complex, pivot: complex, com_height: float, vertical_acceleration: float) -> complex:
    """Horizontal acceleration of the center of mass that puts the centroidal moment pivot at `pivot` [m/s2].

    Args:
        com, pivot: Points of the level plane [m].
        com_height: Height of the center of mass above the pivot [m].
        vertical_acceleration: Acceleration of the center of mass [m/s2].
    """
    return (GRAVITY + vertical_acceleration) / com_height * (com - pivot)
