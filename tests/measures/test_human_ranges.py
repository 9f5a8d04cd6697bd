"""Human ranges of measures: how they depend on speed and leg length."""

import pytest

from humanwalk.body import human
from humanwalk.measures.human_ranges import (
    Pace,
    people_com_excursion,
    people_double_support,
    people_late_stance_knee,
    people_speed,
    people_stance,
    people_step_width,
    people_steps,
)

LEG = human().hip_height


@pytest.mark.parametrize("speed", [0.9, 1.2, 1.4])
@pytest.mark.parametrize("leg", [0.75, 0.95])
def test_human_steps_have_the_speed_and_the_walk_ratio(speed: float, leg: float) -> None:
    length, cadence = people_steps(Pace(speed, leg))
    assert length.low < length.high
    assert length.low * cadence.high / 60.0 == pytest.approx(speed)
    assert length.high * cadence.low / 60.0 == pytest.approx(speed)


@pytest.mark.parametrize("size", [0.6, 1.1])
def test_steps_of_dynamically_similar_people_are_in_proportion(size: float) -> None:
    pace, similar = Pace(1.2, 0.9), Pace(1.2 * size**0.5, 0.9 * size)
    (length, cadence), (length_there, cadence_there) = people_steps(pace), people_steps(similar)
    width, width_there = people_step_width(pace), people_step_width(similar)
    for end in ("low", "high"):
        assert getattr(length_there, end) == pytest.approx(size * getattr(length, end))
        assert getattr(cadence_there, end) == pytest.approx(size**-0.5 * getattr(cadence, end))
        assert getattr(width_there, end) == pytest.approx(size * getattr(width, end))


@pytest.mark.parametrize("size", [0.6, 0.8, 1.1])
def test_ranges_of_dynamically_similar_people_are_in_proportion(size: float) -> None:
    pace, similar = Pace(1.2, 0.9), Pace(1.2 * size**0.5, 0.9 * size)
    assert people_stance(similar).low == pytest.approx(people_stance(pace).low)
    assert people_speed(similar).high == pytest.approx(people_speed(pace).high * size**0.5)
    for direction in ("vertical", "lateral"):
        there, here = (people_com_excursion(direction, at) for at in (similar, pace))
        assert there is not None
        assert here is not None
        assert (there.low, there.high) == pytest.approx((size * here.low, size * here.high))


def test_people_stand_on_both_feet_as_long_as_two_stances_exceed_a_stride() -> None:
    stance, both = people_stance(Pace(1.2, LEG)), people_double_support(Pace(1.2, LEG))
    assert (1.0 + both.low, 1.0 + both.high) == pytest.approx((2.0 * stance.low, 2.0 * stance.high))


def test_human_stance_is_shorter_in_faster_walks() -> None:
    slow, fast = people_stance(Pace(0.9, LEG)), people_stance(Pace(1.4, LEG))
    assert fast.low < slow.low
    # The 60 % of the textbooks.
    textbook = people_stance(Pace(1.2, LEG))
    assert textbook.low < 0.6 < textbook.high


@pytest.mark.parametrize("direction", ["vertical", "lateral"])
def test_human_excursion_is_given_between_the_speeds_of_the_source(direction: str) -> None:
    assert people_com_excursion(direction, Pace(0.6, LEG)) is None
    assert people_com_excursion(direction, Pace(1.7, LEG)) is None
    slow, middle, fast = (people_com_excursion(direction, Pace(speed, LEG)) for speed in (0.7, 1.15, 1.6))
    assert middle.low == pytest.approx((slow.low + fast.low) / 2)
    # A faster walk rises more and sways less.
    assert (fast.high > slow.high) == (direction == "vertical")


def test_people_choose_speeds_of_the_free_group() -> None:
    speed = people_speed(Pace(1.2, LEG))
    assert speed.low < speed.high
    assert {Pace(end, LEG).group for end in (speed.low, speed.high)} == {"free"}


def test_human_knee_is_nearly_straight_in_terminal_stance() -> None:
    knee = people_late_stance_knee(Pace(1.2, LEG))
    assert 0.0 < knee.low < knee.high < 15.0
