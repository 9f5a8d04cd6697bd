"""A foot rolls over its heel after touchdown and over its ball before toe-off, farther in a faster walk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.walking.foot_rockers import FootRockers, Rollover
from humanwalk.walking.walking_reference import FootReference, FootTask

ROCKERS = FootRockers()
DOUBLE_SUPPORT = 0.1


def over_ball(
    since: float, speed: float = ROCKERS.full_pitch_speed, rockers: FootRockers = ROCKERS, climbing: float = 0.0
) -> FootReference:
    return rockers.over_ball(since, DOUBLE_SUPPORT, 0.5, 0.0, np.eye(3), Rollover(speed, rockers.ball, climbing))


def test_heels_rise_above_a_minimum_forward_speed() -> None:
    assert ROCKERS.heel_rises(1.0)
    assert not ROCKERS.heel_rises(0.0)
    assert not ROCKERS.heel_rises(-1.0)


def test_the_heel_rises_from_flat_to_its_pitch() -> None:
    assert over_ball(0.0).pitch[:2] == pytest.approx((0.0, 0.0))
    assert over_ball(ROCKERS.ball + DOUBLE_SUPPORT).pitch[0] == pytest.approx(ROCKERS.pitch)


@given(st.floats(0.01, 1.0), st.floats(0.0, 2.0))
def test_pitch_and_lead_follow_a_power_of_the_speed(share: float, exponent: float) -> None:
    rockers, speed = FootRockers(speed_exponent=exponent), share * ROCKERS.full_pitch_speed
    expected = share**exponent
    assert over_ball(rockers.ball + DOUBLE_SUPPORT, speed, rockers).pitch[0] == pytest.approx(expected * rockers.pitch)
    assert rockers.lead(speed) == pytest.approx(expected * rockers.ball)


@given(st.floats(1.0, 2.0))
def test_pitch_and_lead_are_greatest_from_the_full_pitch_speed_on(share: float) -> None:
    assert ROCKERS.lead(share * ROCKERS.full_pitch_speed) == ROCKERS.ball


def test_a_heel_that_rises_late_has_the_same_pitch_at_toe_off() -> None:
    early, late = (FootRockers(late_rise=share) for share in (0.0, 0.7))
    duration = ROCKERS.ball + DOUBLE_SUPPORT
    assert over_ball(0.5 * duration, rockers=late).pitch[0] < over_ball(0.5 * duration, rockers=early).pitch[0]
    for rockers in (early, late):
        assert over_ball(duration, rockers=rockers).pitch[0] == pytest.approx(ROCKERS.pitch)


@given(st.floats(0.01, 0.19), st.floats(0.0, 1.0))
def test_rates_are_derivatives(since: float, late_rise: float) -> None:
    h, rockers = 1e-5, FootRockers(late_rise=late_rise)
    before, here, after = (over_ball(since + d, rockers=rockers).pitch for d in (-h, 0.0, h))
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(here[1], rel=1e-4)
    assert (after[1] - before[1]) / (2 * h) == pytest.approx(here[2], rel=1e-4)


@given(st.floats(0.01, 0.3), st.floats(0.3, 1.2), st.floats(0.05, 0.3), st.floats(0.0, 1.0))
def test_the_rate_of_the_toes_is_a_derivative(since: float, most: float, half: float, climbing: float) -> None:
    h, rockers = 1e-6, FootRockers(toes=most, toe_range=half)
    before, here, after = (over_ball(since + d, rockers=rockers, climbing=climbing).toes for d in (-h, 0.0, h))
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(here[1], abs=1e-3)


def test_toes_stay_on_the_ground_while_the_foot_pitches() -> None:
    reference = over_ball(0.15)
    assert reference.task is FootTask.HEEL_OFF
    assert reference.toes == reference.pitch[:2]


@given(st.floats(0.0, 0.5), st.floats(0.3, 1.2), st.floats(0.01, 0.3))
def test_a_foot_that_pitches_further_than_its_toes_extend_rolls_over_them(
    since: float, most: float, half: float
) -> None:
    reference = over_ball(since, rockers=FootRockers(toes=most, toe_range=half))
    extension, rate = reference.toes
    pitch = reference.pitch
    assert -1e-12 <= extension <= min(pitch.value, most) + 1e-12
    assert -1e-12 <= rate <= pitch.rate + 1e-12
    if pitch.value <= most - half:
        assert reference.toes == pitch[:2]
    if pitch.value >= most + half:
        assert extension == pytest.approx(most)
        assert rate == 0.0


def test_toes_that_would_turn_before_the_heel_rises_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"^toe_range: 0\.3 is too large; allowed: up to toes, 0\.2 rad"):
        FootRockers(toes=0.2, toe_range=0.3)


@given(st.floats(0.0, 0.22), st.floats(0.3, 1.2), st.floats(0.0, 1.2))
def test_toes_stay_on_the_ground_in_a_step_up_or_down(since: float, most: float, speed: float) -> None:
    reference = over_ball(since, speed, FootRockers(toes=most), climbing=1.0)
    assert reference.toes == reference.pitch[:2]


def test_a_foot_is_loaded_from_touchdown_on() -> None:
    landed = ROCKERS.over_heel(1.0, 0.3, np.eye(3))
    assert (landed.task, landed.load, landed.yaw) == (FootTask.HEEL_STRIKE, 1.0, 0.3)
    assert landed.heel[0] == ROCKERS.landing_load > 0.0


@given(st.floats(0.01, 1.0))
def test_the_heel_lands_and_leaves_with_its_load_in_level_steps_only(level: float) -> None:
    assert ROCKERS.over_heel(level, 0.0, np.eye(3)).heel[0] == level * ROCKERS.landing_load
    before = ROCKERS.before_heel_off(0.05, 0.0, np.eye(3), Rollover(1.0, 0.1, 1.0 - level))
    assert before.heel[1] * level == pytest.approx(0.05 * ROCKERS.unloading)


def test_the_heel_carries_nothing_after_heel_off() -> None:
    assert over_ball(0.5).heel == (0.0, 0.0)
