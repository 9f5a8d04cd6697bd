"""The command over time: piecewise linear with bounded rates; unsorted points are an error."""

from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.systems.command_source import CommandSource
from humanwalk.walking.command import Command, CommandParameters, CommandPoint, CommandProfile

WALK = CommandParameters(points=(CommandPoint(1.0, forward=1.0), CommandPoint(6.0, sideways=0.2, turn=0.5)))


def command_at(time: float, parameters: CommandParameters = WALK) -> Array:
    source = CommandSource(parameters)
    context = source.CreateDefaultContext()
    context.SetTime(time)
    return source.GetOutputPort("command").Eval(context)


def test_port_and_signal() -> None:
    (signal,) = CommandSource(WALK).signals
    assert (signal.name, signal.port.get_name(), signal.port.size()) == ("command", "command", 3)
    assert signal.columns == ("command.forward_m_s", "command.sideways_m_s", "command.turn_rad_s")


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
def test_speeds_ramp_to_each_point(time: float, expected: tuple[float, ...]) -> None:
    assert command_at(time) == pytest.approx(expected)


speeds = st.tuples(st.floats(-1.5, 3.0), st.floats(-1.0, 1.0), st.floats(-2.0, 2.0))
profiles = st.lists(st.tuples(st.floats(0.1, 5.0), speeds), max_size=4).map(
    lambda steps: CommandParameters(
        tuple(
            CommandPoint(time, *target)
            for time, (_, target) in zip(accumulate(gap for gap, _ in steps), steps, strict=True)
        )
    )
)


@given(profiles, st.floats(0.0, 25.0), st.floats(1e-3, 0.5))
def test_speeds_change_no_faster_than_allowed(parameters: CommandParameters, time: float, dt: float) -> None:
    profile = CommandProfile(parameters)
    before, after = profile.at(time), profile.at(time + dt)
    assert abs(after.forward - before.forward) <= parameters.acceleration * dt + 1e-9
    assert abs(after.sideways - before.sideways) <= parameters.acceleration * dt + 1e-9
    assert abs(after.turn - before.turn) <= parameters.turn_acceleration * dt + 1e-9


@given(profiles)
def test_in_the_end_the_last_target_is_reached(parameters: CommandParameters) -> None:
    last = (parameters.points or (CommandPoint(),))[-1]
    end = CommandProfile(parameters).at(1000.0)
    assert (end.forward, end.sideways, end.turn) == pytest.approx((last.forward, last.sideways, last.turn))


def test_a_point_may_interrupt_the_ramp_of_the_point_before() -> None:
    parameters = CommandParameters(points=(CommandPoint(0.0, forward=1.0), CommandPoint(1.0)))
    assert command_at(1.0, parameters)[0] == pytest.approx(0.4)
    assert command_at(1.5, parameters)[0] == pytest.approx(0.2)


@given(profiles, st.floats(0.1, 25.0), st.floats(0.0, 1.0))
def test_the_command_at_a_time_does_not_depend_on_later_points(
    parameters: CommandParameters, time: float, share: float
) -> None:
    full, steered = CommandProfile(parameters), CommandProfile(parameters).steered(time, Command(0.3, 0.2, 0.1))
    assert steered.at(share * time) == full.at(share * time)
    assert steered.at(time) == full.at(time)
    assert steered.target_at(time) == Command(0.3, 0.2, 0.1)


def test_without_points_the_command_is_zero() -> None:
    assert command_at(5.0, CommandParameters(points=())) == pytest.approx([0, 0, 0])


def test_unsorted_points_are_an_error() -> None:
    for second in (1.0, 2.0):
        with pytest.raises(ParameterError, match=rf"points: time {second:g} comes after 2; allowed: increasing times"):
            CommandParameters(points=(CommandPoint(2.0), CommandPoint(second)))
