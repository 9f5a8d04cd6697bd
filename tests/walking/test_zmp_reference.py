"""The desired gait has the commanded velocity and width; the nominal zero-moment point goes from foot to foot."""

import cmath
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES
from humanwalk.sides import Side
from humanwalk.walking.command import Command
from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.footholds import LEVEL, Foothold
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.preview import STEPS, Preview
from humanwalk.walking.walking_reference import Phase
from humanwalk.walking.zmp_reference import (
    descent_shares,
    desired_gait,
    desired_gaits,
    pivot_lead,
    remaining_pivot,
    turned,
)

PARAMETERS = StepPlannerParameters()
TIMING, PLACEMENT = PARAMETERS.timing, PARAMETERS.placement
speeds = st.floats(-0.5, 1.5)
sideways = st.floats(-0.3, 0.3)


def state_at(
    elapsed: Any = 0.0,
    phase: Any = Phase.DOUBLE_SUPPORT,
    stance: Any = "Left",
    heading: Any = 0.0,
    **changes: Any,
) -> PlannerState:
    u = cmath.exp(1j * heading)
    feet = {"right": Foothold(-0.1j * u, 0.0), "left": Foothold((0.5 + 0.1j) * u, 0.0)}
    path = PathFollowing().begin(0.0, heading)
    state = PlannerState(phase, elapsed, stance, **feet, support=0.0, heading=heading, old_heading=heading,  # type: ignore[arg-type]
                         path=path, height=0.9)  # fmt: skip
    return state._replace(**changes)


@given(speeds, sideways)
def test_two_steps_advance_by_the_commanded_velocity(forward: float, left: float) -> None:
    gait = desired_gait(state_at(), Command(forward, left), PARAMETERS)
    stride = gait.displacement.left + gait.displacement.right
    assert stride == pytest.approx(2.0 * TIMING.step * complex(forward, left))


@given(speeds, sideways)
def test_every_step_has_at_least_the_minimum_width(forward: float, left: float) -> None:
    gait = desired_gait(state_at(), Command(forward, left), PARAMETERS)
    assert -gait.displacement.left.imag >= PLACEMENT.min_width - 1e-9
    assert gait.displacement.right.imag >= PLACEMENT.min_width - 1e-9


@given(st.floats(-0.5, 0.5))
def test_in_a_turn_the_heading_changes_at_the_turn_rate_of_the_path(turn: float) -> None:
    assert desired_gait(state_at(turn=turn), Command(0.5), PARAMETERS).turn == pytest.approx(turn * TIMING.step)


def state_on_path(command: Command, time: float, heading: float, **changes: Any) -> PlannerState:
    """A step along a path that a command has described for some time; its stance foot is on the path's end."""
    path = PathFollowing().begin(0.0, heading)
    for _ in range(round(time / 0.01)):
        path = path.advanced(command, 0.01)
    state = state_at(heading=heading, path=path, **changes)
    return state._replace(left=Foothold(path.end.position, 0.0), heading=path.end.heading)


@given(st.floats(0.2, 1.5), st.floats(-0.4, 0.4), st.floats(-3.0, 3.0))
def test_on_a_circle_the_steps_turn_at_its_turn_rate(forward: float, turn: float, heading: float) -> None:
    command = Command(forward, 0.0, turn)
    state = turned(state_on_path(command, 3.0, heading, turn=turn), command)
    assert state.turn == pytest.approx(turn, rel=0.01, abs=1e-9)
    assert state.next_turn == turn


@given(st.floats(0.2, 1.5), sideways, st.floats(-3.0, 3.0))
def test_on_a_straight_path_the_steps_do_not_turn_at_all(forward: float, left: float, heading: float) -> None:
    command = Command(forward, left)
    state = turned(state_on_path(command, 3.0, heading), command)
    assert (state.turn, state.next_turn) == (0.0, 0.0)


def test_a_turn_that_begins_within_a_step_turns_this_step_and_the_next_ones() -> None:
    state = turned(state_on_path(Command(1.0), 3.0, 0.0), Command(1.0, 0.0, 0.3))
    first, *following = desired_gaits(state, Command(1.0, 0.0, 0.3), PARAMETERS)
    assert 0.0 < first.turn < 0.3 * TIMING.step + 1e-9
    assert [gait.turn for gait in following] == pytest.approx([0.3 * TIMING.step] * len(following))


