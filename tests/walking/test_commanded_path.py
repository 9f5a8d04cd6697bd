"""The commanded path is the integral of the command; who strays from it is drawn back, and waited for."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.command import Command
from humanwalk.walking.commanded_path import CommandedPath, PathFollowing

START = CommandedPath.begin(0.0, 0.0)
FOLLOWING = PathFollowing()
STRAIGHT, TURNING = Command(0.6), Command(0.6, 0.0, 0.2)


def walked(command, duration, start=START, dt=0.02):
    path = start
    for _ in range(round(duration / dt)):
        path = path.advanced(command, dt)
    return path


def test_a_constant_turn_is_a_circle():
    for duration in (2.0, 7.0, 12.0):
        end = walked(TURNING, duration).end
        assert abs(end.position - 3.0j) == pytest.approx(3.0, abs=1e-3)
        assert end.heading == pytest.approx(0.2 * duration)
        assert end.way == pytest.approx(0.6 * duration)


def test_sideways_is_to_the_left():
    assert walked(Command(0.0, 0.3, 0.0), 2.0).end.position == pytest.approx(0.6j)


def test_what_is_remembered_does_not_grow():
    assert len(walked(STRAIGHT, 20.0).places) == len(walked(STRAIGHT, 10.0).places)


@given(st.floats(-0.5, 1.5))
def test_beside_a_walker_on_the_circle_is_where_he_is(lag):
    """Also for who is ahead of the command."""
    path = walked(TURNING, 6.0)
    there = walked(TURNING, 6.0 - lag / 0.6).end
    beside = path.beside(there.position, TURNING)
    assert beside.position == pytest.approx(there.position, abs=0.02)
    assert beside.heading == pytest.approx(there.heading, abs=0.02)
    assert beside.way == pytest.approx(there.way, abs=0.02)


@given(st.floats(0.05, 0.5))
def test_who_is_still_before_the_corner_goes_straight_on(lag):
    """The command turns already."""
    corner = walked(STRAIGHT, 3.0)
    beside = walked(TURNING, 1.0, corner).beside(corner.end.position - lag, TURNING)
    assert beside.heading == pytest.approx(0.0, abs=0.02)
    assert beside.turn == 0.0


def test_who_turns_on_the_spot_turns_with_the_command():
    path = CommandedPath.begin(1.0, 0.7)
    assert path.beside(0.5j, Command(0.0, 0.0, 0.5)) == path.end


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-math.pi, math.pi))
def test_the_correction_is_towards_the_path_and_bounded(x, y, heading):
    path = walked(STRAIGHT, 3.0, CommandedPath.begin(0.3 + 0.1j, heading))
    away = complex(x, y) * cmath.exp(1j * heading)
    own = path.end.position - FOLLOWING.behind * STRAIGHT.velocity * cmath.exp(1j * heading)
    walker = own + away
    correction = FOLLOWING.correction(path, path.beside(walker, STRAIGHT), walker, STRAIGHT)
    assert correction.real * x <= 1e-9
    assert correction.imag * y <= 1e-9
    assert abs(correction.real) <= FOLLOWING.pace_speed_limit + 1e-9
    assert abs(correction.imag) <= FOLLOWING.lane_speed_limit + 1e-9


def test_who_is_half_a_step_behind_the_command_is_left_alone():
    path = walked(STRAIGHT, 2.0)
    own = path.end.position - FOLLOWING.behind * STRAIGHT.velocity
    assert FOLLOWING.correction(path, path.beside(own, STRAIGHT), own, STRAIGHT) == pytest.approx(0.0, abs=1e-9)


def test_the_path_waits_for_who_was_held_up_but_keeps_his_lane():
    leash = FOLLOWING.pace_speed_limit / FOLLOWING.pace_gain
    path = walked(STRAIGHT, 5.0)
    far = path.end.position - leash - 0.5 + 0.4j
    leashed = FOLLOWING.leashed(path, path.beside(far, STRAIGHT))
    assert leashed.end.position == pytest.approx(far.real + leash, abs=1e-6)
    near = path.end.position - 0.5 * leash + 0.4j
    assert FOLLOWING.leashed(path, path.beside(near, STRAIGHT)).end == path.end
