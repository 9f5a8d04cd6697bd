"""Recorded joint angles and pelvis path as smooth functions of time, and the mapping that names their columns."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from scipy.interpolate import PchipInterpolator

from humanwalk.numerics import Array
from humanwalk.quantity import quantity, require_in_range


@dataclass(frozen=True)
class MotionColumn:
    """Column of a recording that holds a joint angle: angle = scale * column + offset."""

    column: str = ""
    """Name in the recording."""

    scale: float = quantity(1.0, "", -1e6, 1e6)
    """-1 where the recording has the opposite sign."""

    offset: float = quantity(0.0, "", -1e6, 1e6)
    """Added after scaling, in the recording's unit."""


@dataclass(frozen=True)
class MotionMapping:
    """Which column of a recording is which joint, and in which unit."""

    angle_unit: Literal["auto", "deg", "rad"] = "auto"
    """auto: by the file's header (inDegrees) or the column's suffix (_deg, _rad)."""

    length_unit: Literal["m", "cm", "mm"] = "m"
    """Unit of the pelvis path."""

    columns: dict[str, MotionColumn] = field(default_factory=dict)
    """By joint, or by pelvis_tilt, pelvis_list, pelvis_rotation, pelvis_tx, pelvis_ty, pelvis_tz (OpenSim's axes)."""

    hold: dict[str, float] = field(default_factory=dict)
    """Constant angle by joint [rad], whether the joint is recorded or not."""

    def __post_init__(self) -> None:
        """Check the constant angles.

        Raises:
            ParameterError: an angle is not a finite number within half a turn.
        """
        for name, angle in self.hold.items():
            require_in_range(f"hold.{name}", angle, "rad", -math.pi, math.pi)


class PelvisMotion(NamedTuple):
    """Pose of the pelvis in W, and its time derivative."""

    X_WP: RigidTransform
    V_WP: SpatialVelocity


@dataclass(frozen=True)
class RecordedMotion:
    """Shape-preserving cubic through the samples (Fritsch and Carlson 1980), which does not overshoot.

    Time starts at 0 with the first sample. It runs slower at first, so that the motion starts at rest; after the last
    sample the posture is constant.

    Attributes:
        time: Sample times [s], increasing from 0, shape (rows,).
        angles: Joint angles [rad], shape (rows, n).
        pelvis_angles: Pitch, roll, yaw [rad] about y, then x, then z of the rotated pelvis, shape (rows, 3).
        pelvis_position: p_WP [m], shape (rows, 3).
        ease_in: Time until full speed [s].
    """

    time: Array
    angles: Array
    pelvis_angles: Array
    pelvis_position: Array
    ease_in: float

    @cached_property
    def _curve(self) -> PchipInterpolator:
        return PchipInterpolator(self.time, np.hstack((self.angles, self.pelvis_angles, self.pelvis_position)))

    @cached_property
    def _slope(self) -> PchipInterpolator:
        return self._curve.derivative()

    def _recorded_time(self, time: float) -> tuple[float, float]:
        """Time in the recording [s] at a time [s], and its rate."""
        if time < self.ease_in:
            u = time / self.ease_in
            recorded, rate = self.ease_in * (u**3 - 0.5 * u**4), 3 * u**2 - 2 * u**3
        else:
            recorded, rate = time - 0.5 * self.ease_in, 1.0
        return (recorded, rate) if recorded < self.time[-1] else (float(self.time[-1]), 0.0)

    def _at(self, time: float) -> tuple[Array, Array]:
        recorded, rate = self._recorded_time(time)
        return self._curve(recorded), rate * self._slope(recorded)

    def joints(self, time: float) -> tuple[Array, Array]:
        """Angles [rad] and rates [rad/s] at a time [s], shape (n,) each."""
        value, rate = self._at(time)
        return value[:-6], rate[:-6]

    def angles_at(self, recorded: Array) -> Array:
        """Joint angles [rad] at times in the recording [s], shape (times, n)."""
        values: Array = self._curve(recorded)
        return values[:, :-6]

    def pelvis(self, time: float) -> PelvisMotion:
        """Pose and spatial velocity of the pelvis at a time [s]."""
        value, rate = self._at(time)
        X_WP = RigidTransform(pelvis_rotation(value[-6:-3]), value[-3:])
        pitch, roll = value[-6:-4]
        pitch_rate, roll_rate, yaw_rate = rate[-6:-3]
        R_WA = RotationMatrix.MakeYRotation(pitch)
        R_WB = R_WA @ RotationMatrix.MakeXRotation(roll)
        x, y, z = np.eye(3)
        w_WP = pitch_rate * y + roll_rate * (R_WA.matrix() @ x) + yaw_rate * (R_WB.matrix() @ z)
        return PelvisMotion(X_WP, SpatialVelocity(w_WP, rate[-3:]))


def pelvis_rotation(angles: Array) -> RotationMatrix:
    """R_WP from pitch, roll, yaw [rad], shape (3,)."""
    pitch, roll, yaw = angles
    R_WP: RotationMatrix = (
        RotationMatrix.MakeYRotation(pitch) @ RotationMatrix.MakeXRotation(roll) @ RotationMatrix.MakeZRotation(yaw)
    )
    return R_WP
