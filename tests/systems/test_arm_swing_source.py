"""Arm swing source: a posture of all joints in which only the arms move, with exact rates."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import ARMS
from humanwalk.body.skeleton import Skeleton
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.numerics import Array
from humanwalk.systems.arm_swing_source import ArmSwingSource
from humanwalk.walking.arm_swing import ArmSwingParameters

MOVING = {joint for arm in ARMS.values() for joint in (arm.shoulder_flexion, arm.elbow)}
times = st.floats(0.0, 5.0)


def posture_of(source: ArmSwingSource, t: float) -> list[Array]:
    context = source.CreateDefaultContext()
    context.SetTime(t)
    return np.split(source.GetOutputPort("posture").Eval(context), 2)


@pytest.fixture(scope="module")
def source(joints: JointMap, gait: WalkingGait) -> ArmSwingSource:
    return ArmSwingSource(joints.names, gait, ArmSwingParameters())


def test_ports(source: ArmSwingSource) -> None:
    assert source.num_input_ports() == 0
    assert source.num_output_ports() == 1
    port = source.GetOutputPort("posture")
    assert (port.get_name(), port.size()) == ("posture", 84)


@given(t=times)
def test_rates_are_the_derivatives_of_the_angles(source: ArmSwingSource, gait: WalkingGait, t: float) -> None:
    h = 1e-6
    # The swing's growth ends with a kink of the speed ramp; a difference across it means nothing.
    if abs(t - gait.ramp.duration) < 2 * h or t < 2 * h:
        return
    quotient = (posture_of(source, t + h)[0] - posture_of(source, t - h)[0]) / (2 * h)
    np.testing.assert_allclose(posture_of(source, t)[1], quotient, atol=1e-6)


@given(t=times)
def test_only_shoulders_and_elbows_move(source: ArmSwingSource, joints: JointMap, t: float) -> None:
    angles, rates = posture_of(source, t)
    still = [i for i, name in enumerate(joints.names) if name not in MOVING]
    np.testing.assert_array_equal(angles[still], 0.0)
    np.testing.assert_array_equal(rates[still], 0.0)


@given(t=times)
def test_angles_stay_within_the_joint_ranges(source: ArmSwingSource, joints: JointMap, t: float) -> None:
    angles, _ = posture_of(source, t)
    assert np.all((joints.lower <= angles) & (angles <= joints.upper))


def test_an_arm_is_furthest_back_at_touchdown_of_its_side(
    source: ArmSwingSource, joints: JointMap, gait: WalkingGait, footsteps: Callable[..., Any]
) -> None:
    touchdown = next(s.touchdown for s in footsteps(gait, 6.0) if s.side == "Right" and s.touchdown > 2.0)
    right, left = (joints.names.index(arm.shoulder_flexion) for arm in ARMS.values())
    angles, rates = posture_of(source, touchdown)
    amplitude = ArmSwingParameters().shoulder_amplitude
    assert (angles[right], angles[left]) == pytest.approx((-amplitude, amplitude), abs=1e-6)
    assert rates[right] == pytest.approx(0.0, abs=1e-6)


def test_in_standing_the_arms_hang(joints: JointMap, skeleton: Skeleton) -> None:
    standing = WalkingGait(FootPathParameters(), skeleton.hip_half_width, SpeedRamp(0.0, 1.0))
    angles, rates = posture_of(ArmSwingSource(joints.names, standing, ArmSwingParameters()), 3.0)
    elbows = [joints.names.index(arm.elbow) for arm in ARMS.values()]
    np.testing.assert_allclose(angles[elbows], ArmSwingParameters().elbow_flexion)
    np.testing.assert_allclose(np.delete(angles, elbows), 0.0, atol=1e-12)
    np.testing.assert_allclose(rates, 0.0, atol=1e-12)
