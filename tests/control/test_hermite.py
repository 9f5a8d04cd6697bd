"""Cubic Hermite interpolation between two states."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.hermite import hermite
from humanwalk.numerics import Array

numbers = st.floats(-5.0, 5.0)
states = st.tuples(*[numbers] * 4).map(np.array)
shares = st.floats(0.0, 1.0)


@given(x0=states, x1=states)
def test_it_passes_through_both_samples(x0: Array, x1: Array) -> None:
    np.testing.assert_allclose(hermite(1.0, 1.0, x0, 1.5, x1), x0, atol=1e-12)
    np.testing.assert_allclose(hermite(1.5, 1.0, x0, 1.5, x1), x1, atol=1e-12)


@given(x0=states, x1=states, share=st.floats(-0.5, 1.5))
def test_velocity_is_the_derivative_of_position(x0: Array, x1: Array, share: float) -> None:
    t0, t1, h = 0.3, 0.5, 1e-6
    t = t0 + share * (t1 - t0)
    before, after = (hermite(t + e, t0, x0, t1, x1)[:2] for e in (-h, h))
    np.testing.assert_allclose(hermite(t, t0, x0, t1, x1)[2:], (after - before) / (2 * h), atol=2e-2)


@given(coefficients=st.tuples(*[numbers] * 4), share=shares)
def test_a_cubic_is_reproduced(coefficients: tuple[float, float, float, float], share: float) -> None:
    polynomial = np.polynomial.Polynomial(coefficients)

    def state(t: float) -> Array:
        return np.array([polynomial(t), polynomial.deriv()(t)])

    t0, t1 = -0.4, 0.7
    t = t0 + share * (t1 - t0)
    np.testing.assert_allclose(hermite(t, t0, state(t0), t1, state(t1)), state(t), atol=1e-9)


@given(x0=states, x1=states, share=st.floats(0.001, 1.0))
def test_outside_the_samples_it_is_a_first_order_hold(x0: Array, x1: Array, share: float) -> None:
    (q0, v0), (q1, v1) = np.split(x0, 2), np.split(x1, 2)
    np.testing.assert_allclose(hermite(1.0 - share, 1.0, x0, 1.5, x1), [*(q0 - share * v0), *v0], atol=1e-12)
    np.testing.assert_allclose(hermite(1.5 + share, 1.0, x0, 1.5, x1), [*(q1 + share * v1), *v1], atol=1e-12)


@pytest.mark.parametrize("t", [1.0, 2.0])
def test_of_two_samples_at_one_time_the_second_is_used(t: float) -> None:
    actual = hermite(t, 1.0, np.array([9.0, 9.0]), 1.0, np.array([0.5, 2.0]))
    np.testing.assert_allclose(actual, [0.5 + 2.0 * (t - 1.0), 2.0])
