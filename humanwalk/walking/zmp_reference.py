"""The desired periodic gait, and the nominal centroidal moment pivot from now to the end of the step."""

import cmath
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from humanwalk.numerics.scalars import wrapped
from humanwalk.walking.command import Command
from humanwalk.walking.lipm import PeriodicGait, PerStance, ZmpSegment, remainder
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.preview import STEPS
from humanwalk.walking.walking_reference import Phase


def descent_shares(state: PlannerState, parameters: StepPlannerParameters) -> tuple[float, ...]:
    """How much of a step down this step is, and each of the next ones; 0 on a plane and in standing, 1 on stairs."""
    feet = (state.stance_foot, *state.preview.footholds)
    shares = [parameters.swing.descent_share(start.step_to(goal)) for start, goal in pairwise(feet)]
    return (*shares, *(0.0,) * (STEPS - len(shares)))


def turned(state: PlannerState, command: Command) -> PlannerState:
    """The state with the turn of this step and of the next ones, from the path beside the next foothold.

    Beyond its end the path continues along the current command. In turns on the spot the turn changes at touchdown
    only. See docs/decisions/0052-turns-within-a-step.md.
    """
    if abs(command.velocity) < state.path.min_speed:
        return state
    step, preview = state.timing.step, state.preview
    next_foot = state.world(preview.paced(command).velocity * step * cmath.exp(0.5j * state.turn * step))
    beside = state.path.nearest(next_foot, command)
    return state._replace(turn=wrapped(beside.heading - state.heading) / step, next_turn=beside.turn)


def desired_gait(
    state: PlannerState, command: Command, parameters: StepPlannerParameters, descent: float = 0.0
) -> PeriodicGait:
    """The periodic gait with the commanded velocity and the velocity towards the path.

    Args:
        state: State of the planner.
        command: The command.
        parameters: Parameters of the planner.
        descent: How much of a step down its steps are, 0 to 1: in these the pivot is ahead of the ball while the heel
            is up.
    """
    timing, placement, rockers = state.timing, parameters.placement, parameters.rockers
    move = (command.velocity + state.path_correction) * timing.step
    turn = state.turn * timing.step
    # In a sideways walk, every other step is narrower by the sideways displacement.
    width = max(placement.step_width, placement.min_width + abs(move.imag))
    half = 0.5j * width * (1.0 + cmath.exp(1j * turn))
    along = move * cmath.exp(0.5j * turn)
    # When walking backward, the heel stays down.
    descent = descent if command.forward >= 0.0 else 0.0
    roll = parameters.support.roll * complex(max(command.forward, 0.0), command.sideways)
    descending_roll = descent * (parameters.support.descent - parameters.support.center)
    return PeriodicGait(
        displacement=PerStance(left=along - half, right=along + half),
        turn=turn,
        # When walking backward, the feet land flat: the zero-moment point does not roll.
        roll=complex(max(roll.real, descending_roll), roll.imag),
        double_support=timing.double_support,
        single_support=timing.single_support,
        # With the heel up before a step down the pivot stays where `descent` puts it.
        pivot=(1.0 - descent) * parameters.support.pivot * max(command.forward, 0.0),
        # While the heel is up the ball is all that the foot stands on.
        hold=min((1.0 - descent) * rockers.lead(command.forward) + descent * rockers.descent, timing.single_support),
    )


def desired_gaits(state: PlannerState, command: Command, parameters: StepPlannerParameters) -> tuple[PeriodicGait, ...]:
    """The desired gaits of this step and of the next ones, which have steps of the same length in their own time.

    A step that takes longer begins with a DCM that is nearer to its stance foot.
    """
    gaits, turn = [], state.turn
    for duration, descent in zip((1.0, *state.preview.durations), descent_shares(state, parameters), strict=True):
        timed = state._replace(
            timing=state.timing.stretched(duration),
            path_correction=state.path_correction / duration,
            turn=turn / duration,
        )
        speed = replace(command, forward=command.forward / duration, sideways=command.sideways / duration)
        gaits.append(desired_gait(timed, speed, parameters, descent))
        turn = state.next_turn
    return tuple(gaits)


def foothold_moves(state: PlannerState, gaits: Sequence[PeriodicGait]) -> tuple[complex, ...]:
    """Displacements of the planned footholds beyond those of the gaits of the steps, in W [m]; see `Preview.moves`."""
    return state.preview.moves(gaits, state.stance_foot.position, state.stance, state.direction)


def remaining_pivot(
    state: PlannerState, gait: PeriodicGait, parameters: StepPlannerParameters
) -> tuple[ZmpSegment, ...]:
    """The nominal centroidal moment pivot to the end of the step, over the feet as they stand [m]."""
    timing, support = state.timing, parameters.support
    stance = support.center_of(state.stance_foot.position, state.heading)
    single = tuple(segment.moved(stance, state.direction) for segment in gait.along_foot)
    if state.phase is Phase.SINGLE_SUPPORT:
        return remainder(single, state.elapsed - timing.double_support)
    old = support.center_of(state.old_foot.position, state.old_heading)
    old_end = old + gait.pivot_end * cmath.exp(1j * state.old_heading)
    return (ZmpSegment(old_end, single[0].start, timing.double_support).remainder(state.elapsed), *single)


def pivot_lead(state: PlannerState, gait: PeriodicGait) -> complex:
    """Centroidal moment pivot relative to the zero-moment point, now and in W [m]."""
    timing, pivot = state.timing, gait.pivot * state.direction
    exchange = ZmpSegment(pivot, -pivot, timing.double_support)
    swing = ZmpSegment(-pivot, pivot, timing.single_support)
    if state.phase is Phase.SINGLE_SUPPORT:
        return swing.at(state.elapsed - timing.double_support)
    return exchange.at(state.elapsed)


def remaining_ground(state: PlannerState) -> tuple[ZmpSegment, ...]:
    """Height of the ground under the nominal zero-moment point to the end of the step [m]."""
    timing, stance = state.timing, state.stance_foot.ground
    if state.phase is Phase.SINGLE_SUPPORT:
        return (ZmpSegment(stance, stance, timing.step - state.elapsed),)
    change = ZmpSegment(state.old_foot.ground, stance, timing.double_support)
    return (change.remainder(state.elapsed), ZmpSegment(stance, stance, timing.single_support))
