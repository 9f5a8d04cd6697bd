"""Transitions between standing, weight shift, double support and single support."""

from dataclasses import replace
from typing import Any, Literal

import pytest

from humanwalk.body.contact import SoleExtent
from humanwalk.sides import Side
from humanwalk.terrain import Plane
from humanwalk.terrain.course import Course
from humanwalk.terrain.piece import Piece
from humanwalk.terrain.steps import Curb, Obstacle, Stairs
from humanwalk.walking.command import Command
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.lipm import divergent_component
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.phases import STOP_TURN, PhaseTransitions
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.preview import FootholdPlanner
from humanwalk.walking.walking_reference import BodyState, FootState, Phase

PARAMETERS = StepPlannerParameters()
ANKLE = 0.07
WALK, STOP = Command(0.5), Command()
TIMING = PARAMETERS.timing.at_velocity(WALK.forward)
CAREFUL = PARAMETERS.timing.step
FOOTHOLDS = FootholdPlanner(
    SoleExtent(0.055, 0.211, 0.048), PARAMETERS.footholds, PARAMETERS.placement, PARAMETERS.pacing, com_height=0.95
)
FREQUENCY = 3.2
PHASES = PhaseTransitions(PARAMETERS, ANKLE, "Right", Plane(slope=0.1), FOOTHOLDS)
LEVEL = PhaseTransitions(PARAMETERS, ANKLE, "Right", Plane(), FOOTHOLDS)


def foot(position: complex, force: float = 350.0, **changes: Any) -> FootState:
    values = dict(velocity=0j, height=ANKLE, height_rate=0.0, yaw=0.0, pitch=0.0, pitch_rate=0.0)
    return FootState(position=position, force=force, **(values | changes))


BODY = BodyState(0j, 0j, 0.97, right=foot(-0.1j), left=foot(0.1j))


