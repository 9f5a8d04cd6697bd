"""The monitor ends a simulation on a fall, a number that is none, or Ctrl-C, and says which."""

import os
import signal

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import EventStatus
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body.plant import Subject, add_human
from humanwalk.run.monitor import CHECK_PERIOD, FALL_HEIGHT_SHARE, Monitor

GRAVITY = 9.81


@pytest.fixture(scope="module")
def falling_plant():
    """A body in free fall."""
    plant = MultibodyPlant(time_step=0.001)
    add_human(plant, Subject())
    plant.Finalize()
    return plant


def context_at(plant, height: float, time: float = 0.0):
    context = plant.CreateDefaultContext()
    state = plant.GetPositionsAndVelocities(context)
    state[plant.GetBodyByName("Pelvis").floating_positions_start() + 6] = height
    # By the state itself: Drake's own setter of positions ends the program on a number that is none.
    context.SetDiscreteState(state)
    context.SetTime(time)
    return context


def test_fall_ends_the_simulation_when_the_pelvis_is_too_low(falling_plant):
    monitor = Monitor(falling_plant)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.set_monitor(monitor)
    status = simulator.AdvanceTo(5.0)
    expected = np.sqrt(2 * (1.0 - FALL_HEIGHT_SHARE) / GRAVITY)
    assert monitor.reason == "fell"
    assert simulator.get_context().get_time() == pytest.approx(expected, abs=2 * CHECK_PERIOD)
    assert status.reason() == status.ReturnReason.kReachedTerminationCondition


def test_height_is_measured_from_the_start_and_not_from_the_standing_body(falling_plant):
    monitor = Monitor(falling_plant)
    monitor(context_at(falling_plant, 2.0))
    assert monitor(context_at(falling_plant, 1.25, 0.1)).severity() == EventStatus.Severity.kSucceeded
    assert monitor(context_at(falling_plant, 1.15, 0.2)).severity() == EventStatus.Severity.kReachedTermination


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_number_that_is_none_ends_the_simulation(falling_plant, value):
    monitor = Monitor(falling_plant)
    monitor(context_at(falling_plant, 1.0))
    status = monitor(context_at(falling_plant, value, 0.1))
    assert status.severity() == EventStatus.Severity.kReachedTermination
    assert monitor.reason == "not a number"


def test_progress_is_told_at_every_look_and_no_more_often(falling_plant):
    times = []
    monitor = Monitor(falling_plant, on_progress=times.append)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.set_monitor(monitor)
    simulator.AdvanceTo(0.1)
    assert len(times) == pytest.approx(0.1 / CHECK_PERIOD, abs=2)
    assert (np.diff(times) >= CHECK_PERIOD - 1e-9).all()
    assert monitor.reason == ""


def test_it_advances_a_simulator_to_its_time_or_to_the_fall(falling_plant):
    times = []
    monitor = Monitor(falling_plant, on_progress=times.append)
    simulator = Simulator(falling_plant, context_at(falling_plant, 1.0))
    simulator.Initialize()
    monitor.advance(simulator, 0.035)
    assert simulator.get_context().get_time() == 0.035
    np.testing.assert_allclose(times, [0.0, 0.01, 0.02, 0.03], atol=1e-12)
    monitor.advance(simulator, 5.0)
    assert monitor.reason == "fell"
    expected = np.sqrt(2 * (1.0 - FALL_HEIGHT_SHARE) / GRAVITY)
    assert simulator.get_context().get_time() == pytest.approx(expected, abs=2 * CHECK_PERIOD)
    monitor.advance(simulator, 5.0)
    assert simulator.get_context().get_time() < 1.0


def test_looking_adds_no_steps(falling_plant):
    """At the systems' own times to the last bit: another time, however near, would be another step."""
    counts = []
    for looks in (False, True):
        simulator = Simulator(falling_plant, context_at(falling_plant, 2.0))
        simulator.Initialize()
        if looks:
            Monitor(falling_plant).advance(simulator, 0.3)
        else:
            simulator.AdvanceTo(0.3)
        counts.append(simulator.get_num_steps_taken())
    assert counts[0] == counts[1]


def test_interrupt_ends_the_simulation_at_the_next_look(falling_plant):
    monitor = Monitor(falling_plant)
    before = signal.getsignal(signal.SIGINT)
    with monitor.stop_on_interrupt():
        assert monitor(context_at(falling_plant, 1.0)).severity() == EventStatus.Severity.kSucceeded
        os.kill(os.getpid(), signal.SIGINT)
        status = monitor(context_at(falling_plant, 1.0, 1.0))
        assert status.severity() == EventStatus.Severity.kReachedTermination
        assert monitor.reason == "interrupted"
    assert signal.getsignal(signal.SIGINT) is before


def test_second_interrupt_does_what_it_always_did(falling_plant):
    # Whatever a test before has left there.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    monitor = Monitor(falling_plant)
    with monitor.stop_on_interrupt():
        os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


def test_without_a_plant_nothing_falls_and_ctrl_c_still_ends(falling_plant):
    monitor = Monitor(ConstantVectorSource([0.0]))
    assert monitor(context_at(falling_plant, 0.01)).severity() == EventStatus.Severity.kSucceeded
    monitor.interrupted = True
    assert monitor(context_at(falling_plant, 0.01, time=1.0)).severity() == EventStatus.Severity.kReachedTermination
    assert monitor.reason == "interrupted"
