"""Shows how a walker that has fallen comes to lie; nothing of it is measured."""

from collections.abc import Sequence
from contextlib import suppress

from pydrake.geometry import Meshcat
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.diagrams.ragdoll import make_ragdoll
from humanwalk.diagrams.visualizer import add_visualizer
from humanwalk.measures.ends import FELL
from humanwalk.measures.summary import Summary
from humanwalk.numerics import Array
from humanwalk.scenario import Scenario

TIME_TO_LIE = 1.5
"""Time from the detection of a fall, with the pelvis at half of its height, until the body lies [s]."""


def replay_duration(summary: Summary) -> float:
    """Duration of the replay of a run [s]: that of the run, and after a fall TIME_TO_LIE more."""
    return summary["duration_s"] + (TIME_TO_LIE if summary["end"] == FELL else 0.0)


def show_fall(scenario: Scenario, meshcats: Sequence[Meshcat], time: float, state: Array, realtime_rate: float) -> None:
    """Continue the pictures after a fall for TIME_TO_LIE, with a body without control.

    Args:
        scenario: What was simulated.
        meshcats: They show the walk; recordings continue.
        time: Of the fall [s].
        state: [q; v] of the walker's plant at that time.
        realtime_rate: Simulated seconds per second that are not exceeded; 0 is as fast as it goes.
    """
    builder = DiagramBuilder()
    ragdoll = builder.AddNamedSystem("ragdoll", make_ragdoll(scenario.subject, scenario.terrain, state))
    # A picture is no reason to lose the run: Meshcat may be lost, and the simulation may fail.
    with suppress(RuntimeError):
        for meshcat in meshcats:
            add_visualizer(builder, ragdoll, meshcat, scenario.recording.frame_rate, scenario.terrain, record=False)
        simulator = Simulator(builder.Build())
        simulator.set_target_realtime_rate(realtime_rate)
        context = simulator.get_mutable_context()
        context.SetTime(time)
        plant = ragdoll.GetSubsystemByName("plant")
        plant.SetPositionsAndVelocities(plant.GetMyMutableContextFromRoot(context), state)
        simulator.AdvanceTo(time + TIME_TO_LIE)
