"""The step planner stands, shifts the weight, steps with alternate feet, balances by footholds, and stops."""

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics import Array
from humanwalk.sides import OUTWARD, SIDES, other_side
from humanwalk.terrain import Course, Plane
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.steps import Stairs
from humanwalk.walking.command import Command
from humanwalk.walking.motions import ScalarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.step_planner import StepPlanner
from humanwalk.walking.walking_reference import BodyState, FootState, FootTask, Phase, WalkingReference

PERIOD = 0.004
COM_HEIGHT = 0.98
ANKLE = 0.068
LEG = 0.864
PARAMETERS = StepPlannerParameters()
LEVEL = Plane()


WALK = Command(0.8, 0.0, 0.0)

SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)


def stairs(rise: float) -> Course:
    """Steps of 0.4 m from x = 0.5 m on, up or down."""
    direction: Any = "up" if rise >= 0.0 else "down"
    return Course(pieces=(Stairs(rise=abs(rise), tread=0.4, number=30, direction=direction),), run_up=0.5)


@dataclass(frozen=True)
class Raised(Plane):
    """A level plane at another height."""

    base: float = 0.0

    def height(self, xy: Array) -> Array:
        return super().height(xy) + self.base


def planner(
    terrain: Any = LEVEL, period: float = PERIOD, parameters: StepPlannerParameters = PARAMETERS
) -> StepPlanner:
    return StepPlanner(parameters, COM_HEIGHT, ANKLE, LEG, "Right", period, SOLE, terrain)


def foot(position: Any, force: float = 350.0, **changes: Any) -> FootState:
    values = dict(
        position=position, velocity=0j, height=ANKLE, height_rate=0.0, yaw=0.0, pitch=0.0, pitch_rate=0.0, force=force
    )
    return FootState(**(values | changes))


def standing() -> BodyState:
    return BodyState(0.03 + 0j, 0j, 0.96, foot(-0.0875j), foot(0.0875j))


def pendulum_walk(
    plan: StepPlanner, command: Callable[..., Any], duration: float, push: tuple[float, complex] | None = None
) -> Iterator[tuple[float, PlannerState, WalkingReference, BodyState]]:
    """A linear inverted pendulum whose feet follow their references; yields time, state, reference and body."""
    body = standing()
    state = plan.start(body)
    for tick in range(round(duration / PERIOD)):
        time = tick * PERIOD
        commanded = command(time)
        state, reference = plan.update(state, body, commanded)
        yield time, state, reference, body
        velocity = body.com_velocity + PERIOD * plan.frequency**2 * (body.com - reference.pivot)
        if push is not None and abs(time - push[0]) < 0.5 * PERIOD:
            velocity += push[1]
        feet = {}
        for side in ("Right", "Left"):
            target, old = reference.foot(side), body.foot(side)
            if target.task is FootTask.SWING:
                feet[side] = foot(target.position.position, 0.0, velocity=target.position.velocity, yaw=target.yaw)
            else:
                feet[side] = foot(old.position, yaw=old.yaw)
        body = BodyState(body.com + PERIOD * velocity, velocity, 0.93, feet["Right"], feet["Left"])


def walk_at(forward: float, sideways: float = 0.0, turn: float = 0.0) -> Callable[..., Any]:
    return lambda time: Command(forward, sideways, turn) if time > 0.2 else Command()


def test_it_stands_while_nothing_is_commanded() -> None:
    for _, state, reference, _ in pendulum_walk(planner(), lambda time: Command(), 1.0):
        assert state.phase is Phase.STAND
        assert {reference.right.task, reference.left.task} == {FootTask.FLAT}


def test_in_standing_the_center_of_mass_moves_to_its_height_of_standing() -> None:
    *_, (_, _, reference, _) = pendulum_walk(planner(), lambda time: Command(), 4.0)
    assert reference.com_height.value == pytest.approx(PARAMETERS.height.standing * COM_HEIGHT, abs=1e-3)


def test_phases_follow_each_other_and_sides_alternate() -> None:
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
    assert all(later == other_side(earlier) for earlier, later in pairwise(stances))


def test_the_stance_foot_never_swings() -> None:
    for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.8), 4.0):
        assert reference.foot(state.stance).task is not FootTask.SWING
        assert reference.foot(state.stance).load == 1.0


