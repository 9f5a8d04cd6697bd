"""Simulates a scenario and returns what happened."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from pydrake.geometry import Meshcat
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import Diagram, DiagramBuilder, System

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices.sources import FROM_SCENARIO, Sources
from humanwalk.choices.start import start_velocities
from humanwalk.diagrams.visualizer import add_visualizer
from humanwalk.diagrams.walker import make_diagram
from humanwalk.measures.ends import COMPLETED, FELL, INTERRUPTED, UNFINISHED
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD
from humanwalk.run.fall_picture import show_fall
from humanwalk.run.live_view import is_lost
from humanwalk.run.monitor import Monitor
from humanwalk.run.outcome import Outcome
from humanwalk.run.recorder import Recorder
from humanwalk.run.stored import before_runaway
from humanwalk.scenario import Scenario, require_scenario
from humanwalk.systems.following_view import FollowingView

CENIC_MAX_STEP = 0.01
"""Largest step that the error control may choose [s]: no longer than a heel strike lasts."""


@dataclass(frozen=True)
class Prepared:
    """A simulation that has not begun.

    Attributes:
        simulator: of a root diagram with the walker in it, not initialized.
        walker: the scenario's diagram.
        plant: the plant in it; None where a recording is shown without physics.
        recorder: of its signals; None where nothing is recorded.
        live_view: of the live picture; None where there is none.
        meshcats: all that show the motion.
    """

    simulator: Simulator
    walker: Diagram
    plant: MultibodyPlant | None
    recorder: Recorder | None
    live_view: FollowingView | None = None
    meshcats: tuple[Meshcat, ...] = ()

    @property
    def watched(self) -> System:
        """What a Monitor watches: the plant, or the walker where there is none."""
        return self.plant or self.walker


def prepare(
    scenario: Scenario,
    meshcat: Meshcat | None = None,
    record: bool = True,
    live: Meshcat | None = None,
    sources: Sources = FROM_SCENARIO,
) -> Prepared:
    """Build the root diagram of a scenario and its simulator.

    Args:
        scenario: what to simulate.
        meshcat: shows and records the motion.
        record: whether signals are recorded.
        live: shows the motion without recording it.
        sources: systems that command and push the walker.

    Raises:
        ParameterError: the scenario cannot be simulated.
    """
    builder = DiagramBuilder()
    meshcats = tuple(shown for shown in (meshcat, live) if shown is not None)
    walker = builder.AddNamedSystem("walker", make_diagram(scenario, bool(meshcats), sources))
    plant = walker.GetSubsystemByName("plant") if walker.HasSubsystemNamed("plant") else None
    assert plant is None or isinstance(plant, MultibodyPlant)
    recorder = None
    if record:
        joints = JointMap.of(plant or kinematics_plant(scenario.subject))
        recorder = Recorder.add_to(builder, walker, joints, scenario.recording.signal_period)
    show = partial(add_visualizer, builder, walker, frame_rate=scenario.recording.frame_rate, terrain=scenario.terrain)
    if meshcat is not None:
        show(meshcat)
    live_view = None if live is None else show(live, record=False)
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
    return Prepared(simulator, walker, plant, recorder, live_view, meshcats)


def simulate(
    scenario: Scenario,
    meshcat: Meshcat | None = None,
    on_progress: Callable[[float], None] | None = None,
    realtime_rate: float = 0.0,
    on_checkpoint: Callable[[Outcome], None] | None = None,
    checkpoint_period: float = CHECKPOINT_PERIOD,
    on_end: Callable[[Outcome], object] | None = None,
    live: Meshcat | None = None,
) -> Outcome:
    """Simulate a scenario from its start to its duration, or until it falls, fails or Ctrl-C is pressed.

    Args:
        scenario: what to simulate.
        meshcat: shows and records the motion, after a fall until the body lies; the caller publishes the recording.
        on_progress: called with the simulated time [s] every 10 ms of it.
        realtime_rate: simulated seconds per second that are not exceeded; 0 is as fast as it goes.
        on_checkpoint: called with the outcome so far every `checkpoint_period` seconds of wall-clock time.
        on_end: called with the outcome while signals such as SIGTERM still wait, to save it.
        live: shows the motion without recording it; if it is lost, the simulation ends as at Ctrl-C.

    Raises:
        ParameterError: the scenario cannot be simulated, or failed before there was anything to record.
    """
    require_scenario(scenario, "simulate")
    prepared = prepare(scenario, meshcat, live=live)
    prepared.simulator.set_target_realtime_rate(realtime_rate)
    monitor = Monitor(prepared.watched, scenario.terrain)
    return simulate_prepared(
        scenario, prepared, monitor, on_progress, on_checkpoint, checkpoint_period, on_end, realtime_rate
    )


def simulate_prepared(
    scenario: Scenario,
    prepared: Prepared,
    monitor: Monitor,
    on_progress: Callable[[float], None] | None = None,
    on_checkpoint: Callable[[Outcome], None] | None = None,
    checkpoint_period: float = CHECKPOINT_PERIOD,
    on_end: Callable[[Outcome], object] | None = None,
    fall_rate: float = 0.0,
) -> Outcome:
    """Simulate what was prepared; see `simulate`.

    Args:
        scenario: what was prepared.
        prepared: with a recorder.
        monitor: of its plant; another cause than those of a Monitor may interrupt it.
        on_progress, on_checkpoint, checkpoint_period, on_end: see `simulate`.
        fall_rate: simulated seconds per second that are not exceeded after a fall; 0 is as fast as it goes.

    Raises:
        ParameterError: it failed before there was anything to record.
    """
    simulator, recorder = prepared.simulator, prepared.recorder
    assert recorder is not None
    started = last_checkpoint = time.perf_counter()

    def look(simulated: float) -> None:
        nonlocal last_checkpoint
        if on_progress is not None:
            on_progress(simulated)
        now = time.perf_counter()
        if on_checkpoint is not None and now - last_checkpoint >= checkpoint_period:
            signals = before_runaway(recorder.table(simulator.get_context()))
            on_checkpoint(Outcome(scenario, signals, UNFINISHED, now - started))
            last_checkpoint = time.perf_counter()

    monitor.on_progress = look
    with monitor.stop_on_signal():
        try:
            simulator.Initialize()
            monitor.advance(simulator, scenario.duration)
            end = monitor.reason or COMPLETED
        except ParameterError:
            raise
        except (RuntimeError, SystemExit, ValueError, ArithmeticError) as error:
            # When the state has run away, Drake's solvers throw, its checks exit and NumPy raises; the record until
            # then is kept.
            failed = f"solver failed: {printable((str(error) or repr(error)).splitlines()[0])}"
            end = monitor.reason or (INTERRUPTED if any(map(is_lost, prepared.meshcats)) else failed)
        wall_time = time.perf_counter() - started
        signals = before_runaway(recorder.table(simulator.get_context()))
        if signals.num_rows == 0:
            raise ParameterError(
                f"simulation: nothing to record, it ended at its start: {end}; change start or actuators"
            )
        outcome = Outcome(scenario, signals, end, wall_time)
        if on_end is not None:
            on_end(outcome)
        if end == FELL and prepared.meshcats and prepared.plant is not None:
            context = simulator.get_context()
            state = prepared.plant.GetPositionsAndVelocities(prepared.plant.GetMyContextFromRoot(context))
            show_fall(scenario, prepared.meshcats, context.get_time(), state, fall_rate)
    return outcome
