"""The height of the support: constant on level ground, and the vertical pendulum on stairs."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.step_timing import StepTiming
from humanwalk.walking.support import support_motion
from humanwalk.walking.walking_reference import Phase

TIMING = StepTiming()
FREQUENCY = 3.2
heights = st.floats(-1.0, 1.0)


def state_at(elapsed: float, old: float, stance: float, support: float, phase: Phase | None = None) -> PlannerState:
    stepping = Phase.DOUBLE_SUPPORT if elapsed < TIMING.double_support else Phase.SINGLE_SUPPORT
    feet = Foothold(-0.1j, old), Foothold(0.1j, stance)
    path = PathFollowing().begin(0.0, 0.0)
    return PlannerState(phase or stepping, elapsed, "Left", *feet, support, 0.0, 0.0, path, height=0.9)


@given(heights, st.floats(0.0, 0.52))
def test_on_level_ground_the_support_is_the_ground(height: float, elapsed: float) -> None:
    ground, motion, _ = support_motion(state_at(elapsed, height, height, height), 0.0, FREQUENCY)
    assert (ground, motion.value) == (height, height)
    assert motion[1:] == pytest.approx((0.0, 0.0), abs=1e-12)


@given(heights, heights, heights, st.floats(0.0, 0.52), st.floats(-0.3, 0.3))
def test_it_obeys_the_pendulum(old: float, stance: float, height: float, elapsed: float, shift: float) -> None:
    ground, motion, _ = support_motion(state_at(elapsed, old, stance, height), shift, FREQUENCY)
    assert motion.acceleration == pytest.approx(FREQUENCY**2 * (height - ground), abs=1e-9)
    assert min(old, stance) - 1e-9 <= ground <= max(old, stance) + 1e-9


def test_the_ground_under_the_zero_moment_point_goes_to_the_stance_foot_in_double_support() -> None:
    exchange = TIMING.double_support
    times = (0.0, 0.5 * exchange, exchange, 4.0 * exchange)
    grounds = [support_motion(state_at(t, 0.1, 0.3, 0.2), 0.0, FREQUENCY).ground for t in times]
    assert grounds == pytest.approx([0.1, 0.2, 0.3, 0.3])


@pytest.mark.parametrize("rise", [0.18, -0.18])
def test_on_endless_stairs_it_follows_the_feet_without_a_jump_half_way_between_them(rise: float) -> None:
    period, support, previous = 1e-3, 0.5 * rise, None
    decay = math.exp(-FREQUENCY * TIMING.step)
    wt = FREQUENCY * TIMING.double_support
    shift = rise * (1.0 - math.exp(-wt)) / wt / (1.0 - decay)
    for step in range(1, 30):
        for tick in range(round(TIMING.step / period)):
            state = state_at(tick * period, (step - 1) * rise, step * rise, support)
            motion = support_motion(state, shift, FREQUENCY).motion
            if previous is not None and step > 10:
                assert motion.rate == pytest.approx(previous.rate, abs=0.01)
            if tick == 0 and step > 10:
                assert support == pytest.approx((step - 0.5) * rise, abs=0.15 * abs(rise))
            support += period * motion.rate + 0.5 * period**2 * motion.acceleration
            previous = motion


@pytest.mark.parametrize("phase, goal", [(Phase.STAND, 0.2), (Phase.WEIGHT_SHIFT, 0.3)])
def test_in_standing_it_goes_to_the_mean_of_both_feet_and_then_to_the_first_stance_foot(
    phase: Phase, goal: float
) -> None:
    motion = support_motion(state_at(0.5, 0.1, 0.3, 0.15, phase), 0.0, FREQUENCY).motion
    assert motion.rate == pytest.approx(FREQUENCY * (goal - 0.15))


@given(heights, st.floats(0.0, 0.4))
def test_its_prediction_is_its_motion(height: float, duration: float) -> None:
    state, n = state_at(0.1, 0.0, 0.0, height), 400
    predicted = support_motion(state, 0.05, FREQUENCY).after(duration)
    support, rate = height, support_motion(state, 0.05, FREQUENCY).motion.rate
    for _ in range(n):
        acceleration = FREQUENCY**2 * support
        support += duration / n * (rate + 0.5 * duration / n * acceleration)
        rate += duration / n * acceleration
    assert predicted == pytest.approx(support, abs=5e-3)