@pytest.mark.parametrize("speed", [complex(0.4), complex(1.0), complex(-0.3), complex(0.3, 0.1)])
def test_a_perfect_pendulum_walks_as_commanded(speed: complex) -> None:
    middle = [b.com for t, _, _, b in pendulum_walk(planner(), walk_at(speed.real, speed.imag), 12.0) if t > 7.8]
    step = PARAMETERS.timing.step
    window = round(6 * step / PERIOD)
    assert (middle[window] - middle[0]).real / (window * PERIOD) == pytest.approx(speed.real, abs=0.03)
    assert (middle[window] - middle[0]).imag / (window * PERIOD) == pytest.approx(speed.imag, abs=0.03)


@given(st.floats(0.0, 0.03))
@settings(max_examples=15, deadline=None)
def test_the_first_foothold_of_a_swing_is_not_filtered_however_fast_the_clock_ran(overshoot: float) -> None:
    state = next(s for _, s, _, _ in pendulum_walk(planner(), walk_at(0.8), 4.0) if s.phase is Phase.DOUBLE_SUPPORT)
    behind, ahead = (foot(state.foot(side).position) for side in (other_side(state.stance), state.stance))
    feet = {state.stance: ahead, other_side(state.stance): behind}
    body = BodyState(state.midpoint + 0.05, 0.8 + 0j, 0.93, feet["Right"], feet["Left"])
    lifting = state._replace(elapsed=state.timing.double_support + overshoot)
    footholds = []
    for time in (0.0, 0.5):
        placement = replace(PARAMETERS.placement, filter_time=time, rise_filter_time=time)
        after, _ = planner(parameters=replace(PARAMETERS, placement=placement)).update(lifting, body, WALK)
        assert after.swing is not None
        footholds.append(after.swing.foothold.position)
    assert footholds[0] == footholds[1]


def test_a_turn_turns_the_feet_and_the_walk() -> None:
    *_, (_, state, _, body) = pendulum_walk(planner(), walk_at(0.5, turn=0.3), 8.0)
    assert state.heading > 1.0
    assert cmath.phase(body.com_velocity) == pytest.approx(state.heading, abs=0.6)


@pytest.mark.parametrize("begin", np.linspace(5.0, 6.1, 7))
@pytest.mark.parametrize("speed", [0.6, 1.0, 1.4])
def test_a_turn_that_begins_at_any_time_leaves_the_dcm_near_its_place(speed: float, begin: float) -> None:
    def command(time: float) -> Command:
        return Command(min(0.4 * time, speed), 0.0, min(max(0.5 * (time - begin), 0.0), 0.4))

    walked = pendulum_walk(planner(), command, begin + 2.0)
    assert max(state.largest_error for time, state, _, _ in walked if time > begin) < 0.1


@pytest.mark.parametrize("wait", [2.0, 8.0])
def test_a_turn_too_slow_for_steps_does_not_turn_the_path_of_a_standing_walker(wait: float) -> None:
    command = lambda time: Command(0.5 if time > wait else 0.0, 0.0, 0.04 if time < wait else 0.0)  # noqa: E731
    *_, (_, state, _, _) = pendulum_walk(planner(), command, wait + 4.0)
    assert state.is_stepping
    assert state.heading == 0.0


def test_it_stays_on_the_path_around_a_corner() -> None:
    command = lambda time: Command(0.4, 0.0, 0.4 if 3.0 < time < 6.9 else 0.0) if time > 0.2 else Command()  # noqa: E731
    for _, state, _, _ in pendulum_walk(planner(), command, 10.0):
        assert abs(state.path.nearest(state.midpoint, Command(0.4)).position - state.midpoint) < 0.03


def test_the_pelvis_turns_with_the_leading_leg_and_drops_toward_the_swinging_one() -> None:
    """And the chest turns against it. Turning to the left is positive, and so is a roll with the left side up."""
    for time, _, reference, body in pendulum_walk(planner(), walk_at(1.0), 4.0):
        left_ahead = (body.left.position - body.right.position).real
        if time > 2.0 and abs(left_ahead) > 0.1:
            assert left_ahead * reference.pelvis_yaw < 0.0 < left_ahead * reference.chest_yaw
        if time > 2.0 and 0.3 < reference.phase_time / reference.step_duration < 0.7:
            assert (reference.pelvis_roll > 0.0) == (reference.stance == "Left")


