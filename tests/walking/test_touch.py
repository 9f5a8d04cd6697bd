"""What the feet feel: feet that should stand, with their pressure if they are loaded."""

from dataclasses import replace

import numpy as np
import pytest

from humanwalk.body.contact import SoleExtent
from humanwalk.terrain import Plane
from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.felt_ground import FeltGround
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.touch import STANDING_TIME, first_touches, standing_feet, touches
from humanwalk.walking.walking_reference import BodyState, FootState, Phase

PARAMETERS, SOLE, ANKLE = StepPlannerParameters(), SoleExtent(0.055, 0.211, 0.048), 0.07
TIMING = PARAMETERS.timing
FOOT = FootState(0.1j, 0j, ANKLE, 0.0, 0.0, 0.0, 0.0, force=350.0, pressure=np.array((0.03, 0.1, 0.0)))
BODY = BodyState(0j, 0j, 0.95, right=replace(FOOT, position=-0.1j), left=FOOT)


def state_at(phase: Phase, elapsed: float = 0.3) -> PlannerState:
    feet, path = (Foothold(-0.1j, 0.0), Foothold(0.1j, 0.0)), PathFollowing().begin(0.0, 0.0)
    return PlannerState(phase, elapsed, "Left", *feet, 0.0, 0.0, 0.0, path, height=0.9, steps=2)


@pytest.mark.parametrize(
    "phase, feet", [(Phase.STAND, (0, 1)), (Phase.DOUBLE_SUPPORT, (1,)), (Phase.SINGLE_SUPPORT, (1,))]
)
def test_the_stance_foot_feels_the_ground_and_in_standing_both(phase: Phase, feet: tuple[int, ...]) -> None:
    assert tuple(touch.foot for touch in touches(state_at(phase), BODY, PARAMETERS, SOLE, ANKLE)) == feet
    assert len(standing_feet(state_at(phase))) == len(feet)


def test_a_loaded_foot_feels_its_pressure_and_knows_its_heel() -> None:
    (touch,) = touches(state_at(Phase.SINGLE_SUPPORT), BODY, PARAMETERS, SOLE, ANKLE)
    assert touch.heel == pytest.approx((-SOLE.back, 0.1, 0.0))
    assert touch.pressure_ahead == pytest.approx(0.03)
    assert touch.pressure == pytest.approx(FOOT.pressure)


def test_a_foot_across_an_edge_feels_the_height_of_its_sole_and_not_that_of_the_ground_below() -> None:
    pitch, pressure = 0.1, np.array((0.05, 0.1, -0.02))
    forward, normal = np.array((np.cos(pitch), 0.0, np.sin(pitch))), np.array((-np.sin(pitch), 0.0, np.cos(pitch)))
    bridging = replace(FOOT, forward=forward, normal=normal, pressure=pressure)
    (touch,) = touches(state_at(Phase.SINGLE_SUPPORT), replace(BODY, left=bridging), PARAMETERS, SOLE, ANKLE)
    assert touch.pressure is not None
    assert touch.pressure[:2] == pytest.approx(pressure[:2])
    assert (touch.pressure - touch.heel) @ normal == pytest.approx(0.0, abs=1e-12)


def test_a_stance_foot_compares_its_pressure_with_the_planned_one() -> None:
    state = state_at(Phase.SINGLE_SUPPORT)._replace(zmp=-0.02 + 0.1j)
    (touch,) = touches(state, BODY, PARAMETERS, SOLE, ANKLE)
    assert touch.planned_ahead == pytest.approx(-0.02)


def test_at_the_start_both_feet_feel_the_ground_under_their_soles_without_force() -> None:
    pitch = 0.07
    tilted = replace(
        FOOT,
        force=0.0,
        forward=np.array((np.cos(pitch), 0.0, np.sin(pitch))),
        normal=np.array((-np.sin(pitch), 0.0, np.cos(pitch))),
    )
    body = replace(BODY, right=replace(tilted, position=-0.1j), left=tilted)
    found = first_touches(body, SOLE, ANKLE)
    assert tuple(touch.foot for touch in found) == (0, 1)
    ground = FeltGround(Plane()).felt(found, STANDING_TIME)
    for x in (0.0, 0.5):
        # The ankle is above its sole along the normal, not along z.
        expected = ANKLE * (1.0 - 1.0 / np.cos(pitch)) + x * np.tan(pitch)
        assert float(ground.height(np.array((x, 0.1)))) == pytest.approx(expected, abs=3e-3)


def test_a_landing_foot_without_load_feels_no_pressure_and_later_nothing() -> None:
    airborne = replace(BODY, left=replace(FOOT, force=0.0))
    (touch,) = touches(state_at(Phase.DOUBLE_SUPPORT, 0.02), airborne, PARAMETERS, SOLE, ANKLE)
    assert touch.pressure is None
    assert touches(state_at(Phase.SINGLE_SUPPORT), airborne, PARAMETERS, SOLE, ANKLE) == ()


@pytest.mark.parametrize(
    "elapsed, pitch_rate, is_still",
    [(0.2, 0.1, True), (0.2, -1.5, False), (0.5 * PARAMETERS.rockers.heel, 0.1, False), (TIMING.step, 0.1, False)],
)
def test_a_foot_is_still_if_it_does_not_turn_between_landing_and_heel_off(
    elapsed: float, pitch_rate: float, is_still: bool
) -> None:
    body = replace(BODY, left=replace(FOOT, pitch_rate=pitch_rate))
    (touch,) = touches(state_at(Phase.SINGLE_SUPPORT, elapsed), body, PARAMETERS, SOLE, ANKLE)
    assert touch.is_still is is_still


def test_a_foot_rolls_from_heel_off_on() -> None:
    for elapsed, rolls in ((TIMING.step - 1.5 * PARAMETERS.rockers.ball, False), (TIMING.step - 0.01, True)):
        (touch,) = touches(state_at(Phase.SINGLE_SUPPORT, elapsed), BODY, PARAMETERS, SOLE, ANKLE)
        assert touch.is_rolling is rolls
