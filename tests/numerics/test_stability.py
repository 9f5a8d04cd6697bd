"""The largest stable step of a linear update, and of the support on the body."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.control.balance_support import BalanceSupportParameters, largest_support_step
from humanwalk.numerics.stability import largest_stable_step, round_down


@given(rate=st.floats(30.0, 1e5))
def test_euler_on_a_decaying_exponential_is_stable_up_to_two_over_its_rate(rate):
    step = largest_stable_step(lambda h: np.array([[1.0 - h * rate]]))
    assert step == pytest.approx(2.0 / rate, rel=0.011)
    assert step <= 2.0 / rate * (1 + 1e-6)


@given(step=st.floats(1e-6, 1.0))
def test_a_rounded_step_is_no_longer_and_keeps_two_digits(step):
    rounded = round_down(step)
    assert 0.9 * step < rounded <= step * (1 + 1e-9)
    assert float(f"{rounded:.2g}") == pytest.approx(rounded, rel=1e-9)


@given(mass=st.floats(1.0, 100.0), damping=st.floats(1e3, 1e5))
def test_a_damped_block_is_stable_as_euler_says(mass, damping):
    """Without joints or stiffness each direction is v' = (1 - h d / m) v."""
    support = BalanceSupportParameters(stiffness=0.0, damping=damping, rotational_stiffness=0.0, rotational_damping=0.0)
    step = largest_support_step(mass * np.eye(6), np.array([]), np.array([]), support, upper=1.0)
    assert step == pytest.approx(min(1.0, 2.0 * mass / damping), rel=0.011)


def test_stiff_joints_let_the_support_take_longer_steps():
    """Held joints make the pelvis carry more inertia."""
    plant = kinematics_plant(Subject())
    M = base_first_mass_matrix(plant, plant.CreateDefaultContext())
    n = M.shape[0] - 6
    support = BalanceSupportParameters()
    loose = largest_support_step(M, np.zeros(n), np.zeros(n), support)
    held = largest_support_step(M, np.full(n, 1e4), np.full(n, 1e2), support)
    assert loose < held
