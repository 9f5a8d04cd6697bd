"""The step planner stands, shifts weight, steps on alternate sides, balances by footholds and stops."""

import cmath
import math
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.walking.command import Command
from humanwalk.walking.step_planner import StepPlanner, StepPlannerParameters
from humanwalk.walking.walking_reference import BodyState, FootState, FootTask, Phase, other

PERIOD = 0.004
ANKLE = 0.068
LEG = 0.864
PARAMETERS = StepPlannerParameters()


def planner(**changes):
    return StepPlanner(replace(PARAMETERS, **changes), 0.98, ANKLE, LEG, "Right", PERIOD)


def foot(position, force=350.0, **changes):
    values = dict(
        position=position, velocity=0j, height=ANKLE, height_rate=0.0, yaw=0.0, pitch=0.0, pitch_rate=0.0, force=force
    )
    return FootState(**(values | changes))


def standing(com=0.03 + 0j, velocity=0j, time=0.0):
    return BodyState(time, com, velocity, 0.96, foot(-0.0875j), foot(0.0875j))


def pendulum_walk(plan, command, duration, push=None):
    """A pendulum whose feet are where the planner wants them: the planner's own world. Yields what happens."""
    body = standing()
    state = plan.start(body)
    for tick in range(round(duration / PERIOD)):
        time = tick * PERIOD
        wanted = command(time)
        state, reference = plan.update(state, body, wanted)
        yield time, state, reference, body
        velocity = body.com_velocity + PERIOD * plan.frequency**2 * (body.com - reference.zmp)
        if push is not None and abs(time - push[0]) < 0.5 * PERIOD:
            velocity += push[1]
        feet = {}
        for side in ("Right", "Left"):
            target, old = reference.foot(side), body.foot(side)
            if target.task is FootTask.SWING:
                feet[side] = foot(target.position.position, 0.0, velocity=target.position.velocity, yaw=target.yaw)
            else:
                feet[side] = foot(old.position, yaw=old.yaw)
        body = BodyState(time + PERIOD, body.com + PERIOD * velocity, velocity, 0.93, feet["Right"], feet["Left"])


def walk_at(forward, sideways=0.0, turn=0.0):
    return lambda time: Command(forward, sideways, turn) if time > 0.2 else Command()


def test_it_stands_where_nothing_is_commanded():
    for _, state, reference, _ in pendulum_walk(planner(), lambda time: Command(), 1.0):
        assert state.phase is Phase.STAND
        assert {reference.right.task, reference.left.task} == {FootTask.FLAT}


def test_phases_follow_each_other_and_sides_alternate():
    previous, stances = Phase.STAND, []
    follows = {
        Phase.STAND: {Phase.WEIGHT_SHIFT},
        Phase.WEIGHT_SHIFT: {Phase.SINGLE_SUPPORT},
        Phase.DOUBLE_SUPPORT: {Phase.SINGLE_SUPPORT},
        Phase.SINGLE_SUPPORT: {Phase.DOUBLE_SUPPORT},
    }
    for _, state, _, _ in pendulum_walk(planner(), walk_at(0.5), 6.0):
        if state.phase is not previous:
            assert state.phase in follows[previous]
            previous = state.phase
            if state.phase is Phase.SINGLE_SUPPORT:
                stances.append(state.stance)
    assert len(stances) >= 6
    assert stances[0] == "Left"
    assert all(later == other(earlier) for earlier, later in pairwise(stances))


def test_the_foot_that_stands_is_never_the_one_that_swings():
    for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.8), 4.0):
        assert reference.foot(state.stance).task is not FootTask.SWING
        assert reference.foot(state.stance).load == 1.0


@pytest.mark.parametrize("speed", [complex(0.4), complex(1.0), complex(-0.3), complex(0.3, 0.1)])
def test_a_perfect_pendulum_walks_as_commanded(speed):
    middle = [b.com for t, _, _, b in pendulum_walk(planner(), walk_at(speed.real, speed.imag), 12.0) if t > 7.8]
    step = PARAMETERS.timing.step
    window = round(6 * step / PERIOD)
    assert (middle[window] - middle[0]).real / (window * PERIOD) == pytest.approx(speed.real, abs=0.03)
    assert (middle[window] - middle[0]).imag / (window * PERIOD) == pytest.approx(speed.imag, abs=0.03)


def test_a_turn_turns_the_feet_and_the_walk():
    *_, (_, state, _, body) = pendulum_walk(planner(), walk_at(0.5, turn=0.3), 8.0)
    assert state.heading > 1.0
    assert cmath.phase(body.com_velocity) == pytest.approx(state.heading, abs=0.6)


def test_it_stays_on_the_path_round_a_corner():
    command = lambda time: Command(0.4, 0.0, 0.4 if 3.0 < time < 6.9 else 0.0) if time > 0.2 else Command()  # noqa: E731
    for _, state, _, _ in pendulum_walk(planner(), command, 10.0):
        assert abs(state.path.beside(state.middle, Command(0.4)).position - state.middle) < 0.03


def test_the_body_turns_without_a_jump():
    yaws = [ref.pelvis_yaw for time, _, ref, _ in pendulum_walk(planner(), walk_at(0.4, turn=0.4), 8.0) if time > 4.0]
    assert max(abs(later - earlier) for earlier, later in pairwise(yaws)) < 0.05


@settings(max_examples=10)
@given(st.floats(0.02, 0.15), st.floats(-math.pi, math.pi))
def test_a_pendulum_that_is_pushed_is_caught_by_steps(size, direction):
    push = (3.0, cmath.rect(size, direction))
    *_, (_, state, reference, body) = pendulum_walk(planner(), walk_at(0.5), 7.0, push)
    assert abs(body.com - state.middle) < 0.6
    assert abs(reference.dcm - reference.dcm_reference) < 0.05


