"""Speed ramp: from rest, linear, then constant."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.gait.speed_ramp import SpeedRamp

ramps = st.builds(SpeedRamp, st.floats(0.1, 3.0), st.floats(0.05, 10.0))
times = st.floats(0.0, 20.0)


@given(ramp=ramps)
def test_starts_at_rest_and_reaches_its_speed(ramp: SpeedRamp) -> None:
    assert ramp.distance(0.0) == ramp.speed_at(0.0) == 0.0
    assert ramp.distance(-1.0) == ramp.speed_at(-1.0) == ramp.acceleration(-1.0) == 0.0
    assert ramp.speed_at(0.5 * ramp.duration) == pytest.approx(0.5 * ramp.speed)
    assert ramp.speed_at(ramp.duration) == ramp.speed
    assert ramp.acceleration(ramp.duration) == 0.0


@given(ramp=ramps, t=times)
def test_speed_is_the_rate_of_distance_and_acceleration_of_speed(ramp: SpeedRamp, t: float) -> None:
    h = 1e-5
    kink = abs(t - ramp.duration) < 2 * h or t < 2 * h
    rate = (ramp.distance(t + h) - ramp.distance(t - h)) / (2 * h)
    assert rate == pytest.approx(ramp.speed_at(t), abs=1e-3 if kink else 1e-8)
    if not kink:
        rate = (ramp.speed_at(t + h) - ramp.speed_at(t - h)) / (2 * h)
        assert rate == pytest.approx(ramp.acceleration(t), abs=1e-8)


@given(ramp=ramps, t=times)
def test_time_at_inverts_distance(ramp: SpeedRamp, t: float) -> None:
    assert ramp.distance(ramp.time_at(ramp.distance(t))) == pytest.approx(ramp.distance(t), abs=1e-12)


def test_the_backward_start_of_the_thesis_takes_0_365_s() -> None:
    """E26: 25.56 cm while ramping to 1.4 m/s, the same time as 51.08 cm at 1.4 m/s."""
    ramp = SpeedRamp(1.4, 0.3652)
    assert ramp.time_at(0.2556) == pytest.approx(0.5108 / 1.4, rel=2e-3)


def test_no_ramp_starts_at_full_speed() -> None:
    ramp = SpeedRamp(1.0, 0.0)
    assert (ramp.distance(2.0), ramp.speed_at(0.0), ramp.acceleration(0.0)) == (2.0, 1.0, 0.0)


def test_with_speed_zero_the_body_stands() -> None:
    assert SpeedRamp(0.0).distance(100.0) == 0.0
    assert math.isinf(SpeedRamp(0.0).time_at(0.1))


@pytest.mark.parametrize("field", ["speed", "duration"])
@pytest.mark.parametrize("value", [-0.1, 140.0, math.nan])
def test_values_out_of_range_are_rejected(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"{field}: .*allowed"):
        SpeedRamp(**{field: value})
