"""Adaptive feedforward in a loop: it finds the inertia and the load of a known joint, and the error goes."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator

from humanwalk.body.joint_map import JointMap
from humanwalk.control.adaptive_feedforward import AdaptationParameters
from humanwalk.control.pd_control import PD_LAWS, PdLaw
from humanwalk.systems.adaptive_feedforward import AdaptiveFeedforward

N, H = 42, 0.002
KP, KD, INERTIA, LOAD = 100.0, 10.0, 0.5, 5.0
WAVE = (0.3, 8.0)
"""Amplitude [rad] and angular frequency [rad/s]: accelerations of up to 19 rad/s2."""
IDEAL = AdaptationParameters(error_rate=15.0, adaptation_time=0.2, leakage=0.0, reference_error=0.1)


def feedforward(plant: MultibodyPlant, parameters: AdaptationParameters = IDEAL, max_load: float = 50.0) -> Any:
    return AdaptiveFeedforward(plant, np.array([KP]), np.array([INERTIA]), np.array([max_load]), parameters)


def test_ports_and_signal(discrete_plant: MultibodyPlant, joints: JointMap) -> None:
    system = AdaptiveFeedforward(discrete_plant, np.ones(N), np.ones(N), np.ones(N), IDEAL)
    inputs = map(system.get_input_port, range(system.num_input_ports()))
    outputs = map(system.get_output_port, range(system.num_output_ports()))
    assert {port.get_name(): port.size() for port in inputs} == {"desired_state": 84, "state": 97, "saturated": 42}
    assert {port.get_name(): port.size() for port in outputs} == {"torque": N, "estimates": 2 * N}
    (signal,) = system.signals
    assert signal.name == "estimates"
    assert signal.columns[:1] == (f"{joints.names[0]}.estimated_inertia_kg_m2",)
    assert signal.columns[N:] == tuple(f"{name}.estimated_load_N_m" for name in joints.names)
    assert not system.HasAnyDirectFeedthrough()


def test_every_joint_adapts_to_its_own_error(discrete_plant: MultibodyPlant, joints: JointMap) -> None:
    """A constant error and no motion: only loads adapt, by kp / T per second and error."""
    kp, error = np.linspace(0.0, 10.0, N), np.linspace(-1.0, 1.0, N)
    system = AdaptiveFeedforward(discrete_plant, kp, np.ones(N), np.full(N, 50.0), IDEAL)
    context = system.CreateDefaultContext()
    state = np.zeros(discrete_plant.num_multibody_states())
    state[joints.q] = -error
    saturated = (np.arange(N) % 5 == 0).astype(float)
    for name, value in (("desired_state", np.zeros(2 * N)), ("state", state), ("saturated", saturated)):
        system.GetInputPort(name).FixValue(context, value)
    simulator = Simulator(system, context)
    simulator.AdvanceTo(9.5 * H)
    expected = np.where(saturated, 0.0, 10 * H * kp * error / IDEAL.adaptation_time)
    np.testing.assert_allclose(system.GetOutputPort("estimates").Eval(context), [*np.zeros(N), *expected], atol=1e-12)
    np.testing.assert_allclose(system.GetOutputPort("torque").Eval(context), expected, atol=1e-12)


@pytest.mark.parametrize("law", sorted(PD_LAWS))
def test_inertia_and_load_of_a_known_joint_are_found_and_the_error_goes(rig: Callable[..., Any], law: PdLaw) -> None:
    pd, adaptive = (rig(correction, target=WAVE, load=LOAD, law=law) for correction in (None, feedforward))
    for each in (pd, adaptive):
        each.simulator.AdvanceTo(4.0)
    inertia, load = adaptive.output("estimates")
    # The feedforward is late by two steps, 0.03 rad of the wave.
    assert inertia == pytest.approx(INERTIA, rel=0.04)
    assert load == pytest.approx(LOAD, rel=0.04)
    time = H * np.arange(pd.logged.shape[1])
    errors = [
        np.sqrt(np.mean((WAVE[0] * np.cos(WAVE[1] * time) - each.logged[0])[-400:] ** 2)) for each in (pd, adaptive)
    ]
    assert errors[1] < 0.05 * errors[0]


def test_leakage_leaves_some_of_the_error(rig: Callable[..., Any]) -> None:
    """The price of bounded estimates: at rest L' = 0 where the leakage of L equals what the error adds."""
    leaky = AdaptationParameters(error_rate=15.0, adaptation_time=0.1, leakage=1.0)
    leaked = rig(lambda plant: feedforward(plant, leaky), load=LOAD)
    leaked.simulator.AdvanceTo(2.0)
    _, load = leaked.output("estimates")
    assert load == pytest.approx(LOAD / (1 + leaky.leakage * leaky.adaptation_time), rel=1e-3)
    assert leaked.angle == pytest.approx(-(LOAD - load) / KP, rel=1e-3)


def test_a_joint_that_cannot_carry_its_load_stops_adapting(rig: Callable[..., Any]) -> None:
    lost = rig(feedforward, load=LOAD, limit=0.8 * LOAD)
    lost.simulator.AdvanceTo(1.0)
    estimates = lost.logged[4:]
    assert np.abs(estimates[1]).max() <= 0.8 * LOAD
    assert np.all(estimates[:, 100:] == estimates[:, 100:101])


def test_estimates_end_at_their_bounds(rig: Callable[..., Any]) -> None:
    bounded = rig(lambda plant: feedforward(plant, max_load=2.0), load=LOAD)
    bounded.simulator.AdvanceTo(1.5)
    assert bounded.output("estimates")[1] == 2.0
    assert bounded.angle == pytest.approx(-(LOAD - 2.0) / KP, rel=1e-3)


def test_the_same_bits_again(rig: Callable[..., Any]) -> None:
    first, again = (rig(feedforward, target=WAVE, load=LOAD) for _ in range(2))
    for each in (first, again):
        each.simulator.AdvanceTo(0.5)
    np.testing.assert_array_equal(first.logged, again.logged)


def test_half_the_step_halves_the_difference(rig: Callable[..., Any]) -> None:
    """First order in the step: the motion converges."""

    def end(step: float) -> float:
        each = rig(feedforward, target=WAVE, load=LOAD, time_step=step)
        each.simulator.AdvanceTo(0.4)
        return float(each.angle)

    coarse, middle, fine = map(end, (0.002, 0.001, 0.0005))
    assert abs(middle - fine) < 0.6 * abs(coarse - middle) < 1e-3
