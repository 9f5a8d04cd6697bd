"""The two balance levels of the thesis: signs, bounds, and no response without an error."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.balance_levels import (
    FootForceBalanceParameters,
    UpperBodyBalanceParameters,
    desired_foot_forces,
    foot_shift_rate,
    lean_angles,
)
from humanwalk.numerics import Array

WEIGHT = 686.0
LEVEL_1 = FootForceBalanceParameters(compliance=2e-5, time_constant=0.1, max_shift=0.02)
forces = st.tuples(*[st.floats(-5000.0, 5000.0)] * 6).map(lambda f: np.array(f).reshape(2, 3))


def test_both_levels_are_off_by_default() -> None:
    assert not FootForceBalanceParameters().enabled
    assert not UpperBodyBalanceParameters().enabled


@pytest.mark.parametrize("schedule", [(1, 1), (1, 0), (0, 1)])
def test_feet_in_stance_share_the_weight_evenly(schedule: Any) -> None:
    schedule = np.array(schedule, dtype=float)
    desired = desired_foot_forces(schedule, WEIGHT)
    assert desired[:, 2].sum() == pytest.approx(WEIGHT)
    np.testing.assert_array_equal(desired[:, :2], 0.0)
    assert np.unique(desired[schedule == 1, 2]).size == 1
    np.testing.assert_array_equal(desired[schedule == 0], 0.0)


def test_in_flight_no_force_is_desired() -> None:
    np.testing.assert_array_equal(desired_foot_forces(np.zeros(2), WEIGHT), 0.0)


def test_without_a_force_error_the_targets_do_not_move() -> None:
    np.testing.assert_array_equal(foot_shift_rate(np.zeros((2, 3)), np.zeros((2, 3)), LEVEL_1), 0.0)


@pytest.mark.parametrize("axis", range(3))
def test_a_missing_force_moves_the_target_in_the_opposite_direction(axis: int) -> None:
    """A missing vertical force moves the target down, which increases the ground reaction force."""
    force_error = np.zeros((2, 3))
    force_error[0, axis] = 100.0
    rate = foot_shift_rate(np.zeros((2, 3)), force_error, LEVEL_1)
    assert rate[0, axis] < 0
    assert np.count_nonzero(rate) == 1


@given(force_error=forces)
def test_the_shift_converges_to_compliance_times_force_within_its_bound(force_error: Array) -> None:
    shift, dt = np.zeros((2, 3)), 0.01
    for _ in range(200):
        shift = shift + dt * foot_shift_rate(shift, force_error, LEVEL_1)
        assert np.abs(shift).max() <= LEVEL_1.max_shift * (1 + 1e-12)
    np.testing.assert_allclose(shift, np.clip(-2e-5 * force_error, -0.02, 0.02), atol=1e-9)


def test_the_lag_is_of_first_order() -> None:
    force_error = np.array([[0.0, 0.0, 500.0], [0.0, 0.0, 0.0]])
    shift, dt = np.zeros((2, 3)), 1e-4
    for _ in range(round(LEVEL_1.time_constant / dt)):
        shift = shift + dt * foot_shift_rate(shift, force_error, LEVEL_1)
    assert shift[0, 2] == pytest.approx(-0.01 * (1 - np.exp(-1)), rel=1e-3)


@given(forward=st.floats(-0.7, 0.7), height=st.floats(0.5, 1.2), place=st.tuples(*[st.floats(-5, 5)] * 3))
def test_lean_is_the_angle_from_the_ground_normal(
    forward: float, height: float, place: tuple[float, float, float]
) -> None:
    feet = np.array(place)
    com = feet + height * np.array([np.tan(forward), 0.0, 1.0])
    np.testing.assert_allclose(lean_angles(feet, com), [forward, 0.0], atol=1e-9)


def test_an_upright_body_does_not_lean_and_left_is_positive() -> None:
    np.testing.assert_array_equal(lean_angles(np.zeros(3), np.array([0.0, 0.0, 1.0])), 0.0)
    alpha = lean_angles(np.zeros(3), np.array([0.0, 0.1, 1.0]))
    assert alpha[0] == 0.0
    assert alpha[1] == pytest.approx(np.arctan(0.1))
