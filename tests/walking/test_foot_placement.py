"""Footholds stay within reach and clear of the stance leg; those excess call for a faster clock."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from humanwalk.sides import OUTWARD, SIDES, Side, other_side
from humanwalk.walking.foot_placement import StepPlacement, foothold_gain

PLACEMENT = StepPlacement()
sides = st.sampled_from(["Left", "Right"])


places = st.builds(complex, st.floats(-1.0, 1.0), st.floats(-0.5, 0.5))


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), sides, places)
def test_a_foothold_is_within_reach_and_clear_of_the_stance_leg(
    x: float, y: float, stance: Side, place: complex
) -> None:
    foothold, excess = PLACEMENT.within_reach(complex(x, y), stance, place)
    width = OUTWARD[other_side(stance)] * foothold.imag
    assert abs(foothold.real) <= PLACEMENT.max_length
    assert -PLACEMENT.max_crossover <= width <= PLACEMENT.max_width
    if abs(foothold.real) <= PLACEMENT.abreast:
        assert width >= PLACEMENT.min_width
    assert excess >= 0.0


def crossed_at(x: float) -> float:
    """Length at which a foothold far across the stance foot ends that balance requires x ahead [m]."""
    return PLACEMENT.within_reach(complex(x, -2.0), "Right", complex(x, 0.3))[0].real


@given(st.floats(-1.0, 1.0))
def test_a_foothold_across_is_farther_ahead_or_behind_where_the_legs_are_not_side_by_side(x: float) -> None:
    farthest = PLACEMENT.abreast + PLACEMENT.min_width + PLACEMENT.max_crossover
    if abs(x) >= farthest:
        assert crossed_at(x) == x
    else:
        assert crossed_at(x) == pytest.approx(math.copysign(farthest, x + PLACEMENT.abreast))


@given(st.floats(-0.4, 0.4), st.floats(-0.2, 0.09), st.floats(0.0, 0.1))
def test_the_length_of_a_narrow_foothold_grows_by_half_of_the_missing_width(
    x: float, width: float, narrower: float
) -> None:
    lengths = [abs(PLACEMENT.clear_length(x, w) + PLACEMENT.abreast) for w in (width, width - narrower)]
    assert lengths[1] >= lengths[0] >= abs(x + PLACEMENT.abreast)
    missing = max(PLACEMENT.min_step_width(x) - width, 0.0)
    assert abs(PLACEMENT.clear_length(x, width) - x) <= 0.5 * missing + 1e-12


@given(st.floats(0.16, 0.9), sides)
def test_a_foot_crosses_only_after_it_has_passed_the_stance_foot(x: float, stance: Side) -> None:
    outward = OUTWARD[other_side(stance)]
    desired = complex(x, -outward)
    widths = [outward * PLACEMENT.within_reach(desired, stance, place)[0].imag for place in (-0.4, 0.0, 0.5 * x, x)]
    assert widths[:2] == [PLACEMENT.min_width] * 2
    assert PLACEMENT.min_width >= widths[2] >= widths[3] == PLACEMENT.min_step_width(x)


@given(st.floats(-1.0, 1.0), st.floats(0.0, 0.5))
def test_the_minimum_width_decreases_with_the_distance_ahead_or_behind(x: float, farther: float) -> None:
    assert PLACEMENT.min_step_width(abs(x) + farther) <= PLACEMENT.min_step_width(x) == PLACEMENT.min_step_width(-x)


@given(st.floats(-0.6, 0.7), st.floats(0.1, 0.29), sides)
def test_a_foothold_within_reach_is_not_moved_and_keeps_the_clock(x: float, width: float, stance: Side) -> None:
    desired = complex(x, OUTWARD[other_side(stance)] * width)
    assert PLACEMENT.within_reach(desired, stance, 0.0) == (desired, 0.0)


@pytest.mark.parametrize("desired", [0.5 - 0.1j, 0.5 + 0.6j, 0.97 + 0.16j, -0.97 + 0.16j])
def test_footholds_across_wide_far_ahead_and_far_behind_call_for_a_faster_clock(desired: complex) -> None:
    assert PLACEMENT.within_reach(desired, "Right", 0.0)[1] > 0.0


@given(st.floats(-0.5, 0.5), st.floats(-1.0, 1.5), sides)
def test_in_double_support_footholds_across_and_wide_ones_call_for_a_faster_clock(
    x: float, width: float, stance: Side
) -> None:
    outward = OUTWARD[other_side(stance)]
    beside = complex(-0.4, outward * 0.15)
    excess = PLACEMENT.double_support_excess(complex(x, outward * width), stance, beside)
    assert excess == pytest.approx(max(-width, width - PLACEMENT.speedup_width, 0.0))


def test_a_foot_that_is_itself_across_does_not_hurry_to_cross() -> None:
    for stance in SIDES:
        outward = OUTWARD[other_side(stance)]
        across = complex(-0.4, -0.05 * outward)
        assert PLACEMENT.double_support_excess(-1j * outward, stance, across) == 0.0
        assert PLACEMENT.double_support_excess(1j * outward, stance, across) > 0.0


def test_left_and_right_are_mirror_images() -> None:
    right, excess_right = PLACEMENT.within_reach(0.4 + 0.9j, "Right", 0.2)
    left, excess_left = PLACEMENT.within_reach(0.4 - 0.9j, "Left", 0.2)
    assert right == left.conjugate()
    assert excess_right == excess_left


def test_the_foothold_gain_tends_to_one_without_double_support() -> None:
    assert foothold_gain(3.2, 1e-6) == pytest.approx(1.0, abs=1e-5)
    assert foothold_gain(3.2, 0.2) > foothold_gain(3.2, 0.1) > 1.0


ways = st.tuples(st.floats(-0.6, 0.6), st.floats(-0.2, 0.3), st.floats(-0.6, 0.6), st.floats(-0.2, 0.85))
"""x and width of a foot and of its foothold."""


@given(st.floats(-0.2, 0.3), ways, st.floats(0.0, 0.1), st.floats(0.0, 0.1), sides)
def test_only_a_foot_whose_way_or_straight_way_would_hit_the_stance_foot_has_a_waypoint(
    start: float, ends: tuple[float, float, float, float], bend: float, toe_in: float, stance: Side
) -> None:
    outward = OUTWARD[other_side(stance)]
    x, width, goal, goal_width = ends
    share = np.linspace(0.0, 1.0, 9)
    along, across = x + share * (goal - x), width + share * (goal_width - width) - bend * np.sin(np.pi * share)
    way = (along + 1j * outward * across).tolist()
    waypoint = PLACEMENT.passing_waypoint(complex(-0.6, outward * start), way, stance, toe_in)
    places = [(0.0, width - x / (goal - x) * (goal_width - width))] if x * goal < 0.0 else []
    places += zip(along.tolist(), across.tolist(), strict=True)
    room = min(w - toe_in - PLACEMENT.min_step_width(place) for place, w in places)
    assume(abs(room) > 1e-9 and abs(x * goal) > 1e-9)
    assert (waypoint is not None) == (x * goal < 0.0 and room < 0.0)
    comes_from_across = start < PLACEMENT.min_own_side_offset
    before = np.clip(abs(x) - PLACEMENT.abreast, 0.0, PLACEMENT.abreast) if comes_from_across else 0.0
    passing = math.copysign(before, x)
    if waypoint is not None:
        point, fraction = waypoint
        assert point == complex(passing, outward * (PLACEMENT.passing_distance + toe_in))
        assert x + fraction * (goal - x) == pytest.approx(passing, abs=1e-9)


@given(st.floats(-1.5, 1.5), st.floats(-0.5, 0.5), st.floats(-0.5, 0.8))
def test_a_foothold_is_within_reach_of_the_center_of_mass_at_touchdown(x: float, y: float, com: float) -> None:
    foothold = PLACEMENT.near_com(complex(x, y), complex(com, 0.1))
    assert abs(foothold.real - com) <= PLACEMENT.max_com_distance + 1e-12
    assert foothold.imag == y
    if abs(x - com) <= PLACEMENT.max_com_distance:
        assert foothold.real == x
