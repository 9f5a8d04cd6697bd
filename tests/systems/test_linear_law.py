"""What Drake's blocks make of samples is a bank's own actuation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.joint_map import JointMap
from humanwalk.systems.linear_law import LinearLaw
from humanwalk.systems.pd_actuator_bank import PdActuatorBank

N = 42
PERIOD = 0.01
KP, KD = np.linspace(1.0, 900.0, N), np.linspace(0.1, 20.0, N)


@pytest.fixture(scope="module")
def bank(plant):
    return PdActuatorBank(plant, KP, KD, law="semi_implicit", effort_limits=np.full(N, np.inf))


@pytest.fixture(scope="module")
def law(plant):
    return LinearLaw(plant, KP, KD, PERIOD)


def test_ports(law, plant):
    ports = [
        law.GetInputPort("previous_state"),
        law.GetInputPort("desired_state"),
        law.GetInputPort("previous_time"),
        law.GetInputPort("state"),
        law.GetInputPort("feedforward"),
    ]
    names = ["previous_state", "desired_state", "previous_time", "state", "feedforward"]
    assert [port.get_name() for port in ports] == names
    assert [port.size() for port in ports] == [2 * N, 2 * N, 1, plant.num_multibody_states(), N]
    assert law.num_input_ports() == len(ports)
    assert law.GetOutputPort("actuation").size() == N


@given(
    rng=st.integers(0, 2**32 - 1).map(np.random.default_rng),
    share=st.sampled_from([-0.5, 0.0, 0.3, 0.9, 1.0, 1.5]),
    fed=st.booleans(),
)
def test_it_is_the_banks_actuation(bank, law, plant, rng, share, fed):
    """Before, between and after the samples; with and without a feed-forward."""
    joints, state = JointMap.of(plant), rng.normal(size=plant.num_multibody_states())
    inputs = {
        "previous_state": rng.normal(size=2 * N),
        "previous_time": [1.0],
        "desired_state": rng.normal(size=2 * N),
        "state": state,
    }
    if fed:
        inputs["feedforward"] = rng.normal(size=N)
    of_bank, of_law = bank.CreateDefaultContext(), law.CreateDefaultContext()
    for name, value in inputs.items():
        bank.GetInputPort(name).FixValue(of_bank, value)
        law.GetInputPort(name).FixValue(of_law, value)
    bank.GetInputPort("sample_time").FixValue(of_bank, [1.0 + PERIOD])
    of_bank.SetTime(1.0 + PERIOD * share)
    of_law.SetTime(1.0 + PERIOD * share)
    found = law.GetOutputPort("actuation").Eval(of_law)
    np.testing.assert_allclose(found, bank.GetOutputPort("actuation").Eval(of_bank), rtol=1e-9, atol=1e-7)
    held = bank.GetOutputPort("held_desired_state").Eval(of_bank)
    expected = KP * (held[:N] - joints.positions(state)) + KD * held[N:] + inputs.get("feedforward", 0.0)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-7)


def test_a_bank_is_linear_if_semi_implicit_and_without_limits(plant, bank):
    assert bank.is_linear
    for law, limits in (("semi_implicit", np.full(N, 100.0)), ("explicit", np.full(N, np.inf))):
        assert not PdActuatorBank(plant, KP, KD, law=law, effort_limits=limits).is_linear
