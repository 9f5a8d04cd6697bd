"""The monitor ends a simulation after a fall, at a value that is not finite, or at a signal, and gives the reason."""

import os
import signal
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, EventStatus
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body.limbs import PELVIS
from humanwalk.body.plant import add_human
from humanwalk.body.subject import Subject
from humanwalk.quantity import GRAVITY
from humanwalk.run.monitor import CHECK_PERIOD, FALL_HEIGHT_SHARE, STOP_SIGNALS, Monitor
from humanwalk.terrain import Plane

LEVEL = Plane()


@pytest.fixture(scope="module")
def falling_plant() -> MultibodyPlant:
    """A body in free fall."""
    plant = MultibodyPlant(time_step=0.001)
    add_human(plant, Subject())
    plant.Finalize()
    return plant


def context_at(plant: MultibodyPlant, height: float, time: float = 0.0, x: float = 0.0) -> Context:
    context = plant.CreateDefaultContext()
    state = plant.GetPositionsAndVelocities(context)
    place = plant.GetBodyByName(PELVIS).floating_positions_start() + 4
    state[place], state[place + 2] = x, height
    # Drake's own setter of positions ends the program on a value that is not finite.
    context.SetDiscreteState(state)
    context.SetTime(time)
    return context


def test_fall_ends_the_simulation_when_the_pelvis_is_too_low(falling_plant: MultibodyPlant) -> None:
    monitor = Monitor(falling_plant, LEVEL)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.set_monitor(monitor)
    status = simulator.AdvanceTo(5.0)
    expected = np.sqrt(2 * (1.0 - FALL_HEIGHT_SHARE) / GRAVITY)
    assert monitor.reason == "fell"
    assert simulator.get_context().get_time() == pytest.approx(expected, abs=2 * CHECK_PERIOD)
    assert status.reason() == status.ReturnReason.kReachedTerminationCondition


def test_fall_is_relative_to_the_initial_height(falling_plant: MultibodyPlant) -> None:
    monitor = Monitor(falling_plant, LEVEL)
    monitor(context_at(falling_plant, 2.0))
    above, below = 2.0 * FALL_HEIGHT_SHARE + 0.05, 2.0 * FALL_HEIGHT_SHARE - 0.05
    assert monitor(context_at(falling_plant, above, 0.1)).severity() == EventStatus.Severity.kSucceeded
    assert monitor(context_at(falling_plant, below, 0.2)).severity() == EventStatus.Severity.kReachedTermination


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_value_that_is_not_finite_ends_the_simulation(falling_plant: MultibodyPlant, value: float) -> None:
    monitor = Monitor(falling_plant, LEVEL)
    monitor(context_at(falling_plant, 1.0))
    status = monitor(context_at(falling_plant, value, 0.1))
    assert status.severity() == EventStatus.Severity.kReachedTermination
    assert monitor.reason == "not a number"


def test_progress_is_reported_at_every_check(falling_plant: MultibodyPlant) -> None:
    times = []
    monitor = Monitor(falling_plant, LEVEL, on_progress=times.append)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.set_monitor(monitor)
    simulator.AdvanceTo(0.1)
    assert len(times) == pytest.approx(0.1 / CHECK_PERIOD, abs=2)
    assert (np.diff(times) >= CHECK_PERIOD - 1e-9).all()
    assert monitor.reason == ""


def test_advance_ends_at_its_time_or_at_the_fall(falling_plant: MultibodyPlant) -> None:
    times = []
    monitor = Monitor(falling_plant, LEVEL, on_progress=times.append)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.Initialize()
    monitor.advance(simulator, 0.035)
    assert simulator.get_context().get_time() == 0.035
    np.testing.assert_allclose(times, [0.0, 0.01, 0.02, 0.03], atol=1e-12)  # type: ignore[arg-type]
    monitor.advance(simulator, 5.0)
    assert monitor.reason == "fell"
    expected = np.sqrt(2 * (1.0 - FALL_HEIGHT_SHARE) / GRAVITY)
    assert simulator.get_context().get_time() == pytest.approx(expected, abs=2 * CHECK_PERIOD)
    monitor.advance(simulator, 5.0)
    assert simulator.get_context().get_time() < 1.0


