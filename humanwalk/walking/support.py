"""The height of the support: the vertical coordinate of the pendulum on ground that is not level.

With the center of mass at c_z = s + h above a support s that obeys s'' = w^2 (s - g), where g is the height of the
ground under the zero-moment point and w^2 = g_0 / h, the horizontal motion is that of the pendulum on level ground:
(g_0 + c_z'') / (c_z - g) = w^2. The support has a divergent component of its own, sigma = s + s'/w, which obeys
sigma' = w (sigma - g), and whose value at the end of a step follows from the heights of the next footholds, as that of
the DCM does from their places (Englsberger et al. 2015).
"""

from typing import NamedTuple

from humanwalk.walking.lipm import backward, com_after
from humanwalk.walking.motions import ScalarMotion
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.walking_reference import Phase
from humanwalk.walking.zmp_reference import remaining_ground


class SupportMotion(NamedTuple):
    """Motion of the support.

    Attributes:
        ground: Height of the ground under the zero-moment point [m].
        motion: Height of the support.
        frequency: Natural frequency of the pendulum [1/s].
    """

    ground: float
    motion: ScalarMotion
    frequency: float

    def after(self, duration: float) -> float:
        """Height of the support after a time [s] in which the ground does not change [m]."""
        divergent = self.motion.value + self.motion.rate / self.frequency
        return com_after(duration, self.motion.value, divergent, self.ground, self.frequency).real


def support_motion(state: PlannerState, end_shift: float, frequency: float) -> SupportMotion:
    """Return the motion of the support.

    Args:
        state: State of the planner.
        end_shift: Divergent component at the end of the step above the ground under the stance foot [m].
        frequency: Natural frequency of the pendulum [1/s].
    """
    stance, height = state.stance_foot.ground, state.support
    if state.is_stepping:
        segments = remaining_ground(state)
        ground, divergent = segments[0].start.real, backward(segments, stance + end_shift, frequency).real
    else:
        # Toward the mean of both feet, or to the foot that stands first.
        goal = 0.5 * (state.right.ground + state.left.ground) if state.phase is Phase.STAND else stance
        ground = divergent = goal
    rate = frequency * (divergent - height)
    return SupportMotion(ground, ScalarMotion(height, rate, frequency**2 * (height - ground)), frequency)
