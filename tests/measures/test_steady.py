"""The walk is steady at a constant speed, after it has settled."""

import numpy as np
import pyarrow as pa
import pytest

from humanwalk.choices.balanced import SETTLING
from humanwalk.measures.signals import TIME
from humanwalk.measures.steady import steady_rows
from humanwalk.numerics import Array
from humanwalk.scenario import Scenario, load_scenario

DURATION = 30.0
TIMES = np.arange(0.0, DURATION, 0.01)
SIGNALS = pa.table({TIME: TIMES})


def commanded(points: str) -> Scenario:
    return load_scenario("walk", {"duration": DURATION, "controller.balanced.command.points": points})


def steady_parts(scenario: Scenario) -> Array:
    """Begin and end of the steady parts [s], shape (parts, 2)."""
    edges = np.flatnonzero(np.diff(steady_rows(SIGNALS, scenario).astype(int), prepend=0, append=0))
    return np.append(TIMES, DURATION)[edges].reshape(-1, 2)


@pytest.mark.parametrize("name", ["walk", "thesis", "turn", "backward", "sideways"])
def test_a_walk_at_one_speed_is_steady_to_its_end(name: str) -> None:
    scenario = load_scenario(name)
    begin = scenario.controller.steady_from(scenario.subject)
    np.testing.assert_array_equal(steady_rows(SIGNALS, scenario), begin <= TIMES)


def test_a_stop_a_start_and_a_change_of_speed_are_not_steady() -> None:
    scenario = commanded(
        "[{time: 1, forward: 1}, {time: 10, forward: 0}, {time: 14, forward: 1}, {time: 22, forward: 1.5}]"
    )
    ramp = 1.0 / scenario.controller.command.acceleration
    first = scenario.controller.steady_from(scenario.subject)
    expected = [(first, 10.0), (14.0 + ramp + SETTLING, 22.0), (22.0 + 0.5 * ramp + SETTLING, DURATION)]
    assert steady_parts(scenario) == pytest.approx(np.array(expected), abs=0.03)


def test_a_turn_at_one_speed_is_steady() -> None:
    (part,) = steady_parts(commanded("[{time: 1.0, forward: 1.0}, {time: 10.0, forward: 1.0, turn: 0.3}]"))
    assert part[1] == DURATION


def test_standing_is_not_a_steady_walk() -> None:
    assert not steady_rows(SIGNALS, load_scenario("stand")).any()
