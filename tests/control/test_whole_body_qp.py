"""The whole-body program: Newton's laws, its tasks, limits of friction and torque, terrain, and QP failures."""

import cmath
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.math import RotationMatrix
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import contact_spheres
from humanwalk.body.devices import AnkleProsthesis
from humanwalk.body.impairments import NO_TORQUE, JointImpairment, StiffKnee, WeakPlantarflexors
from humanwalk.body.limbs import ARMS, LEGS
from humanwalk.body.plant import body_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.control.body_dynamics import BodyDynamics, Dynamics
from humanwalk.control.whole_body_contacts import Soles
from humanwalk.control.whole_body_parameters import BallTwist, ForcePivot, TaskGains, WholeBodyParameters
from humanwalk.control.whole_body_qp import Posture, WholeBodyQp
from humanwalk.control.whole_body_tasks import Task, tasks
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import yaw_pitch, yaw_roll
from humanwalk.quantity import GRAVITY
from humanwalk.sides import SIDES, Side
from humanwalk.terrain import Plane
from humanwalk.walking.motions import PlanarMotion, ScalarMotion
from humanwalk.walking.walking_reference import FootReference, FootTask, Phase, WalkingReference

PARAMETERS = WholeBodyParameters()
LEVEL = Plane()
WEIGHT = 70.0 * 9.81


@pytest.fixture(scope="module")
def dynamics(plant: MultibodyPlant) -> BodyDynamics:
    return BodyDynamics(plant)


@pytest.fixture(scope="module")
def qp(dynamics: BodyDynamics, skeleton: Skeleton) -> WholeBodyQp:
    return WholeBodyQp(dynamics, contact_spheres(skeleton), PARAMETERS)


def body_at(dynamics: BodyDynamics, flexion: float = 0.12, v: Array | None = None) -> Dynamics:
    """Standing with bent knees, soles on the ground."""
    plant, joints = dynamics.plant, dynamics.joints
    q = plant.GetPositions(plant.CreateDefaultContext())
    for leg in LEGS.values():
        for joint, times in ((leg.hip_flexion, 1), (leg.knee, 2), (leg.ankle, 1)):
            q[joints.q[joints.names.index(joint)]] = times * flexion
    q[6] -= (0.4242 + 0.439767) * (1 - np.cos(flexion)) + 0.0003
    return dynamics.at(np.concatenate((q, np.zeros(plant.num_velocities()) if v is None else v)))


def reference_for(
    body: Any,
    zmp: complex | None = None,
    right: FootReference | None = None,
    left: None = None,
    ground_height: float = 0.0,
    terrain: Plane = LEVEL,
) -> WalkingReference:
    flat = FootReference(FootTask.FLAT, 1.0, 0.0, terrain.axes(np.zeros(2)).T)
    com = complex(body.com.position[0], body.com.position[1])
    return WalkingReference(
        phase=Phase.STAND,
        phase_time=0.0,
        zmp=com if zmp is None else zmp,
        pivot=com if zmp is None else zmp,
        dcm=com,
        dcm_reference=com,
        com_height=(float(body.com.position[2]), 0.0, 0.0),  # type: ignore[arg-type]
        ground_height=ground_height,
        right=right or flat,
        left=left or flat,
        pelvis_yaw=0.0,
        chest_yaw=0.0,
        shoulder_flexion=((0.0, 0.0), (0.0, 0.0)),
        foothold=0j,
        ground=terrain,
    )


def sole_points(body: Dynamics, skeleton: Skeleton) -> Array:
    """Lowest points of all contact spheres of flat feet in W [m], shape (12, 3)."""
    spheres = contact_spheres(skeleton)
    lowest = [np.array(sphere.center) - np.array((0.0, 0.0, sphere.radius)) for sphere in spheres]
    return np.array([body.frame(s.body).point(p).position for s, p in zip(spheres, lowest, strict=True)])


def rest(qp: WholeBodyQp) -> Posture:
    return Posture(np.zeros(len(qp.names)), np.zeros(len(qp.names)))


def newton_residual(body: Dynamics, solution: Any, skeleton: Skeleton) -> Array:
    """M v' + h - J'f on the six rows of the floating base, from the contact points' own Jacobians."""
    total = body.M @ solution.acceleration + body.h
    for sphere, f in zip(contact_spheres(skeleton), solution.forces, strict=True):
        lowest = np.array(sphere.center) - np.array((0.0, 0.0, sphere.radius))
        total -= body.frame(sphere.body).point(lowest).J.T @ f
    return total


