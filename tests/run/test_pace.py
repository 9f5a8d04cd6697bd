"""The pace on a clock of its own: time runs at the commanded rate, or evenly slower, and never catches up a pause."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.run.pace import MAX_LAG, Pace

STEP = 0.01


class Clock:
    """Time passes only by sleeping and by work."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def walk(pace: Pace, clock: Clock, steps: int, work: float, rate: float = 1.0, first: int = 1) -> list[float]:
    """Times on the clock at which each of the steps, which take `work` seconds, is over."""
    times = []
    for i in range(first, first + steps):
        clock.now += work
        pace.wait(i * STEP, rate)
        times.append(clock.now)
    return times


@given(st.floats(0.1, 2.0), st.floats(0.0, 0.9))
def test_a_fast_machine_keeps_the_rate(rate: float, load: float) -> None:
    clock = Clock()
    pace = Pace(clock, clock.sleep)
    times = walk(pace, clock, 300, load * STEP / rate, rate)
    assert times[-1] - times[0] == pytest.approx(299 * STEP / rate)
    assert pace.factor == pytest.approx(rate)


def test_a_slow_machine_is_evenly_slow_and_the_factor_shows_it() -> None:
    clock = Clock()
    pace = Pace(clock, clock.sleep)
    times = walk(pace, clock, 300, 4.0 * STEP)
    assert {round(later - earlier, 9) for earlier, later in pairwise(times)} == {4.0 * STEP}
    assert pace.factor == pytest.approx(0.25)


def test_a_short_delay_is_made_up_for_and_a_long_one_is_not() -> None:
    clock = Clock()
    pace = Pace(clock, clock.sleep)
    begin = walk(pace, clock, 1, 0.0)[0]
    clock.now += 0.03
    assert walk(pace, clock, 10, 0.0, first=2)[-1] - begin == pytest.approx(10 * STEP)
    begin = clock.now
    clock.now += 2.0
    late = walk(pace, clock, 20, 0.0, first=12)
    assert late[-1] - begin == pytest.approx(2.0 - MAX_LAG + 19 * STEP)


def test_after_a_pause_time_goes_on_at_its_rate() -> None:
    clock = Clock()
    pace = Pace(clock, clock.sleep)
    walk(pace, clock, 10, 0.0)
    clock.now += 60.0
    pace.restart(10 * STEP)
    resumed = clock.now
    assert walk(pace, clock, 10, 0.0, first=11)[-1] - resumed == pytest.approx(10 * STEP)
