"""Recorded joint angles and pelvis path as smooth functions of time."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.trajectories import PiecewisePolynomial

from humanwalk.numerics import Array
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class FollowParameters:
    """A recording whose joint angles are followed instead of the gait's."""

    file: str = ""
    """A .mot, .sto or .csv file with joint angles, beside the scenario's if not elsewhere; none: the gait is walked."""

    mapping: str = ""
    """A YAML file, beside the scenario's as well, that says which column is which joint and in what unit
    (`MotionMapping`); none: by name."""

    kinematic: bool = False
    """Show the recording as it is, without physics: no forces, no torques, no balance."""

    ease_in: float = quantity(0.3, "s", 0.0, 5.0)
    """Time over which the recording gets up to speed, since the body starts at rest."""


@dataclass(frozen=True)
class MotionColumn:
    """Where a joint's angle stands in a recording: scale times column plus offset."""

    column: str = ""
    """Name in the recording."""

    scale: float = quantity(1.0, "", -1e6, 1e6)
    """-1 where the recording counts the other way."""

    offset: float = quantity(0.0, "", -1e6, 1e6)
    """Added after scaling, in the recording's unit."""


@dataclass(frozen=True)
class MotionMapping:
    """What a recording's columns are."""

    angle_unit: Literal["auto", "deg", "rad"] = "auto"
    """auto: as the file says (inDegrees), or as a column's name ends (_deg, _rad)."""

    length_unit: Literal["m", "cm", "mm"] = "m"
    """Of the pelvis' path."""

    columns: dict[str, MotionColumn] = field(default_factory=dict)
    """By joint, or by pelvis_tilt, pelvis_list, pelvis_rotation, pelvis_tx, pelvis_ty, pelvis_tz (OpenSim's axes)."""

    hold: dict[str, float] = field(default_factory=dict)
    """Joints that stay at an angle [rad], recorded or not."""


class PelvisMotion(NamedTuple):
    """Pose of the pelvis in W, and its time derivative."""

    X_WP: RigidTransform
    V_WP: SpatialVelocity


@dataclass(frozen=True)
class RecordedMotion:
    """Piecewise cubic in time, without overshoot between samples; velocities are its derivatives.

    Time starts at 0 with the first sample. It runs slower at first, so that the motion starts at rest; after the last
    sample the motion stands still.

    Attributes:
        time: of the samples [s], increasing from 0, shape (rows,).
        angles: joints [rad], shape (rows, n).
        pelvis_turns: pitch, roll, yaw [rad] about y, then x, then z of the pelvis turned so far, shape (rows, 3).
        pelvis_place: in W [m], shape (rows, 3).
        ease_in: time until full speed [s].
    """

    time: Array
    angles: Array
    pelvis_turns: Array
    pelvis_place: Array
    ease_in: float

    @property
    def duration(self) -> float:
        """Time until the last sample is reached [s]."""
        return float(self.time[-1] + 0.5 * self.ease_in)

    @cached_property
    def _curve(self) -> PiecewisePolynomial:
        breaks = self.time.tolist()
        samples = np.column_stack((self.angles, self.pelvis_turns, self.pelvis_place)).T.tolist()
        if len(breaks) < 3:
            line: PiecewisePolynomial = PiecewisePolynomial.FirstOrderHold(breaks, samples)
            return line
        curve: PiecewisePolynomial = PiecewisePolynomial.CubicShapePreserving(breaks, samples)
        return curve

    @cached_property
    def _slope(self) -> PiecewisePolynomial:
        return self._curve.derivative()

    def _recorded_time(self, time: float) -> tuple[float, float]:
        """Time in the recording at a time, and how fast it runs."""
        if time < self.ease_in:
            u = time / self.ease_in
            recorded, speed = self.ease_in * (u**3 - 0.5 * u**4), 3 * u**2 - 2 * u**3
        else:
            recorded, speed = time - 0.5 * self.ease_in, 1.0
        return (recorded, speed) if recorded < self.time[-1] else (float(self.time[-1]), 0.0)

    def _at(self, time: float) -> tuple[Array, Array]:
        recorded, speed = self._recorded_time(time)
        return self._curve.value(recorded)[:, 0], speed * self._slope.value(recorded)[:, 0]

    def joints(self, time: float) -> tuple[Array, Array]:
        """Angles [rad] and rates [rad/s] at a time [s], shape (n,) each."""
        value, rate = self._at(time)
        return value[:-6], rate[:-6]

    def pelvis(self, time: float) -> PelvisMotion:
        """Where the pelvis should be at a time [s]."""
        value, rate = self._at(time)
        X_WP = RigidTransform(pelvis_rotation(value[-6:-3]), value[-3:])
        pitch, roll = value[-6:-4]
        pitch_rate, roll_rate, yaw_rate = rate[-6:-3]
        R_WA = RotationMatrix.MakeYRotation(pitch)
        R_WB = R_WA.multiply(RotationMatrix.MakeXRotation(roll))
        x, y, z = np.eye(3)
        w_WP = pitch_rate * y + roll_rate * R_WA.matrix() @ x + yaw_rate * R_WB.matrix() @ z
        return PelvisMotion(X_WP, SpatialVelocity(w_WP, rate[-3:]))


def pelvis_rotation(turns: Array) -> RotationMatrix:
    """R_WP from pitch, roll, yaw [rad], shape (3,)."""
    pitch, roll, yaw = turns
    R_WB = RotationMatrix.MakeYRotation(pitch).multiply(RotationMatrix.MakeXRotation(roll))
    R_WP: RotationMatrix = R_WB.multiply(RotationMatrix.MakeZRotation(yaw))
    return R_WP
