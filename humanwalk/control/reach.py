"""Whether the legs of a body can follow a foot path."""

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix

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
from humanwalk.quantity import ParameterError

PHASES = 48
"""Phases of the cycle at which the legs' reach is tried."""

TOLERANCE = 0.005
TOLERANCE_RAD = 0.02
"""How far the sole may stay off its path [m], and how far it may be rotated from it [rad]."""

TOE_TOLERANCE = 0.003
"""How far below the ground the path may put the toes in swing [m]: what the toe joint yields to."""


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
    leg = LegKinematics(plant, PELVIS, LEGS["Right"].sole, LEGS["Right"].chain)
    theta = 0.5 * (leg.lower + leg.upper)
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
        X_PS = RigidTransform(
            RotationMatrix.MakeYRotation(cycle.pitch(float(phase))[0]),
            np.array([x - 0.5 * path.step_length, -skeleton.hip_half_width, z - below_hips]),
        )
        solution = solve_inverse_kinematics(leg, X_PS, theta, parameters)
        theta = solution.theta
        error = pose_error(leg.X_PS(theta), X_PS)
        turned, off = np.linalg.norm(error[:3]), np.linalg.norm(error[3:])
        if turned > TOLERANCE_RAD or off > TOLERANCE:
            at_end = [
                name
                for name, angle, low, high in zip(leg.joint_names, theta, leg.lower, leg.upper, strict=True)
                if not low < angle < high
            ]
            raise ParameterError(
                f"controller.thesis.gait.path: at phase {phase:.2f} of the cycle the sole stays {100 * off:.1f} cm and "
                f"{np.rad2deg(turned):.0f} deg off its path, with {', '.join(at_end) or 'the knee'} at the end of "
                f"its range; allowed: {100 * TOLERANCE:.1f} cm and {np.rad2deg(TOLERANCE_RAD):.0f} deg; "
                f"change step_height ({path.step_height:g}), toe_drop ({path.toe_drop:g}), "
                f"step_length ({path.step_length:g}) or offset ({path.offset:g})"
            )
