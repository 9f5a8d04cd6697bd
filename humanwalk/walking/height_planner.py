"""Plans the height of the center of mass from period to period: low enough for the legs to reach the next foothold.

It is the sum of the height of the support, a mean height that follows the law `ComHeight`, and an arc over the stance
leg.
"""

import math
from typing import NamedTuple

from humanwalk.walking.footholds import Foothold
from humanwalk.walking.motions import ScalarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.support import SupportMotion
from humanwalk.walking.walking_reference import Phase
from humanwalk.walking.zmp_reference import descent_shares


class Touchdown(NamedTuple):
    """What is expected at the touchdown of the swinging foot.

    Attributes:
        foothold: Where the foot will stand.
        com: Center of mass over the level plane [m].
        support: Height of the support [m].
    """

    foothold: Foothold
    com: complex
    support: float


class HeightPlanner:
    """Pure functions of the state of the step planner.

    Args:
        parameters: Parameters of the planner.
        standing_com_height: Height of the center of mass above the ground with straight legs [m].
        leg_length: Distance of hip and ankle of a straight leg [m].
        period: Control period [s].
    """

    def __init__(
        self, parameters: StepPlannerParameters, standing_com_height: float, leg_length: float, period: float
    ) -> None:
        self._parameters, self._law, self._period = parameters, parameters.height, period
        self._standing_com_height, self._leg_length = standing_com_height, leg_length

    def highest(self, state: PlannerState, touchdown: Touchdown | None = None) -> float:
        """Largest mean height above the support in a step [m]; infinite without a planned foothold.

        Args:
            state: State of the planner.
            touchdown: What is expected at the end of the swing; None in double support.
        """
        height = self._highest_for_rise(state)
        if touchdown is not None:
            height = min(height, self._highest_for_reach(state, touchdown))
        descent, *_ = descent_shares(state, self._parameters)
        return height + self._law.before_descent(descent, state.timing.step - state.elapsed)

    def advanced(
        self, state: PlannerState, support: SupportMotion, forward_speed: float = 0.0, highest: float = math.inf
    ) -> tuple[PlannerState, ScalarMotion]:
        """The state with support and mean height one period later, and the reference of the center of mass in W.

        Args:
            state: State of the planner.
            support: Motion of the support in this period.
            forward_speed: Commanded speed of the step [m/s].
            highest: Largest mean height above the support [m].
        """
        law, period = self._law, self._period
        if state.phase is Phase.STAND:
            goal = law.standing * self._standing_com_height
        else:
            goal = law.mean(forward_speed, state.timing.step, self._standing_com_height)
        acceleration = law.approach(state.height, state.height_rate, goal, highest)
        mean = ScalarMotion(state.height, state.height_rate, acceleration)
        rate = state.height_rate + period * acceleration
        moved = support.motion
        next_state = state._replace(
            height=state.height + period * rate,
            height_rate=rate,
            support=moved.value + period * (moved.rate + 0.5 * period * moved.acceleration),
        )
        return next_state, moved.plus(mean).plus(law.arc(state.elapsed, state.timing.step, forward_speed))

    def _highest_for_rise(self, state: PlannerState) -> float:
        """Largest height from which the legs reach both the stance foot and the next foothold [m]."""
        if not state.preview.footholds:
            return math.inf
        stance, goal = state.stance_foot, state.preview.footholds[0]
        rolling = self._parameters.swing.rolling_share(stance.step_to(goal))
        return self._law.max_for_step(goal.ground - stance.ground, rolling, self._standing_com_height)

    def _highest_for_reach(self, state: PlannerState, touchdown: Touchdown) -> float:
        """Largest height from which the foothold is within reach at touchdown [m]."""
        reach = (touchdown.foothold.position - touchdown.com) / state.direction
        height = self._law.max_com_height_for_reach(reach, self._leg_length, self._standing_com_height)
        return height + touchdown.foothold.ground - touchdown.support
