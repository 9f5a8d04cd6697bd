"""The swinging foot continues its motion at toe-off, reaches its foothold in time, and bounds its jerk."""

import cmath
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.swing_foot import LANDING_DEPTH, MAX_PITCH_SPEED, PlanarMotion, SwingParameters, SwingProfile

DT = 0.004
DURATION = 0.42


def swing_to(goal_at, duration, jerk_limit=1e9):
    motion, t = PlanarMotion(0.0), 0.0
    path = [motion]
    while t < duration - 0.5 * DT:
        motion = motion.towards(PlanarMotion(goal_at(t)), duration - t, DT, jerk_limit)
        t += DT
        path.append(motion)
    return path


@given(st.floats(-0.8, 0.8), st.floats(-0.3, 0.3))
def test_it_comes_to_rest_at_the_foothold(x, y):
    goal = complex(x, y)
    end = swing_to(lambda t: goal, 0.4)[-1]
    assert end.position == pytest.approx(goal, abs=0.01)
    assert abs(end.velocity) < 0.5


def test_a_foothold_that_moves_is_reached_too():
    end = swing_to(lambda t: 0.6 if t < 0.2 else 0.7 + 0.05j, 0.42)[-1]
    assert end.position == pytest.approx(0.7 + 0.05j, abs=0.02)


def test_velocity_is_the_derivative_of_position():
    path = swing_to(lambda t: 0.7, 0.4)
    for before, after in pairwise(path):
        mean = 0.5 * (before.velocity + after.velocity)
        assert (after.position - before.position) / DT == pytest.approx(mean, abs=0.01)


def test_jerk_is_bounded():
    path = swing_to(lambda t: 2.0, 0.4, jerk_limit=1000.0)
    for before, after in pairwise(path):
        assert abs(after.acceleration - before.acceleration) <= 1000.0 * DT + 1e-9


def test_it_lands_with_the_desired_speed_and_deceleration():
    goal, motion, t = PlanarMotion(0.7, 0.35, -30.0), PlanarMotion(0.0, 0.7, 8.0), 0.0
    # In the last two periods the quintic ends later than the swing.
    while t < 0.4 - 2.5 * DT:
        motion = motion.towards(goal, 0.4 - t, DT, 1e9)
        t += DT
    assert motion.velocity.real == pytest.approx(0.35 + 30.0 * (0.4 - t), abs=0.1)
    assert motion.acceleration.real == pytest.approx(-30.0, abs=6.0)


def test_the_pitch_at_touchdown_grows_with_the_forward_speed_up_to_a_limit():
    law = SwingParameters()
    assert law.touchdown_pitch(-0.5) == law.touchdown_pitch(0.0) == 0.0
    assert law.touchdown_pitch(1.4) == pytest.approx(2.0 * law.touchdown_pitch(0.7))
    assert law.touchdown_pitch(3.0) == law.touchdown_pitch(MAX_PITCH_SPEED)


@given(st.complex_numbers(max_magnitude=2.0))
def test_it_accelerates_along_the_walk_with_the_square_of_its_speed(pace):
    law = SwingParameters()
    assert law.toe_off_acceleration(2.0 * pace) == pytest.approx(4.0 * law.toe_off_acceleration(pace))
    assert (law.toe_off_acceleration(pace) * pace.conjugate()).real == pytest.approx(
        law.push_off * abs(pace) ** 3, abs=1e-9
    )


@pytest.fixture
def profile():
    return SwingProfile.from_toe_off(0.12, 0.3, 0.6, -2.0, 0.068, 0.25, DURATION, SwingParameters())


def test_it_continues_the_motion_at_toe_off(profile):
    height, pitch = (motion.time_scaled(1.0 / DURATION) for motion in profile.at(0.0))
    assert (height.value, pitch.value) == pytest.approx((0.12, 0.6))
    assert (height.rate, pitch.rate) == pytest.approx((0.3, -2.0))


def test_it_lands_on_the_heel_with_the_landing_speed(profile):
    (height, pitch), parameters = profile.at(1.0), SwingParameters()
    assert height.value == pytest.approx(0.068 - LANDING_DEPTH)
    assert pitch.value == pytest.approx(-0.25)
    assert height.rate / DURATION == pytest.approx(-parameters.landing_sink_rate)


def test_it_clears_the_ground_in_between(profile):
    assert all(profile.at(s / 100)[0].value > 0.068 for s in range(95))


@given(st.floats(0.0, 0.1))
def test_a_foot_that_leaves_the_ground_flat_has_clearance(raised):
    parameters, ground = SwingParameters(), 0.068
    profile = SwingProfile.from_toe_off(ground + raised, 0.0, 0.0, 0.0, ground, 0.25, DURATION, parameters)
    highest = max(profile.at(s / 100)[0].value for s in range(100)) - ground
    assert highest >= max(parameters.clearance, raised + parameters.lift) - 1e-9


@given(st.floats(0.01, 0.99))
def test_rates_are_derivatives(progress):
    profile = SwingProfile.from_toe_off(0.12, 0.3, 0.6, -2.0, 0.068, 0.25, DURATION, SwingParameters())
    h = 1e-6
    for before, here, after in zip(*(profile.at(progress + d) for d in (-h, 0.0, h)), strict=True):
        assert (after.value - before.value) / (2.0 * h) == pytest.approx(here.rate, abs=1e-3)
        assert (after.rate - before.rate) / (2.0 * h) == pytest.approx(here.acceleration, abs=0.1)


@given(st.floats(-3.1, 3.1))
def test_a_motion_with_the_sideways_of_another_has_both(heading):
    u = cmath.exp(1j * heading)
    along, across = PlanarMotion(1.0 + 2.0j, 3.0, 4.0j), PlanarMotion(-1.0 + 0.5j, 1.0j, 2.0)
    mixed = along.with_sideways_of(across, u)
    for got, x, y in zip(mixed, along, across, strict=True):
        assert (got / u).real == pytest.approx((x / u).real)
        assert (got / u).imag == pytest.approx((y / u).imag)