def test_the_pelvis_turns_without_a_jump() -> None:
    yaws = [ref.pelvis_yaw for time, _, ref, _ in pendulum_walk(planner(), walk_at(0.4, turn=0.4), 8.0) if time > 4.0]
    assert max(abs(later - earlier) for earlier, later in pairwise(yaws)) < 0.05


@settings(max_examples=10)
@given(st.floats(0.02, 0.15), st.floats(-math.pi, math.pi))
def test_steps_stop_the_divergence_after_a_push(size: float, direction: float) -> None:
    push = (3.0, cmath.rect(size, direction))
    *_, (_, state, reference, body) = pendulum_walk(planner(), walk_at(0.5), 7.0, push)
    assert abs(body.com - state.midpoint) < 0.6
    assert abs(reference.dcm - reference.dcm_reference) < 0.05


def test_a_push_forward_lengthens_the_next_step() -> None:
    def foothold(push: tuple[float, complex] | None) -> float:
        for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.5), 4.2, push):
            if state.phase is Phase.SINGLE_SUPPORT:
                last = reference.foothold - state.stance_foot.position
        return last.real

    assert foothold((4.1, 0.1 + 0j)) > foothold(None)


def test_footholds_keep_the_minimum_step_width() -> None:
    for push in (0.5j, -0.5j):
        for _, state, reference, _ in pendulum_walk(planner(), walk_at(0.3), 5.0, (3.0, push)):
            if reference.phase is Phase.SINGLE_SUPPORT and reference.phase_time > 0.3:
                outward = -1.0 if state.stance == "Left" else 1.0
                place = (reference.foothold - state.stance_foot.position) / cmath.exp(1j * state.heading)
                assert outward * place.imag >= PARAMETERS.placement.min_step_width(place.real) - 0.02


def test_a_wide_step_lowers_the_center_of_mass() -> None:
    def lowest(push: tuple[float, complex] | None) -> float:
        return min(r.com_height[0] for t, _, r, _ in pendulum_walk(planner(), walk_at(0.5), 5.0, push) if t > 3.0)

    assert min(lowest((3.5, 0.8j)), lowest((3.5, -0.8j))) < lowest(None) - 0.01


def test_the_path_begins_along_the_given_heading_not_along_the_feet() -> None:
    turned = replace(standing(), right=foot(-0.0875j, yaw=0.1), left=foot(0.0875j, yaw=0.06))
    assert planner().start(turned).heading == 0.0
    assert planner().start(turned, heading=0.3).heading == 0.3


def test_it_stops_and_stands_with_its_feet_side_by_side() -> None:
    command = lambda time: Command(0.4 if 0.2 < time < 4.0 else 0.0)  # noqa: E731
    *_, (_, state, _, body) = pendulum_walk(planner(), command, 8.0)
    assert state.phase is Phase.STAND
    assert abs(body.com_velocity) < 0.02


def test_the_zero_moment_point_stays_over_the_stance_foot() -> None:
    support = PARAMETERS.support
    for _, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 5.0, (3.0, 0.3 + 0.2j)):
        if reference.phase is Phase.SINGLE_SUPPORT and state.phase is Phase.SINGLE_SUPPORT:
            offset = reference.zmp - state.stance_foot.position
            assert -support.back - 1e-9 <= offset.real <= support.front + 1e-9
            assert abs(offset.imag) <= support.half_width + 1e-9


def in_single_support() -> tuple[PlannerState, BodyState]:
    """A state of a walk at 0.8 m/s in which one foot alone supports the body."""
    return next(
        (state, body)
        for time, state, _, body in pendulum_walk(planner(), walk_at(0.8), 2.0)
        if time > 1.2 and state.phase is Phase.SINGLE_SUPPORT and state.elapsed > 0.25
    )


@given(right=st.floats(0.0, 1.0), left=st.floats(0.0, 1.0))
def test_each_arm_swings_against_its_leg_as_far_as_it_is_free(right: float, left: float) -> None:
    state, body = in_single_support()
    free, carrying = (
        planner().update(state, replace(body, arm_freedom=freedom), WALK)[1].shoulder_flexion
        for freedom in ((1.0, 1.0), (right, left))
    )
    assert free[0] == pytest.approx(tuple(-part for part in free[1]))
    assert free[0] != (0.0, 0.0)
    for share, loaded, unloaded in zip((right, left), carrying, free, strict=True):
        assert loaded == pytest.approx(tuple(share * part for part in unloaded))


