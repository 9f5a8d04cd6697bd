"""Simulates a scenario and returns what happened."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from pydrake.geometry import Meshcat
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import Diagram, DiagramBuilder, System

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices.start import start_velocities
from humanwalk.diagrams.visualizer import add_visualizer
from humanwalk.diagrams.walker import make_diagram
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.fall_picture import show_fall
from humanwalk.run.monitor import Monitor
from humanwalk.run.outcome import Outcome
from humanwalk.run.recorder import Recorder
from humanwalk.run.stored import before_runaway
from humanwalk.scenario import Scenario

CENIC_MAX_STEP = 0.01
"""Largest step that the error control may choose [s]: no longer than a heel strike lasts."""


@dataclass(frozen=True)
class Prepared:
    """A simulation that has not begun.

    Attributes:
        simulator: of a root diagram with the walker in it, not initialized.
        walker: the scenario's diagram.
        plant: the plant in it; None where a recording is shown without physics.
        recorder: its log sinks; None where nothing is recorded.
    """

    simulator: Simulator
    walker: Diagram
    plant: MultibodyPlant | None
    recorder: Recorder | None

    @property
    def watched(self) -> System:
        """What a Monitor watches: the plant, or the walker where there is none."""
        return self.plant or self.walker


def prepare(scenario: Scenario, meshcat: Meshcat | None = None, record: bool = True) -> Prepared:
    """Build the root diagram of a scenario and its simulator.

    Args:
        scenario: what to simulate.
        meshcat: shows and records the motion.
        record: whether signals are recorded.

    Raises:
        ParameterError: the scenario cannot be simulated.
    """
    builder = DiagramBuilder()
    walker = builder.AddNamedSystem("walker", make_diagram(scenario, visuals=meshcat is not None))
    plant = walker.GetSubsystemByName("plant") if walker.HasSubsystemNamed("plant") else None
    assert plant is None or isinstance(plant, MultibodyPlant)
    recorder = None
    if record:
        joints = JointMap.of(plant or kinematics_plant(scenario.subject))
        recorder = Recorder.add_to(builder, walker, joints, scenario.recording.signal_period)
    if meshcat is not None:
        add_visualizer(
            builder,
            walker.GetOutputPort("query_object"),
            meshcat,
            scenario.recording.frame_rate,
            scenario.terrain,
            walker.GetOutputPort("foot_forces") if walker.HasOutputPort("foot_forces") else None,
        )
    diagram = builder.Build()
    diagram.set_name("humanwalk")
    simulator = Simulator(diagram)
    if plant is not None:
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        plant.SetVelocities(context, start_velocities(scenario.subject, scenario.start, scenario.seed))
    if plant is not None and scenario.simulation.integrator == "cenic":
        ApplySimulatorConfig(
            SimulatorConfig(
                integration_scheme="cenic", accuracy=scenario.simulation.accuracy, max_step_size=CENIC_MAX_STEP
            ),
            simulator,
        )
    return Prepared(simulator, walker, plant, recorder)


def simulate(
    scenario: Scenario,
    meshcat: Meshcat | None = None,
    on_progress: Callable[[float], None] | None = None,
    realtime_rate: float = 0.0,
    on_checkpoint: Callable[[Outcome], None] | None = None,
    checkpoint_period: float = 60.0,
    on_end: Callable[[Outcome], object] | None = None,
) -> Outcome:
    """Simulate a scenario from its start to its duration, or until it falls, fails or Ctrl-C is pressed.

    Args:
        scenario: what to simulate.
        meshcat: shows and records the motion, after a fall until the body lies; the caller publishes the recording.
        on_progress: called with the simulated time [s] every 10 ms of it.
        realtime_rate: simulated seconds per second that are not exceeded; 0 is as fast as it goes.
        on_checkpoint: called with the outcome so far every `checkpoint_period` seconds of wall-clock time.
        on_end: called with the outcome while signals such as SIGTERM still wait, to save it.

    Raises:
        ParameterError: the scenario cannot be simulated, or failed before there was anything to record.
    """
    prepared = prepare(scenario, meshcat)
    simulator, recorder = prepared.simulator, prepared.recorder
    assert recorder is not None
    simulator.set_target_realtime_rate(realtime_rate)
    started = last_checkpoint = time.perf_counter()

    def look(simulated: float) -> None:
        nonlocal last_checkpoint
        if on_progress is not None:
            on_progress(simulated)
        now = time.perf_counter()
        if on_checkpoint is not None and now - last_checkpoint >= checkpoint_period:
            signals = before_runaway(recorder.table(simulator.get_context()))
            on_checkpoint(Outcome(scenario, signals, "unfinished", now - started))
            last_checkpoint = time.perf_counter()

    monitor = Monitor(prepared.watched, scenario.terrain, on_progress=look)
    with monitor.stop_on_signal():
        try:
            simulator.Initialize()
            monitor.advance(simulator, scenario.duration)
            end = monitor.reason or "completed"
        except ParameterError:
            raise
        except (RuntimeError, SystemExit, ValueError, ArithmeticError) as error:
            # When the state has run away, Drake's solvers throw, its checks exit and NumPy raises; the record until
            # then is kept.
            end = monitor.reason or f"solver failed: {printable((str(error) or repr(error)).splitlines()[0])}"
        wall_time = time.perf_counter() - started
        signals = before_runaway(recorder.table(simulator.get_context()))
        if signals.num_rows == 0:
            raise ParameterError(
                f"simulation: nothing to record, it ended at its start: {end}; change start or actuators"
            )
        outcome = Outcome(scenario, signals, end, wall_time)
        if on_end is not None:
            on_end(outcome)
        if end == "fell" and meshcat is not None and prepared.plant is not None:
            context = simulator.get_context()
            state = prepared.plant.GetPositionsAndVelocities(prepared.plant.GetMyContextFromRoot(context))
            show_fall(scenario, meshcat, context.get_time(), state, realtime_rate)
    return outcome
