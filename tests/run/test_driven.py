"""A driven walk is a run like any other: its scenario has what the hand did, and repeats it to the last bit."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from humanwalk.choices import BalancedController
from humanwalk.choices.sources import LIVE
from humanwalk.measures.signals import TIME
from humanwalk.parameter_file import MAX_FILE_SIZE
from humanwalk.quantity import ParameterError
from humanwalk.run.driven import MAX_POINTS, MAX_PUSHES, Driven, require_drivable
from humanwalk.run.monitor import Monitor
from humanwalk.run.outcome import Outcome
from humanwalk.run.simulate import prepare, simulate, simulate_prepared
from humanwalk.scenario import Scenario, dump_scenario, load_scenario, parse_scenario
from humanwalk.walking.command import Command, CommandParameters, CommandPoint

LATENCY = 0.05
"""Largest simulated time from a push on the page to the force on the plant [s]."""


class Walk(NamedTuple):
    outcome: Outcome
    driven: Driven
    recorded: Scenario


def driven_walk(scenario: Scenario, act: Callable[[Driven, float], Any]) -> Walk:
    """Simulate a scenario in which `act` is done at every check."""
    prepared = prepare(scenario, sources=LIVE)
    driven = Driven(scenario, prepared)
    monitor = Monitor(prepared.watched, scenario.terrain)
    outcome = simulate_prepared(scenario, prepared, monitor, lambda time: act(driven, time))
    return Walk(outcome, driven, driven.recorded())


def at(time: float, now: float) -> bool:
    return abs(now - time) < 1e-9


def hand(driven: Driven, now: float) -> None:
    """Begin to walk, change the mind in the middle of the ramp, and push twice at once."""
    if at(0.05, now):
        driven.steer(Command(forward=0.5))
    if at(0.31, now):
        driven.steer(Command(forward=-0.2, turn=0.3))
    if at(0.2, now):
        driven.push(12.0, math.pi / 2)
        driven.push(5.0, 0.0)


@pytest.fixture(scope="module")
def walk() -> Walk:
    return driven_walk(load_scenario("stand", {"duration": "0.6"}), hand)


def test_the_recorded_scenario_repeats_the_walk_to_the_last_bit(walk: Walk) -> None:
    again = simulate(parse_scenario(dump_scenario(walk.recorded)))
    assert again.signals.equals(walk.outcome.signals)
    assert again.end == walk.outcome.end == "completed"


def test_it_holds_what_the_hand_did_and_only_that(walk: Walk) -> None:
    command = walk.recorded.controller.command
    assert command is not None
    assert [(point.time, point.forward, point.turn) for point in command.points] == [
        (0.06, 0.5, 0.0),
        (0.32, -0.2, 0.3),
    ]
    assert [(push.time, push.impulse) for push in walk.recorded.pushes.given] == [(0.21, 12.0), (0.21, 5.0)]
    assert walk.recorded.duration == pytest.approx(0.6)
    assert walk.recorded.description.endswith("driven by hand")


def test_a_push_acts_on_the_plant_within_50_ms(walk: Walk) -> None:
    signals = walk.outcome.signals
    time, force = signals[TIME].to_numpy(), signals["push.force_y_N"].to_numpy()
    acting = time[force > 100.0]
    assert 0.2 < acting[0] <= 0.2 + LATENCY
    assert acting[-1] - acting[0] == pytest.approx(0.1, abs=0.0101)
    # The body gains the impulse: 12 N s over 70 kg, less what the feet give back in 0.1 s.
    gained = signals["com.velocity_y_m_s"].to_numpy()[np.searchsorted(time, 0.3)]
    assert 0.05 < gained < 12.0 / 70.0 + 0.01


def test_speeds_change_at_the_rate_of_the_scenario(walk: Walk) -> None:
    forward = walk.outcome.signals["command.forward_m_s"].to_numpy()
    period = walk.outcome.scenario.recording.signal_period
    assert np.abs(np.diff(forward)).max() <= 0.4 * period + 1e-12
    assert forward.max() == pytest.approx(0.4 * 0.26, abs=0.005)


def test_a_direction_counts_from_the_heading_of_the_walker() -> None:
    turned = load_scenario("stand", {"duration": "0.02"})
    walk = driven_walk(turned, lambda driven, now: at(0.0, now) and driven.push(1.0, math.pi))
    (push,) = walk.recorded.pushes.given
    assert abs(push.direction) == pytest.approx(math.pi - abs(walk.driven.heading), abs=0.05)


def test_the_thesis_walker_can_be_pushed_and_not_steered() -> None:
    scenario = load_scenario("thesis", {"duration": "0.12"})
    walk = driven_walk(scenario, lambda driven, now: at(0.03, now) and driven.push(10.0, 0.0))
    assert walk.driven.target is None
    assert walk.outcome.signals["push.force_x_N"].to_numpy().max() == pytest.approx(100.0, rel=0.05)
    assert simulate(walk.recorded).signals.equals(walk.outcome.signals)


def test_no_more_is_recorded_than_a_scenario_file_holds() -> None:
    stand = load_scenario("stand")
    points = tuple(CommandPoint(round(1.0 + 0.01 * i, 2), -0.35, -0.15, -0.35) for i in range(MAX_POINTS))
    many = replace(stand, controller=BalancedController(command=CommandParameters(points)))
    driven = Driven(many, prepare(many, sources=LIVE))
    assert [driven.push(1.23, 0.5) for _ in range(MAX_PUSHES + 1)] == [True] * MAX_PUSHES + [False]
    assert driven.steer(Command()) is False
    recorded = driven.recorded()
    assert len(dump_scenario(recorded).encode()) < MAX_FILE_SIZE
    assert parse_scenario(dump_scenario(recorded)) == recorded


def test_what_is_not_simulated_is_not_driven() -> None:
    recorded = {"controller": "{recorded: {angles: walk.mot, kinematic: true}}"}
    with pytest.raises(ParameterError, match=r"^drive: a recording without physics .* allowed: scenarios with physics"):
        require_drivable(parse_scenario("", recorded))
