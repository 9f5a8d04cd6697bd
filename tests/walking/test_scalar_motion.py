"""Scalar motions: derivatives are consistent under sums, changes of the clock and quintic blends."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.scalar_motion import ScalarMotion, blend

numbers = st.floats(-10.0, 10.0)
motions = st.builds(ScalarMotion, numbers, numbers, numbers)


@given(motions, motions)
def test_the_sum_adds_values_rates_and_accelerations(a, b):
    assert a.plus(b) == pytest.approx([x + y for x, y in zip(a, b, strict=True)])


@given(numbers, numbers, st.floats(0.1, 2.0), st.floats(0.1, 3.0))
def test_a_faster_clock_shortens_a_blend(start, end, time, factor):
    slow = blend(start, end, factor * time, 2.0).time_scaled(factor)
    assert slow == pytest.approx(blend(start, end, time, 2.0 / factor), abs=1e-6)


@given(numbers, numbers, st.floats(0.1, 2.0))
def test_a_blend_rests_before_its_start_and_after_its_end(start, end, duration):
    assert blend(start, end, -0.1, duration) == pytest.approx((start, 0.0, 0.0), abs=1e-9)
    assert blend(start, end, duration + 0.1, duration) == pytest.approx((end, 0.0, 0.0), abs=1e-9)


@given(numbers, numbers, st.floats(0.01, 0.99))
def test_rates_of_a_blend_are_derivatives(start, end, time):
    h = 1e-5
    before, here, after = (blend(start, end, time + d, 1.0) for d in (-h, 0.0, h))
    assert (after.value - before.value) / (2 * h) == pytest.approx(here.rate, abs=1e-4)
    assert (after.rate - before.rate) / (2 * h) == pytest.approx(here.acceleration, abs=1e-4)
