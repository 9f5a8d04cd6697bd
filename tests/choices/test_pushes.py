"""Pushes act with every controller."""

import math
from typing import Any

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.diagrams.walker import make_walker
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario, parse_scenario
from humanwalk.walking.push import Push

PUSH = {"pushes.given": "[{time: 0.02, duration: 0.05, impulse: 10.0, direction: 1.5707963}]"}


def momentum_along_y(scenario: str, overrides: dict[str, str]) -> float:
    """Momentum along y [N s] of a body that has fallen freely for 0.08 s: only pushes change it."""
    walker = make_walker(load_scenario(scenario, {"start.pelvis_lift": "0.3"} | overrides))
    simulator = Simulator(walker)
    simulator.AdvanceTo(0.08)
    velocity: float = walker.GetOutputPort("com").Eval(simulator.get_context())[4]
    return 70.0 * velocity


@pytest.mark.parametrize(
    ("scenario", "overrides"),
    [("thesis", {"controller.thesis.balance.support.enabled": "false"}), ("stand", {})],
    ids=["thesis", "balanced"],
)
def test_a_push_gives_the_body_momentum_whatever_the_controller(scenario: Any, overrides: Any) -> None:
    gained = momentum_along_y(scenario, overrides | PUSH) - momentum_along_y(scenario, overrides)
    assert gained == pytest.approx(10.0, rel=1e-3)


@pytest.mark.parametrize("overrides", [{}, PUSH])
def test_a_walker_can_be_pushed_after_it_was_made(overrides: dict[str, str]) -> None:
    walker = make_walker(load_scenario("stand", {"start.pelvis_lift": "0.3"} | overrides))
    context = walker.CreateDefaultContext()
    pushes = walker.GetSubsystemByName("pushes")
    pushes.set_pushes(pushes.GetMyMutableContextFromRoot(context), [Push(0.02, 0.05, 10.0, math.pi / 2)])
    simulator = Simulator(walker, context)
    simulator.AdvanceTo(0.08)
    gained = 70.0 * walker.GetOutputPort("com").Eval(context)[4] - momentum_along_y("stand", {})
    assert gained == pytest.approx(10.0, rel=1e-3)


def test_a_walker_without_pushes_records_none() -> None:
    walker = make_walker(parse_scenario(""))
    np.testing.assert_array_equal(walker.GetOutputPort("push").Eval(walker.CreateDefaultContext()), 0.0)


def test_random_pushes_need_time_between_them() -> None:
    message = r"^scenario, line 1: pushes\.random_interval: 1e-09 .* allowed: 0, or 0\.1 to 600 s"
    with pytest.raises(ParameterError, match=message):
        parse_scenario("pushes: {random_interval: 1e-9}")