@pytest.mark.parametrize("pace", [0.6, 1.0, 1.2])
def test_on_irregular_footholds_the_steps_turn_with_the_path_at_the_planned_pace(pace: float) -> None:
    command = Command(0.8, 0.0, 0.3)
    on_boxes = state_on_path(command, 3.0, 0.0)._replace(preview=Preview(command=Command(0.8), pace=pace))
    on_a_plane = state_on_path(command, 3.0, 0.0)
    irregular, slower = turned(on_boxes, command), turned(on_a_plane, Command(pace * 0.8, 0.0, pace * 0.3))
    assert irregular.turn == pytest.approx(slower.turn, abs=1e-6)
    assert irregular.next_turn == 0.3


def test_on_the_spot_the_turn_changes_at_touchdown_only() -> None:
    state = state_on_path(Command(0.0, 0.0, 0.2), 3.0, 0.0, turn=0.2)
    assert turned(state, Command(0.0, 0.0, 0.4)) is state


def test_the_velocity_towards_the_path_adds_to_the_command() -> None:
    corrected = desired_gait(state_at(path_correction=0.1 + 0.05j), Command(0.5), PARAMETERS)
    commanded = desired_gait(state_at(), Command(0.6, 0.05), PARAMETERS)
    assert corrected.displacement == pytest.approx(commanded.displacement)


def test_walking_backward_the_zero_moment_point_does_not_roll() -> None:
    assert desired_gait(state_at(), Command(-0.5), PARAMETERS).roll == 0.0
    assert desired_gait(state_at(), Command(0.5), PARAMETERS).roll.real > 0.0


@given(st.sampled_from(SIDES), st.floats(0.0, 0.99), st.floats(-3.0, 3.0))
def test_the_remaining_segments_last_to_the_end_of_the_step_and_are_connected(
    stance: Side, fraction: float, heading: float
) -> None:
    elapsed = fraction * TIMING.step
    phase = Phase.DOUBLE_SUPPORT if elapsed < TIMING.double_support else Phase.SINGLE_SUPPORT
    state = state_at(elapsed, phase, stance, heading)
    segments = remaining_pivot(state, desired_gait(state, Command(1.0), PARAMETERS), PARAMETERS)
    assert sum(segment.duration for segment in segments) == pytest.approx(TIMING.step - elapsed)
    for first, second in pairwise(segments):
        assert first.end == pytest.approx(second.start)
    end = PARAMETERS.support.center + PARAMETERS.support.roll * 1.0 + PARAMETERS.support.pivot * 1.0
    assert state.local(segments[-1].end) == pytest.approx(end, abs=1e-9)


SWINGING = replace(PARAMETERS, support=replace(PARAMETERS.support, pivot=0.05))
"""Parameters with angular momentum of the swinging leg."""

PLAIN = replace(PARAMETERS, support=replace(PARAMETERS.support, pivot=0.0))
"""The same without."""


@given(st.sampled_from(SIDES), st.floats(0.0, 0.99), st.floats(-3.0, 3.0))
def test_the_zero_moment_point_does_not_depend_on_the_angular_momentum(
    stance: Side, fraction: float, heading: float
) -> None:
    """The pivot less its lead is the zero-moment point, which rolls from foot to foot."""
    elapsed = fraction * TIMING.step
    phase = Phase.DOUBLE_SUPPORT if elapsed < TIMING.double_support else Phase.SINGLE_SUPPORT
    state = state_at(elapsed, phase, stance, heading)
    plain, swinging = (desired_gait(state, Command(1.0), parameters) for parameters in (PLAIN, SWINGING))
    pivot = remaining_pivot(state, swinging, SWINGING)[0].start
    zmp = remaining_pivot(state, plain, PLAIN)[0].start
    assert pivot - pivot_lead(state, swinging) == pytest.approx(zmp, abs=1e-9)
    assert pivot_lead(state, plain) == 0.0


