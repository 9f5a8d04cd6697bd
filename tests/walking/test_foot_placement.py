"""Footholds stay within reach and out of the other leg's way; what is beyond calls for a hurry."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.foot_placement import StepPlacement, foothold_gain

PLACEMENT = StepPlacement()
OUTWARD = {"Left": -1.0, "Right": 1.0}
sides = st.sampled_from(["Left", "Right"])


places = st.builds(complex, st.floats(-1.0, 1.0), st.floats(-0.5, 0.5))


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), sides, places)
def test_a_foothold_is_within_reach_and_not_in_the_other_leg(x, y, stance, place):
    foothold, beyond = PLACEMENT.within_reach(complex(x, y), stance, place)
    width = OUTWARD[stance] * foothold.imag
    assert abs(foothold.real) <= PLACEMENT.longest
    assert -PLACEMENT.across <= width <= PLACEMENT.widest
    if abs(foothold.real) <= PLACEMENT.beside:
        assert width >= PLACEMENT.narrowest
    assert beyond >= 0.0


@given(st.floats(0.16, 0.9), sides)
def test_a_foot_crosses_only_once_it_has_passed_the_other(x, stance):
    wanted = complex(x, -OUTWARD[stance])
    widths = [
        OUTWARD[stance] * PLACEMENT.within_reach(wanted, stance, place)[0].imag for place in (-0.4, 0.0, 0.5 * x, x)
    ]
    assert widths[:2] == [PLACEMENT.narrowest] * 2
    assert PLACEMENT.narrowest >= widths[2] >= widths[3] == PLACEMENT.least_width(x)


@given(st.floats(-1.0, 1.0), st.floats(0.0, 0.5))
def test_the_farther_before_or_behind_the_narrower_it_may_be(x, farther):
    assert PLACEMENT.least_width(abs(x) + farther) <= PLACEMENT.least_width(x) == PLACEMENT.least_width(-x)


@given(st.floats(-0.6, 0.7), st.floats(0.1, 0.34), sides)
def test_what_is_within_reach_is_kept_without_a_hurry(x, width, stance):
    wanted = complex(x, OUTWARD[stance] * width)
    assert PLACEMENT.within_reach(wanted, stance, 0.0) == (wanted, 0.0)


@pytest.mark.parametrize("wanted", [0.5 - 0.1j, 0.5 + 0.6j, 0.97 + 0.16j, -0.97 + 0.16j])
def test_across_far_beside_far_ahead_and_far_behind_call_for_a_hurry(wanted):
    assert PLACEMENT.within_reach(wanted, "Right", 0.0)[1] > 0.0


@given(st.floats(-0.5, 0.5), st.floats(-1.0, 1.5), sides)
def test_a_foot_is_late_to_leave_when_it_is_wanted_across(x, width, stance):
    beside = complex(-0.4, OUTWARD[stance] * 0.15)
    across = PLACEMENT.late_lift_off(complex(x, OUTWARD[stance] * width), stance, beside)
    assert across == pytest.approx(max(-width, 0.0))


def test_a_foot_that_is_across_itself_takes_its_time_to_leave():
    for side, outward in OUTWARD.items():
        assert PLACEMENT.late_lift_off(1j * outward, side, complex(-0.4, -0.05 * outward)) == 0.0


def test_both_sides_are_alike():
    right, hurry_right = PLACEMENT.within_reach(0.4 + 0.9j, "Right", 0.2)
    left, hurry_left = PLACEMENT.within_reach(0.4 - 0.9j, "Left", 0.2)
    assert right == left.conjugate()
    assert hurry_right == hurry_left


def test_without_double_support_the_foothold_follows_the_error_itself():
    assert foothold_gain(3.2, 1e-6) == pytest.approx(1.0, abs=1e-5)
    assert foothold_gain(3.2, 0.2) > foothold_gain(3.2, 0.1) > 1.0


@given(st.floats(-0.6, 0.6), st.floats(-0.2, 0.3), st.floats(-0.6, 0.6), sides)
def test_only_a_foot_that_would_run_into_the_other_goes_round_it(x, width, goal, stance):
    outward = OUTWARD[stance]
    way_round = PLACEMENT.way_round(complex(x, outward * width), complex(goal, outward * 0.16), stance)
    if width >= PLACEMENT.narrowest or x * goal >= 0.0:
        assert way_round is None
    else:
        place, share = way_round
        assert place == complex(0.0, outward * PLACEMENT.passing)
        assert x + share * (goal - x) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-1.5, 1.5), st.floats(-0.5, 0.5), st.floats(-0.5, 0.8))
def test_a_foothold_is_where_a_leg_of_the_body_that_comes_there_reaches(x, y, com):
    foothold = PLACEMENT.near_body(complex(x, y), complex(com, 0.1))
    assert abs(foothold.real - com) <= PLACEMENT.reach + 1e-12
    assert foothold.imag == y
    if abs(x - com) <= PLACEMENT.reach:
        assert foothold.real == x
