"""The diagram that a scenario asks for."""

from pydrake.systems.framework import Diagram

from humanwalk.choices.balanced import make_balanced_walker
from humanwalk.diagrams.playback import make_playback
from humanwalk.diagrams.walker import make_walker
from humanwalk.scenario import Scenario


def make_diagram(scenario: Scenario, visuals: bool = True) -> Diagram:
    """The walker with the scenario's controller, or its recording without physics; see the builders for the ports.

    Args:
        scenario: what is simulated.
        visuals: whether the walker can be seen; without physics it always can.
    """
    if scenario.follow.kinematic:
        return make_playback(scenario)
    return (make_balanced_walker if scenario.controller == "balanced" else make_walker)(scenario, visuals)