def test_the_angular_momentum_of_a_step_is_that_of_the_one_before() -> None:
    """The lead is the rate of the angular momentum: it has no mean."""
    gait = desired_gait(state_at(), Command(1.2), SWINGING)
    times = (TIMING.step * (k + 0.5) / 1000 for k in range(1000))
    phases = ((t, Phase.DOUBLE_SUPPORT if t < TIMING.double_support else Phase.SINGLE_SUPPORT) for t in times)
    leads = [pivot_lead(state_at(t, phase), gait).real for t, phase in phases]
    assert sum(leads) / len(leads) == pytest.approx(0.0, abs=1e-4)
    assert max(leads) == pytest.approx(0.06, rel=0.01)


def test_walking_backward_the_pivot_stays_at_the_zero_moment_point() -> None:
    assert desired_gait(state_at(), Command(-0.5), SWINGING).pivot == 0.0


@given(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_only_steps_down_are_descents(rise: float, next_rise: float) -> None:
    feet = (Foothold(1.0 - 0.1j, rise, LEVEL._replace(intercept=rise)), Foothold(1.5 + 0.1j, rise + next_rise))
    shares = descent_shares(state_at(preview=Preview(feet)), PARAMETERS)
    for share, height in zip(shares, (rise, next_rise, 0.0), strict=True):
        assert 0.0 <= share <= 1.0
        assert (share > 0.0) == (height < -1e-9) or abs(height) < 1e-9
    assert descent_shares(state_at(), PARAMETERS) == (0.0,) * STEPS


later = st.tuples(*(st.floats(0.6, 1.7),) * (STEPS - 1))


@given(speeds, sideways, st.floats(-0.3, 0.3), later)
def test_the_steps_that_follow_are_as_long_and_take_their_own_time(
    forward: float, left: float, turn: float, durations: tuple[float, ...]
) -> None:
    state = state_at(preview=Preview(durations=durations), turn=turn, next_turn=turn, path_correction=0.1 - 0.05j)
    gait, *following = desired_gaits(state, Command(forward, left), PARAMETERS)
    for after, duration in zip(following, durations, strict=True):
        for side in SIDES:
            assert after.displacement.on(side) == pytest.approx(gait.displacement.on(side), abs=1e-12)
        assert after.turn == pytest.approx(gait.turn)
        expected = duration**TIMING.double_support_exponent * gait.double_support
        assert after.double_support == pytest.approx(min(expected, TIMING.longest_double_support))
        assert after.step == pytest.approx(duration * gait.step)


@given(st.floats(0.2, 1.0), st.floats(1.05, 1.7))
def test_before_a_slower_step_the_body_is_less_far_ahead(speed: float, slower: float) -> None:
    """A pendulum that has more time for the same way begins it with a smaller DCM."""
    gait, *following = desired_gaits(state_at(preview=Preview(durations=(slower, 1.0))), Command(speed), PARAMETERS)
    assert gait.end_offset("Left", 3.2, *following).real < gait.end_offset("Left", 3.2).real


def test_on_a_plane_the_gaits_that_follow_are_the_same() -> None:
    gaits = desired_gaits(state_at(turn=0.2, next_turn=0.2, path_correction=0.1j), Command(0.7, 0.1), PARAMETERS)
    assert len(gaits) == STEPS
    assert set(gaits) == {gaits[0]}


@given(st.floats(-0.6, -0.01))
def test_a_step_down_backward_keeps_the_pressure_of_a_flat_foot(speed: float) -> None:
    state, command = state_at(), Command(speed)
    assert desired_gait(state, command, PARAMETERS, descent=1.0) == desired_gait(state, command, PARAMETERS)


@given(st.floats(0.0, 0.8))
def test_the_pivot_is_ahead_of_the_ball_while_the_heel_is_up_before_a_step_down(speed: float) -> None:
    gait = desired_gait(state_at(), Command(speed), PARAMETERS, descent=1.0)
    lead = PARAMETERS.rockers.descent
    state = state_at(TIMING.step - 0.9 * lead, Phase.SINGLE_SUPPORT)
    held = [state.local(segment.start).real for segment in remaining_pivot(state, gait, PARAMETERS)]
    assert held == pytest.approx([PARAMETERS.support.descent] * len(held))
    assert held[0] > PARAMETERS.support.ball
