"""The body at time zero."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from pydrake.math import RigidTransform

from humanwalk.body import contact_spheres
from humanwalk.body.joint_map import ROUNDING, JointMap, pelvis_pose
from humanwalk.body.plant import body_plant, sole_points
from humanwalk.body.subject import Subject
from humanwalk.numerics import Array
from humanwalk.numerics.random_stream import RandomStream
from humanwalk.quantity import ParameterError, near_or_all, quantity, require_in_range
from humanwalk.terrain import Terrain


@dataclass(frozen=True)
class StartParameters:
    """The body at time zero: at rest above the origin, facing +x."""

    joint_angles: dict[str, float] = field(default_factory=dict)
    """Angles [rad] by joint name; every other joint has its desired angle."""

    pelvis_lift: float = quantity(0.0, "m", -0.002, 0.5)
    """Height of the lowest point of the soles above the ground; contact explodes below the allowed range."""

    joint_noise: float = quantity(0.0, "rad", 0.0, 0.2)
    """Standard deviation of a random error of every joint angle, drawn from the seed."""

    rate_noise: float = quantity(0.0, "rad/s", 0.0, 2.0)
    """Standard deviation of a random rate of every joint, drawn from the seed; the pelvis is at rest."""

    gain_noise: float = quantity(0.0, "", 0.0, 0.5)
    """Standard deviation of the logarithm of a random factor on every gain, drawn from the seed: kp and kd of each
    actuator, stiffness and damping of each task of the whole-body program. It lasts for the whole run."""

    def __post_init__(self) -> None:
        """Raise ParameterError for an angle beyond half a turn."""
        for name, angle in self.joint_angles.items():
            require_in_range(f"joint_angles.{name}", angle, "rad", -math.pi, math.pi)


@dataclass(frozen=True)
class StartPosture:
    """What a controller starts from: angles [rad] by joint name, 0 where not named, and the pose of the pelvis.

    X_WP's height is replaced by the one at which the soles touch the ground.
    """

    angles: Mapping[str, float]
    X_WP: RigidTransform = RigidTransform()


def start_slope(terrain: Terrain) -> float:
    """Pitch of a sole that stands at the start, along x [rad]."""
    return math.asin(terrain.axes(np.zeros(2))[0, 2])


def load_lean(subject: Subject) -> float:
    """Forward rotation of the whole body about the ankles against known loads, devices and impairments [rad].

    It puts the center of mass with these above the point where it is without them; 0 without any.
    """
    free, carrying = subject.body, subject.known_skeleton
    return math.atan2(float(free.com[0] - carrying.com[0]), float(carrying.com[2]) - free.ankle_height("Right"))


def start_positions(
    subject: Subject, terrain: Terrain, start: StartParameters, posture: StartPosture, seed: int
) -> Array:
    """Positions q of the plant at time zero, shape (nq,): soles on the ground.

    Raises:
        ParameterError: a start angle names no joint or is beyond its range.
    """
    plant = body_plant(subject)
    context = plant.CreateDefaultContext()
    joints = JointMap.of(plant)
    for name in start.joint_angles:
        if name not in joints.names:
            raise ParameterError(
                f"start.joint_angles.{name}: no such joint; allowed: the {len(joints.names)} joints of the body"
                f"{near_or_all(name, joints.names)}"
            )
    # An impaired joint may not reach the posture of the controller.
    theta = np.clip([posture.angles.get(name, 0.0) for name in joints.names], joints.lower, joints.upper)
    for name, angle in start.joint_angles.items():
        theta[joints.names.index(name)] = angle
    for i in np.flatnonzero((theta < joints.lower - ROUNDING) | (theta > joints.upper + ROUNDING)):
        nearest = np.clip(theta[i], joints.lower[i], joints.upper[i])
        raise ParameterError(
            f"start.joint_angles.{joints.names[i]}: {theta[i]:g} is beyond the joint's range; allowed: "
            f"{joints.lower[i]:.4g} to {joints.upper[i]:.4g} rad; the nearest allowed value is {nearest:.4g}"
        )
    noise = RandomStream.START_ANGLES.of(seed).standard_normal(theta.size)
    theta = np.clip(theta + start.joint_noise * noise, joints.lower, joints.upper)

    q = plant.GetPositions(context)
    q[joints.q] = theta
    pelvis = pelvis_pose(plant)
    q[pelvis] = [*posture.X_WP.rotation().ToQuaternion().wxyz(), *posture.X_WP.translation()]
    plant.SetPositions(context, q)
    soles = sole_points(plant, context, contact_spheres(subject.skeleton))
    clearance = soles[:, 2] - terrain.height(soles[:, :2])
    q[pelvis.stop - 1] += start.pelvis_lift - clearance.min()
    return q


def start_velocities(subject: Subject, start: StartParameters, seed: int) -> Array:
    """Velocities v of the plant at time zero, shape (nv,): 0 but for the noise on the joints' rates."""
    plant = body_plant(subject)
    joints = JointMap.of(plant)
    v = np.zeros(plant.num_velocities())
    v[joints.v] = start.rate_noise * RandomStream.START_RATES.of(seed).standard_normal(joints.v.size)
    return v
