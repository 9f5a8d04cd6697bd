"""Integral action in a loop: it removes the error that a load leaves with PD, and does not wind up at the limit."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator

from humanwalk.body.joint_map import JointMap
from humanwalk.control.pd_control import PD_LAWS, PdLaw
from humanwalk.systems.integral_action import IntegralAction

N, H = 42, 0.002
KP, LOAD = 100.0, 5.0
INTEGRAL_TIME = 0.2


def action(plant: MultibodyPlant) -> IntegralAction:
    return IntegralAction(plant, np.array([KP / INTEGRAL_TIME]))


def test_ports_and_signal(discrete_plant: MultibodyPlant, joints: JointMap) -> None:
    system = IntegralAction(discrete_plant, np.ones(N))
    inputs = map(system.get_input_port, range(system.num_input_ports()))
    assert {port.get_name(): port.size() for port in inputs} == {"desired_state": 84, "state": 97, "saturated": 42}
    assert (system.num_output_ports(), system.GetOutputPort("torque").size()) == (1, N)
    (signal,) = system.signals
    assert signal.name == "integral_torque"
    assert signal.columns == tuple(f"{name}.integral_torque_N_m" for name in joints.names)
    assert not system.HasAnyDirectFeedthrough()


def test_every_joint_integrates_its_own_error_at_every_step(discrete_plant: MultibodyPlant, joints: JointMap) -> None:
    """Joints are in actuator order, the plant's state is not."""
    ki, error = np.linspace(1.0, 10.0, N), np.linspace(-1.0, 1.0, N)
    system = IntegralAction(discrete_plant, ki)
    context = system.CreateDefaultContext()
    state = np.zeros(discrete_plant.num_multibody_states())
    state[joints.q] = -error
    saturated = (np.arange(N) % 5 == 0).astype(float)
    for name, value in (("desired_state", np.zeros(2 * N)), ("state", state), ("saturated", saturated)):
        system.GetInputPort(name).FixValue(context, value)
    simulator = Simulator(system, context)
    simulator.Initialize()
    np.testing.assert_array_equal(system.GetOutputPort("torque").Eval(context), 0.0)
    simulator.AdvanceTo(9.5 * H)
    expected = np.where(saturated, 0.0, 10 * H * ki * error)
    np.testing.assert_allclose(system.GetOutputPort("torque").Eval(context), expected, atol=1e-12)


@pytest.mark.parametrize("law", sorted(PD_LAWS))
def test_a_load_leaves_an_error_with_pd_and_none_with_pid(rig: Callable[..., Any], law: PdLaw) -> None:
    pd, pid = (rig(correction, target=0.3, load=LOAD, law=law) for correction in (None, action))
    for each in (pd, pid):
        each.simulator.AdvanceTo(2.5)
    assert pd.angle == pytest.approx(0.3 - LOAD / KP, abs=1e-6)
    assert pid.angle == pytest.approx(0.3, abs=1e-4)
    assert pid.output("torque") == pytest.approx([LOAD], rel=1e-3)


def test_a_joint_that_cannot_carry_its_load_does_not_wind_up(rig: Callable[..., Any]) -> None:
    """The load exceeds the limit; the integral stops where the law reaches it."""
    limit = 0.8 * LOAD
    lost = rig(action, load=LOAD, limit=limit)
    lost.simulator.AdvanceTo(1.0)
    torques = lost.logged[3]
    assert np.abs(torques).max() <= limit
    assert np.all(torques[100:] == torques[100])
    assert lost.angle < -1.0


def test_saturation_on_the_way_to_a_target_adds_little_overshoot(rig: Callable[..., Any]) -> None:
    """A far target saturates the joint; an integral that goes on growing carries it far beyond."""
    limit, target = 5.0, 1.0
    pd, pid, winding = (
        rig(correction, target=target, limit=limit, reports_saturation=reports)
        for correction, reports in ((None, True), (action, True), (action, False))
    )
    for each in (pd, pid, winding):
        each.simulator.AdvanceTo(3.0)
    overshoot, added, wound = (each.logged[0].max() - target for each in (pd, pid, winding))
    assert added - overshoot < 0.2 * (wound - overshoot)
    assert pid.angle == pytest.approx(target, abs=1e-4)


def test_the_same_bits_again(rig: Callable[..., Any]) -> None:
    first, again = (rig(action, target=(0.3, 8.0), load=LOAD) for _ in range(2))
    for each in (first, again):
        each.simulator.AdvanceTo(0.5)
    np.testing.assert_array_equal(first.logged, again.logged)


def test_half_the_step_halves_the_difference(rig: Callable[..., Any]) -> None:
    """First order in the step: the motion converges."""

    def end(step: float) -> float:
        each = rig(action, target=(0.3, 8.0), load=LOAD, time_step=step)
        each.simulator.AdvanceTo(0.4)
        return float(each.angle)

    coarse, middle, fine = map(end, (0.002, 0.001, 0.0005))
    assert abs(middle - fine) < 0.6 * abs(coarse - middle) < 1e-3
