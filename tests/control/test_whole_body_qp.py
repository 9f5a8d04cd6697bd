"""The whole-body program: Newton's laws, the ground's and the muscles' limits, and what happens without a solution."""

from dataclasses import replace

import numpy as np
import pytest

from humanwalk.body import contact_spheres
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.control.whole_body_qp import Posture, WholeBodyParameters, WholeBodyQp
from humanwalk.walking.swing_foot import PlanarMotion
from humanwalk.walking.walking_reference import FootReference, FootTask, Phase, WalkingReference

PARAMETERS = WholeBodyParameters()
WEIGHT = 70.0 * 9.81


@pytest.fixture(scope="module")
def dynamics(plant):
    return BodyDynamics(plant)


@pytest.fixture(scope="module")
def qp(dynamics, skeleton):
    return WholeBodyQp(dynamics, contact_spheres(skeleton), PARAMETERS)


def body_at(dynamics, flexion=0.12, v=None):
    """Standing with bent knees, soles on the ground."""
    plant, joints = dynamics.plant, dynamics.joints
    q = plant.GetPositions(plant.CreateDefaultContext())
    for side in ("Right", "Left"):
        for joint, times in (("Femur", 1), ("Tibia", 2), ("Ankle", 1)):
            q[joints.q[joints.names.index(f"{side}Leg{joint}Motion")]] = times * flexion
    q[6] -= (0.4242 + 0.439767) * (1 - np.cos(flexion)) + 0.0003
    return dynamics.at(np.concatenate((q, np.zeros(plant.num_velocities()) if v is None else v)))


def reference_for(body, zmp=None, right=None, left=None):
    flat = FootReference(FootTask.FLAT, 1.0, 0.0)
    com = complex(body.com[0], body.com[1])
    return WalkingReference(
        phase=Phase.STAND,
        phase_time=0.0,
        zmp=com if zmp is None else zmp,
        dcm=com,
        dcm_reference=com,
        com_height=(float(body.com[2]), 0.0, 0.0),
        ground_height=0.0,
        right=right or flat,
        left=left or flat,
        pelvis_yaw=0.0,
        chest_yaw=0.0,
        shoulder_flexion=((0.0, 0.0), (0.0, 0.0)),
        foothold=0j,
    )


def rest(qp):
    return Posture(np.zeros(len(qp.names)), np.zeros(len(qp.names)))


def newton_residual(body, solution, skeleton):
    """M v' + h - J'f on the six rows of the floating base, from the contact points' own Jacobians."""
    total = body.M @ solution.acceleration + body.h
    for sphere, f in zip(contact_spheres(skeleton), solution.forces, strict=True):
        lowest = np.array(sphere.center) - np.array((0.0, 0.0, sphere.radius))
        total -= body.frame(sphere.body).point(lowest)[1].T @ f
    return total


def test_standing_the_ground_carries_the_weight(dynamics, qp):
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert solution.forces.sum(axis=0) == pytest.approx([0.0, 0.0, WEIGHT], abs=2.0)


def test_the_floating_base_obeys_newton(dynamics, qp, skeleton):
    body = body_at(dynamics, v=np.random.default_rng(1).normal(0.0, 0.1, 48))
    solution = qp.solve(body, reference_for(body, zmp=0.05 + 0.02j), rest(qp))
    assert newton_residual(body, solution, skeleton)[:6] == pytest.approx(np.zeros(6), abs=0.05)


def test_the_torques_are_what_these_forces_and_accelerations_need(dynamics, qp, skeleton):
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body), rest(qp))
    assert newton_residual(body, solution, skeleton)[6:] == pytest.approx(solution.torque, abs=1e-6)


def test_the_centre_of_pressure_is_the_zero_moment_point_that_is_asked(dynamics, qp):
    """At rest, with a small shift that needs hardly any angular momentum."""
    body = body_at(dynamics)
    zmp = complex(body.com[0] + 0.01, body.com[1])
    solution = qp.solve(body, reference_for(body, zmp=zmp), rest(qp))
    acceleration = body.com_J @ solution.acceleration + body.com_bias
    assert acceleration[0] == pytest.approx(-9.81 / body.com[2] * 0.01, abs=0.03)


@pytest.mark.parametrize("zmp", [0.1 + 0j, -0.3 + 0j, 0.5 + 0.5j, 1.0 - 1.0j])
def test_forces_stay_in_the_friction_pyramid_and_torques_in_their_limits(dynamics, qp, zmp):
    body = body_at(dynamics)
    solution = qp.solve(body, reference_for(body, zmp=zmp), rest(qp))
    f = solution.forces
    assert (np.abs(f[:, 0]) + np.abs(f[:, 1]) <= PARAMETERS.friction * f[:, 2] + 1e-3).all()
    assert (f[:, 2] >= -1e-6).all()
    assert (np.abs(solution.torque) <= qp.limits + 1e-6).all()


def test_a_foot_in_the_air_presses_on_nothing(dynamics, qp):
    body = body_at(dynamics)
    ankle = body.frame("RightLeg_Ankle").p_WB
    swing = FootReference(
        FootTask.SWING, 0.0, 0.0, PlanarMotion(complex(ankle[0], ankle[1])), (0.15, 0.0, 0.0), (0.0, 0.0, 0.0)
    )
    solution = qp.solve(body, reference_for(body, zmp=0.02 + 0.0875j, right=swing), rest(qp))
    assert np.abs(solution.forces[:6]).max() == 0.0
    lift = body.frame("RightLeg_Ankle").J @ solution.acceleration
    assert lift[5] > 1.0


def test_a_knee_that_is_nearly_straight_is_not_straightened(dynamics, qp):
    body = body_at(dynamics, flexion=0.015)
    high = replace(reference_for(body), com_height=(1.2, 0.0, 0.0))
    solution = qp.solve(body, high, rest(qp))
    knee = qp.names.index("RightLegTibiaMotion")
    angle = body.q[dynamics.joints.q[dynamics.joints.names.index("RightLegTibiaMotion")]]
    bound = PARAMETERS.range_stiffness * (PARAMETERS.knee_margin - angle)
    assert solution.acceleration[6 + knee] >= bound - 0.1


def test_without_ground_under_the_feet_the_body_falls(dynamics, qp):
    q = body_at(dynamics).q.copy()
    q[6] += 0.3
    body = dynamics.at(np.concatenate((q, np.zeros(48))))
    solution = qp.solve(body, reference_for(body), rest(qp))
    acceleration = body.com_J @ solution.acceleration + body.com_bias
    assert acceleration[2] == pytest.approx(-9.81, abs=0.01)


def test_a_program_without_a_solution_gives_none_and_the_next_is_solved(dynamics, skeleton):
    qp = WholeBodyQp(dynamics, contact_spheres(skeleton), PARAMETERS)
    body = body_at(dynamics)
    broken = replace(body, h=body.h + 1e6)
    assert qp.solve(broken, reference_for(body), rest(qp)) is None
    assert qp.solve(body, reference_for(body), rest(qp)) is not None
