"""What the feet feel of the ground in the phases of the walk."""

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import SoleExtent
from humanwalk.numerics import Array
from humanwalk.terrain.terrain import Touch
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.walking_reference import BodyState, FootState

UP = np.array((0.0, 0.0, 1.0))

STANDING_TIME = 10.0
"""Time for which both feet have stood before the start [s], long enough to feel the whole slope (our choice)."""


def standing_feet(state: PlannerState) -> tuple[Side, ...]:
    """The feet that should stand with the whole sole: the stance foot of a step, both without steps."""
    return (state.stance,) if state.is_stepping else SIDES


def touches(
    state: PlannerState, body: BodyState, parameters: StepPlannerParameters, sole: SoleExtent, ankle_height: float
) -> tuple[Touch, ...]:
    """Return what the feet feel that should stand; a foot that is being unloaded feels nothing.

    Args:
        state: State of the planner.
        body: State of the body.
        parameters: Parameters of the planner.
        sole: Extent of the sole.
        ankle_height: Height of the ankle above the sole [m].
    """
    is_landing = state.is_stepping and state.steps > 0 and state.elapsed <= parameters.rockers.heel
    is_rolling = state.is_stepping and state.elapsed > state.timing.step - parameters.rockers.ball
    has_landed = state.is_stepping and not is_landing and not is_rolling
    found = []
    for side in standing_feet(state):
        foot = body.foot(side)
        is_loaded = foot.force >= parameters.timing.loaded_force
        if not (is_loaded or is_landing):
            continue
        pressure = foot.pressure if is_loaded else None
        planned = ((state.zmp - foot.position) / state.direction).real
        is_still = has_landed and abs(foot.pitch_rate) < parameters.feeling.still_rate
        found.append(_touch(side, foot, pressure, planned, sole, ankle_height, is_rolling, is_still))
    return tuple(found)


def first_touches(body: BodyState, sole: SoleExtent, ankle_height: float) -> tuple[Touch, ...]:
    """Return what the feet feel at the start, when both stand with the whole sole; see `touches`."""
    feet = ((side, body.foot(side)) for side in SIDES)
    return tuple(
        _touch(side, foot, foot.ankle - ankle_height * foot.normal, 0.0, sole, ankle_height) for side, foot in feet
    )


def _touch(
    side: Side,
    foot: FootState,
    pressure: Array | None,
    planned: float,
    sole: SoleExtent,
    ankle_height: float,
    is_rolling: bool = False,
    is_still: bool = False,
) -> Touch:
    heel = foot.ankle - sole.back * foot.forward - ankle_height * foot.normal
    if pressure is not None:
        # A foot across an edge feels the plane of its sole, and not how far below it the ground is.
        pressure = pressure - UP * ((pressure - heel) @ foot.normal / foot.normal[2])
    ahead = 0.0 if pressure is None else float((pressure - foot.ankle) @ foot.forward)
    return Touch(SIDES.index(side), heel, foot.forward, foot.normal, pressure, ahead, planned, is_rolling, is_still)