def test_a_push_forward_makes_the_next_step_longer():
    def foothold(push):
        for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.5), 4.2, push):
            if state.phase is Phase.SINGLE_SUPPORT:
                last = reference.foothold - state.ankle(state.stance)
        return last.real

    assert foothold((4.1, 0.1 + 0j)) > foothold(None)


def test_legs_are_never_asked_to_cross_beside_each_other():
    for push in (0.5j, -0.5j):
        for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.3), 5.0, (3.0, push)):
            if reference.phase is Phase.SINGLE_SUPPORT and reference.phase_time > 0.3:
                outward = -1.0 if state.stance == "Left" else 1.0
                place = (reference.foothold - state.ankle(state.stance)) / cmath.exp(1j * state.heading)
                assert outward * place.imag >= PARAMETERS.placement.least_width(place.real) - 0.02


def test_a_wide_step_lowers_the_body():
    def lowest(push):
        return min(r.com_height[0] for t, _, r, _ in pendulum_walk(planner(), walk_at(0.5), 5.0, push) if t > 3.0)

    assert min(lowest((3.5, 0.8j)), lowest((3.5, -0.8j))) < lowest(None) - 0.01


def test_the_path_begins_along_the_heading_that_is_given_not_along_the_feet():
    turned = replace(standing(), right=foot(-0.0875j, yaw=0.1), left=foot(0.0875j, yaw=0.06))
    assert planner().start(turned).heading == 0.0
    assert planner().start(turned, heading=0.3).heading == 0.3


def test_it_stops_and_stands_with_its_feet_side_by_side():
    command = lambda time: Command(0.4 if 0.2 < time < 4.0 else 0.0)  # noqa: E731
    *_, (_, state, _, body) = pendulum_walk(planner(), command, 8.0)
    assert state.phase is Phase.STAND
    assert abs(body.com_velocity) < 0.02


def test_the_zero_moment_point_stays_over_the_stance_foot():
    support = PARAMETERS.support
    for _, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 5.0, (3.0, 0.3 + 0.2j)):
        if reference.phase is Phase.SINGLE_SUPPORT and state.phase is Phase.SINGLE_SUPPORT:
            offset = reference.zmp - state.ankle(state.stance)
            assert -support.back - 1e-9 <= offset.real <= support.front + 1e-9
            assert abs(offset.imag) <= support.half_width + 1e-9


def test_durations_do_not_depend_on_the_control_period():
    def landings(period):
        plan = StepPlanner(PARAMETERS, 0.98, ANKLE, LEG, "Right", period)
        body, state, times = standing(), None, []
        state = plan.start(body)
        for tick in range(round(4.0 / period)):
            before = state.phase
            state, _ = plan.update(state, replace(body, time=tick * period), walk_at(0.0001, 0.06)(tick * period))
            if before is Phase.SINGLE_SUPPORT and state.phase is Phase.DOUBLE_SUPPORT:
                times.append(tick * period)
            body = replace(body, right=replace(body.right, force=0.0), left=replace(body.left, force=0.0))
        return times

    coarse, fine = landings(0.004), landings(0.002)
    assert len(coarse) == len(fine) > 3


def test_a_foot_leaves_flatter_from_a_short_step_than_from_an_ordinary_one():
    pitches = {}
    for time, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 8.0, push=(5.0, -0.5 + 0j)):
        behind = reference.foot(other(state.stance))
        if time > 4.0 and state.phase is Phase.DOUBLE_SUPPORT and behind.task is FootTask.HEEL_OFF:
            pitches[abs((state.right - state.left).real)] = behind.pitch[0]
    shortest, longest = min(pitches), max(pitches)
    assert shortest < 0.5 * longest
    assert pitches[shortest] < 0.6 * pitches[longest]
    assert max(pitches.values()) <= PARAMETERS.rockers.pitch


def test_who_goes_backward_sets_and_lifts_his_feet_flat():
    for time, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 5.2, push=(4.0, -1.2 + 0j)):
        behind = (state.ankle(other(state.stance)) - state.ankle(state.stance)).real < 0.0
        if time > 4.0 and state.phase is Phase.DOUBLE_SUPPORT and not behind:
            assert reference.foot(other(state.stance)).task is FootTask.FLAT
            break
    else:
        pytest.fail("no step backward")


def test_a_foot_whose_time_is_over_in_the_air_stands_where_it_comes_down():
    plan, command = planner(), walk_at(0.5)
    walked = pendulum_walk(plan, command, 5.0)
    time, state, _, body = next(w for w in walked if w[0] > 3.0 and w[1].phase is Phase.DOUBLE_SUPPORT)
    drifted = body.foot(state.stance).position + 0.05j

    def stance_after(force):
        feet = {state.stance.lower(): foot(drifted, force)}
        later, _ = plan.update(state, replace(body, **feet), command(time))
        return later.ankle(state.stance)

    assert stance_after(0.0) == drifted
    assert stance_after(500.0) == state.ankle(state.stance)


def test_where_it_does_not_listen_the_feets_forces_do_not_matter():
    """The system sums up the contacts only where it listens."""
    plan, command = planner(), walk_at(1.0)
    deaf = 0
    for (_, state, _, _), (time, _, _, body) in pairwise(pendulum_walk(plan, command, 4.0)):
        if not plan.listens(state):
            unloaded, loaded = (
                replace(body, right=replace(body.right, force=force), left=replace(body.left, force=force))
                for force in (0.0, 1000.0)
            )
            assert plan.update(state, unloaded, command(time)) == plan.update(state, loaded, command(time))
            deaf += 1
    assert deaf > 300
