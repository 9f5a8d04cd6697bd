"""The commanded path is the integral of the command; who strays from it is drawn back, and waited for."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.command import Command
from humanwalk.control.commanded_path import CommandedPath, PathFollowing

START = CommandedPath(0.0, 0.0)
FOLLOWING = PathFollowing()
TURNING = Command(0.6, 0.0, 0.2)


def walked(command, duration, start=START, dt=0.004):
    path = start
    for _ in range(round(duration / dt)):
        path = path.advanced(command, dt)
    return path


def test_a_constant_turn_is_a_circle():
    for duration in (2.0, 7.0, 12.0):
        path = walked(TURNING, duration)
        assert abs(path.position - 3.0j) == pytest.approx(3.0, abs=1e-4)
        assert path.heading == pytest.approx(0.2 * duration)


def test_sideways_is_to_the_left():
    assert walked(Command(0.0, 0.3, 0.0), 2.0).position == pytest.approx(0.6j)


@given(st.floats(-0.5, 0.5))
def test_beside_a_walker_on_the_circle_is_where_he_is(lag):
    path = walked(TURNING, 6.0)
    there = walked(TURNING, 6.0 - lag / 0.6)
    beside = path.beside(there.position, TURNING)
    assert beside.position == pytest.approx(there.position, abs=0.02)
    assert beside.heading == pytest.approx(there.heading, abs=0.01)


def test_who_turns_on_the_spot_turns_with_the_command():
    path = CommandedPath(1.0, 0.7)
    assert path.beside(0.5j, Command(0.0, 0.0, 0.5)) == path


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-math.pi, math.pi))
def test_the_correction_is_towards_the_path_and_bounded(x, y, heading):
    path = CommandedPath(0.3 + 0.1j, heading)
    away = complex(x, y) * cmath.exp(1j * heading)
    correction = FOLLOWING.correction(path, path, path.position + away)
    assert correction.real * x <= 1e-9
    assert correction.imag * y <= 1e-9
    assert abs(correction.real) <= FOLLOWING.pace_speed_limit
    assert abs(correction.imag) <= FOLLOWING.lane_speed_limit


def test_who_is_on_the_path_is_left_alone():
    assert FOLLOWING.correction(START, START, 0.0) == 0.0


def test_the_path_waits_for_who_was_held_up_but_keeps_his_lane():
    leashed = FOLLOWING.leashed(CommandedPath(5.0, 0.0), 1.0 + 0.4j)
    leash = FOLLOWING.pace_speed_limit / FOLLOWING.pace_gain
    assert leashed.position == pytest.approx(1.0 + leash)
    near = CommandedPath(1.0 + 0.5 * leash, 0.0)
    assert FOLLOWING.leashed(near, 1.0 + 0.4j).position == pytest.approx(near.position)
