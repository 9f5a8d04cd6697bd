"""Footholds stay within reach and never cross the other leg; what is beyond calls for a hurry."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.foot_placement import StepPlacement, foothold_gain

PLACEMENT = StepPlacement()
OUTWARD = {"Left": -1.0, "Right": 1.0}
sides = st.sampled_from(["Left", "Right"])


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), sides)
def test_a_foothold_is_within_reach_and_not_across(x, y, stance):
    foothold, beyond = PLACEMENT.within_reach(complex(x, y), stance)
    assert abs(foothold.real) <= PLACEMENT.longest
    assert PLACEMENT.narrowest <= OUTWARD[stance] * foothold.imag <= PLACEMENT.widest
    assert beyond >= 0.0


@given(st.floats(-0.6, 0.7), st.floats(0.1, 0.34), sides)
def test_what_is_within_reach_is_kept_without_a_hurry(x, width, stance):
    wanted = complex(x, OUTWARD[stance] * width)
    assert PLACEMENT.within_reach(wanted, stance) == (wanted, 0.0)


@pytest.mark.parametrize("wanted", [0.5 - 0.1j, 0.5 + 0.6j, 0.97 + 0.16j, -0.97 + 0.16j])
def test_across_far_beside_far_ahead_and_far_behind_call_for_a_hurry(wanted):
    assert PLACEMENT.within_reach(wanted, "Right")[1] > 0.0


def test_both_sides_are_alike():
    right, hurry_right = PLACEMENT.within_reach(0.4 + 0.9j, "Right")
    left, hurry_left = PLACEMENT.within_reach(0.4 - 0.9j, "Left")
    assert right == left.conjugate()
    assert hurry_right == hurry_left


def test_without_double_support_the_foothold_follows_the_error_itself():
    assert foothold_gain(3.2, 1e-6) == pytest.approx(1.0, abs=1e-5)
    assert foothold_gain(3.2, 0.2) > foothold_gain(3.2, 0.1) > 1.0
