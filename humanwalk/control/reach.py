"""Whether the legs of a body can follow a foot path, on level ground and on a terrain."""

import math
from typing import NamedTuple

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from humanwalk.body import contact_spheres
from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.control.inverse_kinematics import (
    InverseKinematicsParameters,
    LegKinematics,
    pose_error,
    solve_inverse_kinematics,
)
from humanwalk.gait.foot_cycle import FootCycle, FootPathParameters, minimum_offset
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES
from humanwalk.terrain import Terrain
from humanwalk.walking.gait_on_ground import GaitOnGround

PHASES = 48
"""Phases of the cycle at which the legs' reach is tried."""

POSES = 12
"""Poses of both soles that are tried in a step on a terrain."""

STEPS_AHEAD = 4
"""Number of steps after the beginning of the last face of a terrain; then all are alike."""

DIGITS = 5
"""Decimals [m, rad] in which poses that are tried differ."""

TOLERANCE = 0.005
TOLERANCE_RAD = 0.02
"""How far the sole may stay off its path [m], and how far it may be rotated from it [rad]."""

STANCE_TOLERANCE_RAD, SWING_TOLERANCE_RAD = 0.06, 0.12
"""How far a sole may be rotated from its path on a terrain [rad]: the ankle of a leg far behind is at its end. The toes
are then 1.3 cm lower in stance, as when a heel begins to rise, and 2.5 cm in swing, less than its margin."""

TOE_TOLERANCE = 1e-4
"""How far below the ground the path may put the toes in swing [m] (our choice). Slow steps of 8 cm whose toes are 1 mm
below it drag the foot, and no step is taken; 1 mm above it all steps are."""


class NearestPose(NamedTuple):
    """The pose of a sole nearest to a desired one.

    Attributes:
        theta: Joint angles [rad], shape (n,).
        off, turned: Distance [m] and rotation [rad] from the desired pose.
        at_end: Joints at the end of their range.
    """

    theta: Array
    off: float
    turned: float
    at_end: tuple[str, ...]

    def is_near(self, turned: float) -> bool:
        """Whether the pose is within the tolerance and a rotation [rad] of the desired one."""
        return self.turned <= turned and self.off <= TOLERANCE

    def difference(self, turned: float) -> str:
        """The difference, the joints and what is allowed, for a message."""
        return (
            f"the sole stays {100 * self.off:.1f} cm and {math.degrees(self.turned):.0f} deg off its path, with "
            f"{', '.join(self.at_end) or 'the knee'} at the end of its range; allowed: {100 * TOLERANCE:.1f} cm and "
            f"{math.degrees(turned):.0f} deg"
        )


def nearest_pose(
    leg: LegKinematics, X_PS: RigidTransform, theta_guess: Array, parameters: InverseKinematicsParameters
) -> NearestPose:
    """Return the pose of the sole that inverse kinematics find; see `solve_inverse_kinematics`."""
    theta = solve_inverse_kinematics(leg, X_PS, theta_guess, parameters).theta
    error = pose_error(leg.X_PS(theta), X_PS)
    ends = zip(leg.joint_names, theta, leg.lower, leg.upper, strict=True)
    at_end = tuple(name for name, angle, low, high in ends if not low < angle < high)
    return NearestPose(theta, float(np.linalg.norm(error[3:])), float(np.linalg.norm(error[:3])), at_end)


