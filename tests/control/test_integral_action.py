"""Integral action: the integral of a constant error, no windup, and the integral time from which it is stable."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.plant import add_human
from humanwalk.body.subject import Subject
from humanwalk.control.integral_action import integral_update, integrated, require_stable_integral
from humanwalk.control.joint_gains import JointGains, joint_gains
from humanwalk.control.pd_control import PD_LAWS, PdLaw
from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step
from humanwalk.quantity import ParameterError

LAWS = sorted(PD_LAWS)
numbers, gains, steps = st.floats(-10.0, 10.0), st.floats(1.0, 1e4), st.floats(1e-5, 1e-2)
inertias, dampings = st.floats(0.01, 1.0), st.floats(1.0, 100.0)


def one(x: float) -> Array:
    return np.array([x])


@given(numbers, numbers, gains, steps, st.integers(1, 50))
def test_a_constant_error_grows_linearly(start: float, error: float, ki: float, h: float, count: int) -> None:
    torque = one(start)
    for _ in range(count):
        torque = integrated(torque, one(error), one(ki), one(0.0) > 0, h)
    assert torque[0] == pytest.approx(start + count * h * ki * error, rel=1e-9, abs=1e-9)


def test_a_saturated_joint_keeps_its_integral_and_the_others_do_not() -> None:
    torque = integrated(np.array([2.0, 2.0]), np.ones(2), np.ones(2), np.array([True, False]), 0.1)
    np.testing.assert_allclose(torque, [2.0, 2.1])


@pytest.mark.parametrize("law", LAWS)
@given(inertias, gains, dampings, gains, st.floats(0.0, 10.0), steps, st.tuples(numbers, numbers, numbers))
def test_one_joint_steps_by_the_formula(
    law: PdLaw,
    inertia: float,
    kp: Any,
    kd: Any,
    ki: float,
    kx: float,
    h: float,
    state: tuple[float, float, float],
) -> None:
    """(I + D) v' = (I - E) v - h kp q + h z, q' = q + h v', z' = z - h (ki q + kx v)."""
    q, v, z = state
    D, E = (x[0] for x in PD_LAWS[law].impedance(h, one(kp), one(kd)))
    v_next = ((inertia - E) * v - h * kp * q + h * z) / (inertia + D)
    expected = [q + h * v_next, v_next, z - h * (ki * q + kx * v)]
    A = integral_update(h, one(inertia)[:, np.newaxis], one(kp), one(kd), law, one(ki), one(kx))
    np.testing.assert_allclose(A @ state, expected, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("law", LAWS)
@given(inertias, st.floats(100.0, 1e4), dampings)
def test_at_short_steps_the_bound_is_that_of_routh(law: PdLaw, inertia: float, kp: Any, kd: Any) -> None:
    """I s^3 + kd s^2 + kp s + ki is stable while ki I < kp kd; with ki = kp / T_i, while T_i > I / kd."""
    M = one(inertia)[:, np.newaxis]

    def update(rate: float) -> Array:
        return integral_update(1e-6, M, one(kp), one(kd), law, rate * one(kp), one(0.0))

    assert largest_stable_step(update, upper=1e6) == pytest.approx(kd / inertia, rel=0.02)


@pytest.mark.parametrize("law", ["implicit", "semi_implicit"])
def test_the_integral_time_named_by_the_error_is_accepted(law: PdLaw) -> None:
    """The body in neutral standing, at the default step, with the thesis' gains."""
    plant = standing(0.002)
    kp, kd = joint_gains(plant, JointGains())
    with pytest.raises(ParameterError, match=r"^T_i: 0\.001 is unstable at time_step 0\.002 s; allowed: ") as refused:
        require_stable_integral(plant, kp, kd, law, "T_i", 0.001)
    named = float(str(refused.value).partition("allowed: ")[2].split()[0])
    require_stable_integral(plant, kp, kd, law, "T_i", named)
    assert 0.01 < named < 0.1


def test_a_joint_without_stiffness_has_no_integral_and_is_stable() -> None:
    """The balanced controller's gains: damping everywhere, stiffness at few joints."""
    plant = standing(0.002)
    kp, kd = np.zeros(42), np.ones(42)
    require_stable_integral(plant, kp, kd, "semi_implicit", "T_i", 0.1)
    kp[5], kd[5] = 500.0, 10.0
    require_stable_integral(plant, kp, kd, "semi_implicit", "T_i", 0.1)


def test_a_continuous_plant_is_refused(plant: MultibodyPlant) -> None:
    assert plant.time_step() == 0
    with pytest.raises(ParameterError, match=r"^T_i: an integral needs the discrete plant; allowed: .* set it"):
        require_stable_integral(plant, np.ones(42), np.ones(42), "implicit", "T_i", 1.0)


def standing(time_step: float) -> MultibodyPlant:
    """The human as a discrete plant."""
    plant = MultibodyPlant(time_step)
    add_human(plant, Subject())
    plant.Finalize()
    return plant
