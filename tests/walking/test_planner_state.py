"""The frame of a step, and the ground under the support."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.terrain import Plane
from humanwalk.walking.commanded_path import CommandedPath
from humanwalk.walking.planner_state import Foothold, PlannerState
from humanwalk.walking.step_timing import StepTiming
from humanwalk.walking.walking_reference import Phase

TIMING = StepTiming()
points = st.builds(complex, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
heights = st.floats(-1.0, 1.0)


def state_on(
    right: Foothold,
    left: Foothold,
    phase: Phase = Phase.DOUBLE_SUPPORT,
    elapsed: float = 0.0,
    support_start: float = 0.0,
    heading: float = 0.0,
) -> PlannerState:
    path = CommandedPath.begin(0.0, heading)
    return PlannerState(phase, elapsed, "Left", right, left, support_start, heading, heading, path, height=0.9)


@given(points)
def test_a_foothold_is_on_the_terrain(position: complex) -> None:
    terrain = Plane(slope=0.1, cross_slope=-0.05)
    right, up = Foothold.on(terrain, position), Foothold.on(terrain, position + 1.0)
    assert right.position == position
    assert up.ground - right.ground == pytest.approx(math.tan(0.1))


@given(points, points, st.floats(-3.0, 3.0))
def test_the_frame_of_the_step_is_at_the_stance_ankle_along_the_heading(
    ankle: complex, point: complex, heading: float
) -> None:
    state = state_on(Foothold(0.0, 0.0), Foothold(ankle, 0.0), heading=heading)
    assert state.world(state.local(point)) == pytest.approx(point, abs=1e-9)
    assert state.local(ankle) == pytest.approx(0.0, abs=1e-9)
    assert state.local(ankle + cmath.exp(1j * heading)) == pytest.approx(1.0, abs=1e-9)


@given(heights, heights, heights)
def test_the_ground_under_the_support_goes_to_the_stance_foot_in_double_support(
    start: float, right: float, left: float
) -> None:
    feet = Foothold(-0.1j, right), Foothold(0.1j, left)
    begin, end = (
        state_on(*feet, elapsed=elapsed, support_start=start).support_ground(TIMING)
        for elapsed in (0.0, TIMING.double_support)
    )
    assert begin == pytest.approx((start, 0.0, 0.0), abs=1e-9)
    assert end == pytest.approx((left, 0.0, 0.0), abs=1e-9)


@given(heights, heights)
def test_the_ground_under_the_support_is_the_mean_of_both_feet_in_standing(right: float, left: float) -> None:
    state = state_on(Foothold(-0.1j, right), Foothold(0.1j, left), Phase.STAND, elapsed=1.0)
    assert state.support_ground(TIMING).value == pytest.approx(0.5 * (right + left), abs=1e-9)
