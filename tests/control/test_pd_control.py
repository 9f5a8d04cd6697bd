"""PD law of the joints: its formula, its gains and the step that its explicit form survives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.pd_control import pd_torque

numbers = st.floats(-10.0, 10.0)
gains = st.floats(0.0, 1e4)


@given(numbers, numbers, numbers, numbers, gains, gains)
def test_torque_is_stiffness_times_lag_plus_damping_times_lag_of_rate(q, v, q_d, v_d, kp, kd):
    tau = pd_torque(*(np.array([x]) for x in (q, v, q_d, v_d, kp, kd)))
    assert tau[0] == pytest.approx(kp * (q_d - q) + kd * (v_d - v))


def test_damping_brakes():
    """Erratum E10: as printed the damping would drive the joint on."""
    one = np.ones(1)
    assert pd_torque(0 * one, one, 0 * one, 0 * one, 0 * one, one)[0] < 0
