"""Shows a run from its signals, without simulating it again."""

from pydrake.geometry import Meshcat
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.diagrams.replay import make_replay
from humanwalk.diagrams.visualizer import add_visualizer
from humanwalk.measures.ends import FELL
from humanwalk.measures.signals import matrix
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.fall_picture import show_fall
from humanwalk.run.folder import Run
from humanwalk.systems.balance_support import WRENCH_COLUMNS
from humanwalk.systems.foot_signals import foot_columns
from humanwalk.systems.push_source import FORCE_COLUMNS
from humanwalk.systems.signal import state_columns

FORCES: dict[str, tuple[str, ...]] = {
    "foot_forces": foot_columns(SIDES),
    "push": FORCE_COLUMNS,
    "support_wrench": WRENCH_COLUMNS,
}
"""Columns of the forces that a picture shows, by output port."""


def show_run(run: Run, meshcat: Meshcat) -> None:
    """Show a run in Meshcat and record the picture, after a fall until the body lies; the caller publishes it.

    Raises:
        ParameterError: the run has a single sample.
    """
    scenario, signals, time = run.scenario, run.signals, run.time
    if time.size < 2:
        raise ParameterError(f"{printable(run.path)}: one sample; allowed: two or more; walk longer")
    state = matrix(signals, state_columns(JointMap.of(kinematics_plant(scenario.subject))))
    recorded = set(signals.column_names)
    forces = {port: matrix(signals, columns) for port, columns in FORCES.items() if recorded.issuperset(columns)}
    builder = DiagramBuilder()
    replay = builder.AddNamedSystem("replay", make_replay(scenario, time, state, forces))
    add_visualizer(builder, replay, meshcat, scenario.recording.frame_rate, scenario.terrain)
    Simulator(builder.Build()).AdvanceTo(time[-1])
    if run.summary["end"] == FELL:
        show_fall(scenario, [meshcat], time[-1], state[-1], realtime_rate=0.0)
