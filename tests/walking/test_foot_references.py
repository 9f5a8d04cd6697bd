"""References of the feet: heel strike, flat, heel-off and swing in their order, without jumps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.walking.command import Command
from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.foot_references import foot_behind, rollover, stance_foot, swinging_foot
from humanwalk.walking.footholds import LEVEL, Foothold
from humanwalk.walking.motions import PlanarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState, Swing
from humanwalk.walking.swing_foot import SwingProfile
from humanwalk.walking.walking_reference import FootState, FootTask, Phase

PARAMETERS = StepPlannerParameters()
TIMING, ROCKERS = PARAMETERS.timing, PARAMETERS.rockers
ANKLE = 0.07
WALK = Command(1.0)
SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)
OLD, STANCE, NEXT = Foothold(-0.1j, 0.0), Foothold(0.5 + 0.1j, 0.0), Foothold(1.0 - 0.1j, 0.0)


def state_at(elapsed: float, steps: int = 1) -> PlannerState:
    phase = Phase.DOUBLE_SUPPORT if elapsed < TIMING.double_support else Phase.SINGLE_SUPPORT
    path = PathFollowing().begin(0.0, 0.0)
    return PlannerState(phase, elapsed, "Left", OLD, STANCE, 0.0, 0.0, 0.0, path, height=0.9, steps=steps)


def swing_to(foothold: Foothold, toes: float = 0.5) -> Swing:
    foot = FootState(OLD.position, 0j, ANKLE + 0.05, height_rate=0.2, yaw=0.1, pitch=0.9, pitch_rate=3.0, force=0.0)
    profile = SwingProfile.from_toe_off(foot, ANKLE, 0.25, 0.2, TIMING.single_support, PARAMETERS.swing, SOLE)
    return Swing(PlanarMotion(OLD.position), profile, foothold, start_yaw=0.1, start_toes=toes, rise=foothold.ground)


@pytest.mark.parametrize(
    "elapsed, steps, task",
    [
        (0.5 * ROCKERS.heel, 1, FootTask.HEEL_STRIKE),
        (0.5 * ROCKERS.heel, 0, FootTask.FLAT),
        (0.5 * TIMING.step, 1, FootTask.FLAT),
        (TIMING.step - 0.5 * ROCKERS.ball, 1, FootTask.HEEL_OFF),
    ],
)
def test_the_stance_foot_rolls_from_heel_strike_to_heel_off(elapsed: float, steps: int, task: FootTask) -> None:
    reference = stance_foot(state_at(elapsed, steps), swing_to(NEXT), WALK, PARAMETERS)
    assert (reference.task, reference.load) == (task, 1.0)


@given(st.floats(0.3, 1.0))
def test_the_heel_rises_later_the_slower_the_walk(speed: float) -> None:
    lead = (speed / ROCKERS.full_pitch_speed) ** ROCKERS.speed_exponent * ROCKERS.ball
    for before, task in ((1.01 * lead, FootTask.FLAT), (0.99 * lead, FootTask.HEEL_OFF)):
        state, swing = state_at(TIMING.step - before), swing_to(NEXT)
        assert stance_foot(state, swing, Command(speed), PARAMETERS).task is task


@given(st.floats(0.0, 1.0))
def test_the_heel_is_unloaded_until_it_rises(share: float) -> None:
    heel_off = TIMING.step - ROCKERS.lead(WALK.forward)
    remaining = share * (heel_off - ROCKERS.heel)
    least, largest = stance_foot(state_at(heel_off - remaining), swing_to(NEXT), WALK, PARAMETERS).heel
    assert least == 0.0
    assert largest == pytest.approx(ROCKERS.unloading * remaining, abs=1e-6)


@given(st.floats(0.0, 1.0))
def test_a_heel_that_does_not_rise_is_not_unloaded(share: float) -> None:
    state = state_at(ROCKERS.heel + share * (TIMING.step - ROCKERS.heel))
    assert stance_foot(state, swing_to(NEXT), Command(0.0), PARAMETERS).heel == (0.0, math.inf)
    assert stance_foot(state, None, WALK, PARAMETERS).heel == (0.0, math.inf)


@given(st.floats(-0.3, 0.3))
def test_the_toes_extend_further_before_a_step_up_or_down(rise: float) -> None:
    at_lift_off, higher = state_at(TIMING.double_support), STANCE._replace(ground=rise)
    level = foot_behind(at_lift_off, WALK, PARAMETERS)
    climbing = foot_behind(at_lift_off._replace(left=higher), WALK, PARAMETERS)
    assert climbing.toes[0] >= level.toes[0] == ROCKERS.toes
    if abs(rise) >= PARAMETERS.swing.flat_rise:
        assert climbing.toes[0] == climbing.pitch.value > ROCKERS.toes


@given(st.floats(0.0, 0.1))
def test_the_foot_behind_continues_the_heel_off_of_the_stance_foot_after_an_early_touchdown(early: float) -> None:
    before = stance_foot(state_at(TIMING.step - early - 1e-9), swing_to(NEXT), WALK, PARAMETERS)
    landed = state_at(0.0)._replace(early=early)
    assert foot_behind(landed, WALK, PARAMETERS).pitch == pytest.approx(before.pitch, abs=1e-6)


@given(st.floats(0.0, 1.0))
def test_the_foot_behind_is_unloaded_in_double_support(fraction: float) -> None:
    reference = foot_behind(state_at(fraction * TIMING.double_support), WALK, PARAMETERS)
    assert reference.load == pytest.approx(1.0 - fraction, abs=1e-9)


@pytest.mark.parametrize("command", [WALK, Command(0.5 * ROCKERS.min_speed)])
def test_the_force_on_the_foot_behind_is_limited_in_a_step_on_one_face(command: Command) -> None:
    landed = state_at(0.5 * TIMING.double_support)
    box = landed._replace(left=STANCE._replace(face=LEVEL._replace(lower=(0.3, -10.0))))
    assert foot_behind(landed, command, PARAMETERS).force == ROCKERS.unloading_force
    assert foot_behind(box, command, PARAMETERS).force == math.inf
    assert foot_behind(landed, command, PARAMETERS, is_passive=True).force == math.inf


@given(st.floats(-1.0, 1.5), st.floats(-1.0, 1.5))
def test_the_rollover_speed_is_at_most_the_commanded_one_and_small_for_short_steps(
    forward: float, length: float
) -> None:
    goal = Foothold(OLD.position + complex(length, 0.2), 0.0)
    speed = rollover(state_at(0.0), OLD, goal, 0.0, Command(forward), PARAMETERS).speed
    assert speed <= forward
    if length <= 0.0:
        assert speed <= 0.0
    if length >= forward * TIMING.at_velocity(forward).step > 0.0:
        assert speed == forward


@given(st.floats(0.3, 1.5), st.floats(0.1, 1.0))
def test_the_rollover_after_an_ordinary_step_is_the_same_before_a_careful_one(forward: float, length: float) -> None:
    goal = Foothold(OLD.position + complex(length, 0.2), 0.0)
    ordinary, careful = (
        rollover(
            state_at(0.0)._replace(timing=TIMING.at_velocity(forward, caution)),
            OLD,
            goal,
            0.0,
            Command(forward),
            PARAMETERS,
        )
        for caution in (0.0, 1.0)
    )
    assert careful == ordinary


@given(st.floats(0.3, 1.5), st.floats(-1.0, 1.5), st.floats(0.0, 0.4))
def test_a_foot_leaves_the_ground_the_steeper_the_more_it_is_raised_next(
    forward: float, length: float, raised: float
) -> None:
    goal = Foothold(OLD.position + complex(length, 0.2), 0.0)
    level, higher, highest = (
        rollover(state_at(0.0), OLD, goal, height, Command(forward), PARAMETERS)
        for height in (0.0, raised, PARAMETERS.swing.flat_rise)
    )
    assert level.speed <= higher.speed <= highest.speed
    behind = min(max(length / PARAMETERS.placement.abreast, 0.0), 1.0)
    assert (level.climbing, highest.climbing) == (0.0, behind)
    if behind == 1.0:
        assert highest.speed == max(level.speed, ROCKERS.full_pitch_speed)


@given(st.floats(0.3, 1.5), st.floats(-1.0, 0.0), st.floats(-0.3, 0.3), st.floats(0.0, 0.4))
def test_a_foot_that_is_not_behind_the_other_one_leaves_the_ground_flat_on_stairs_too(
    forward: float, length: float, rise: float, raised: float
) -> None:
    goal = Foothold(OLD.position + complex(length, 0.2), rise, LEVEL._replace(lower=(0.3, -10.0), intercept=rise))
    found = rollover(state_at(0.0), OLD, goal, raised, Command(forward), PARAMETERS)
    assert found.climbing == 0.0
    assert not ROCKERS.heel_rises(found.speed)


@pytest.mark.parametrize("side", [0, 1])
def test_each_foot_leaves_the_ground_as_its_own_swing_requires(side: int) -> None:
    raised = (0.3, 0.0) if side == 0 else (0.0, 0.3)
    level = state_at(TIMING.double_support - 1e-9), state_at(TIMING.step)
    high = [state._replace(preview=state.preview._replace(raised=raised)) for state in level]
    behind = [foot_behind(state, WALK, PARAMETERS).pitch.value for state in (level[0], high[0])]
    stance = [stance_foot(state, swing_to(NEXT), WALK, PARAMETERS).pitch.value for state in (level[1], high[1])]
    assert [after > before for before, after in (behind, stance)] == [side == 0, side == 1]


@given(st.floats(-0.2, 0.2))
def test_the_swinging_foot_lands_at_the_height_of_its_foothold(ground: float) -> None:
    foothold = Foothold(NEXT.position, ground)
    end = swinging_foot(state_at(TIMING.step), swing_to(foothold), 1.0)
    assert end.height.value == pytest.approx(ground + ANKLE - PARAMETERS.swing.landing_depth)
    assert end.pitch.value == pytest.approx(-0.25)
    assert end.toes == pytest.approx((0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("slope", [-0.2, 0.2])
def test_the_swinging_foot_turns_from_the_face_that_it_left_to_that_of_its_foothold(slope: float) -> None:
    inclined = LEVEL._replace(gradient=(slope, 0.0))
    for start, goal in ((OLD, NEXT._replace(face=inclined)), (OLD._replace(face=inclined), NEXT)):
        for elapsed, foothold in ((TIMING.double_support, start), (TIMING.step, goal)):
            reference = swinging_foot(state_at(elapsed)._replace(right=start), swing_to(goal), 1.0)
            np.testing.assert_allclose(reference.R_WS, foothold.R_WS, atol=1e-9)


@given(st.floats(0.05, 0.95), st.floats(1.0, 1.8))
def test_rates_of_the_swinging_foot_are_derivatives_also_on_a_faster_clock(progress: float, rate: float) -> None:
    elapsed, h = TIMING.double_support + progress * TIMING.single_support, 1e-6
    swing = swing_to(Foothold(NEXT.position, 0.1))
    before, here, after = (swinging_foot(state_at(elapsed + rate * d), swing, rate) for d in (-h, 0.0, h))
    for name in ("height", "pitch"):
        change = getattr(after, name).value - getattr(before, name).value
        assert change / (2.0 * h) == pytest.approx(getattr(here, name).rate, abs=1e-3)
    assert (after.toes[0] - before.toes[0]) / (2.0 * h) == pytest.approx(here.toes[1], abs=1e-3)


def test_before_a_step_up_the_heel_stays_on_the_ground_and_before_one_down_it_rises_early() -> None:
    def task(ground: float, before: float) -> FootTask:
        goal = Foothold(NEXT.position, ground)
        return stance_foot(state_at(TIMING.step - before), swing_to(goal), WALK, PARAMETERS).task

    assert task(0.18, 0.01) is FootTask.FLAT
    assert task(0.0, 0.01) is task(-0.18, 0.01) is FootTask.HEEL_OFF
    assert task(0.0, 1.1 * ROCKERS.ball) is FootTask.FLAT
    assert task(-0.18, 0.99 * ROCKERS.descent) is FootTask.HEEL_OFF
    assert task(-0.18, 1.01 * ROCKERS.descent) is FootTask.FLAT


def test_onto_another_face_the_heel_stays_on_the_ground() -> None:
    beside = LEVEL._replace(lower=(0.8, -10.0))
    boxes = state_at(TIMING.step - 1e-3)._replace(left=STANCE._replace(face=LEVEL._replace(upper=(0.8, 10.0))))
    assert stance_foot(boxes, swing_to(NEXT._replace(face=beside)), WALK, PARAMETERS).task is FootTask.FLAT
    assert stance_foot(boxes, swing_to(NEXT._replace(face=boxes.left.face)), WALK, PARAMETERS).task is FootTask.HEEL_OFF


@pytest.mark.parametrize("ground", [0.18, -0.18])
def test_in_a_step_up_or_down_the_foot_behind_is_steep_also_at_a_low_speed(ground: float) -> None:
    landed = state_at(0.9 * TIMING.double_support)
    level = foot_behind(landed, Command(0.3), PARAMETERS).pitch.value
    stepped = foot_behind(landed._replace(left=STANCE._replace(ground=ground)), Command(0.3), PARAMETERS).pitch.value
    assert stepped > 2.0 * level > 0.0
