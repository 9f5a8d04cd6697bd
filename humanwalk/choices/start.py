"""The body at time zero, and whether the scenario's gait can be walked from there."""

import difflib

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix

from humanwalk.body import LEG_JOINTS, SIDES, contact_spheres
from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices.reference import standing_posture
from humanwalk.control.inverse_kinematics import LegKinematics, pose_error, solve_inverse_kinematics
from humanwalk.gait.foot_cycle import FootCycle, minimum_offset
from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario

REACH_SAMPLES = 48
"""Phases of the cycle at which the legs' reach is tried."""

REACH_TOLERANCE = 0.005
"""How far a sole may stay off its path before the gait counts as unreachable [m]."""

TOE_TOLERANCE = 0.003
"""How far below the ground the gait may ask the toes to go in swing [m]: what the toe joint gives way to."""

REACH_TOLERANCE_RAD = 0.02
"""How far it may be turned from its path [rad]."""


RATES = 1
"""What the seed is drawn from together with the scenario's own, so that rates and angles are independent."""


def start_positions(scenario: Scenario, motion: RecordedMotion | None = None) -> Array:
    """Positions q of the plant at time zero, shape (49,): standing as the gait asks, soles on the ground.

    Args:
        scenario: whose body, and which angles differ.
        motion: a recording to start from instead of the gait.

    Raises:
        ParameterError: a start angle names no joint or is beyond its range.
    """
    plant = kinematics_plant(scenario.subject)
    context = plant.CreateDefaultContext()
    joints = JointMap.of(plant)
    angles = dict.fromkeys(joints.names, 0.0)
    if motion is None:
        angles |= standing_posture(scenario)
    else:
        angles |= zip(joints.names, motion.joints(0.0)[0], strict=True)
    for name, angle in scenario.start.joint_angles.items():
        if name not in angles:
            near = difflib.get_close_matches(name, joints.names, n=1, cutoff=0.0)[0]
            raise ParameterError(
                f"start.joint_angles.{name}: no such joint; allowed: the {len(joints.names)} joints of the body; "
                f"did you mean {near}?"
            )
        angles[name] = angle
    theta = np.array([angles[name] for name in joints.names])
    for i in np.flatnonzero((theta < joints.lower) | (theta > joints.upper)):
        nearest = np.clip(theta[i], joints.lower[i], joints.upper[i])
        raise ParameterError(
            f"start.joint_angles.{joints.names[i]}: {theta[i]:g} is beyond the joint's range; allowed: "
            f"{joints.lower[i]:.4g} to {joints.upper[i]:.4g} rad; the nearest allowed value is {nearest:.4g}"
        )
    noise = np.random.default_rng(scenario.seed).standard_normal(theta.size)
    theta = np.clip(theta + scenario.start.joint_noise * noise, joints.lower, joints.upper)

    q = plant.GetPositions(context)
    q[joints.q] = theta
    pelvis = plant.GetBodyByName("Pelvis").floating_positions_start()
    if motion is not None:
        X_WP = motion.pelvis(0.0).X_WP
        q[pelvis : pelvis + 7] = [*X_WP.rotation().ToQuaternion().wxyz(), *X_WP.translation()]
    plant.SetPositions(context, q)
    lowest = min(
        (plant.GetBodyByName(sphere.body).EvalPoseInWorld(context) @ np.array(sphere.center))[2] - sphere.radius
        for sphere in contact_spheres(scenario.subject.skeleton)
    )
    q[pelvis + 6] += scenario.start.pelvis_lift - lowest
    return q


def start_velocities(scenario: Scenario) -> Array:
    """Velocities v of the plant at time zero, shape (48,): 0 but for the noise on the joints' rates."""
    plant = kinematics_plant(scenario.subject)
    joints = JointMap.of(plant)
    v = np.zeros(plant.num_velocities())
    random = np.random.default_rng((scenario.seed, RATES))
    v[joints.v] = scenario.start.rate_noise * random.standard_normal(joints.v.size)
    return v


def require_reachable(scenario: Scenario) -> None:
    """Raise ParameterError if the legs of the scenario's body cannot follow its foot path (erratum E32)."""
    path, skeleton = scenario.gait.path, scenario.subject.skeleton
    least = minimum_offset(path.step_length, skeleton.leg_length)
    if path.offset < least:
        raise ParameterError(
            f"gait.path.offset: {path.offset:g} is too small for step_length {path.step_length:g}: the straight leg "
            f"ends {skeleton.leg_length:.3f} m from the hip; allowed: from {least:.4f} m on; "
            f"set offset: {np.ceil(1e3 * least) / 1e3 + 0.01:.3f}, or shorten the step"
        )
    plant = kinematics_plant(scenario.subject)
    cycle = FootCycle(path)
    below_hips = skeleton.hip_height - path.offset
    side = SIDES[0]
    leg = LegKinematics(plant, "Pelvis", f"{side}Leg_Sole", LEG_JOINTS[side])
    theta = 0.5 * (leg.lower + leg.upper)
    toe = max(sphere.center[0] + skeleton.origins[sphere.body][0] for sphere in contact_spheres(skeleton))
    for phase in np.arange(REACH_SAMPLES) / REACH_SAMPLES:
        x, z = cycle.position(float(phase))
        clearance = z - toe * np.sin(cycle.pitch(float(phase))[0])
        if clearance < -TOE_TOLERANCE:
            raise ParameterError(
                f"gait.path.toe_drop: {path.toe_drop:g} puts the toes {-100 * clearance:.1f} cm into the ground "
                f"at phase {phase:.2f}; allowed with step_height {path.step_height:g}: 0 to about "
                f"{0.8 * np.arcsin(min(1.0, path.step_height / toe)):.2f} rad; lower it, or lift the foot higher"
            )
        X_PS = RigidTransform(
            RotationMatrix.MakeYRotation(cycle.pitch(float(phase))[0]),
            np.array([x - 0.5 * path.step_length, -skeleton.hip_half_width, z - below_hips]),
        )
        solution = solve_inverse_kinematics(leg, X_PS, theta, scenario.inverse_kinematics)
        theta = solution.theta
        error = pose_error(leg.X_PS(theta), X_PS)
        turned, off = np.linalg.norm(error[:3]), np.linalg.norm(error[3:])
        if turned > REACH_TOLERANCE_RAD or off > REACH_TOLERANCE:
            at_end = [
                name
                for name, angle, low, high in zip(leg.joint_names, theta, leg.lower, leg.upper, strict=True)
                if not low < angle < high
            ]
            raise ParameterError(
                f"gait.path: at phase {phase:.2f} of the cycle the sole stays {100 * off:.1f} cm and "
                f"{np.rad2deg(turned):.0f} deg off its path, with {', '.join(at_end) or 'the knee'} at the end of "
                f"its range; allowed: {100 * REACH_TOLERANCE:.1f} cm and {np.rad2deg(REACH_TOLERANCE_RAD):.0f} deg; "
                f"change step_height ({path.step_height:g}), toe_drop ({path.toe_drop:g}), "
                f"step_length ({path.step_length:g}) or offset ({path.offset:g})"
            )
