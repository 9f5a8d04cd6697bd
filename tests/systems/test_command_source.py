"""The command source: piecewise linear, bounded rates, and what it refuses."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.systems.command_source import CommandSource
from humanwalk.walking.command import CommandParameters, CommandPoint, CommandProfile

WALK = CommandParameters(points=(CommandPoint(1.0, forward=1.0), CommandPoint(6.0, sideways=0.2, turn=0.5)))


def command_at(time, parameters=WALK):
    source = CommandSource(parameters)
    context = source.CreateDefaultContext()
    context.SetTime(time)
    return source.GetOutputPort("command").Eval(context)


def test_port_name_and_size():
    port = CommandSource(WALK).GetOutputPort("command")
    assert (port.get_name(), port.size()) == ("command", 3)


@pytest.mark.parametrize(
    "time, expected",
    [
        (0.0, (0, 0, 0)),
        (1.0, (0, 0, 0)),
        (2.0, (0.4, 0, 0)),
        (5.0, (1, 0, 0)),
        (6.5, (0.8, 0.2, 0.25)),
        (20.0, (0, 0.2, 0.5)),
    ],
)
def test_it_ramps_to_each_point(time, expected):
    assert command_at(time) == pytest.approx(expected)


@given(st.floats(0.0, 12.0), st.floats(1e-3, 0.5))
def test_speeds_change_no_faster_than_allowed(time, dt):
    profile = CommandProfile(WALK)
    before, after = profile.at(time), profile.at(time + dt)
    assert abs(after.forward - before.forward) <= WALK.acceleration * dt + 1e-9
    assert abs(after.turn - before.turn) <= WALK.turn_acceleration * dt + 1e-9


def test_a_point_may_interrupt_the_ramp_before_it():
    parameters = CommandParameters(points=(CommandPoint(0.0, forward=1.0), CommandPoint(1.0)))
    assert command_at(1.0, parameters)[0] == pytest.approx(0.4)
    assert command_at(1.5, parameters)[0] == pytest.approx(0.2)


def test_without_points_it_stands():
    assert command_at(5.0, CommandParameters(points=())) == pytest.approx([0, 0, 0])


def test_points_that_go_back_in_time_are_refused():
    with pytest.raises(ParameterError, match=r"points: time 1 comes after 2"):
        CommandParameters(points=(CommandPoint(2.0), CommandPoint(1.0)))
