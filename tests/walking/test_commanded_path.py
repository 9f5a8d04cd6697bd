"""The commanded path is the integral of the command; the walker returns to it, and it waits for the walker."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.command import Command
from humanwalk.walking.commanded_path import CommandedPath, PathFollowing

START = PathFollowing().begin(0.0, 0.0)
FOLLOWING = PathFollowing()
STRAIGHT, TURNING = Command(0.6), Command(0.6, 0.0, 0.2)


def walked(command: Command, duration: float, start: CommandedPath = START, dt: float = 0.02) -> CommandedPath:
    path = start
    for _ in range(round(duration / dt)):
        path = path.advanced(command, dt)
    return path


def test_a_constant_turn_is_a_circle() -> None:
    for duration in (2.0, 7.0, 12.0):
        end = walked(TURNING, duration).end
        assert abs(end.position - 3.0j) == pytest.approx(3.0, abs=1e-3)
        assert end.heading == pytest.approx(0.2 * duration)
        assert end.distance == pytest.approx(0.6 * duration)


def test_sideways_is_to_the_left() -> None:
    assert walked(Command(0.0, 0.3, 0.0), 2.0).end.position == pytest.approx(0.6j)


def test_the_number_of_stored_places_is_bounded() -> None:
    assert len(walked(STRAIGHT, 20.0).places) == len(walked(STRAIGHT, 10.0).places)


@given(st.floats(-0.5, 1.5))
def test_the_nearest_place_of_a_walker_on_the_path_is_its_own(lag: float) -> None:
    """Ahead of the command too."""
    path = walked(TURNING, 6.0)
    there = walked(TURNING, 6.0 - lag / 0.6).end
    nearest = path.nearest(there.position, TURNING)
    assert nearest.position == pytest.approx(there.position, abs=0.02)
    assert nearest.heading == pytest.approx(there.heading, abs=0.02)
    assert nearest.distance == pytest.approx(there.distance, abs=0.02)


@given(st.floats(0.05, 0.5))
def test_before_the_corner_the_nearest_place_is_on_the_straight(lag: float) -> None:
    """The command already turns."""
    corner = walked(STRAIGHT, 3.0)
    nearest = walked(TURNING, 1.0, corner).nearest(corner.end.position - lag, TURNING)
    assert nearest.heading == pytest.approx(0.0, abs=0.02)
    assert nearest.turn == 0.0


@given(st.floats(0.1, 1.8), st.floats(-0.05, 0.05))
def test_on_the_way_back_the_nearest_place_is_on_the_way_back(back: float, aside: float) -> None:
    """After a turn on the spot, although the way out is as near."""
    out = walked(Command(0.6), 5.0)
    turned = walked(Command(0.0, 0.0, math.pi / 8.0), 8.0, out)
    returning = walked(Command(0.6), 3.3, turned)
    nearest = returning.nearest(out.end.position - back + 1j * aside, STRAIGHT)
    assert nearest.heading == pytest.approx(math.pi, abs=0.05)
    assert nearest.distance == pytest.approx(3.0 + back, abs=0.02)


@given(st.floats(FOLLOWING.lag + 0.35, 3.0))
def test_a_walker_that_reverses_at_its_nominal_place_is_not_corrected(time: float) -> None:
    to_the_right, to_the_left = Command(0.0, -0.3), Command(0.0, 0.3)
    path = walked(to_the_left, time, walked(to_the_right, 6.0))
    own = path.end.position - FOLLOWING.lag * 0.3j
    correction = FOLLOWING.correction(path, path.nearest(own, to_the_left), own, to_the_left)
    assert correction == pytest.approx(0.0, abs=1e-6)


@given(st.floats(0.0, 0.2), st.floats(-0.1, 0.1))
def test_after_a_turn_on_the_spot_the_path_goes_on_in_the_new_direction(way: float, aside: float) -> None:
    path = FOLLOWING.begin(0.0, 0.0)
    for command, duration in ((Command(0.5), 1.01), (Command(0.0, 0.0, 0.4), 7.85), (Command(0.5), way / 0.5)):
        for _ in range(round(duration / 0.01)):
            path = path.advanced(command, 0.01)
    beside = path.end.position + complex(0.01, aside)
    assert path.nearest(beside, Command(0.5)).heading == pytest.approx(path.end.heading, abs=0.11)


def test_on_the_spot_the_walker_turns_with_the_command() -> None:
    path = PathFollowing().begin(1.0, 0.7)
    assert path.nearest(0.5j, Command(0.0, 0.0, 0.5)) == path.end


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-math.pi, math.pi))
def test_the_correction_points_to_the_path_and_is_bounded(x: float, y: float, heading: float) -> None:
    path = walked(STRAIGHT, 3.0, PathFollowing().begin(0.3 + 0.1j, heading))
    away = complex(x, y) * cmath.exp(1j * heading)
    own = path.end.position - FOLLOWING.lag * STRAIGHT.velocity * cmath.exp(1j * heading)
    walker = own + away
    correction = FOLLOWING.correction(path, path.nearest(walker, STRAIGHT), walker, STRAIGHT)
    assert correction.real * x <= 1e-9
    assert correction.imag * y <= 1e-9
    assert abs(correction.real) <= FOLLOWING.pace_speed_limit + 1e-9
    assert abs(correction.imag) <= FOLLOWING.lane_speed_limit + 1e-9


def test_at_the_nominal_place_there_is_no_correction() -> None:
    path = walked(STRAIGHT, 2.0)
    own = path.end.position - FOLLOWING.lag * STRAIGHT.velocity
    assert FOLLOWING.correction(path, path.nearest(own, STRAIGHT), own, STRAIGHT) == pytest.approx(0.0, abs=1e-9)


def test_the_path_waits_for_a_walker_that_was_held_up_but_keeps_its_lane() -> None:
    lead = FOLLOWING.lag * STRAIGHT.forward + FOLLOWING.pace_speed_limit / FOLLOWING.pace_gain
    path = walked(STRAIGHT, 5.0)
    far = path.end.position - lead - 0.5 + 0.4j
    limited = FOLLOWING.limit_lead(path, path.nearest(far, STRAIGHT), STRAIGHT)
    assert limited.end.position == pytest.approx(far.real + lead, abs=1e-6)
    near = path.end.position - 0.5 * lead + 0.4j
    assert FOLLOWING.limit_lead(path, path.nearest(near, STRAIGHT), STRAIGHT).end == path.end
