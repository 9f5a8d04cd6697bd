"""Pushes by hand: they add to those of the scenario, and the recorded pushes repeat them."""

import math

import pytest
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.quantity import ParameterError
from humanwalk.systems.live_push_source import LivePushSource
from humanwalk.systems.push_source import PushSource
from humanwalk.walking.push import Push, PushParameters

GIVEN = Push(2.0, 0.1, 30.0)
BY_HAND = Push(1.0, 0.1, 20.0, math.pi / 2)


@pytest.fixture
def source(plant: MultibodyPlant) -> LivePushSource:
    return LivePushSource(plant, PushParameters((GIVEN,)), seed=0)


def test_ports_and_signal_are_those_of_a_push_source(plant: MultibodyPlant, source: LivePushSource) -> None:
    fixed = PushSource(plant, PushParameters((GIVEN,)), seed=0)
    (live,), (other,) = source.signals, fixed.signals
    assert (live.name, live.port.get_name(), live.columns) == (other.name, other.port.get_name(), other.columns)


def test_a_push_by_hand_adds_to_those_of_the_scenario(plant: MultibodyPlant, source: LivePushSource) -> None:
    context = source.CreateDefaultContext()
    source.push(context, BY_HAND)
    assert source.pushes(context) == (GIVEN, BY_HAND)
    recorded = PushSource(plant, PushParameters(source.pushes(context)), seed=0)
    again = recorded.CreateDefaultContext()
    for time, force in ((0.99, [0, 0, 0]), (1.05, [0, 200, 0]), (1.2, [0, 0, 0]), (2.05, [300, 0, 0])):
        context.SetTime(time)
        again.SetTime(time)
        shown = source.GetOutputPort("force").Eval(context)
        assert shown == pytest.approx(force, abs=1e-9)
        assert shown.tolist() == recorded.GetOutputPort("force").Eval(again).tolist()


def test_a_push_in_the_past_is_refused(source: LivePushSource) -> None:
    context = source.CreateDefaultContext()
    context.SetTime(1.0)
    with pytest.raises(ValueError, match="not later than 1 s"):
        source.push(context, BY_HAND)


def test_an_unknown_body_is_refused(source: LivePushSource) -> None:
    with pytest.raises(ParameterError, match="Rib: no such body"):
        source.push(source.CreateDefaultContext(), Push(1.0, body="Rib"))
