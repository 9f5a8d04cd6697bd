"""What the feet feel of the ground in the phases of the walk."""

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import SoleExtent
from humanwalk.terrain.terrain import Touch
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.walking_reference import BodyState


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
    found = []
    for side in standing_feet(state):
        foot = body.foot(side)
        is_loaded = foot.force >= parameters.timing.touchdown_force
        if not (is_loaded or is_landing):
            continue
        ankle = (foot.position.real, foot.position.imag, foot.height)
        heel = ankle - sole.back * foot.forward - ankle_height * foot.normal
        pressure = foot.pressure if is_loaded else None
        ahead = float((foot.pressure - ankle) @ foot.forward)
        found.append(Touch(SIDES.index(side), heel, foot.forward, foot.normal, pressure, ahead, is_rolling))
    return tuple(found)
