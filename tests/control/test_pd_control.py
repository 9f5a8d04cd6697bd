"""PD law of the joints: its formula, its gains and the step that its explicit form survives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.limbs import JOINT_GROUPS
from humanwalk.control.pd_control import (
    THESIS_ANKLE,
    ActuatorParameters,
    PdGains,
    joint_gains,
    pd_torque,
)
from humanwalk.quantity import ParameterError

numbers = st.floats(-10.0, 10.0)
gains = st.floats(0.0, 1e4)


@pytest.fixture(scope="module")
def inertia(plant, joints):
    return plant.CalcMassMatrix(plant.CreateDefaultContext()).diagonal()[joints.v]


@given(numbers, numbers, numbers, numbers, gains, gains)
def test_torque_is_stiffness_times_lag_plus_damping_times_lag_of_rate(q, v, q_d, v_d, kp, kd):
    tau = pd_torque(*(np.array([x]) for x in (q, v, q_d, v_d, kp, kd)))
    assert tau[0] == pytest.approx(kp * (q_d - q) + kd * (v_d - v))


def test_damping_brakes():
    """Erratum E10: as printed the damping would drive the joint on."""
    one = np.ones(1)
    assert pd_torque(0 * one, one, 0 * one, 0 * one, 0 * one, one)[0] < 0


def test_thesis_preset_gives_the_ankles_the_printed_gains(joints, inertia):
    kp, kd = joint_gains(joints.names, inertia, ActuatorParameters())
    ankles = [i for i, name in enumerate(joints.names) if name in JOINT_GROUPS["ankle"]]
    assert len(ankles) == 6
    assert {(kp[i], kd[i]) for i in ankles} == {THESIS_ANKLE} == {(10000.0, 10.0)}


@pytest.mark.parametrize("preset", ["thesis", "damped"])
def test_every_other_joint_is_damped_by_the_ratio_asked_for(joints, inertia, preset):
    kp, kd = joint_gains(joints.names, inertia, ActuatorParameters(preset=preset, damping_ratio=0.7))
    ratio = kd / (2 * np.sqrt(kp * inertia))
    for name, zeta in zip(joints.names, ratio, strict=True):
        if preset == "damped" or name not in JOINT_GROUPS["ankle"]:
            assert zeta == pytest.approx(0.7), name


def test_stiffness_scale_leaves_named_gains_alone(joints, inertia):
    named = {"RightLegTibiaMotion": PdGains(kp=123.0, kd=4.0)}
    softer, _ = joint_gains(joints.names, inertia, ActuatorParameters("damped", stiffness_scale=0.5, gains=named))
    full, kd = joint_gains(joints.names, inertia, ActuatorParameters("damped", gains=named))
    knee = joints.names.index("RightLegTibiaMotion")
    assert (softer[knee], full[knee], kd[knee]) == (123.0, 123.0, 4.0)
    np.testing.assert_allclose(np.delete(softer, knee), 0.5 * np.delete(full, knee))


def test_left_and_right_have_equal_gains(joints, inertia):
    kp, kd = joint_gains(joints.names, inertia, ActuatorParameters())
    for i, name in enumerate(joints.names):
        twin = joints.names.index(name.replace("Right", "Left"))
        assert (kp[i], kd[i]) == pytest.approx((kp[twin], kd[twin]))


def test_gains_for_no_joint_of_the_body_are_refused_with_the_nearest_name(joints, inertia):
    parameters = ActuatorParameters(gains={"RightLegTibia": PdGains(1.0, 1.0)})
    with pytest.raises(
        ParameterError, match=r"^actuators\.gains\.RightLegTibia: .*42 joints.*did you mean RightLegTibiaMotion\?"
    ):
        joint_gains(joints.names, inertia, parameters)
