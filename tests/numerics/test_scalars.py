"""Scalar functions: angles, bounds, and the quintic with its derivatives."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.numerics.scalars import clip, quintic_blend, wrapped


@given(st.floats(-1e3, 1e3))
def test_a_wrapped_angle_is_the_same_direction(angle: float) -> None:
    assert abs(wrapped(angle)) <= math.pi
    assert cmath.rect(1.0, wrapped(angle)) == pytest.approx(cmath.rect(1.0, angle), abs=1e-9)


@given(st.floats(-5.0, 5.0))
def test_clip_returns_the_nearest_number_of_an_interval(x: float) -> None:
    clipped = clip(x, -1.0, 2.0)
    assert -1.0 <= clipped <= 2.0
    assert all(abs(x - clipped) <= abs(x - y) for y in (-1.0, 0.0, 0.7, 2.0))


def test_the_quintic_rests_at_both_ends() -> None:
    assert quintic_blend(0.0) == pytest.approx((0.0, 0.0, 0.0))
    assert quintic_blend(1.0) == pytest.approx((1.0, 0.0, 0.0))


def test_the_quintic_and_its_derivatives_are_those_of_its_polynomial() -> None:
    quintic = np.polynomial.Polynomial((0.0, 0.0, 0.0, 10.0, -15.0, 6.0))
    s = np.linspace(0.0, 1.0, 101)
    for order, values in enumerate(quintic_blend(s)):
        np.testing.assert_allclose(values, quintic.deriv(order)(s), atol=1e-12)
