"""Cubic Hermite interpolation between two states."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.hermite import HermitePiece

numbers = st.floats(-5.0, 5.0)
states = st.tuples(*[numbers] * 4).map(np.array)
shares = st.floats(0.0, 1.0)


@given(x0=states, x1=states)
def test_it_has_both_states_at_their_times(x0, x1):
    np.testing.assert_allclose(HermitePiece.between(1.0, x0, 1.5, x1).at(1.0), x0, atol=1e-12)
    np.testing.assert_allclose(HermitePiece.between(1.0, x0, 1.5, x1).at(1.5), x1, atol=1e-12)


@given(x0=states, x1=states, share=st.floats(-0.5, 1.5))
def test_velocity_is_the_derivative_of_position(x0, x1, share):
    t0, t1, h = 0.3, 0.5, 1e-6
    t = t0 + share * (t1 - t0)
    piece = HermitePiece.between(t0, x0, t1, x1)
    before, after = (piece.at(t + e)[:2] for e in (-h, h))
    np.testing.assert_allclose(piece.at(t)[2:], (after - before) / (2 * h), atol=2e-2)


@given(coefficients=st.tuples(*[numbers] * 4), share=shares)
def test_a_cubic_is_met_exactly(coefficients, share):
    polynomial = np.polynomial.Polynomial(coefficients)

    def state(t):
        return np.array([polynomial(t), polynomial.deriv()(t)])

    t0, t1 = -0.4, 0.7
    t = t0 + share * (t1 - t0)
    np.testing.assert_allclose(HermitePiece.between(t0, state(t0), t1, state(t1)).at(t), state(t), atol=1e-9)


@given(x0=states, x1=states, share=st.floats(-0.5, 1.5))
def test_an_affine_function_of_the_piece_is_that_of_its_value(x0, x1, share):
    gain, constant = np.array((2.0, -3.0, 0.5, 7.0)), np.array([11.0])
    piece, t = HermitePiece.between(0.3, x0, 0.5, x1), 0.3 + 0.2 * share
    mapped = piece.mapped(lambda rows: rows @ gain[:, None], constant)
    np.testing.assert_allclose(mapped.at(t), piece.at(t) @ gain + constant, atol=1e-9)


@pytest.mark.parametrize("t", [1.0, 2.0])
def test_two_samples_of_one_time_count_as_the_second(t):
    piece = HermitePiece.between(1.0, np.array([9.0, 9.0]), 1.0, np.array([0.5, 2.0]))
    np.testing.assert_allclose(piece.at(t), [0.5 + 2.0 * (t - 1.0), 2.0])