@pytest.mark.parametrize("torque_unit, bound", [(1e5, 2.0), (PARAMETERS.torque_unit, 0.005 * WEIGHT)])
def test_in_standing_the_contact_forces_carry_the_weight(
    dynamics: BodyDynamics, skeleton: Skeleton, torque_unit: float, bound: float
) -> None:
    """The cost of the torques lets bent legs yield a little."""
    qp = WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, torque_unit=torque_unit))
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert solution.forces.sum(axis=0) == pytest.approx([0.0, 0.0, WEIGHT], abs=bound)


def test_the_floating_base_obeys_newton(dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton) -> None:
    body = body_at(dynamics, v=np.random.default_rng(1).normal(0.0, 0.1, 48))
    solution = qp.solve(body, reference_for(body, zmp=0.05 + 0.02j), rest(qp))
    assert newton_residual(body, solution, skeleton)[:6] == pytest.approx(np.zeros(6), abs=0.05)


def test_the_torques_are_the_inverse_dynamics_of_accelerations_and_forces(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton
) -> None:
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert newton_residual(body, solution, skeleton)[6:] == pytest.approx(solution.torque, abs=1e-6)


def test_the_center_of_pressure_is_the_zero_moment_point_of_the_reference(
    dynamics: BodyDynamics, qp: WholeBodyQp
) -> None:
    """At rest, with a small shift that needs hardly any angular momentum."""
    body = body_at(dynamics)
    zmp = complex(body.com.position[0] + 0.01, body.com.position[1])
    solution = qp.solve(body, reference_for(body, zmp=zmp), rest(qp))
    acceleration = body.com.J @ solution.acceleration + body.com.bias
    assert acceleration[0] == pytest.approx(-9.81 / body.com.position[2] * 0.01, abs=0.03)


def center_of_pressure(dynamics: BodyDynamics, body: Dynamics, forces: Array, skeleton: Skeleton) -> Array:
    """Of the contact forces, on level ground [m], shape (2,)."""
    points = sole_points(body, skeleton)
    pressure: Array = forces[:, 2] @ points[:, :2] / forces[:, 2].sum()
    return pressure


def test_the_center_of_pressure_follows_its_reference_while_angular_momentum_changes(
    dynamics: BodyDynamics, skeleton: Skeleton
) -> None:
    """With its weight, not without: the trunk, which leans forward on the hips, is straightened."""
    body, lean, joints = body_at(dynamics), 0.1, dynamics.joints
    q = body.q.copy()
    q[:4] = np.cos(0.5 * lean), 0.0, np.sin(0.5 * lean), 0.0
    for leg in LEGS.values():
        q[joints.q[joints.names.index(leg.hip_flexion)]] += lean
    body = dynamics.at(np.concatenate((q, body.v)))
    reference = reference_for(body, zmp=complex(*body.com.position[:2]))
    errors = []
    for weight in (0.0, 1e4):
        program = WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, pressure_weight=weight))
        solution = program.solve(body, reference, rest(program))
        pressure = center_of_pressure(dynamics, body, solution.forces, skeleton)
        errors.append(abs(pressure[0] - reference.zmp.real))
    assert errors[1] < 0.2 * errors[0]
    assert errors[1] < 0.01


@pytest.mark.parametrize("zmp", [0.1 + 0j, -0.3 + 0j, 0.5 + 0.5j, 1.0 - 1.0j])
def test_forces_stay_in_the_friction_pyramid_and_torques_in_their_limits(
    dynamics: BodyDynamics, qp: WholeBodyQp, zmp: complex
) -> None:
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body, zmp=zmp), rest(qp))
    f = solution.forces
    assert (np.abs(f[:, 0]) + np.abs(f[:, 1]) <= PARAMETERS.friction * f[:, 2] + 1e-3).all()
    assert (f[:, 2] >= -1e-6).all()
    assert (np.abs(solution.torque) <= qp.limits + 1e-6).all()


