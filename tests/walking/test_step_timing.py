"""The clock of a step: durations, landing by time or contact, and the rate for footholds out of reach."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.step_timing import StepTiming

TIMING = StepTiming()
LOADED, UNLOADED = 2.0 * StepTiming.touchdown_force, 0.5 * StepTiming.touchdown_force


def at_progress(progress: float) -> float:
    return TIMING.double_support + progress * TIMING.single_support


def test_double_and_single_support_make_the_step() -> None:
    assert TIMING.double_support + TIMING.single_support == pytest.approx(TIMING.step)


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
