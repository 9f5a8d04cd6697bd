"""The foot in the air goes on as it left, arrives where and when it should, and bounds its jerk."""

import cmath
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.swing_foot import BRISKEST, PlanarMotion, SwingParameters, SwingProfile

DT = 0.004


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


def test_it_lands_with_the_speed_and_deceleration_that_are_asked():
    goal, motion, t = PlanarMotion(0.7, 0.35, -30.0), PlanarMotion(0.0, 0.7, 8.0), 0.0
    # The quintic is not made anew in its last moments, where there is nothing left to steer.
    while t < 0.4 - 2.5 * DT:
        motion = motion.towards(goal, 0.4 - t, DT, 1e9)
        t += DT
    assert motion.velocity.real == pytest.approx(0.35 + 30.0 * (0.4 - t), abs=0.1)
    assert motion.acceleration.real == pytest.approx(-30.0, abs=6.0)


def test_it_lands_the_steeper_the_faster_but_not_on_its_end():
    law = SwingParameters()
    assert law.heel_strike(-0.5) == law.heel_strike(0.0) == 0.0
    assert law.heel_strike(1.4) == pytest.approx(2.0 * law.heel_strike(0.7))
    assert law.heel_strike(3.0) == law.heel_strike(BRISKEST)


@given(st.complex_numbers(max_magnitude=2.0))
def test_it_leaves_the_way_that_the_walk_goes(pace):
    law = SwingParameters()
    assert law.leaving(2.0 * pace) == pytest.approx(4.0 * law.leaving(pace))
    assert (law.leaving(pace) * pace.conjugate()).real == pytest.approx(law.push_off * abs(pace) ** 3, abs=1e-9)


@pytest.fixture
def profile():
    return SwingProfile.from_lift_off(0.12, 0.3, 0.6, -2.0, 0.068, 0.25, 0.42, SwingParameters())


def test_it_goes_on_as_the_foot_left(profile):
    begin = profile.at(0.0)
    assert (begin.height, begin.pitch) == pytest.approx((0.12, 0.6))
    assert (begin.height_rate, begin.pitch_rate) == pytest.approx((0.3, -2.0))


def test_it_lands_on_the_heel_with_the_landing_speed(profile):
    end, parameters = profile.at(1.0), SwingParameters()
    assert end.pitch == pytest.approx(-0.25)
    assert end.height_rate == pytest.approx(-parameters.landing_speed)


def test_it_clears_the_ground_in_between(profile):
    assert all(profile.at(s / 100).height > 0.068 for s in range(95))


@given(st.floats(0.0, 0.1))
def test_a_foot_that_leaves_flat_is_lifted_over_what_it_could_scuff(raised):
    parameters, ground = SwingParameters(), 0.068
    profile = SwingProfile.from_lift_off(ground + raised, 0.0, 0.0, 0.0, ground, 0.25, 0.42, parameters)
    highest = max(profile.at(s / 100).height for s in range(100)) - ground
    assert highest >= max(parameters.clearance, raised + parameters.lift) - 1e-9


@given(st.floats(0.01, 0.99))
def test_rates_are_derivatives(progress):
    profile = SwingProfile.from_lift_off(0.12, 0.3, 0.6, -2.0, 0.068, 0.25, 0.42, SwingParameters())
    h = 1e-6
    before, here, after = (profile.at(progress + d) for d in (-h, 0.0, h))
    dt = 2.0 * h * profile.duration
    assert (after.height - before.height) / dt == pytest.approx(here.height_rate, abs=1e-3)
    assert (after.pitch - before.pitch) / dt == pytest.approx(here.pitch_rate, abs=1e-3)


@given(st.floats(-3.1, 3.1))
def test_a_motion_with_the_sideways_of_another_has_both(heading):
    u = cmath.exp(1j * heading)
    along, across = PlanarMotion(1.0 + 2.0j, 3.0, 4.0j), PlanarMotion(-1.0 + 0.5j, 1.0j, 2.0)
    mixed = along.with_sideways_of(across, heading)
    for got, x, y in zip(mixed, along, across, strict=True):
        assert (got / u).real == pytest.approx((x / u).real)
        assert (got / u).imag == pytest.approx((y / u).imag)