def advance(phases: PhaseTransitions, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
    return phases.advance(state, body, command, divergent_component(body.com, body.com_velocity, FREQUENCY))


def on_course(*pieces: Piece) -> PhaseTransitions:
    return PhaseTransitions(PARAMETERS, ANKLE, "Right", Course(pieces, run_up=0.6), FOOTHOLDS)


def in_single_support(progress: float = 0.5, steps: int = 1, phases: PhaseTransitions = PHASES) -> PlannerState:
    state = phases.start(BODY, 0.0)
    state = advance(phases, state._replace(phase=Phase.WEIGHT_SHIFT, elapsed=TIMING.weight_shift), BODY, WALK)
    return state._replace(elapsed=TIMING.double_support + progress * TIMING.single_support, steps=steps)


def landed_at(position: complex, force: float = 350.0) -> BodyState:
    return replace(BODY, right=foot(position, force))


def test_it_starts_in_standing_on_the_foot_that_does_not_swing_first() -> None:
    state = PHASES.start(BODY, 0.3)
    assert (state.phase, state.stance, state.heading, state.steps) == (Phase.STAND, "Left", 0.3, 0)
    assert state.height == pytest.approx(BODY.com_height)


@pytest.mark.parametrize("command", [WALK, Command(-0.2), Command(0.0, 0.2), Command(0.0, 0.0, 0.3)])
def test_any_command_above_the_stop_speed_begins_a_weight_shift(command: Command) -> None:
    state = PHASES.start(BODY, 0.0)
    assert advance(PHASES, state, BODY, command).phase is Phase.WEIGHT_SHIFT
    assert (
        advance(
            PHASES, state, BODY, Command(0.9 * PARAMETERS.stop_speed, turn=0.9 * STOP_TURN / PARAMETERS.timing.step)
        ).phase
        is Phase.STAND
    )


def test_the_first_swing_follows_the_weight_shift_and_starts_as_measured() -> None:
    pitched = replace(BODY, right=foot(0.01 - 0.1j, height=0.1, height_rate=0.2, pitch=0.3, velocity=0.4 + 0j))
    state = PHASES.start(BODY, 0.0)._replace(phase=Phase.WEIGHT_SHIFT, elapsed=TIMING.weight_shift)
    state = advance(PHASES, state, pitched, WALK)
    assert (state.phase, state.elapsed) == (Phase.SINGLE_SUPPORT, TIMING.double_support)
    assert state.swing.motion[:2] == (0.01 - 0.1j, 0.4)
    height, pitch = (motion.time_scaled(1.0 / TIMING.single_support) for motion in state.swing.profile.at(0.0))
    assert (height.value, height.rate, pitch.value) == pytest.approx((0.1, 0.2, 0.3))


@pytest.mark.parametrize("behind", [0.0, 0.1, 0.15, 0.19])
def test_a_foot_that_stood_behind_the_other_one_leaves_the_ground_with_straight_toes(behind: float) -> None:
    """It was flat in the weight shift."""
    body = replace(BODY, right=foot(-behind - 0.1j))
    state = LEVEL.start(body, 0.0)._replace(phase=Phase.WEIGHT_SHIFT, elapsed=TIMING.weight_shift)
    assert advance(LEVEL, state, body, WALK).swing.start_toes == 0.0


@pytest.mark.parametrize("passive_ankles", [(), ("Right",), ("Left",)])
def test_a_foot_without_muscles_at_the_ankle_lands_with_level_toes(passive_ankles: tuple[Side, ...]) -> None:
    phases = PhaseTransitions(PARAMETERS, ANKLE, "Right", Plane(), FOOTHOLDS, passive_ankles)
    _, pitch = in_single_support(phases=phases).swing.profile.at(1.0)
    toe_up = 0.0 if "Right" in passive_ankles else PARAMETERS.swing.touchdown_pitch(WALK.forward)
    assert pitch.value == pytest.approx(-toe_up, abs=1e-9)


@pytest.mark.parametrize("caution", [0.0, 0.5, 1.0])
def test_a_foot_is_lifted_the_higher_the_more_careful_the_step(caution: float) -> None:
    """It leaves the ground so steeply that its ankle is above the least clearance already."""
    steep, before = replace(BODY, right=foot(-0.1j, height=ANKLE + 0.1)), in_single_support(phases=LEVEL)
    before = before._replace(phase=Phase.DOUBLE_SUPPORT, elapsed=before.timing.double_support, caution=caution)
    apex, _ = advance(LEVEL, before, steep, WALK).swing.profile.at(0.25)
    lift = PARAMETERS.caution.lift_above(PARAMETERS.swing.lift, caution)
    assert apex.value - steep.right.height == pytest.approx(lift)


def test_early_contact_ends_the_swing_only_near_its_end() -> None:
    body = landed_at(0.5 - 0.1j)
    assert advance(PHASES, in_single_support(0.5), body, WALK).phase is Phase.SINGLE_SUPPORT
    assert advance(PHASES, in_single_support(0.95), body, WALK).phase is Phase.DOUBLE_SUPPORT


def test_at_touchdown_the_feet_change_roles_and_stand_where_they_are_measured() -> None:
    before = in_single_support(1.01)
    state = advance(PHASES, before, landed_at(0.5 - 0.1j), WALK)
    assert (state.stance, state.elapsed, state.steps, state.swing) == ("Right", 0.0, 2, None)
    assert state.right.position == 0.5 - 0.1j
    assert state.right.ground - state.left.ground == pytest.approx(0.5 * 0.1, rel=0.01)
    assert state.support == before.support


def test_after_a_large_error_of_the_dcm_the_next_steps_are_careful() -> None:
    law, first, second = PARAMETERS.caution, landed_at(0.5 - 0.1j), replace(BODY, left=foot(1.0 + 0.1j))
    disturbed = in_single_support(1.01, phases=LEVEL)._replace(largest_error=law.full_error)
    state = advance(LEVEL, disturbed, first, WALK)
    assert state.caution == pytest.approx(1.0)
    assert state.timing.step == pytest.approx(CAREFUL)
    state = state._replace(phase=Phase.SINGLE_SUPPORT, elapsed=1.0)
    state = advance(LEVEL, state, replace(second, right=first.right), WALK)
    assert state.caution == pytest.approx(law.memory)
    assert CAREFUL < state.timing.step < TIMING.step


@pytest.mark.parametrize("share", [0.99, 1.01])
@pytest.mark.parametrize("ahead", [-0.1, 0.2])
def test_on_stairs_a_body_that_lags_after_a_large_error_pauses(share: float, ahead: float) -> None:
    stairs, error = on_course(Stairs(number=10)), share * PARAMETERS.caution.pause_error
    disturbed = in_single_support(1.01, phases=stairs)._replace(largest_error=error)
    body = landed_at(0.4 - 0.1j)
    planned = stairs.advance(disturbed, body, WALK, dcm=body.right.position + ahead).preview
    assert planned.command == (WALK.at_pace(0.0) if share > 1.0 and ahead < 0.0 else WALK)


def test_on_a_plane_the_foothold_corrects_every_error_at_the_commanded_speed() -> None:
    body, error = landed_at(0.5 - 0.1j), 2.0 * PARAMETERS.caution.pause_error
    careful, disturbed = (
        advance(LEVEL, in_single_support(1.01, phases=LEVEL)._replace(largest_error=e), body, WALK)
        for e in (PARAMETERS.caution.full_error, error)
    )
    assert disturbed == careful


def test_steps_on_a_plane_are_ordinary() -> None:
    state = advance(LEVEL, in_single_support(1.01, phases=LEVEL), landed_at(0.5 - 0.1j), WALK)
    assert state.caution == pytest.approx(0.0, abs=1e-9)
    assert state.timing.step == pytest.approx(TIMING.step)


@pytest.mark.parametrize("height", [0.015, 0.05])
def test_steps_to_a_curb_are_careful(height: float) -> None:
    phases = on_course(Curb(height=height))
    state = advance(phases, phases.start(BODY, 0.0), BODY, WALK)
    assert state.phase is Phase.WEIGHT_SHIFT
    assert state.caution == pytest.approx(min(height / PARAMETERS.caution.full_height, 1.0))
    assert state.timing.step == pytest.approx(TIMING.step + state.caution * (CAREFUL - TIMING.step))


@pytest.mark.parametrize("progress", [0.95, 1.01])
def test_the_last_step_ends_in_standing(progress: float) -> None:
    state = advance(PHASES, in_single_support(progress), landed_at(-0.1j), STOP)
    assert (state.phase, state.steps, state.early) == (Phase.STAND, 0, 0.0)


@pytest.mark.parametrize("velocity", [-0.5, 0.8, 0.6j, -0.6j])
def test_the_walker_goes_on_stepping_while_the_dcm_is_outside_the_base_of_support(velocity: complex) -> None:
    body = replace(landed_at(-0.1j), com_velocity=velocity)
    assert advance(PHASES, in_single_support(1.01), body, STOP).phase is Phase.DOUBLE_SUPPORT
    slow = replace(body, com_velocity=0.1 * velocity)
    assert advance(PHASES, in_single_support(1.01), slow, STOP).phase is Phase.STAND


@pytest.mark.parametrize("direction", ["up", "down"])
def test_the_walker_does_not_stop_with_a_foot_on_each_of_two_treads(direction: Literal["up", "down"]) -> None:
    stairs = on_course(Stairs(rise=0.17, tread=0.28, direction=direction))
    apart = replace(BODY, com=0.7, right=foot(0.8 - 0.1j), left=foot(0.52 + 0.1j))
    state = in_single_support(1.01, phases=stairs)
    state = advance(stairs, state._replace(left=Foothold.on(state.ground, apart.left.position)), apart, STOP)
    assert state.phase is Phase.DOUBLE_SUPPORT
    together = replace(apart, com=0.8, left=foot(0.8 + 0.1j))
    state = advance(stairs, state._replace(phase=Phase.SINGLE_SUPPORT, elapsed=state.timing.step), together, STOP)
    assert state.phase is Phase.STAND


@pytest.mark.parametrize(
    "velocity, stance", [(0.8 + 0.05j, "Left"), (-0.3 - 0.05j, "Right"), (0.5j, "Left"), (-0.5j, "Right")]
)
@pytest.mark.parametrize(
    "phase, command", [(Phase.STAND, STOP), (Phase.WEIGHT_SHIFT, STOP), (Phase.WEIGHT_SHIFT, WALK)]
)
def test_a_push_in_standing_leads_to_a_careful_step_on_the_foot_nearer_to_the_dcm(
    phase: Phase, command: Command, velocity: complex, stance: str
) -> None:
    standing = LEVEL.start(BODY, 0.0)._replace(phase=phase)
    assert advance(LEVEL, standing, replace(BODY, com_velocity=0.1 * velocity), command).phase is phase
    caught = advance(LEVEL, standing, replace(BODY, com_velocity=velocity), command)
    assert (caught.phase, caught.elapsed, caught.stance, caught.steps) == (Phase.DOUBLE_SUPPORT, 0.0, stance, 0)
    assert (caught.caution, caught.timing.step) == (1.0, CAREFUL)
    assert len(caught.preview.footholds) > 0


@pytest.mark.parametrize("phase, margin", [(Phase.STAND, 0.0), (Phase.WEIGHT_SHIFT, PARAMETERS.shift_margin)])
def test_the_dcm_may_leave_the_base_of_support_by_a_margin_in_the_weight_shift_only(
    phase: Phase, margin: float
) -> None:
    standing = LEVEL.start(BODY, 0.0)._replace(phase=phase)
    for outside, expected in ((margin - 1e-4, phase), (margin + 1e-4, Phase.DOUBLE_SUPPORT)):
        ahead = replace(BODY, com=BODY.right.position.real + PARAMETERS.support.front + outside + 0j)
        assert advance(LEVEL, standing, ahead, STOP).phase is expected


def test_only_a_preview_of_irregular_footholds_keeps_the_command_for_which_it_was_planned() -> None:
    curb, plane = (
        advance(phases, in_single_support(1.01, phases=phases), landed_at(0.3 - 0.1j), WALK)
        for phases in (on_course(Curb(height=0.1)), LEVEL)
    )
    assert curb.preview.command == WALK
    assert plane.preview.command is None


@pytest.mark.parametrize("piece", [Curb(height=0.15), Stairs(rise=0.15, tread=0.3), Obstacle(height=0.15, length=0.3)])
def test_a_preview_knows_which_foot_is_raised_next(piece: Piece) -> None:
    phases = on_course(piece)
    far = advance(phases, in_single_support(1.01, phases=phases), replace(BODY, right=foot(-0.6 - 0.1j)), WALK)
    near = advance(phases, in_single_support(1.01, phases=phases), landed_at(0.5 - 0.1j), WALK)
    assert far.preview.raised == (0.0, 0.0)
    assert max(near.preview.raised) > 0.12


def test_a_foot_is_not_raised_in_a_step_down() -> None:
    phases = on_course(Stairs(rise=0.15, tread=0.3, direction="down"))
    state = advance(phases, in_single_support(1.01, phases=phases), landed_at(0.3 - 0.1j), WALK)
    assert min(foothold.ground for foothold in state.preview.footholds[:2]) < -0.1
    assert state.preview.raised == (0.0, 0.0)


@pytest.mark.parametrize("force, is_moved", [(30.0, True), (120.0, False)])
def test_a_stance_foot_without_load_after_touchdown_stands_where_it_is_measured(force: float, is_moved: bool) -> None:
    state = advance(PHASES, in_single_support(1.01), landed_at(0.5 - 0.1j), WALK)._replace(elapsed=0.02)
    later = advance(PHASES, state, landed_at(0.55 - 0.1j, force), WALK)
    assert later.right.position == (0.55 - 0.1j if is_moved else 0.5 - 0.1j)


def test_irregular_footholds_move_with_a_stance_foot_without_load() -> None:
    """Without this, walks up and down stairs with a push of 10 N s backward ended in a fall."""
    phases = on_course(Curb(height=0.1))
    state = advance(phases, in_single_support(1.01, phases=phases), landed_at(0.3 - 0.1j), WALK)._replace(elapsed=0.02)
    later = advance(phases, state, landed_at(0.32 - 0.1j, 30.0), WALK)
    for before, after in zip(state.preview.footholds, later.preview.footholds, strict=True):
        assert after == before._replace(position=before.position + 0.02)