def require_reachable(subject: Subject, path: FootPathParameters, parameters: InverseKinematicsParameters) -> None:
    """Raise ParameterError if a subject's legs cannot follow a foot path (erratum E32)."""
    skeleton = subject.skeleton
    least = minimum_offset(path.step_length, skeleton.leg_length)
    if path.offset < least:
        raise ParameterError(
            f"controller.thesis.gait.path.offset: {path.offset:g} is too small for step_length {path.step_length:g}: "
            f"the straight leg ends {skeleton.leg_length:.3f} m from the hip; allowed: from {least:.4f} m on; "
            f"set offset: {np.ceil(1e3 * least) / 1e3 + 0.01:.3f}, or shorten the step"
        )
    plant = kinematics_plant(subject)
    cycle = FootCycle(path)
    below_hips = skeleton.hip_height - path.offset
    legs = [LegKinematics(plant, PELVIS, LEGS[side].sole, LEGS[side].chain) for side in SIDES]
    theta = [0.5 * (leg.lower + leg.upper) for leg in legs]
    toe = max(sphere.center[0] + skeleton.origins[sphere.body][0] for sphere in contact_spheres(skeleton))
    for phase in np.arange(PHASES) / PHASES:
        x, z = cycle.position(float(phase))
        clearance = z - toe * np.sin(cycle.pitch(float(phase))[0])
        if clearance < -TOE_TOLERANCE:
            raise ParameterError(
                f"controller.thesis.gait.path.toe_drop: {path.toe_drop:g} puts the toes {-100 * clearance:.1f} cm "
                f"into the ground at phase {phase:.2f}; allowed with step_height {path.step_height:g}: 0 to about "
                f"{0.8 * path.step_height / toe:.2f} rad; lower it, or lift the foot higher"
            )
        R_PS = RotationMatrix.MakeYRotation(cycle.pitch(float(phase))[0])
        for i, y in enumerate((-skeleton.hip_half_width, skeleton.hip_half_width)):
            X_PS = RigidTransform(R_PS, np.array([x - 0.5 * path.step_length, y, z - below_hips]))
            nearest = nearest_pose(legs[i], X_PS, theta[i], parameters)
            theta[i] = nearest.theta
            if not nearest.is_near(TOLERANCE_RAD):
                raise ParameterError(
                    f"controller.thesis.gait.path: at phase {phase:.2f} of the cycle "
                    f"{nearest.difference(TOLERANCE_RAD)}; change step_height ({path.step_height:g}), "
                    f"toe_drop ({path.toe_drop:g}), step_length ({path.step_length:g}) or offset ({path.offset:g})"
                )


def require_reachable_on(
    terrain: Terrain, subject: Subject, gait: GaitOnGround, parameters: InverseKinematicsParameters
) -> None:
    """Raise ParameterError if a gait has no footholds on its terrain, or a subject's legs cannot follow it there."""
    path, hip_height = gait.parameters, subject.skeleton.hip_height - gait.parameters.offset
    plant = kinematics_plant(subject)
    legs = [LegKinematics(plant, PELVIS, LEGS[side].sole, LEGS[side].chain) for side in SIDES]
    theta = [0.5 * (leg.lower + leg.upper) for leg in legs]
    last = max((face.lower[0] for face in terrain.faces), default=0.0) / path.walked_step + STEPS_AHEAD
    tried = set()
    for step in np.arange(0.0, last, 1.0 / POSES).tolist():
        time = gait.ramp.time_at(step * path.walked_step)
        if math.isinf(time):
            return
        for i, foot in enumerate(gait.target(time)[2:]):
            pose = (i, *np.round((*foot.position, foot.pitch, foot.roll), DIGITS).tolist())
            if pose in tried:
                continue
            tried.add(pose)
            x, y, z = foot.position
            X_PS = RigidTransform(RollPitchYaw(foot.roll, foot.pitch, 0.0), np.array((x, y, z - hip_height)))
            nearest = nearest_pose(legs[i], X_PS, theta[i], parameters)
            theta[i] = nearest.theta
            turned = STANCE_TOLERANCE_RAD if foot.in_stance else SWING_TOLERANCE_RAD
            if not nearest.is_near(turned):
                place = f"in step {int(step) + 1}, at x = {step * path.walked_step:.2f} m"
                raise ParameterError(
                    f"controller.thesis.gait.path: on this terrain, {place}, {nearest.difference(turned)}; "
                    f"change step_length ({path.step_length:g}), step_height ({path.step_height:g}), toe_drop "
                    f"({path.toe_drop:g}) or offset ({path.offset:g}), or choose a terrain that is less steep"
                )
