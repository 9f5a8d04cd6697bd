"""The height of the center of mass follows its law, and is low enough for the legs to reach the next foothold."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.footholds import LEVEL, Foothold
from humanwalk.walking.height_planner import HeightPlanner, Touchdown
from humanwalk.walking.motions import ScalarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.preview import Preview
from humanwalk.walking.support import SupportMotion
from humanwalk.walking.walking_reference import Phase

PARAMETERS = StepPlannerParameters()
LAW, STEP = PARAMETERS.height, PARAMETERS.timing.step
COM_HEIGHT, LEG, PERIOD = 0.98, 0.864, 0.004
PLANNER = HeightPlanner(PARAMETERS, COM_HEIGHT, LEG, PERIOD)
LEVEL_SUPPORT = SupportMotion(0.0, ScalarMotion(0.0), 3.2)
speeds = st.floats(0.0, LAW.fast_speed)


def on(position: complex, ground: float) -> Foothold:
    return Foothold(position, ground, LEVEL._replace(intercept=ground))


def state_at(
    phase: Phase = Phase.SINGLE_SUPPORT, height: float = 0.95, rise: float | None = None, ground: float = 0.0
) -> PlannerState:
    """On the left foot; the next foothold is 0.6 m ahead, and higher by the rise."""
    path, riser = PathFollowing().begin(0.0, 0.0), rise or 0.0
    feet = on(-0.6 - 0.1j, ground - riser), on(0.1j, ground)
    footholds = () if rise is None else (on(0.6 - 0.1j, ground + rise), on(1.2 + 0.1j, ground + 2.0 * rise))
    state = PlannerState(phase, 0.3, "Left", *feet, ground, 0.0, 0.0, path, height=height)
    return state._replace(preview=Preview(footholds=footholds))


def settled(state: PlannerState, speed: float, highest: float = math.inf) -> PlannerState:
    for _ in range(round(5.0 / PERIOD)):
        state, _ = PLANNER.advanced(state, LEVEL_SUPPORT, speed, highest)
    return state


@given(speeds, st.floats(0.85, 1.0))
def test_the_mean_height_settles_at_that_of_the_speed(speed: float, height: float) -> None:
    state = settled(state_at(height=height), speed)
    assert state.height == pytest.approx(LAW.mean(speed, STEP, COM_HEIGHT), abs=1e-6)
    assert state.height_rate == pytest.approx(0.0, abs=1e-6)


@given(st.floats(0.85, 1.0))
def test_in_standing_it_settles_at_the_height_of_standing(height: float) -> None:
    assert settled(state_at(Phase.STAND, height), 0.0).height == pytest.approx(LAW.standing * COM_HEIGHT, abs=1e-6)


@given(st.floats(0.7, 0.9))
def test_it_settles_at_the_highest_from_which_the_legs_reach(highest: float) -> None:
    assert settled(state_at(), 0.8, highest).height == pytest.approx(highest, abs=1e-6)


@given(speeds, st.floats(-0.5, 0.5), st.floats(-1.0, 1.0))
def test_the_reference_is_the_sum_of_support_mean_and_arc(speed: float, support: float, rate: float) -> None:
    state, moved = state_at(), ScalarMotion(support, rate, 0.3)
    after, reference = PLANNER.advanced(state, SupportMotion(0.0, moved, 3.2), speed)
    arc = LAW.arc(state.elapsed, STEP, speed)
    assert reference.value == pytest.approx(support + state.height + arc.value)
    assert reference.rate == pytest.approx(rate + state.height_rate + arc.rate)
    assert after.support == pytest.approx(support + PERIOD * rate + 0.5 * PERIOD**2 * 0.3)


def test_without_a_planned_foothold_nothing_limits_it() -> None:
    assert PLANNER.highest(state_at()) == math.inf


@pytest.mark.parametrize("direction", [1.0, -1.0], ids=["up", "down"])
def test_a_higher_riser_is_climbed_and_descended_with_a_lower_body(direction: float) -> None:
    low, high = (PLANNER.highest(state_at(rise=direction * rise)._replace(elapsed=STEP)) for rise in (0.1, 0.2))
    assert high < low < COM_HEIGHT + LAW.heel_rise


@given(st.floats(0.0, 0.4))
def test_a_foothold_far_from_the_center_of_mass_at_touchdown_needs_a_lower_body(more: float) -> None:
    state = state_at(rise=0.0)
    foothold = state.preview.footholds[0]
    near, far = (Touchdown(foothold, foothold.position - reach, 0.0) for reach in (0.3, 0.3 + more))
    assert PLANNER.highest(state, far) <= PLANNER.highest(state, near) <= PLANNER.highest(state)


@given(st.floats(-5.0, 5.0))
def test_it_does_not_depend_on_the_height_of_the_ground(ground: float) -> None:
    states = state_at(rise=0.1), state_at(rise=0.1, ground=ground)
    below, above = (
        PLANNER.highest(state, Touchdown(state.preview.footholds[0], 0.0, state.support + 0.05)) for state in states
    )
    assert above == pytest.approx(below)