def test_the_pressure_under_a_passive_foot_is_where_its_spring_puts_it() -> None:
    """Where it is farther ahead, the body falls forward less, and the step is shorter."""
    state, body = in_single_support()
    side, footholds = state.stance, []
    passive, healthy, other = (
        StepPlanner(PARAMETERS, COM_HEIGHT, ANKLE, LEG, "Right", PERIOD, SOLE, LEVEL, passive_ankles)
        for passive_ankles in ((side,), (), (other_side(side),))
    )
    for ahead in (-0.05 - 0.02j, 0j, 0.05, 0.1 + 0.02j):
        place = state.stance_foot.position + ahead
        pressure = np.array((place.real, place.imag, 0.0))
        for force in (700.0, 0.0):
            there = replace(body.foot(side), pressure=pressure, force=force)
            plans = [
                plan.update(state, replace(body, right=there) if side == "Right" else replace(body, left=there), WALK)[
                    1
                ]
                for plan in (passive, healthy, other)
            ]
            assert plans[2].zmp == plans[1].zmp
            assert plans[0].zmp == pytest.approx(place if force else plans[1].zmp)
            if force:
                footholds.append(plans[0].foothold.real)
    assert (np.diff(footholds) < 0.0).all()


@pytest.mark.parametrize("time", [3.4, 3.5, 3.6])
def test_on_boxes_a_foot_is_on_its_way_to_the_box_on_which_it_will_step_across(time: float) -> None:
    """Behind the stance foot it cannot cross yet, and just before touchdown it cannot change the box any more."""
    walk = pendulum_walk(planner(Course((Rough(length=30.0),), run_up=0.3)), walk_at(0.8), time + 0.6, (time, 0.4j))
    pushed = (state for t, state, _, _ in walk if t > time)
    stance, states = next(groupby(pushed, key=lambda state: state.stance))
    last = [state for state in states if state.swing is not None][-1]
    assert last.swing is not None
    assert (
        OUTWARD[other_side(stance)] * last.local(last.swing.foothold.position).imag
        < PARAMETERS.placement.min_own_side_offset
    )


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_in_double_support_the_clock_runs_faster_in_proportion_to_the_load_of_the_new_foot(share: float) -> None:
    """A foot that left while it carries the weight would let the body fall."""
    walk = pendulum_walk(planner(), walk_at(0.8), 3.0)
    state, body = next((s, b) for t, s, _, b in walk if t > 2.0 and s.phase is Phase.DOUBLE_SUPPORT and s.elapsed > 0.0)
    pushed = replace(body, com_velocity=body.com_velocity + OUTWARD[state.stance] * 1j)
    loads = {state.stance: share * 700.0, state.swing_side: (1.0 - share) * 700.0}
    right, left = (replace(pushed.foot(side), force=loads[side]) for side in SIDES)
    advance = planner().update(state, replace(pushed, right=right, left=left), WALK)[0].elapsed - state.elapsed
    timing = state.timing
    assert advance == pytest.approx(PERIOD * (1.0 + share * timing.double_support_rate_limit))


def test_the_force_on_an_unloading_foot_is_limited_unless_its_ankle_is_passive() -> None:
    state, body = next(
        (state, body)
        for _, state, _, body in pendulum_walk(planner(), walk_at(1.0), 3.0)
        if state.phase is Phase.DOUBLE_SUPPORT and state.elapsed > 0.0
    )
    for passive_ankles in ((), (state.stance,), (state.swing_side,)):
        plan = StepPlanner(PARAMETERS, COM_HEIGHT, ANKLE, LEG, "Right", PERIOD, SOLE, LEVEL, passive_ankles)
        force = plan.update(state, body, WALK)[1].foot(state.swing_side).force
        assert (force == math.inf) == (state.swing_side in passive_ankles)