def test_checks_add_no_steps(falling_plant: MultibodyPlant) -> None:
    """Checks are exactly at the systems' own times; any other time would be another step."""
    counts = []
    for checks in (False, True):
        simulator = Simulator(falling_plant, context_at(falling_plant, 2.0))
        simulator.Initialize()
        if checks:
            Monitor(falling_plant, LEVEL).advance(simulator, 0.3)
        else:
            simulator.AdvanceTo(0.3)
        counts.append(simulator.get_num_steps_taken())
    assert counts[0] == counts[1]


def test_height_is_measured_above_the_terrain_under_the_pelvis(falling_plant: MultibodyPlant) -> None:
    """Uphill a standing walker is higher than at its start; downhill it is lower and has not fallen."""
    slope = Plane(slope=0.2)
    for x, has_fallen in ((-5.0, False), (5.0, False)):
        monitor = Monitor(falling_plant, slope)
        monitor(context_at(falling_plant, 1.0))
        monitor(context_at(falling_plant, 1.0 + x * np.tan(0.2), 0.1, x))
        assert (monitor.reason == "fell") == has_fallen
    monitor = Monitor(falling_plant, slope)
    monitor(context_at(falling_plant, 1.0))
    monitor(context_at(falling_plant, 1.0, 0.1, x=5.0))
    assert monitor.reason == "fell"


@pytest.fixture
def handlers() -> Iterator[list[Any]]:
    """Python's own handlers, and those of before at the end."""
    before = {number: signal.getsignal(number) for number in STOP_SIGNALS}
    caught = []
    for number in STOP_SIGNALS:
        signal.signal(number, lambda number, frame: caught.append(number))
    yield caught
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_signals_end_the_simulation_at_the_next_check_and_only_a_second_ctrl_c_acts_as_before(
    falling_plant: MultibodyPlant, handlers: list[Any], number: Any
) -> None:
    monitor = Monitor(falling_plant, LEVEL)
    before = signal.getsignal(number)
    with monitor.stop_on_signal():
        assert monitor(context_at(falling_plant, 1.0)).severity() == EventStatus.Severity.kSucceeded
        os.kill(os.getpid(), number)
        status = monitor(context_at(falling_plant, 1.0, 1.0))
        assert status.severity() == EventStatus.Severity.kReachedTermination
        assert monitor.reason == "interrupted"
        assert handlers == []
        os.kill(os.getpid(), number)
        assert handlers == ([number] if number == signal.SIGINT else [])
    assert signal.getsignal(number) is before


def test_signal_that_is_ignored_stays_ignored(falling_plant: MultibodyPlant, handlers: list[Any]) -> None:
    """As SIGHUP under nohup."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    monitor = Monitor(falling_plant, LEVEL)
    with monitor.stop_on_signal():
        os.kill(os.getpid(), signal.SIGHUP)
        assert not monitor.interrupted
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_signal_after_the_last_check_acts_at_the_end_of_the_block(
    falling_plant: MultibodyPlant, handlers: list[Any], number: Any
) -> None:
    with Monitor(falling_plant, LEVEL).stop_on_signal():
        os.kill(os.getpid(), number)
        assert handlers == []
    assert handlers == [number]


def test_simulation_in_another_thread_leaves_the_signals_alone(
    falling_plant: MultibodyPlant, handlers: list[Any]
) -> None:
    def simulate() -> None:
        with Monitor(falling_plant, LEVEL).stop_on_signal():
            seen.append(signal.getsignal(signal.SIGINT))

    seen: list = []  # type: ignore[type-arg]
    thread = threading.Thread(target=simulate)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGINT)]


def test_without_a_plant_nothing_falls_and_an_interrupt_still_ends(falling_plant: MultibodyPlant) -> None:
    monitor = Monitor(ConstantVectorSource([0.0]), LEVEL)
    assert monitor(context_at(falling_plant, 0.01)).severity() == EventStatus.Severity.kSucceeded
    monitor.interrupted = True
    assert monitor(context_at(falling_plant, 0.01, time=1.0)).severity() == EventStatus.Severity.kReachedTermination
    assert monitor.reason == "interrupted"
