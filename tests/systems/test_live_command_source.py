"""The command by hand: bounded rates, and the same bits as a profile that was complete from the beginning."""

from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.systems.command_source import CommandSource
from humanwalk.systems.live_command_source import LiveCommandSource
from humanwalk.walking.command import Command, CommandParameters, CommandPoint

WALK = CommandParameters(points=(CommandPoint(1.0, forward=1.0), CommandPoint(6.0, turn=0.5)))
STAND = CommandParameters(points=())


def test_port_and_signal_are_those_of_a_command_source() -> None:
    (live,), (fixed,) = LiveCommandSource(WALK).signals, CommandSource(WALK).signals
    assert (live.name, live.port.get_name(), live.columns) == (fixed.name, fixed.port.get_name(), fixed.columns)


def test_the_command_of_the_scenario_holds_until_a_hand_steers() -> None:
    source = LiveCommandSource(WALK)
    context = source.CreateDefaultContext()
    context.SetTime(2.0)
    assert source.GetOutputPort("command").Eval(context) == pytest.approx([0.4, 0.0, 0.0])
    source.steer(context, 3.0, Command(sideways=0.2))
    context.SetTime(30.0)
    assert source.GetOutputPort("command").Eval(context) == pytest.approx([0.0, 0.2, 0.0])
    assert [point.time for point in source.profile(context).parameters.points] == [1.0, 3.0]


def test_the_default_command_of_the_system_does_not_change() -> None:
    source = LiveCommandSource(STAND)
    source.steer(source.CreateDefaultContext(), 1.0, Command(forward=1.0))
    assert source.profile(source.CreateDefaultContext()).parameters.points == ()


@pytest.mark.parametrize("time", [0.0, 2.0])
def test_what_is_past_cannot_be_steered(time: float) -> None:
    source = LiveCommandSource(STAND)
    context = source.CreateDefaultContext()
    context.SetTime(2.0)
    with pytest.raises(ValueError, match="not later than 2 s"):
        source.steer(context, time, Command(forward=1.0))


targets = st.builds(Command, st.floats(-1.5, 3.0), st.floats(-1.0, 1.0), st.floats(-2.0, 2.0))


@given(st.lists(st.tuples(st.floats(0.01, 3.0), targets), min_size=1, max_size=8), st.floats(1e-3, 0.3))
def test_the_recorded_points_repeat_the_command_to_the_last_bit(
    moves: list[tuple[float, Command]], period: float
) -> None:
    source = LiveCommandSource(STAND)
    context, output = source.CreateDefaultContext(), source.GetOutputPort("command")
    live: list[tuple[float, list[float]]] = []
    for time, (_, target) in zip(accumulate(gap for gap, _ in moves), moves, strict=True):
        now = context.get_time()
        while now < time:
            context.SetTime(now)
            live.append((now, output.Eval(context).tolist()))
            now += period
        source.steer(context, time, target)
    recorded = CommandSource(source.profile(context).parameters)
    again, repeated = recorded.CreateDefaultContext(), recorded.GetOutputPort("command")
    for time, command in live:
        again.SetTime(time)
        assert repeated.Eval(again).tolist() == command