def test_a_foot_in_the_air_carries_no_force(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    body = body_at(dynamics)
    ankle = body.frame(LEGS["Right"].hindfoot).p_WB
    swing = FootReference(
        FootTask.SWING,
        0.0,
        0.0,
        position=PlanarMotion(complex(ankle[0], ankle[1])),
        height=ScalarMotion(0.15),
    )
    solution = qp.solve(body, reference_for(body, zmp=0.02 + 0.0875j, right=swing), rest(qp))
    assert solution.forces[:6] == pytest.approx(np.zeros((6, 3)))
    lift = body.frame(LEGS["Right"].hindfoot).J @ solution.acceleration
    assert lift[5] > 1.0


def test_a_nearly_straight_knee_is_not_extended_further(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    body = body_at(dynamics, flexion=0.015)
    high = replace(reference_for(body), com_height=(1.2, 0.0, 0.0))  # type: ignore[arg-type]
    solution = qp.solve(body, high, rest(qp))
    knee = qp.names.index(LEGS["Right"].knee)
    angle = body.q[dynamics.joints.q[dynamics.joints.names.index(LEGS["Right"].knee)]]
    bound = PARAMETERS.joint_limit_stiffness * (PARAMETERS.knee_margin - angle)
    assert solution.acceleration[6 + knee] >= bound - 0.1


def test_without_ground_under_the_feet_the_body_falls(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    q = body_at(dynamics).q.copy()
    q[6] += 0.3
    body = dynamics.at(np.concatenate((q, np.zeros(48))))
    solution = qp.solve(body, reference_for(body), rest(qp))
    acceleration = body.com.J @ solution.acceleration + body.com.bias
    assert acceleration[2] == pytest.approx(-9.81, abs=0.01)


def test_an_infeasible_program_has_no_solution_and_does_not_affect_the_next(
    dynamics: BodyDynamics, skeleton: Skeleton
) -> None:
    qp = WholeBodyQp(dynamics, contact_spheres(skeleton), PARAMETERS)
    body = body_at(dynamics)
    broken = body._replace(h=body.h + 1e6)
    assert qp.solve(broken, reference_for(body), rest(qp)) is None
    assert qp.solve(body, reference_for(body), rest(qp)) is not None


# ---- terrain


@dataclass(frozen=True)
class RaisedPlane(Plane):
    """A plane that does not contain the origin."""

    offset: float = 0.3

    def height(self, xy: Array) -> Array:
        return super().height(xy) + self.offset


def raised(dynamics: BodyDynamics, body: Dynamics, offset: float) -> Dynamics:
    q = body.q.copy()
    q[6] += offset
    return dynamics.at(np.concatenate((q, body.v)))


def test_ground_and_body_can_be_raised_together(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    terrain = RaisedPlane()
    body = body_at(dynamics)
    zmp = complex(*body.com.position[:2]) + 0.02
    level = qp.solve(body, reference_for(body, zmp), rest(qp))
    body = raised(dynamics, body, terrain.offset)
    high = qp.solve(body, reference_for(body, zmp, ground_height=terrain.offset, terrain=terrain), rest(qp))
    assert high.forces == pytest.approx(level.forces, abs=1e-4)
    assert high.torque == pytest.approx(level.torque, abs=1e-4)


def test_on_ice_forces_use_a_share_of_its_friction(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    ice, body = Plane(friction_coefficient=0.2), body_at(dynamics)
    far = complex(*body.com.position[:2]) - 0.5
    f = qp.solve(body, reference_for(body, far, terrain=ice), rest(qp)).forces
    usable = PARAMETERS.friction_use * 0.2
    assert (np.abs(f[:, 0]) + np.abs(f[:, 1]) <= usable * f[:, 2] + 1e-3).all()
    assert np.abs(f[:, 0]).sum() == pytest.approx(usable * f[:, 2].sum(), rel=0.01)


def on_slope(dynamics: BodyDynamics, slope: float, foot_pitch: float = 0.0, flexion: float = 0.12) -> Dynamics:
    """Standing with bent knees on a plane with a slope along x, feet pitched relative to the plane.

    The pelvis is turned with the plane, so that both legs are as on level ground.
    """
    q = body_at(dynamics, flexion).q.copy()
    R = yaw_pitch(0.0, -slope)
    q[:4] = (np.cos(0.5 * slope), 0.0, -np.sin(0.5 * slope), 0.0)
    q[4:7] = R @ q[4:7]
    for leg in LEGS.values():
        q[dynamics.joints.q[dynamics.joints.names.index(leg.ankle)]] -= foot_pitch
    return dynamics.at(np.concatenate((q, np.zeros(48))))


@pytest.mark.parametrize("slope", [-0.2, -0.1, 0.1, 0.2])
def test_on_a_slope_all_points_of_flat_feet_are_in_contact_within_friction(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton, slope: float
) -> None:
    terrain = Plane(slope=slope)
    body = on_slope(dynamics, slope)
    reference = reference_for(body, terrain=terrain)
    *_, contacts = qp.program(body, reference, rest(qp))
    assert contacts.points.tolist() == list(range(12))
    solution = qp.solve(body, reference, rest(qp))
    f_S = solution.forces @ terrain.axes(np.zeros(2)).T
    assert (np.abs(f_S[:, 0]) + np.abs(f_S[:, 1]) <= PARAMETERS.friction * f_S[:, 2] + 1e-3).all()
    assert newton_residual(body, solution, skeleton)[:6] == pytest.approx(np.zeros(6), abs=0.05)


@pytest.mark.parametrize("slope", [-0.1, 0.0, 0.1])
@pytest.mark.parametrize("pitch", [-0.1, 0.1])
def test_after_heel_strike_a_foot_turns_until_it_is_parallel_to_the_slope(
    dynamics: BodyDynamics, qp: WholeBodyQp, slope: float, pitch: float
) -> None:
    terrain = Plane(slope=slope)
    body = on_slope(dynamics, slope, pitch)
    landed = FootReference(FootTask.HEEL_STRIKE, 1.0, 0.0, terrain.axes(np.zeros(2)).T)
    solution = qp.solve(body, reference_for(body, right=landed, terrain=terrain), rest(qp))
    turning = (body.frame(LEGS["Right"].hindfoot).J @ solution.acceleration)[1]
    parallel = on_slope(dynamics, slope)
    unturned = body.frame(LEGS["Right"].hindfoot).R_WB @ parallel.frame(LEGS["Right"].hindfoot).R_WB.T
    assert np.arcsin(unturned[0, 2]) == pytest.approx(pitch, abs=1e-9)
    assert turning * pitch < -1.0


def test_toes_that_extend_no_further_roll_about_their_contact_points(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton
) -> None:
    body, pitch = body_at(dynamics), ScalarMotion(0.0, 5.0, 0.0)
    flat, rolling = (
        FootReference(FootTask.HEEL_OFF, 1.0, 0.0, pitch=pitch, toes=toes) for toes in ((0.0, 5.0), (-1e-6, 0.0))
    )
    toes = body.frame(LEGS["Right"].toe_segment)
    sole = next(s for s in contact_spheres(skeleton) if s.body == LEGS["Right"].toe_segment)
    turning, standing = [], []
    for reference in (flat, rolling):
        solution = qp.solve(body, reference_for(body, right=reference), rest(qp))
        turning.append((toes.J @ solution.acceleration)[1])
        points = toes.point(np.array((sole.center[0], 0.0, sole.center[2] - sole.radius)))
        standing.append(np.abs(points.J @ solution.acceleration + points.bias).max())
    assert abs(turning[0]) < 10.0
    assert turning[1] == pytest.approx(PARAMETERS.stance.damping * pitch.rate, rel=0.05)
    assert max(standing) < 1.0


def in_double_support(dynamics: BodyDynamics, skeleton: Skeleton) -> Dynamics:
    """Standing with the right foot ahead of the left one; the heel of the left one is up."""
    joints, apart = dynamics.joints, 0.25
    q = body_at(dynamics).q.copy()
    for leg, sign in ((LEGS["Right"], 1.0), (LEGS["Left"], -1.0)):
        q[joints.q[joints.names.index(leg.hip_flexion)]] += sign * apart
        q[joints.q[joints.names.index(leg.ankle)]] -= sign * apart
    q[6] -= sole_points(dynamics.at(np.concatenate((q, np.zeros(48)))), skeleton)[:, 2].min() + 0.0003
    return dynamics.at(np.concatenate((q, np.zeros(48))))


def test_with_effort_the_legs_do_not_work_against_each_other(dynamics: BodyDynamics, skeleton: Skeleton) -> None:
    """In double support the tasks leave the forces along the line between the feet free: the foot behind pushes."""
    body = in_double_support(dynamics, skeleton)
    undirected = replace(PARAMETERS, force_pivot=ForcePivot(unit=1e6))
    free, effort = (
        WholeBodyQp(dynamics, contact_spheres(skeleton), replace(undirected, torque_unit=unit)) for unit in (1e5, 7.0)
    )
    before, after = (program.solve(body, reference_for(body), rest(program)) for program in (free, effort))
    assert after.forces.sum(axis=0) == pytest.approx(before.forces.sum(axis=0), rel=0.02, abs=1.0)
    ahead, behind = (slice(0, 6), slice(6, 12))
    assert after.forces[ahead, 0].sum() < before.forces[ahead, 0].sum() - 20.0
    assert after.forces[behind, 0].sum() > before.forces[behind, 0].sum() + 20.0
    hips = [effort.names.index(leg.hip_flexion) for leg in LEGS.values()]
    assert np.linalg.norm(after.torque[hips]) < 0.8 * np.linalg.norm(before.torque[hips])


def test_in_double_support_the_force_on_each_foot_points_to_the_pivot(
    dynamics: BodyDynamics, skeleton: Skeleton
) -> None:
    body = in_double_support(dynamics, skeleton)
    height = 0.5
    free, pointed = (
        WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, force_pivot=ForcePivot(height, unit)))
        for unit in (1e6, 1.0)
    )
    before, after = (program.solve(body, reference_for(body), rest(program)) for program in (free, pointed))
    assert after.forces.sum(axis=0) == pytest.approx(before.forces.sum(axis=0), rel=0.02, abs=2.0)
    pivot = body.com.position + np.array((0.0, 0.0, height))
    points = sole_points(body, skeleton)

    def across(forces: Array) -> list[float]:
        """Of each foot: part of its force across the line from its center of pressure to the pivot, per force."""
        parts = []
        for foot in (slice(0, 6), slice(6, 12)):
            force, load = forces[foot].sum(axis=0), forces[foot, 2]
            line = pivot - load @ points[foot] / load.sum()
            parts.append(np.linalg.norm(np.cross(force, line)) / np.linalg.norm(force) / np.linalg.norm(line))
        return parts

    assert max(across(after.forces)) < 0.02
    assert max(across(before.forces)) > 0.05


def test_the_force_on_one_foot_points_anywhere(dynamics: BodyDynamics, skeleton: Skeleton) -> None:
    body = in_double_support(dynamics, skeleton)
    alone = replace(reference_for(body), left=FootReference(FootTask.FLAT, 0.0, 0.0, LEVEL.axes(np.zeros(2)).T))
    free, pointed = (
        WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, force_pivot=ForcePivot(unit=unit)))
        for unit in (1e6, 1.0)
    )
    programs = [program.program(body, alone, rest(program))[0] for program in (free, pointed)]
    assert np.array_equal(programs[0].H, programs[1].H)


@pytest.mark.parametrize("turn", [-1.0, 1.0])
@pytest.mark.parametrize(("dcm_error", "speed"), [(0.0, 1.4), (0.033, 1.4), (0.3, 1.4), (0.0, 1.46)])
def test_a_foot_on_its_ball_carries_a_limited_moment_about_the_vertical(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton, turn: float, dcm_error: float, speed: float
) -> None:
    """The limit is in proportion to its vertical force, and grows when the body has to be caught, and in fast walks."""
    body, under = in_double_support(dynamics, skeleton), slice(6, 12)
    on_ball = FootReference(FootTask.HEEL_OFF, 1.0, 0.0, pitch=ScalarMotion(0.25, 0.0, 0.0))
    in_the_air = FootReference(FootTask.FLAT, 0.0, 0.0, LEVEL.axes(np.zeros(2)).T)
    reference = reference_for(body, zmp=complex(*sole_points(body, skeleton)[under, :2].mean(axis=0)))
    dcm = reference.dcm_reference + 1j * dcm_error
    reference = replace(reference, left=on_ball, right=in_the_air, pelvis_yaw=turn, dcm=dcm, speed=speed)
    *_, contacts = qp.program(body, reference, rest(qp))

    def arm(qp: WholeBodyQp) -> float:
        """Moment of the forces about the vertical through the mean of the contact points, over their vertical force."""
        f = qp.solve(body, reference, rest(qp)).forces[contacts.points]
        p = contacts.p_W - contacts.p_W.mean(axis=0)
        return float(np.cross(p, f)[:, 2].sum() / f[:, 2].sum())

    unlimited = WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, ball_twist=BallTwist(arm=0.1)))
    largest = PARAMETERS.ball_twist.at(dcm_error, speed)
    assert abs(arm(unlimited)) > PARAMETERS.ball_twist.at(0.0, 1.46) + 1e-3
    assert turn * arm(qp) == pytest.approx(min(largest, abs(arm(unlimited))), abs=1e-5)


