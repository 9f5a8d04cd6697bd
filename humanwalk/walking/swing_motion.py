"""The swinging foot from one control period to the next: its foothold, its clearance and its way over the level plane.

Points of the level plane are complex numbers x + iy [m].
"""

import math
from typing import NamedTuple

from humanwalk.numerics.scalars import wrapped
from humanwalk.sides import OUTWARD
from humanwalk.walking.command import Command
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.motions import PlanarMotion, shortest_blend
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState, Swing
from humanwalk.walking.preview import FootholdPlanner
from humanwalk.walking.swing_clearance import OrdinarySwing, clearance

TURNED = 0.5
"""Remaining share of the yaw at lift-off, relative to the stance foot, when the toes reach its heel (our choice)."""

PARTS = 16
"""Number of parts of the way to the foothold; the clearance of the stance foot is checked at their ends."""


class SwingGoal(NamedTuple):
    """Where a swinging foot goes.

    Attributes:
        desired: Foothold that balance requires now [m].
        expected: Foothold that it will require at touchdown [m].
        remaining: Time until touchdown [s].
    """

    desired: complex
    expected: complex
    remaining: float


def advanced_swing(
    state: PlannerState,
    swing: Swing,
    goal: SwingGoal,
    command: Command,
    parameters: StepPlannerParameters,
    footholds: FootholdPlanner,
    period: float,
) -> Swing:
    """Return the swinging foot one control period later.

    Args:
        state: State of the planner.
        swing: The swinging foot.
        goal: Where it goes.
        command: The command.
        parameters: Parameters of the planner.
        footholds: Finds the foothold.
        period: Control period [s].
    """
    is_first = state.elapsed == swing.lift_off
    if state.timing.step - state.elapsed > parameters.placement.freeze_time:
        swing = _with_foothold(state, swing, goal, parameters, footholds, None if is_first else period)
    toe_in = footholds.sole.front * math.sin(max(TURNED * _inward(state, swing), 0.0))
    return swing._replace(motion=_moved(state, swing, goal.remaining, command, parameters, period, toe_in))


def _with_foothold(
    state: PlannerState,
    swing: Swing,
    goal: SwingGoal,
    parameters: StepPlannerParameters,
    footholds: FootholdPlanner,
    period: float | None,
) -> Swing:
    """The swing with the foothold nearest to the goal, filtered but in the first control period."""
    placement = parameters.placement
    times = (placement.filter_time, placement.rise_filter_time)
    smoothing, slow = (1.0 if period is None else period / (period + time) for time in times)
    yaw = state.heading + state.turn * state.timing.step
    is_final = state.timing.step - state.elapsed < placement.face_freeze_time
    stance = (state.stance_foot, state.stance, state.direction)
    place, landing = (
        footholds.nearest(state.ground, point, yaw, *stance, swing.foothold.face, goal.expected, is_final)
        for point in (goal.desired, goal.expected)
    )
    # The desired foothold varies within a step; near a riser it would delay the foot for the rest of the swing.
    feet = (_origin(state, swing, landing), landing)
    now = state.timing.swing_progress(state.elapsed), swing.motion.position
    ordinary = OrdinarySwing(swing.lowest, now=now)
    added = clearance(state.ground, *feet, yaw, footholds.sole, parameters.clearance, ordinary)
    position = swing.foothold.position + smoothing * (place.position - swing.foothold.position)
    return swing._replace(
        foothold=place._replace(position=position),
        rise=swing.rise + slow * (place.ground - state.old_foot.ground - swing.rise),
        clearance=swing.clearance.filtered(added, slow),
    )


def _origin(state: PlannerState, swing: Swing, landing: Foothold) -> Foothold:
    """The foothold that the foot left; where it was at lift-off if it returns to the face.

    The rise of its heel has moved it forward, and its toes may be over the next tread.
    """
    stood = state.old_foot
    return stood._replace(position=swing.start) if stood.face.covers_as(landing.face) else stood


def _inward(state: PlannerState, swing: Swing) -> float:
    """Angle by which the foot pointed toward the side of the stance foot at lift-off, relative to this step [rad]."""
    return OUTWARD[state.stance] * wrapped(swing.start_yaw - state.heading)


def _moved(
    state: PlannerState,
    swing: Swing,
    remaining: float,
    command: Command,
    parameters: StepPlannerParameters,
    period: float,
    toe_in: float,
) -> PlanarMotion:
    """Motion over the level plane: on the way to the foothold, and around the stance foot.

    A foot that needs longer to move aside moves forward later.
    """
    foothold, added, jerk_limit = swing.foothold.position, swing.clearance, parameters.swing.jerk_limit
    progress = state.timing.swing_progress(state.elapsed)
    landing, time = parameters.swing.landing(foothold, command.velocity * state.direction), remaining
    start, *way = map(state.local, (swing.start, *swing.motion.way(landing, max(time, period), PARTS)))
    if progress < added.depart:
        landing, time = PlanarMotion(swing.start), added.time_to_depart(progress, remaining, parameters.clearance.hold)
    elif added.arrive < 1.0:
        landing, time = PlanarMotion(foothold), added.time_to_arrive(progress, remaining, parameters.clearance.hold)
    waypoint = parameters.placement.passing_waypoint(start, way, state.stance, toe_in)
    if waypoint is None:
        return swing.motion.towards(landing, time, period, jerk_limit)
    point, fraction = waypoint
    aside = shortest_blend((point - way[0]).imag, parameters.placement.passing_acceleration)
    aside = max(aside, fraction * remaining)
    motion = swing.motion.towards(landing, time + aside - fraction * remaining, period, jerk_limit)
    passing = swing.motion.towards(PlanarMotion(state.world(point)), aside, period, jerk_limit)
    return motion.with_sideways_of(passing, state.direction)
