"""What Drake's blocks make of a bank's driving torque is the bank's own actuation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.joint_map import JointMap
from humanwalk.systems.linear_law import LinearLaw
from humanwalk.systems.pd_actuator_bank import PdActuatorBank

N = 42
KP, KD = np.linspace(1.0, 900.0, N), np.linspace(0.1, 20.0, N)


@pytest.fixture(scope="module")
def bank(plant):
    return PdActuatorBank(plant, KP, KD, law="semi_implicit", effort_limits=np.full(N, np.inf))


@pytest.fixture(scope="module")
def law(plant):
    return LinearLaw(plant, KP)


def test_ports(law, plant):
    sizes = {law.get_input_port(i).get_name(): law.get_input_port(i).size() for i in range(law.num_input_ports())}
    assert sizes == {"driving": 6 * N, "driving_times": 2, "state": plant.num_multibody_states()}
    assert law.get_actuation_output_port().size() == N


@given(
    rng=st.integers(0, 2**32 - 1).map(np.random.default_rng),
    share=st.sampled_from([-0.5, 0.0, 0.3, 0.9, 1.0, 1.5]),
    before=st.booleans(),
    fed=st.booleans(),
)
def test_it_is_the_banks_actuation(bank, law, plant, rng, share, before, fed):
    """Before, between and after the samples; with and without a sample before and a feed-forward."""
    joints, state = JointMap.of(plant), rng.normal(size=plant.num_multibody_states())
    inputs = {"desired_state": rng.normal(size=2 * N), "sample_time": [1.01], "state": state}
    if before:
        inputs |= {"previous_state": rng.normal(size=2 * N), "previous_time": [1.0]}
    if fed:
        inputs["feedforward"] = rng.normal(size=N)
    of_bank, of_law = bank.CreateDefaultContext(), law.CreateDefaultContext()
    for name, value in inputs.items():
        bank.GetInputPort(name).FixValue(of_bank, value)
    of_bank.SetTime(1.0 + 0.01 * share)
    of_law.SetTime(1.0 + 0.01 * share)
    for port, value in (
        (law.get_driving_input_port(), bank.get_driving_output_port().Eval(of_bank)),
        (law.get_driving_times_input_port(), bank.get_driving_times_output_port().Eval(of_bank)),
        (law.get_state_input_port(), state),
    ):
        port.FixValue(of_law, value)
    found = law.get_actuation_output_port().Eval(of_law)
    np.testing.assert_allclose(found, bank.get_actuation_output_port().Eval(of_bank), atol=1e-9)
    # The actuation without the driving torque is -kp q.
    held = bank.get_held_desired_state_output_port().Eval(of_bank)
    expected = KP * (held[:N] - joints.positions(state)) + KD * held[N:] + inputs.get("feedforward", 0.0)
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_only_a_linear_bank_shows_what_drives(plant, bank):
    assert bank.is_linear
    for law, limits in (("semi_implicit", np.full(N, 100.0)), ("explicit", np.full(N, np.inf))):
        other = PdActuatorBank(plant, KP, KD, law=law, effort_limits=limits)
        assert not other.is_linear
        assert not other.HasOutputPort("driving")
