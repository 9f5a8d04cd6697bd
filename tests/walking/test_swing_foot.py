"""The swinging foot continues its motion at toe-off, clears the ground, and lands as desired."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.quantity import ParameterError
from humanwalk.walking.swing_foot import MAX_TOE_UP, SwingParameters, SwingProfile
from humanwalk.walking.walking_reference import FootState

DURATION = 0.42
SINK_RATE = 0.2
SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)


def toe_off(height: float = 0.12, height_rate: float = 0.3, pitch: float = 0.6, pitch_rate: float = -2.0) -> FootState:
    return FootState(0j, 0j, height, height_rate, yaw=0.0, pitch=pitch, pitch_rate=pitch_rate, force=0.0)


def test_the_pitch_at_touchdown_grows_with_the_forward_speed_up_to_a_limit() -> None:
    law = SwingParameters()
    assert law.touchdown_pitch(-0.5) == law.touchdown_pitch(0.0) == 0.0
    assert law.touchdown_pitch(1.4) == pytest.approx(2.0 * law.touchdown_pitch(0.7))
    assert law.touchdown_pitch(3.0) == MAX_TOE_UP


def test_it_sinks_faster_at_touchdown_in_a_slow_walk() -> None:
    law = SwingParameters()
    middle = 0.5 * (law.slow_speed + law.free_speed)
    assert law.sink_rate(-0.5) == law.sink_rate(law.slow_speed) == law.slow_landing_sink_rate
    assert law.sink_rate(middle) == pytest.approx(0.5 * (law.slow_landing_sink_rate + law.landing_sink_rate))
    assert law.sink_rate(law.free_speed) == law.sink_rate(3.0) == law.landing_sink_rate


@pytest.mark.parametrize("slow_speed", [1.2, 1.3])
def test_a_slow_speed_that_is_not_below_the_free_speed_is_an_error(slow_speed: float) -> None:
    with pytest.raises(ParameterError, match=r"slow_speed: 1\.\d is too fast; allowed: below free_speed, 1\.2 m/s"):
        SwingParameters(slow_speed=slow_speed)


@given(st.complex_numbers(max_magnitude=2.0))
def test_it_accelerates_along_the_walk_with_the_square_of_its_speed(pace: complex) -> None:
    law = SwingParameters()
    assert law.toe_off_acceleration(2.0 * pace) == pytest.approx(4.0 * law.toe_off_acceleration(pace))
    assert (law.toe_off_acceleration(pace) * pace.conjugate()).real == pytest.approx(
        law.push_off * abs(pace) ** 3, abs=1e-9
    )


@given(st.complex_numbers(max_magnitude=1.0), st.complex_numbers(max_magnitude=2.0))
def test_it_lands_on_the_foothold_slower_than_the_walk_and_decelerating(foothold: complex, velocity: complex) -> None:
    landing = SwingParameters().landing(foothold, velocity)
    assert landing.position == foothold
    assert abs(landing.velocity) <= abs(velocity)
    assert (landing.velocity * landing.acceleration.conjugate()).real <= 0.0


@pytest.fixture
def profile() -> SwingProfile:
    return SwingProfile.from_toe_off(toe_off(), 0.068, 0.25, SINK_RATE, DURATION, SwingParameters(), SOLE)


def test_it_continues_the_motion_at_toe_off(profile: SwingProfile) -> None:
    height, pitch = (motion.time_scaled(1.0 / DURATION) for motion in profile.at(0.0))
    assert (height.value, pitch.value) == pytest.approx((0.12, 0.6))
    assert (height.rate, pitch.rate) == pytest.approx((0.3, -2.0))


def test_it_lands_on_the_heel_with_the_landing_speed(profile: SwingProfile) -> None:
    height, pitch = profile.at(1.0)
    assert height.value == pytest.approx(0.068 - SwingParameters.landing_depth)
    assert pitch.value == pytest.approx(-0.25)
    assert height.rate / DURATION == pytest.approx(-SINK_RATE)


def test_a_foot_that_lands_on_its_heel_is_higher_by_what_the_heel_is_lower_than_the_ankle() -> None:
    profile = SwingProfile.from_toe_off(
        toe_off(), 0.068, 0.25, SINK_RATE, DURATION, SwingParameters(heel_height=1.0), SOLE
    )
    assert profile.at(1.0)[0].value == pytest.approx(0.068 - SwingParameters.landing_depth + SOLE.back * math.sin(0.25))
    assert profile.lowest(1.0, 0.068, SOLE) == pytest.approx(-SwingParameters.landing_depth)


def test_a_foot_that_leaves_the_ground_as_people_do_clears_it_in_between() -> None:
    """Their ankle is 12 cm above its height in standing at toe-off (docs/likeness_trials.md)."""
    profile = SwingProfile.from_toe_off(
        toe_off(0.068 + 0.12), 0.068, 0.25, SINK_RATE, DURATION, SwingParameters(), SOLE
    )
    assert all(profile.at(s / 100)[0].value > 0.068 for s in range(95))


@given(st.floats(0.0, 0.1))
def test_a_foot_that_leaves_the_ground_flat_has_clearance(raised: float) -> None:
    parameters, ground = SwingParameters(), 0.068
    profile = SwingProfile.from_toe_off(
        toe_off(ground + raised, 0.0, 0.0, 0.0), ground, 0.25, SINK_RATE, DURATION, parameters, SOLE
    )
    highest = max(profile.at(s / 100)[0].value for s in range(100)) - ground
    assert highest >= max(parameters.clearance, raised + parameters.lift) - 1e-9


@given(st.integers(0, 3), st.floats(0.01, 0.99))
def test_rates_are_derivatives_within_each_quarter(quarter: int, fraction: float) -> None:
    profile = SwingProfile.from_toe_off(toe_off(), 0.068, 0.25, SINK_RATE, DURATION, SwingParameters(), SOLE)
    progress, h = 0.25 * (quarter + fraction), 1e-6
    for before, here, after in zip(*(profile.at(progress + d) for d in (-h, 0.0, h)), strict=True):
        assert (after.value - before.value) / (2.0 * h) == pytest.approx(here.rate, abs=1e-4)
        assert (after.rate - before.rate) / (2.0 * h) == pytest.approx(here.acceleration, abs=1e-4)


@pytest.mark.parametrize("knot", [0.25, 0.5, 0.75])
def test_height_and_pitch_have_no_jump_in_their_rates_and_accelerations(profile: SwingProfile, knot: float) -> None:
    for before, after in zip(profile.at(knot - 1e-9), profile.at(knot + 1e-9), strict=True):
        assert before == pytest.approx(after, abs=1e-6)
