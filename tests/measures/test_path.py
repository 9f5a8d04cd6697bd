"""The distance from the commanded path is geometric: it does not depend on when the walker is where."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.measures.path import SPACING, commanded_path, distance_along, path_deviation, path_directions
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array
from humanwalk.scenario import load_scenario
from humanwalk.walking.command import CommandParameters, CommandPoint

AHEAD = CommandParameters((CommandPoint(time=1.0, forward=1.0),))
CIRCLE = CommandParameters((CommandPoint(time=0.0, forward=0.6, turn=0.2),), acceleration=5.0, turn_acceleration=10.0)
RADIUS = 0.6 / 0.2

TIMES = np.linspace(0.0, 20.0, 201)


def record(position: Callable[[Array], Any]) -> pa.Table:
    """A center of mass on complex positions [m]."""
    points = position(TIMES)
    return pa.table({TIME: TIMES, "com.x_m": points.real, "com.y_m": points.imag})


def deviation(position: Callable[[Array], Any], command: CommandParameters) -> float:
    found = path_deviation(record(position), np.ones_like(TIMES, dtype=bool), command)
    assert found is not None
    return found


@given(lateral=st.floats(-0.5, 0.5), speed=st.floats(0.2, 0.8))
def test_of_a_straight_walk_it_is_the_lateral_deviation_at_any_speed(lateral: float, speed: float) -> None:
    walked = deviation(lambda t: 2.0 + 3j + speed * t + 1j * lateral * np.sin(t), AHEAD)
    assert walked == pytest.approx(abs(lateral) * np.abs(np.sin(TIMES)).max(), abs=SPACING)


def test_a_walker_behind_or_ahead_of_the_command_is_on_the_path() -> None:
    assert deviation(lambda t: np.maximum(t - 3.0, 0.0) + 0j, AHEAD) < SPACING
    # The command is 2.25 m behind the time: it begins after 1 s and takes 2.5 s to accelerate.
    assert deviation(lambda t: (t - 1.5).clip(0.0) + 0j, AHEAD) < SPACING


def test_a_walker_beyond_the_end_of_a_stopped_command_is_off_the_path() -> None:
    stops = CommandParameters((CommandPoint(time=0.0, forward=1.0), CommandPoint(time=5.0)), acceleration=1.0)
    assert deviation(lambda t: 0.3 * t + 0j, stops) == pytest.approx(6.0 - 5.0, abs=SPACING)


@pytest.mark.parametrize("inward", [-0.1, 0.2])
def test_on_a_circle_it_is_the_difference_of_the_radii(inward: float) -> None:
    def position(time: Array) -> Any:
        circle = 1j * RADIUS - 1j * (RADIUS - inward) * np.exp(1j * 0.2 * time)
        return np.where(time == 0, 0.0, circle)

    # The ramps displace the circle by some centimeters.
    assert deviation(position, CIRCLE) == pytest.approx(abs(inward), abs=0.04)


def test_the_path_of_a_turning_command_is_a_circle() -> None:
    path = commanded_path(CIRCLE, 60.0)
    x, y = path[len(path) // 4 :].T
    center = np.linalg.lstsq(np.column_stack([2 * x, 2 * y, np.ones_like(x)]), x**2 + y**2, rcond=None)[0]
    radii = np.hypot(x - center[0], y - center[1])
    assert radii == pytest.approx(RADIUS, rel=1e-3)
    assert math.dist(center[:2], (0.0, RADIUS)) < 0.05


def test_standing_has_a_path_of_one_point() -> None:
    assert commanded_path(CommandParameters(()), 3600.0).tolist() == [[0.0, 0.0]]
    assert deviation(lambda t: 0.01 * np.sin(t) + 0j, CommandParameters(())) == pytest.approx(0.01, rel=1e-3)


def test_only_chosen_rows_count() -> None:
    signals = record(lambda t: 0.8 * t + np.where(t < 10.0, 0.5j, 0.1j) - 0.5j * (t == 0))
    assert path_deviation(signals, TIMES >= 10.0, AHEAD) == pytest.approx(0.1, abs=1e-3)
    assert path_deviation(signals, TIMES > 100.0, AHEAD) is None


@pytest.mark.parametrize("name", ["thesis", "comfortable"])
def test_a_walk_without_command_has_none(name: str) -> None:
    command = load_scenario(name).controller.command
    assert command is None
    assert path_deviation(record(lambda t: t + 0j), TIMES >= 0.0, command) is None


EVERY = np.ones_like(TIMES, dtype=bool)


@pytest.mark.parametrize("command", [AHEAD, None])
def test_a_straight_walk_faces_along_x_to_the_last_bit(command: CommandParameters | None) -> None:
    directions = path_directions(record(lambda t: t + 0.1j * np.sin(t)), command)
    assert (directions.facing == 1.0).all()
    assert directions.travel == pytest.approx(1.0, abs=1e-12)
    assert not directions.travel.imag.any()


def test_a_walker_that_is_to_stand_covers_no_distance() -> None:
    signals = record(lambda t: 0.01 * t + 0j)
    directions = path_directions(signals, CommandParameters(points=()))
    assert (directions.facing == 1.0).all()
    assert distance_along(signals, EVERY, directions.travel) == 0.0


@given(lag=st.floats(0.0, 1.0), aside=st.floats(-0.1, 0.1))
def test_on_a_circle_the_walker_faces_along_the_tangent_beside_it(lag: float, aside: float) -> None:
    """The second and the third lap pass the places of the first one."""
    twice = CommandParameters((CommandPoint(time=0.0, forward=0.6, turn=0.8),), acceleration=1e3, turn_acceleration=1e3)

    def position(time: Array) -> Any:
        return 0.75j - (0.75 - aside) * 1j * np.exp(0.8j * np.maximum(time - lag, 0.0))

    directions = path_directions(record(lambda t: np.where(t == 0.0, 0.0, position(t))), twice)
    late = TIMES > 1.5
    expected = np.exp(0.8j * (TIMES - lag))
    assert np.abs(directions.facing - expected)[late].max() < 0.05


@pytest.mark.parametrize(
    ("point", "velocity"),
    [
        (CommandPoint(time=0.0, forward=0.5), 0.5 + 0j),
        (CommandPoint(time=0.0, forward=-0.4), -0.4 + 0j),
        (CommandPoint(time=0.0, sideways=0.3), 0.3j),
    ],
)
def test_distances_are_along_the_motion_and_speeds_along_the_heading(point: CommandPoint, velocity: complex) -> None:
    signals = record(lambda t: velocity * t)
    directions = path_directions(signals, CommandParameters((point,), acceleration=5.0))
    assert distance_along(signals, EVERY, directions.travel) == pytest.approx(20.0 * abs(velocity))
    assert distance_along(signals, EVERY, directions.facing) == pytest.approx(20.0 * velocity.real)


def test_the_distance_along_a_circle_is_its_arc() -> None:
    signals = record(lambda t: 1j * RADIUS - 1j * RADIUS * np.exp(0.2j * t))
    directions = path_directions(signals, CIRCLE)
    assert distance_along(signals, EVERY, directions.travel) == pytest.approx(12.0, rel=2e-3)
