"""The clock of a step: durations, landing by time or contact, and the rate for footholds out of reach."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.subject import Subject
from humanwalk.body_units import scaled
from humanwalk.quantity import ParameterError
from humanwalk.walking.step_timing import MAX_DOUBLE_SUPPORT, StepTiming

TIMING = StepTiming()
LOADED, UNLOADED = 2.0 * StepTiming.touchdown_force, 0.5 * StepTiming.touchdown_force


def at_progress(progress: float) -> float:
    return TIMING.double_support + progress * TIMING.single_support


def test_double_and_single_support_make_the_step() -> None:
    assert TIMING.double_support + TIMING.single_support == pytest.approx(TIMING.step)


@given(st.floats(0.05, 2.5))
def test_without_a_walk_ratio_the_step_takes_the_same_time_at_every_speed(speed: float) -> None:
    timing = replace(TIMING, walk_ratio=0.0)
    assert timing.at_velocity(speed) == timing


@given(st.floats(0.05, 2.5), st.floats(0.0, 1.0))
def test_a_careful_step_is_not_longer_than_the_given_duration(speed: float, caution: float) -> None:
    ordinary, step, careful = (TIMING.at_velocity(speed, c).step for c in (0.0, caution, 1.0))
    assert careful == pytest.approx(min(ordinary, TIMING.step))
    assert min(careful, ordinary) - 1e-12 <= step <= ordinary + 1e-12


@given(st.floats(0.05, 2.5), st.floats(-1.0, 1.0))
def test_a_step_to_the_side_is_shorter_up_to_the_given_duration(forward: float, sideways: float) -> None:
    """The feet of a walk to the side are apart by two steps' way in every other step."""
    ordinary, step = TIMING.at_velocity(forward), TIMING.at_velocity(complex(forward, sideways))
    assert min(ordinary.step, TIMING.step) - 1e-12 <= step.step <= ordinary.step + 1e-12
    assert step == TIMING.at_velocity(complex(forward, -sideways))
    if abs(sideways) >= TIMING.sideways_speed:
        assert step.step <= TIMING.step + 1e-12


@given(st.floats(0.05, 2.5))
def test_a_walk_ratio_is_length_times_duration_up_to_the_longest_step(speed: float) -> None:
    timing = replace(TIMING, walk_ratio=0.36).at_velocity(speed)
    if timing.step < TIMING.longest_step:
        assert speed * timing.step**2 == pytest.approx(0.36)
    else:
        assert timing.step == pytest.approx(TIMING.longest_step)
        assert speed * timing.step**2 <= 0.36 * (1.0 + 1e-12)


@given(st.floats(0.3, 3.0), st.floats(0.0, 3.0), st.floats(0.1, 1.0))
def test_double_support_follows_a_power_of_the_duration_up_to_its_longest(
    factor: float, exponent: float, longest: float
) -> None:
    timing = replace(TIMING, double_support_exponent=exponent, longest_double_support=longest)
    stretched, share = timing.stretched(factor), MAX_DOUBLE_SUPPORT * factor * timing.step
    assert stretched.step == pytest.approx(factor * timing.step)
    assert stretched.double_support == pytest.approx(min(factor**exponent * timing.double_support, longest, share))


@given(st.floats(1.0, 3.0))
def test_the_longest_double_support_does_not_shorten_a_longer_one_that_is_given(factor: float) -> None:
    timing = replace(TIMING, double_support=0.3, longest_double_support=0.2)
    assert timing.stretched(factor).double_support == pytest.approx(0.3)


def test_double_support_is_a_longer_part_of_a_slower_walk() -> None:
    """In people 22 % of the cycle at 0.9 m/s and 19 % at 1.4 m/s."""
    slow, fast = (TIMING.at_velocity(speed) for speed in (0.9, 1.4))
    assert slow.double_support / slow.step > 1.1 * fast.double_support / fast.step


def test_a_step_without_time_to_swing_the_leg_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"^double_support: 0\.4 is too long for step 0\.5; allowed: up to 0\.35"):
        StepTiming(step=0.5, double_support=0.4)
    assert StepTiming(step=0.5, double_support=0.35).single_support > 0.0


@given(st.floats(1e-6, 1.0), st.floats(0.05, 3.0))
def test_no_walk_ratio_gives_steps_too_short_to_swing_a_leg(walk_ratio: float, speed: float) -> None:
    assert replace(TIMING, walk_ratio=walk_ratio).at_velocity(speed).step >= 0.38 * TIMING.step - 1e-12


@given(st.floats(0.0, 1.0))
def test_every_walk_ratio_can_be_scaled_to_a_child(walk_ratio: float) -> None:
    child = Subject(mass=20.0, stature=1.1, age=7.0)
    assert scaled(StepTiming(walk_ratio=walk_ratio), child.scale).walk_ratio <= walk_ratio


@pytest.mark.parametrize("speed", [0.0, -0.5])
def test_a_walk_ratio_says_nothing_about_standing_and_walking_backward(speed: float) -> None:
    timing = replace(TIMING, walk_ratio=0.36)
    assert timing.at_velocity(speed) == timing


@given(st.floats(-0.5, 1.5))
def test_the_swing_progresses_from_lift_off_to_touchdown(progress: float) -> None:
    assert TIMING.swing_progress(at_progress(progress)) == pytest.approx(progress, abs=1e-12)


@pytest.mark.parametrize(
    "progress, force, landed",
    [
        (0.5, LOADED, False),
        (0.95 * TIMING.early_touchdown, LOADED, False),
        (1.05 * TIMING.early_touchdown, LOADED, True),
        (1.05 * TIMING.early_touchdown, UNLOADED, False),
        (1.01, UNLOADED, True),
    ],
)
def test_a_swing_ends_by_contact_late_in_the_swing_or_by_time(progress: float, force: float, landed: bool) -> None:
    assert TIMING.has_landed(at_progress(progress), force) is landed


@given(st.floats(0.0, 1.0), st.floats(0.0, 3.0))
def test_the_clock_runs_faster_in_proportion_up_to_its_limit(excess: float, limit: float) -> None:
    rate = TIMING.phase_rate(excess, limit)
    assert 1.0 <= rate <= 1.0 + limit
    if TIMING.phase_rate_gain * excess <= limit:
        assert rate - 1.0 == pytest.approx(TIMING.phase_rate_gain * excess, abs=1e-12)
