"""Tasks of a style: the joint angles of its curves at the phase of each foot; none in standing."""

from dataclasses import replace

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.limbs import LEGS
from humanwalk.control.body_dynamics import BodyDynamics, Dynamics
from humanwalk.control.joint_style import JointStyle
from humanwalk.control.whole_body_parameters import TaskGains
from humanwalk.motion.gait_curves import GaitCurves
from humanwalk.walking.walking_reference import FootReference, FootTask, Phase, WalkingReference

GAINS = TaskGains(100.0, 20.0, 4.0)
FLAT = FootReference(FootTask.FLAT, 1.0, 0.0)
STEP = 0.5
WALK = WalkingReference(
    phase=Phase.SINGLE_SUPPORT, phase_time=0.4 * STEP, zmp=0j, pivot=0j, dcm=0j, dcm_reference=0j,
    com_height=(0.9, 0.0, 0.0), ground_height=0.0, right=FLAT, left=FLAT, pelvis_yaw=0.0, chest_yaw=0.0,  # type: ignore[arg-type]
    shoulder_flexion=((0.0, 0.0), (0.0, 0.0)), foothold=0j, step_duration=STEP, stance="Left", speed=1.0,
)  # fmt: skip
PHASES = np.arange(100) / 100.0
ANGLES = np.stack([np.outer(np.cos(2.0 * np.pi * PHASES), (0.3, 0.2, 0.1))] * 2, axis=1)[None]


@pytest.fixture(scope="module")
def dynamics(plant: MultibodyPlant) -> BodyDynamics:
    return BodyDynamics(plant)


@pytest.fixture(scope="module")
def style(dynamics: BodyDynamics) -> JointStyle:
    return JointStyle(dynamics.joints, GaitCurves.through(np.array([1.0]), ANGLES), GAINS)


def walking_at(speed: float, dynamics: BodyDynamics, plant: MultibodyPlant) -> Dynamics:
    """The upright body as a whole at a forward speed [m/s]."""
    state = plant.GetPositionsAndVelocities(plant.CreateDefaultContext())
    state[plant.num_positions() + 3] = speed
    return dynamics.at(state)


def test_each_leg_follows_its_own_phase(dynamics: BodyDynamics, style: JointStyle, plant: MultibodyPlant) -> None:
    """Left stance at 20 % of its cycle, the right leg at 70 %: upright with still joints, the angles are the errors."""
    body = walking_at(1.0, dynamics, plant)
    rate = 2.0 * np.pi * 0.5 / STEP
    for task, side, phase in zip(style.tasks(body, WALK, 1.0), ("Right", "Left"), (0.7, 0.2), strict=True):
        cosine, sine = np.cos(2.0 * np.pi * phase), np.sin(2.0 * np.pi * phase)
        wanted = (GAINS.stiffness * cosine - GAINS.damping * rate * sine - rate**2 * cosine) * np.array((0.3, 0.2, 0.1))
        assert task.acceleration == pytest.approx(wanted, abs=1e-6)
        assert task.weight == pytest.approx(GAINS.weight)
        places = [int(dynamics.joints.v[dynamics.joints.names.index(name)]) for name in LEGS[side].sagittal]  # type: ignore[index]
        assert task.J @ np.arange(body.v.size) == pytest.approx(places)


def test_a_style_follows_the_ankle_with_its_own_weight(
    dynamics: BodyDynamics, style: JointStyle, plant: MultibodyPlant
) -> None:
    """The cost is the square of J v' minus the desired value: a weight is the square of a factor of both."""
    body, curves = walking_at(1.0, dynamics, plant), GaitCurves.through(np.array([1.0]), ANGLES)
    softer = JointStyle(dynamics.joints, curves, GAINS, ankle=0.25)
    for task, soft in zip(style.tasks(body, WALK, 1.0), softer.tasks(body, WALK, 1.0), strict=True):
        factors = np.array((1.0, 1.0, 0.5))
        expected = factors[:, None] * task.J
        np.testing.assert_allclose(soft.J, expected)
        assert soft.acceleration == pytest.approx(factors * task.acceleration)


def test_in_standing_and_backward_there_is_no_style(
    dynamics: BodyDynamics, style: JointStyle, plant: MultibodyPlant
) -> None:
    body = walking_at(1.0, dynamics, plant)
    assert style.tasks(body, replace(WALK, phase=Phase.STAND), 1.0) == []
    assert style.tasks(body, replace(WALK, speed=-0.5), 1.0) == []


def test_the_weight_decreases_below_the_speed_of_the_curves_and_with_the_size_of_the_body(
    dynamics: BodyDynamics, style: JointStyle, plant: MultibodyPlant
) -> None:
    body = walking_at(1.0, dynamics, plant)
    assert [task.weight for task in style.tasks(body, replace(WALK, speed=0.25), 1.0)] == pytest.approx([1.0, 1.0])
    assert [task.weight for task in style.tasks(body, WALK, 0.5)] == pytest.approx([1.0, 1.0])
    slow, backward = (walking_at(speed, dynamics, plant) for speed in (0.5, -0.5))
    assert [task.weight for task in style.tasks(slow, WALK, 1.0)] == pytest.approx([2.0, 2.0])
    assert style.tasks(backward, WALK, 1.0) == []


def test_phases_of_both_feet_are_half_a_cycle_apart() -> None:
    assert WALK.gait_phase("Left") == pytest.approx(0.2)
    assert WALK.gait_phase("Right") == pytest.approx(0.7)
    assert replace(WALK, phase_time=10.0).gait_phase("Right") == 1.0
    assert replace(WALK, phase=Phase.WEIGHT_SHIFT).gait_phase("Right") == 0.0
