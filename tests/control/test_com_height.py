"""The centre of mass vaults over each stance leg, lower between two steps the faster the walk."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.com_height import ComHeight

HEIGHT = ComHeight()
STEP = 0.52
speeds = st.floats(-1.0, 1.6)


@given(st.floats(0.0, STEP), speeds)
def test_rates_are_derivatives(t, speed):
    h = 1e-5
    before, here, after = (HEIGHT.arc(t + d, STEP, speed) for d in (-h, 0.0, h))
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(here[1], abs=1e-5)
    assert (after[1] - before[1]) / (2 * h) == pytest.approx(here[2], abs=1e-4)


@given(speeds)
def test_the_top_is_as_high_at_every_speed(speed):
    top = HEIGHT.arc(HEIGHT.lowest + 0.5 * STEP, STEP, speed)[0]
    assert top == pytest.approx(HEIGHT.below_top(speed))


def test_it_is_lowest_soon_after_touchdown():
    heights = {t / 100: HEIGHT.arc(t / 100, STEP, 1.4)[0] for t in range(52)}
    assert min(heights, key=heights.get) == pytest.approx(HEIGHT.lowest)


def test_in_standing_there_is_no_arc():
    assert HEIGHT.arc(0.2, STEP, 0.0) == pytest.approx((0.0, 0.0, 0.0))


LEG = 0.91
steps = st.floats(0.0, 1.2)


@given(steps, steps)
def test_the_longer_the_step_the_lower_the_body(apart, ordinary):
    lower = HEIGHT.lower_for(apart, ordinary, LEG)
    assert 0.0 <= lower <= HEIGHT.lower_for(apart + 0.05, ordinary, LEG)
    if apart <= HEIGHT.stretch * max(ordinary, HEIGHT.easy):
        assert lower == 0.0


@given(st.floats(0.7, 1.2))
def test_lowered_legs_reach_as_far_as_straight_ones_did_in_the_ordinary_step(apart):
    bound = HEIGHT.stretch * 0.55
    height = (LEG**2 - (bound / 2) ** 2) ** 0.5 - HEIGHT.lower_for(apart, 0.55, LEG)
    assert (height**2 + (apart / 2) ** 2) ** 0.5 == pytest.approx(LEG)


def test_it_goes_down_for_a_long_step_sooner_than_it_comes_up():
    down, up = (HEIGHT.approach(0.95, 0.0, 0.90, 0.004, stretched)[1] for stretched in (True, False))
    assert down < up < 0.0


def test_the_mean_height_comes_to_its_goal_without_overshoot():
    height, rate = 0.97, 0.0
    for _ in range(1000):
        height, rate, _ = HEIGHT.approach(height, rate, 0.93, 0.004)
        assert height >= 0.93 - 1e-6
    assert height == pytest.approx(0.93, abs=1e-4)