def test_a_pendulum_with_angular_momentum_walks_as_commanded_and_its_pressure_rolls_forward() -> None:
    support = replace(PARAMETERS.support, pivot=0.05)
    walk = pendulum_walk(planner(parameters=replace(PARAMETERS, support=support)), walk_at(1.0), 12.0)
    steady = [(t, state, reference, body) for t, state, reference, body in walk if t > 7.8]
    (first, *_, start), (last, *_, end) = steady[0], steady[-1]
    assert (end.com - start.com).real / (last - first) == pytest.approx(1.0, abs=0.03)
    single = [(s, r) for _, s, r, _ in steady if s.phase is Phase.SINGLE_SUPPORT]
    ahead = [(s.stance, s.elapsed, (r.zmp - s.stance_foot.position).real) for s, r in single]
    for (stance, before, x), (later, after, y) in pairwise(ahead):
        if stance == later and after > before:
            assert y >= x - 1e-3


def test_step_durations_do_not_depend_on_the_control_period() -> None:
    def landings(period: float) -> list[float]:
        plan = planner(period=period)
        body, state, times = standing(), None, []
        state = plan.start(body)
        for tick in range(round(4.0 / period)):
            before = state.phase
            state, _ = plan.update(state, body, walk_at(0.0001, 0.06)(tick * period))
            if before is Phase.SINGLE_SUPPORT and state.phase is Phase.DOUBLE_SUPPORT:
                times.append(tick * period)
            body = replace(body, right=replace(body.right, force=0.0), left=replace(body.left, force=0.0))
        return times

    coarse, fine = landings(0.004), landings(0.002)
    assert len(coarse) == len(fine) > 3


def test_steps_after_a_push_are_careful_and_then_ordinary_again() -> None:
    cautions = {t: s.caution for t, s, *_ in pendulum_walk(planner(), walk_at(1.0), 12.0, push=(5.0, 0.5 + 0j))}
    assert all(caution == 0.0 for time, caution in cautions.items() if time < 5.0)
    assert max(cautions.values()) > 0.5
    assert list(cautions.values())[-1] < 0.05


def test_the_pitch_at_toe_off_is_smaller_after_a_short_step() -> None:
    pitches = {}
    for time, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 8.0, push=(5.0, -0.7 + 0j)):
        behind = reference.foot(state.swing_side)
        if time > 4.0 and state.phase is Phase.DOUBLE_SUPPORT and behind.task is FootTask.HEEL_OFF:
            pitches[abs((state.right.position - state.left.position).real)] = behind.pitch[0]
    shortest, longest = min(pitches), max(pitches)
    assert shortest < 0.5 * longest
    assert pitches[shortest] < 0.6 * pitches[longest]
    assert max(pitches.values()) <= PARAMETERS.rockers.pitch


def test_in_a_backward_step_the_feet_leave_the_ground_flat() -> None:
    for time, state, reference, _ in pendulum_walk(planner(), walk_at(1.0), 5.2, push=(4.0, -1.6 + 0j)):
        behind = (state.old_foot.position - state.stance_foot.position).real < 0.0
        if time > 4.0 and state.phase is Phase.DOUBLE_SUPPORT and not behind:
            assert reference.foot(state.swing_side).task is FootTask.FLAT
            break
    else:
        pytest.fail("no step backward")


def test_a_stance_foot_that_is_still_airborne_stands_where_it_lands() -> None:
    plan, command = planner(), walk_at(0.5)
    walked = pendulum_walk(plan, command, 5.0)
    time, state, _, body = next(w for w in walked if w[0] > 3.0 and w[1].phase is Phase.DOUBLE_SUPPORT)
    drifted = body.foot(state.stance).position + 0.05j

    def stance_after(force: float) -> complex:
        feet = {state.stance.lower(): foot(drifted, force)}
        later, _ = plan.update(state, replace(body, **feet), command(time))  # type: ignore[arg-type]
        return later.foot(state.stance).position

    assert stance_after(0.0) == drifted
    assert stance_after(500.0) == state.stance_foot.position


def raised(body: Any, height: Any) -> BodyState:
    feet = {side: replace(body.foot(side.title()), height=ANKLE + height) for side in ("right", "left")}
    return replace(body, com_height=body.com_height + height, **feet)


