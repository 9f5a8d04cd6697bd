"""The largest stable step of a linear update."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.numerics.stability import largest_stable_step, round_down, round_up


@given(rate=st.floats(30.0, 1e5))
def test_euler_on_a_decaying_exponential_is_stable_up_to_two_over_its_rate(rate: float) -> None:
    step = largest_stable_step(lambda h: np.array([[1.0 - h * rate]]))
    assert step == pytest.approx(2.0 / rate, rel=0.011)
    assert step <= 2.0 / rate * (1 + 1e-6)


@given(step=st.floats(1e-6, 1.0))
def test_a_rounded_step_is_no_longer_and_keeps_two_digits(step: float) -> None:
    rounded = round_down(step)
    assert 0.9 * step < rounded <= step * (1 + 1e-9)
    assert float(f"{rounded:.2g}") == pytest.approx(rounded, rel=1e-9)


@given(value=st.floats(1e-6, 1e3))
def test_a_value_rounded_up_is_no_smaller_and_keeps_two_digits(value: float) -> None:
    rounded = round_up(value)
    assert value * (1 - 1e-9) <= rounded < 1.1 * value
    assert float(f"{rounded:.2g}") == pytest.approx(rounded, rel=1e-9)
