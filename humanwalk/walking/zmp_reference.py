"""The desired periodic gait, and the nominal centroidal moment pivot from now to the end of the step."""

import cmath

from humanwalk.walking.command import Command
from humanwalk.walking.lipm import PeriodicGait, PerStance, ZmpSegment
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.walking_reference import Phase


def desired_gait(state: PlannerState, command: Command, parameters: StepPlannerParameters) -> PeriodicGait:
    """The periodic gait with the commanded velocity and the velocity towards the path."""
    timing, placement = state.timing, parameters.placement
    move = (command.velocity + state.path_correction) * timing.step
    turn = state.turn * timing.step
    # In a sideways walk, every other step is narrower by the sideways displacement.
    width = max(placement.step_width, placement.min_width + abs(move.imag))
    half = 0.5j * width * (1.0 + cmath.exp(1j * turn))
    along = move * cmath.exp(0.5j * turn)
    return PeriodicGait(
        displacement=PerStance(left=along - half, right=along + half),
        turn=turn,
        # When walking backward, the feet land flat: the zero-moment point does not roll.
        roll=parameters.support.roll * complex(max(command.forward, 0.0), command.sideways),
        double_support=timing.double_support,
        single_support=timing.single_support,
        pivot=parameters.support.pivot * max(command.forward, 0.0),
    )


def remaining_pivot(
    state: PlannerState, gait: PeriodicGait, parameters: StepPlannerParameters
) -> tuple[ZmpSegment, ...]:
    """The nominal centroidal moment pivot to the end of the step, over the feet as they stand [m]."""
    timing, support = state.timing, parameters.support
    stance = support.center_of(state.stance_foot.position, state.heading)
    start, end = stance - gait.pivot * state.direction, stance + gait.pivot_end * state.direction
    single = ZmpSegment(start, end, timing.single_support)
    if state.phase is Phase.SINGLE_SUPPORT:
        return (single.remainder(state.elapsed - timing.double_support),)
    old = support.center_of(state.old_foot.position, state.old_heading)
    old_end = old + gait.pivot_end * cmath.exp(1j * state.old_heading)
    return (ZmpSegment(old_end, start, timing.double_support).remainder(state.elapsed), single)


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