def test_the_limited_moment_of_a_foot_is_about_the_mean_of_its_own_contact_points(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton
) -> None:
    """Although the other foot stands, too."""
    body, arm = in_double_support(dynamics, skeleton), 0.01
    on_ball = FootReference(FootTask.HEEL_OFF, 1.0, 0.0, pitch=ScalarMotion(0.25, 0.0, 0.0))
    *_, contacts = qp.program(body, replace(reference_for(body), left=on_ball), rest(qp))
    left = contacts.side == SIDES.index("Left")
    assert left.any() and not left.all()
    edge_forces = np.random.default_rng(0).uniform(0.0, 1.0, len(contacts.J_edges))
    f, p = contacts.forces(edge_forces)[left], contacts.p_W[left]
    moment, largest = np.cross(p - p.mean(axis=0), f)[:, 2].sum(), arm * f[:, 2].sum()
    assert contacts.twist(arm) @ edge_forces == pytest.approx([moment - largest, -moment - largest])


def test_the_moment_of_a_flat_foot_about_the_vertical_has_no_limit_but_friction(
    dynamics: BodyDynamics, skeleton: Skeleton
) -> None:
    body = body_at(dynamics)
    tight, loose = (
        WholeBodyQp(dynamics, contact_spheres(skeleton), replace(PARAMETERS, ball_twist=BallTwist(arm=arm)))
        for arm in (0.001, 0.1)
    )
    programs = [program.program(body, reference_for(body), rest(program))[0] for program in (tight, loose)]
    assert np.array_equal(programs[0].A, programs[1].A)