@pytest.mark.parametrize("height", [-3.0, 40.0])
def test_on_higher_ground_every_height_is_greater_by_that(height: float) -> None:
    low, high = planner(), planner(Raised(base=height))
    state = high.start(raised(standing(), height))
    for time, _, reference, body in pendulum_walk(low, walk_at(0.8), 4.0):
        state, above = high.update(state, raised(body, height), walk_at(0.8)(time))
        assert above.ground_height == pytest.approx(height)
        assert above.com_height == pytest.approx(lifted(reference.com_height, height), abs=1e-9)
        for side in ("Right", "Left"):
            foot_above, foot_below = above.foot(side), reference.foot(side)
            if foot_below.task is FootTask.SWING:
                assert foot_above.height == pytest.approx(lifted(foot_below.height, height), abs=1e-9)
                assert foot_above.position == pytest.approx(foot_below.position, abs=1e-9)
        assert above.zmp == pytest.approx(reference.zmp, abs=1e-9)


def lifted(height: ScalarMotion, by: float) -> tuple[float, float, float]:
    return (height[0] + by, *height[1:])


@pytest.mark.parametrize("rise", [0.05, -0.05, 0.15])
def test_on_stairs_every_foothold_is_on_a_tread_and_the_swing_ends_there(rise: float) -> None:
    course, swings = stairs(rise), 0
    walk = list(pendulum_walk(planner(course), walk_at(0.5), 6.0))
    for (_, state, reference, _), (_, later, _, _) in pairwise(walk):
        if state.phase is Phase.SINGLE_SUPPORT and later.phase is Phase.DOUBLE_SUPPORT:
            swing = state.swing
            assert swing is not None
            ankle = reference.foot(state.swing_side).height[0]
            assert ankle == pytest.approx(
                swing.foothold.ground + ANKLE - StepPlannerParameters().swing.landing_depth, abs=0.01
            )
            xy = np.array([(reference.foothold.real + x, reference.foothold.imag) for x in (-SOLE.back, SOLE.front)])
            assert (course.height(xy) == swing.foothold.ground).all()
            swings += 1
    assert swings > 5


@pytest.mark.parametrize("rise", [0.05, -0.05])
def test_the_center_of_mass_follows_the_stairs(rise: float) -> None:
    course = stairs(rise)
    walk = list(pendulum_walk(planner(course), lambda time: Command(0.5 if 0.2 < time < 5.0 else 0.0), 9.0))
    heights = [reference.com_height for _, _, reference, _ in walk]
    assert max(abs(later[0] - earlier[0]) for earlier, later in pairwise(heights)) < 0.005
    *_, (_, state, reference, _) = walk
    assert state.phase is Phase.STAND
    assert abs(state.stance_foot.ground) >= 3 * abs(rise) - 1e-9
    standing_height = reference.com_height[0] - 0.5 * (state.right.ground + state.left.ground)
    assert standing_height == pytest.approx(heights[0][0], abs=0.03)


def test_the_rate_of_the_height_of_the_center_of_mass_is_its_derivative_on_stairs() -> None:
    references = [reference for _, _, reference, _ in pendulum_walk(planner(stairs(0.05)), walk_at(0.5), 6.0)]
    for before, after in pairwise(references):
        if before.phase is after.phase and after.phase_time - before.phase_time == pytest.approx(PERIOD):
            mean_rate = 0.5 * (before.com_height[1] + after.com_height[1])
            rate = (after.com_height[0] - before.com_height[0]) / PERIOD
            assert rate == pytest.approx(mean_rate, abs=0.02)


def test_on_stairs_the_walker_takes_one_tread_a_step() -> None:
    walk = list(pendulum_walk(planner(stairs(0.15)), walk_at(1.0), 9.0))
    landed = [later for (_, a, _, _), (_, later, _, _) in pairwise(walk)
              if a.phase is Phase.SINGLE_SUPPORT and later.phase is Phase.DOUBLE_SUPPORT]  # fmt: skip
    rises = [after.stance_foot.ground - before.stance_foot.ground for before, after in pairwise(landed)]
    assert max(rises) == pytest.approx(0.15)
    assert sum(rises) >= 5 * 0.15


def test_a_head_that_turns_against_the_chest_is_steady_in_space() -> None:
    rotation = replace(PARAMETERS.rotation, head=PARAMETERS.rotation.chest)
    walk = pendulum_walk(planner(parameters=replace(PARAMETERS, rotation=rotation)), walk_at(1.0), 4.0)
    chests = [(reference.chest_yaw, reference.head_yaw[0]) for _, _, reference, _ in walk]
    assert max(abs(chest) for chest, _ in chests) > 0.03
    assert all(chest + head == pytest.approx(0.0, abs=1e-9) for chest, head in chests)
