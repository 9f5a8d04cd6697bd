"""All parameters of the step planner."""

from dataclasses import dataclass

from humanwalk.quantity import quantity
from humanwalk.walking.base_of_support import BaseOfSupport
from humanwalk.walking.caution import Caution
from humanwalk.walking.com_height import ComHeight
from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.counter_rotation import CounterRotation
from humanwalk.walking.felt_ground import Feeling
from humanwalk.walking.foot_placement import StepPlacement
from humanwalk.walking.foot_rockers import FootRockers
from humanwalk.walking.footholds import FootholdSearch
from humanwalk.walking.preview import Pacing
from humanwalk.walking.step_timing import StepTiming
from humanwalk.walking.swing_clearance import ClearanceParameters
from humanwalk.walking.swing_foot import SwingParameters


@dataclass(frozen=True)
class StepPlannerParameters:
    """How the walker steps and balances."""

    timing: StepTiming = StepTiming()
    caution: Caution = Caution()
    placement: StepPlacement = StepPlacement()
    footholds: FootholdSearch = FootholdSearch()
    pacing: Pacing = Pacing()
    support: BaseOfSupport = BaseOfSupport()
    rockers: FootRockers = FootRockers()
    swing: SwingParameters = SwingParameters()
    clearance: ClearanceParameters = ClearanceParameters()
    height: ComHeight = ComHeight()
    path: PathFollowing = PathFollowing()
    rotation: CounterRotation = CounterRotation()
    feeling: Feeling = Feeling()

    stop_speed: float = quantity(0.05, "m/s", 0.0, 0.5)
    """Commanded speed up to which a step is the last one."""

    stand_spread: float = quantity(0.2, "m", 0.05, 1.0)
    """Distance of a foot from its place beside the other one up to which a step is the last one. It is shorter than a
    tread: with a foot on each of two treads the walker fell (docs/balance.md, "Standing")."""

    shift_margin: float = quantity(0.015, "m", 0.0, 0.1)
    """Distance by which the DCM may leave the base of support in the weight shift (our choice): at its end before a
    walk at 1 m/s the DCM is at the front of the base of support."""

    dcm_gain: float = quantity(1.0, "", 0.0, 5.0)
    """Rate at which an error of the DCM decays, relative to the natural frequency, within the base of support."""

    double_support_gain: float = quantity(2.0, "", 0.0, 20.0)
    """The same in double support, where the base of support is larger."""
