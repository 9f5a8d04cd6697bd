"""PD law of the joints: its formula, its gains and the step that its explicit form survives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.pd_control import (
    THESIS_ANKLE,
    ActuatorParameters,
    PdGains,
    is_ankle,
    joint_gains,
    largest_explicit_step,
    largest_semi_implicit_step,
    pd_torque,
    preset_stiffness,
)
from humanwalk.quantity import ParameterError

numbers = st.floats(-10.0, 10.0)
gains = st.floats(0.0, 1e4)


@pytest.fixture(scope="module")
def mass_matrix(plant, joints):
    """Mass matrix in neutral standing, floating base first, joints in actuator order."""
    M = plant.CalcMassMatrix(plant.CreateDefaultContext())
    base = np.setdiff1d(np.arange(len(M)), joints.v)
    order = np.concatenate((base, joints.v))
    return M[np.ix_(order, order)]


@pytest.fixture(scope="module")
def inertia(mass_matrix):
    return mass_matrix.diagonal()[6:]


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
    ankles = [i for i, name in enumerate(joints.names) if is_ankle(name)]
    assert len(ankles) == 6
    assert {(kp[i], kd[i]) for i in ankles} == {THESIS_ANKLE} == {(10000.0, 10.0)}


@pytest.mark.parametrize("preset", ["thesis", "damped"])
def test_every_other_joint_is_damped_by_the_ratio_asked_for(joints, inertia, preset):
    kp, kd = joint_gains(joints.names, inertia, ActuatorParameters(preset=preset, damping_ratio=0.7))
    ratio = kd / (2 * np.sqrt(kp * inertia))
    for name, zeta in zip(joints.names, ratio, strict=True):
        if preset == "damped" or not is_ankle(name):
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


def test_a_joint_without_preset_is_named():
    with pytest.raises(ParameterError, match=r"^Tail: no preset stiffness"):
        preset_stiffness("Tail")


@pytest.mark.parametrize(("kp", "kd"), [(1e4, 0.0), (100.0, 10.0), (1e4, 10.0)])
def test_the_stable_step_of_one_joint_is_the_textbooks(kp, kd):
    """Semi-implicit Euler of I q'' = -kp q - kd q' is stable while kp h^2 + 2 kd h < 4 I."""
    inertia = 0.01
    h = largest_explicit_step(np.array([[inertia]]), np.array([kp]), np.array([kd]))
    exact = (-kd + np.sqrt(kd**2 + 4 * inertia * kp)) / kp
    assert exact / 1.02 < h <= exact * (1 + 1e-6)


def test_a_lighter_body_needs_a_shorter_step():
    kp, kd = np.array([1e4]), np.array([10.0])
    heavy, light = (largest_explicit_step(np.array([[i]]), kp, kd) for i in (0.01, 0.001))
    assert light < heavy / 3


def test_gentle_gains_are_stable_at_the_longest_step_looked_at():
    assert largest_explicit_step(np.array([[1.0]]), np.array([1.0]), np.array([0.1]), upper=0.05) == 0.05


def test_a_free_base_makes_joints_lighter_and_the_step_shorter(mass_matrix, joints, inertia):
    kp, kd = joint_gains(joints.names, inertia, ActuatorParameters())
    floating, held = (largest_explicit_step(M, kp, kd) for M in (mass_matrix, mass_matrix[6:, 6:]))
    assert floating <= held * 1.01


@given(kp=st.floats(1.0, 1e5), kd=st.floats(0.0, 100.0))
def test_the_stable_semi_implicit_step_of_one_joint_is_the_textbooks(kp, kd):
    """(I + h kd) q'' = -kp q is stable while kp h^2 < 4 I + 2 kd h."""
    inertia = 0.1
    h = largest_semi_implicit_step(np.array([[inertia]]), np.array([kp]), np.array([kd]))
    limit = (kd + np.sqrt(kd**2 + 4 * kp * inertia)) / kp
    assert h == pytest.approx(min(0.1, limit), rel=0.011)
