"""The held actuation gives the plant what the PdActuatorBank of the same gains does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.framework import DiagramBuilder

from humanwalk.choices.world import add_human_plant
from humanwalk.scenario import load_scenario
from humanwalk.systems.held_actuation import HeldActuation
from humanwalk.systems.pd_actuator_bank import PdActuatorBank


@pytest.fixture(scope="module")
def laws():
    human = add_human_plant(DiagramBuilder(), load_scenario("walk"), visuals=False)
    bank = PdActuatorBank(human.plant, human.kp, human.kd, "semi_implicit", human.effort_limits)
    return bank, HeldActuation(human.plant, human.kp, human.kd, human.effort_limits)


def actuation(law, time, state, desired_state, sample_time, feedforward):
    context = law.CreateDefaultContext()
    context.SetTime(time)
    law.GetInputPort("state").FixValue(context, state)
    law.GetInputPort("desired_state").FixValue(context, desired_state)
    law.GetInputPort("sample_time").FixValue(context, [sample_time])
    law.GetInputPort("feedforward").FixValue(context, feedforward)
    return law.GetOutputPort("actuation").Eval(context)


def test_ports(laws):
    held = laws[1]
    inputs = [held.get_input_port(i) for i in range(held.num_input_ports())]
    assert {port.get_name(): port.size() for port in inputs} == {
        "desired_state": 84,
        "sample_time": 1,
        "feedforward": 42,
        "state": 97,
    }
    assert (held.GetOutputPort("actuation").get_name(), held.GetOutputPort("actuation").size()) == ("actuation", 42)


@given(st.integers(0, 10_000), st.floats(0.0, 10.0), st.floats(0.0, 0.01), st.floats(1.0, 1000.0))
def test_it_is_the_banks_law(laws, seed, sample_time, later, strength):
    random = np.random.default_rng(seed)
    state, desired, feedforward = random.normal(size=97), random.normal(size=84), strength * random.normal(size=42)
    given_ = (sample_time + later, state, desired, sample_time, feedforward)
    expected, got = (actuation(law, *given_) for law in laws)
    assert got == pytest.approx(expected, abs=1e-9)


def test_torques_stay_within_the_limits_but_for_the_damping(laws):
    state, desired = np.zeros(97), np.zeros(84)
    expected, got = (actuation(law, 0.0, state, desired, 0.0, np.full(42, 1e4)) for law in laws)
    assert got == pytest.approx(expected)
    assert np.isfinite(got).all()
    assert got.max() < 1e4
