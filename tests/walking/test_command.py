"""The command as data: tested ranges."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from humanwalk.scenario import load_scenario, shipped_scenarios
from humanwalk.walking.command import CommandParameters, CommandPoint


@pytest.mark.parametrize("name", shipped_scenarios())
def test_every_shipped_scenario_commands_tested_speeds(name: str) -> None:
    assert load_scenario(name).controller.untested == ()


@pytest.mark.parametrize(
    ("point", "problem"),
    [
        (
            CommandPoint(time=2.0, forward=2.1),
            "2.1 m/s at 2 s is not tested; tested: -0.5 to 0 and 0.3 to 2 m/s",
        ),
        (CommandPoint(forward=0.2), "forward 0.2 m/s"),
        (CommandPoint(forward=-0.6), "forward -0.6 m/s"),
        (CommandPoint(sideways=-0.4), "sideways -0.4 m/s at 0 s is not tested; tested: -0.3 to 0.3 m/s"),
        (CommandPoint(turn=0.5), "turn 0.5 rad/s"),
    ],
)
def test_a_speed_beyond_the_tested_range_is_named_with_the_range(point: CommandPoint, problem: str) -> None:
    (line,) = CommandParameters(points=(point,)).untested
    assert problem in line


def test_the_greatest_speed_of_a_backward_walk_is_negative() -> None:
    assert CommandParameters(points=(CommandPoint(forward=-0.5),)).greatest_forward == -0.5
    assert CommandParameters(points=()).greatest_forward == 0.0


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=4), st.sampled_from((-0.5, 0.1, 2.0)))
def test_another_greatest_speed_changes_all_speeds_in_proportion(speeds: list[float], speed: float) -> None:
    greatest = max(speeds, key=abs)
    assume(abs(greatest) > 1e-3)
    points = tuple(CommandPoint(time, forward) for time, forward in enumerate(speeds))
    changed = CommandParameters(points=points).points_at_speed(speed)
    assert [point.forward for point in changed] == pytest.approx([speed * forward / greatest for forward in speeds])