def test_a_style_accelerates_its_joint(dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton) -> None:
    body = in_double_support(dynamics, skeleton)
    hip = 6 + qp.names.index(LEGS["Left"].hip_flexion)
    wanted = qp.solve(body, reference_for(body), rest(qp)).acceleration[hip] + 1.0
    style = [Task(np.eye(body.v.size)[[hip]], np.array([wanted]), 1e4)]
    assert qp.solve(body, reference_for(body), rest(qp), style).acceleration[hip] == pytest.approx(wanted, abs=0.05)


def test_swinging_arms_do_not_accelerate_the_center_of_mass(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    """Legs and trunk make up for joints with prescribed motion."""
    body, posture = body_at(dynamics), rest(qp)
    posture.angle[[qp.names.index(arm.shoulder_flexion) for arm in ARMS.values()]] = 0.5
    still, swinging = (
        body.com.J @ qp.solve(body, reference_for(body), wanted).acceleration for wanted in (rest(qp), posture)
    )
    assert swinging[:2] == pytest.approx(still[:2], abs=0.05)


@pytest.mark.parametrize("load", [1.0, 0.5, 0.1])
@pytest.mark.parametrize("force", [math.inf, 3.0])
def test_a_force_costs_its_square_over_the_load_of_its_foot(
    dynamics: BodyDynamics, qp: WholeBodyQp, force: float, load: float
) -> None:
    """An edge costs the square of its coefficient; the largest force of a foot is in proportion to the load."""
    body = body_at(dynamics)
    old = replace(reference_for(body).left, load=load, force=force)
    program, _, contacts = qp.program(body, replace(reference_for(body), left=old), rest(qp))
    length = contacts.edges_W[:, :, 2]
    assert length[:6] == pytest.approx(PARAMETERS.force_unit)
    assert length[6:] == pytest.approx(np.sqrt(load) * PARAMETERS.force_unit)
    largest = program.upper[: length.size] * length.ravel()
    assert largest[:24] == pytest.approx(PARAMETERS.max_contact_force)
    assert largest[24:] == pytest.approx(load * min(PARAMETERS.max_contact_force, force * WEIGHT / 24))


@pytest.mark.parametrize("load", [0.1, 0.02])
def test_a_foot_that_is_unloaded_carries_a_limited_force_although_the_plan_wants_more(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton, load: float
) -> None:
    """The planned zero-moment point is between the feet, where half of the weight would be on each."""
    body, of_left = body_at(dynamics), [s.body in LEGS["Left"].foot_bodies for s in contact_spheres(skeleton)]
    carried = {}
    for limit in (math.inf, 3.0):
        left = replace(reference_for(body).left, load=load, force=limit)
        solution = qp.solve(body, replace(reference_for(body, zmp=0.05 + 0.04j), left=left), rest(qp))
        carried[limit] = solution.forces[of_left, 2].sum() / WEIGHT
    assert carried[math.inf] > 3.0 * load + 0.05
    assert carried[3.0] <= 3.0 * load + 1e-3


@pytest.mark.parametrize("least, largest", [(0.42, math.inf), (0.0, 0.2), (0.0, 0.0)])
def test_the_force_under_a_heel_is_within_its_limits(
    dynamics: BodyDynamics, qp: WholeBodyQp, skeleton: Skeleton, least: float, largest: float
) -> None:
    """In standing with the pressure below the ankle each heel carries 0.37 body weights."""
    body, heel = body_at(dynamics), [s.body == LEGS["Right"].hindfoot for s in contact_spheres(skeleton)]
    free, limited = (replace(reference_for(body).right, heel=limits) for limits in ((0.0, math.inf), (least, largest)))
    before, after = (
        qp.solve(body, reference_for(body, right=foot), rest(qp)).forces[heel, 2].sum() / WEIGHT
        for foot in (free, limited)
    )
    assert not least <= before <= largest
    assert least - 1e-3 <= after <= largest + 1e-3


def test_a_stance_foot_above_a_slope_moves_along_its_normal(dynamics: BodyDynamics, qp: WholeBodyQp) -> None:
    slope = 0.2
    terrain = Plane(slope=slope)
    # Knees that are bent enough for the foot to go down.
    body = raised(dynamics, on_slope(dynamics, slope, flexion=0.15), 0.05)
    solution = qp.solve(body, reference_for(body, terrain=terrain), rest(qp))
    acceleration = (body.frame(LEGS["Right"].hindfoot).J @ solution.acceleration)[3:]
    normal = terrain.axes(np.zeros(2))[2]
    assert normal @ acceleration < -1.0
    assert acceleration / np.linalg.norm(acceleration) == pytest.approx(-normal, abs=0.1)


# ---- tasks, one at a time

NO_TASK, SOME = TaskGains(0.0, 0.0, 0.0), TaskGains(100.0, 20.0, 1.0)
NOTHING = replace(
    PARAMETERS,
    com_weight=0.0,
    pressure_weight=0.0,
    com_height=NO_TASK,
    stance=NO_TASK,
    heel_strike=NO_TASK,
    heel_off=NO_TASK,
    swing_position=NO_TASK,
    swing_rotation=NO_TASK,
    pelvis=NO_TASK,
    chest=NO_TASK,
)
SWING = dict(swing_position=SOME, swing_rotation=SOME, swing_acceleration_limit=1e3)


@pytest.fixture(scope="module")
def soles(dynamics: BodyDynamics, skeleton: Skeleton) -> Soles:
    return Soles.of(contact_spheres(skeleton), dynamics.bodies)


def error(
    body: Dynamics,
    acceleration: Array,
    reference: WalkingReference,
    soles: Soles,
    passive_ankles: tuple[Side, ...] = (),
    **gains: Any,
) -> Array:
    """Desired minus actual accelerations of the tasks that have gains."""
    J, desired, _ = tasks(body, soles.on(reference.ground, body), reference, replace(NOTHING, **gains), passive_ankles)
    return desired - J @ acceleration


@pytest.mark.parametrize(
    ("gains", "passive_ankles"),
    [(dict(com_weight=1.0, com_height=SOME), ()), (dict(heel_off=SOME), ()), (SWING, ()), (SWING, ("Right",))],
    ids=["center of mass", "heel-off", "swing", "swing of a foot that the ankle does not turn"],
)
@settings(max_examples=10)
@given(seed=st.integers(0, 1000))
def test_a_stiff_body_that_pitches_and_translates_as_planned_has_no_error(
    dynamics: BodyDynamics, soles: Soles, gains: dict[str, Any], passive_ankles: tuple[Side, ...], seed: int
) -> None:
    random = np.random.default_rng(seed)
    pitch = ScalarMotion(*random.uniform(-1.0, 1.0, 3) * (0.4, 3.0, 20.0))
    q, v, acceleration = body_at(dynamics).q.copy(), np.zeros(48), np.zeros(48)
    q[:4] = np.cos(0.5 * pitch.value), 0.0, np.sin(0.5 * pitch.value), 0.0
    v[1], v[3:6] = pitch.rate, random.uniform(-1.0, 1.0, 3)
    acceleration[1], acceleration[3:6] = pitch.acceleration, random.uniform(-3.0, 3.0, 3)
    body = dynamics.at(np.concatenate((q, v)))
    com, ankle = body.com, body.frame(LEGS["Right"].hindfoot).point(np.zeros(3))
    motions = [(p.position, p.velocity, p.J @ acceleration + p.bias) for p in (com, ankle)]
    (level, height), (path, lift) = (
        ([complex(*part[:2]) for part in motion], ScalarMotion(*(float(part[2]) for part in motion)))
        for motion in motions
    )
    task = FootTask.HEEL_OFF if "heel_off" in gains else FootTask.SWING
    foot = FootReference(task, 0.0, 0.0, position=PlanarMotion(*path), height=lift, pitch=pitch)
    # The force on a pendulum passes through its pivot.
    pivot = level[0] - level[2] * height.value / (GRAVITY + height.acceleration)
    reference = replace(reference_for(body, right=foot), pivot=pivot, com_height=height)
    np.testing.assert_allclose(error(body, acceleration, reference, soles, passive_ankles, **gains), 0.0, atol=1e-6)


def test_a_pelvis_that_is_turned_and_rolled_as_planned_has_no_error(dynamics: BodyDynamics, soles: Soles) -> None:
    yaw, roll = 0.4, -0.2
    q = body_at(dynamics).q.copy()
    q[:4] = RotationMatrix(yaw_roll(yaw, roll)).ToQuaternion().wxyz()
    body = dynamics.at(np.concatenate((q, np.zeros(48))))
    reference = replace(reference_for(body), pelvis_yaw=yaw, pelvis_roll=roll)
    np.testing.assert_allclose(error(body, np.zeros(48), reference, soles, pelvis=SOME), 0.0, atol=1e-6)


@pytest.mark.parametrize("way", [0.0, 0.7, 1.57, -2.0])
def test_a_swinging_foot_is_accelerated_to_a_far_foothold_by_the_limit_in_any_direction(
    dynamics: BodyDynamics, soles: Soles, way: float
) -> None:
    body = body_at(dynamics)
    x, y, z = body.frame(LEGS["Right"].hindfoot).p_WB.tolist()
    path = PlanarMotion(complex(x, y) + cmath.rect(5.0, way))
    foot = FootReference(FootTask.SWING, 0.0, 0.0, position=path, height=ScalarMotion(z))
    desired = error(body, np.zeros(48), reference_for(body, right=foot), soles, swing_position=SOME)
    limit = PARAMETERS.swing_acceleration_limit
    assert desired == pytest.approx([limit * math.cos(way), limit * math.sin(way), 0.0], abs=1e-6)


# ---- impairments


def impaired(subject: Subject) -> tuple[BodyDynamics, WholeBodyQp]:
    dynamics = BodyDynamics(body_plant(subject))
    return dynamics, WholeBodyQp(dynamics, contact_spheres(subject.skeleton), PARAMETERS)


def test_a_locked_knee_does_not_move_and_its_muscles_rest() -> None:
    angle, rate = 0.24, 0.1
    dynamics, qp = impaired(Subject(impairments=(StiffKnee(angle),)))
    knee, v = qp.names.index(LEGS["Right"].knee), np.zeros(48)
    v[6 + knee] = rate
    body = body_at(dynamics, 0.5 * angle, v)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert solution is not None
    assert solution.acceleration[6 + knee] == pytest.approx(-PARAMETERS.joint_limit_damping * rate, rel=1e-3)
    assert solution.torque[knee] == 0.0
    assert abs(solution.torque[qp.names.index(LEGS["Left"].knee)]) > 1.0


@pytest.mark.parametrize("angle", [0.02, 0.0995, 0.1745, 0.3])
@pytest.mark.parametrize("play", [0.0101, 0.03, 0.2])
def test_a_stiff_knee_has_a_range_in_the_program_whatever_its_play(angle: float, play: float) -> None:
    """The margin of a straight knee does not shorten the range of a knee that is bent."""
    dynamics, qp = impaired(Subject(impairments=(StiffKnee(angle, play),)))
    body = body_at(dynamics, 0.5 * angle)
    knee, i = qp.names.index(LEGS["Right"].knee), dynamics.joints.names.index(LEGS["Right"].knee)
    low = PARAMETERS.joint_limit_stiffness * (min(max(angle - play, PARAMETERS.knee_margin), angle + play) - angle)
    assert dynamics.joints.upper[i] > angle
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert solution is not None
    assert solution.acceleration[6 + knee] >= low - 0.1


@pytest.mark.parametrize("strength", [0.5, 0.1])
def test_weak_muscles_deliver_no_more_than_their_strength(strength: float) -> None:
    dynamics, qp = impaired(Subject(impairments=(WeakPlantarflexors(strength),)))
    body = body_at(dynamics)
    ahead = complex(body.com.position[0] + 0.15, body.com.position[1])
    solution = qp.solve(body, reference_for(body, ahead), rest(qp))
    assert solution is not None
    for leg in LEGS.values():
        assert abs(solution.torque[qp.names.index(leg.ankle)]) <= 200.0 * strength * (1.0 + 1e-6)


def test_a_passive_spring_is_in_the_equations_of_motion() -> None:
    stiffness, rest = 40.0, 0.05
    healthy = BodyDynamics(body_plant(Subject()))
    sprung = BodyDynamics(
        body_plant(Subject(impairments=(JointImpairment("ankle", "Left", stiffness=stiffness, rest_angle=rest),)))
    )
    difference = body_at(sprung).h - body_at(healthy).h
    place = healthy.joints.v[healthy.joints.names.index(LEGS["Left"].ankle)]
    assert difference[place] == pytest.approx(stiffness * (0.12 - rest))
    assert np.abs(np.delete(difference, place)).max() == 0.0


def test_a_passive_ankle_carries_what_its_spring_delivers() -> None:
    dynamics, qp = impaired(Subject(devices=(AnkleProsthesis(),)))
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert solution is not None
    assert abs(solution.torque[qp.names.index(LEGS["Right"].ankle)]) <= NO_TORQUE
    # The other leg and the hips hold the center of mass.
    assert solution.forces[:, 2].sum() == pytest.approx(9.81 * dynamics.mass, rel=0.02)
