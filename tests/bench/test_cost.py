"""Simulations advance by turns, up to the given time."""

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.bench.cost import Cost, cost_of, in_turns


def advancing(name: str, log: list[Any]) -> Callable[..., Any]:
    def advance(until: float) -> Cost:
        log.append((name, until))
        return Cost(until, 2 * until)

    return advance


def test_simulations_advance_by_turns_and_the_order_alternates() -> None:
    log = []
    costs = in_turns({name: advancing(name, log) for name in "ab"}, 0.3)
    assert [name for name, _ in log] == ["a", "b", "b", "a", "a", "b"]
    assert [until for name, until in log if name == "a"] == pytest.approx([0.1, 0.2, 0.3])
    assert [cost.cpu for cost in costs["b"]] == pytest.approx([0.2, 0.4, 0.6])


@given(st.floats(0.001, 20.0), st.floats(0.0, 5.0), st.floats(0.01, 1.0))
def test_turns_end_at_the_given_time(length: float, begin: float, chunk: float) -> None:
    log = []
    in_turns({"a": advancing("a", log)}, begin + length, begin, chunk)
    ends = [until for _, until in log]
    assert ends == sorted(ends)
    assert ends[0] > begin
    assert ends[-1] == pytest.approx(begin + length)


def test_costs_add_up() -> None:
    assert Cost(1.0, 2.0) + Cost(3.0, 5.0) == Cost(4.0, 7.0)


def test_the_cost_of_work_is_of_both_clocks() -> None:
    cost = cost_of(lambda: sum(range(100_000)))
    assert cost.wall > 0
    assert cost.cpu > 0
