"""The swinging foot clears what it will step over, and the other leg."""

import math
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.terrain.course import Course
from humanwalk.terrain.plane import Plane
from humanwalk.terrain.steps import Obstacle, Stairs
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.command import Command
from humanwalk.walking.motions import PlanarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.phases import PhaseTransitions
from humanwalk.walking.planner_state import PlannerState, Swing
from humanwalk.walking.preview import FootholdPlanner
from humanwalk.walking.swing_motion import TURNED, SwingGoal, advanced_swing
from humanwalk.walking.walking_reference import BodyState, FootState, Phase

PARAMETERS = StepPlannerParameters()
WALK = Command(0.6)
PERIOD = 0.006
FOOTHOLDS = FootholdPlanner(
    SoleExtent(0.055, 0.211, 0.048), PARAMETERS.footholds, PARAMETERS.placement, PARAMETERS.pacing, com_height=0.95
)
BEAM = Course((Obstacle(height=0.15, thickness=0.1, length=0.7),), run_up=0.0)
"""The beam is 0.3 to 0.4 m ahead."""
FOOT_LENGTH, FOOT_WIDTH = 0.21, 0.07
"""Of the capsules with which the feet touch each other [m], `contact/leg_contact.py`."""
BEYOND, AT_THE_BEAM = 0.7 - 0.09j, 0.47 - 0.09j


def foot(position: complex) -> FootState:
    return FootState(position, 0j, height=0.07, height_rate=0.0, yaw=0.0, pitch=0.0, pitch_rate=0.0, force=350.0)


def first_swing(ground: Ground) -> tuple[PlannerState, Swing]:
    body = BodyState(0j, 0j, 0.97, right=foot(-0.09j), left=foot(0.09j))
    phases = PhaseTransitions(PARAMETERS, 0.07, "Right", ground, FOOTHOLDS)
    state = phases.start(body, 0.0)._replace(phase=Phase.WEIGHT_SHIFT, elapsed=PARAMETERS.timing.weight_shift)
    state = phases.advance(state, body, WALK, dcm=body.com)
    assert state.swing is not None
    return state, state.swing


def swung(*goals: tuple[complex, complex]) -> Swing:
    """The swing after control periods in which balance desires a foothold, and will desire another at touchdown."""
    state, swing = first_swing(BEAM)
    for desired, expected in goals:
        goal = SwingGoal(desired, expected, state.timing.step - state.elapsed)
        swing = advanced_swing(state, swing, goal, WALK, PARAMETERS, FOOTHOLDS, PERIOD)
        state = state._replace(elapsed=state.elapsed + PERIOD, swing=swing)
    return swing


def test_a_foothold_that_is_desired_for_a_moment_does_not_change_how_the_foot_clears_a_beam() -> None:
    steady = swung(*[(BEYOND, BEYOND)] * 6)
    assert max(steady.clearance.lift) > 0.15
    disturbed = swung((BEYOND, BEYOND), *[(AT_THE_BEAM, BEYOND)] * 4, (BEYOND, BEYOND))
    assert disturbed.clearance == steady.clearance
    assert disturbed.foothold.position != steady.foothold.position


def test_a_foot_that_will_land_at_the_beam_sinks_last() -> None:
    assert swung((AT_THE_BEAM, AT_THE_BEAM)).clearance.arrive < 1.0
    assert swung((BEYOND, BEYOND)).clearance.arrive == pytest.approx(1.0)


@given(st.floats(0.0, 0.09), st.floats(-0.03, 0.0))
def test_a_foot_that_returns_to_its_tread_clears_the_next_one_over_which_its_toes_are(
    moved: float, along: float
) -> None:
    stairs = Stairs(number=4)
    state, swing = first_swing(Course((stairs,), run_up=FOOTHOLDS.sole.front + 0.02))
    swing = swing._replace(start=swing.start + moved, motion=PlanarMotion(swing.start + moved))
    state = state._replace(swing=swing)
    goal = state.old_foot.position + along
    remaining = state.timing.step - state.elapsed
    added = advanced_swing(
        state, swing, SwingGoal(goal, goal, remaining), WALK, PARAMETERS, FOOTHOLDS, PERIOD
    ).clearance
    if moved > 0.02:
        assert max(added.lift) > stairs.rise
        assert added.arrive < 1.0
    else:
        assert not any(added.lift)


def passing(start: complex, velocity: complex, goal: complex, phase_rate: float, yaw: float = 0.0) -> Iterator[complex]:
    """Places of a foot that passes the stance foot, in the frame of the step; `yaw` is that at lift-off."""
    state, swing = first_swing(Plane())
    start, goal = (state.stance_foot.position + place for place in (start, goal))
    swing = swing._replace(start=start, start_yaw=yaw, motion=PlanarMotion(start, velocity))
    while (remaining := (state.timing.step - state.elapsed) / phase_rate) > PERIOD:
        swing = advanced_swing(state, swing, SwingGoal(goal, goal, remaining), WALK, PARAMETERS, FOOTHOLDS, PERIOD)
        state = state._replace(elapsed=state.elapsed + phase_rate * PERIOD, swing=swing)
        yield state.local(swing.motion.position)


@given(st.floats(-0.7, -0.5), st.floats(0.05, 0.2), st.floats(0.2, 0.5), st.floats(1.0, 2.0))
def test_a_foot_from_across_is_aside_before_its_toes_reach_the_heel_of_the_stance_foot(
    behind: float, across: float, ahead: float, phase_rate: float
) -> None:
    for place in passing(complex(behind, across), 0j, complex(ahead, -0.09), phase_rate):
        if abs(place.real) < FOOT_LENGTH:
            assert -place.imag > FOOT_WIDTH


@given(st.floats(-0.7, -0.3), st.floats(0.05, 0.2), st.floats(0.0, 2.0), st.floats(1.0, 2.0))
def test_a_foot_from_across_is_not_thrown_aside(behind: float, across: float, speed: float, phase_rate: float) -> None:
    for place in passing(complex(behind, across), speed + 0j, 0.4 - 0.09j, phase_rate):
        assert -place.imag < 0.3


@given(st.floats(-0.7, -0.5), st.floats(0.1, 0.14), st.floats(0.5, 0.8), st.floats(0.4, 0.7), st.floats(1.0, 1.5))
def test_a_foot_that_leaves_the_ground_toward_the_stance_foot_passes_it(
    behind: float, width: float, inward: float, ahead: float, phase_rate: float
) -> None:
    """As the outer foot does in a turn: its straight way is clear."""
    for place in passing(complex(behind, -width), 1.0 + 1j * inward, complex(ahead, -0.15), phase_rate):
        if abs(place.real) < FOOT_LENGTH:
            assert -place.imag > FOOT_WIDTH


@given(st.floats(-0.7, -0.5), st.floats(0.11, 0.14), st.floats(0.0, 0.35), st.floats(0.4, 0.7))
def test_a_foot_whose_toes_point_toward_the_stance_foot_passes_it_farther_away(
    behind: float, width: float, yaw: float, ahead: float
) -> None:
    toe_in = FOOTHOLDS.sole.front * math.sin(TURNED * yaw)
    for place in passing(complex(behind, -width), 1.0 + 0j, complex(ahead, -0.1), 1.0, yaw):
        if abs(place.real) < FOOT_LENGTH:
            assert -place.imag > FOOT_WIDTH + toe_in


def test_a_foot_whose_toes_point_outward_keeps_its_way() -> None:
    ends = -0.6 - 0.12j, 1.0 + 0j, 0.6 - 0.1j, 1.0
    assert list(passing(*ends, yaw=-0.3)) == list(passing(*ends, yaw=0.0))
