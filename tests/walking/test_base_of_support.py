"""The zero-moment point is limited to the stance foot, to its front, or to both feet and the area between them."""

import cmath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.walking.base_of_support import BaseOfSupport

SUPPORT = BaseOfSupport()
points = st.builds(complex, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
headings = st.floats(-3.0, 3.0)


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        (
            {"center": -0.05},
            r"^center: -0\.05 is outside .*; allowed: -0\.04 to 0\.2 m; .*back or front$",
        ),
        ({"front": 0.05, "center": 0.04}, r"^ball: 0\.0815 is outside .*; allowed: 0 to 0\.05 m"),
    ],
)
def test_limits_that_contradict_each_other_are_refused(limits: dict[str, float], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        BaseOfSupport(**limits)


@given(points, points, headings, st.booleans())
def test_it_stays_on_the_stance_foot(zmp: complex, stance: complex, heading: float, on_ball: bool) -> None:
    kept = (SUPPORT.clamp(zmp, stance, heading, on_ball=on_ball) - stance) / cmath.exp(1j * heading)
    assert (SUPPORT.ball if on_ball else -SUPPORT.back) - 1e-9 <= kept.real <= SUPPORT.front + 1e-9
    assert abs(kept.imag) <= SUPPORT.half_width + 1e-9


@given(points, points, headings)
def test_a_point_within_the_base_of_support_is_not_moved(zmp: complex, stance: complex, heading: float) -> None:
    once = SUPPORT.clamp(zmp, stance, heading)
    assert SUPPORT.clamp(once, stance, heading) == pytest.approx(once, abs=1e-9)


def test_between_two_feet_it_may_be_anywhere_on_the_line_of_the_ankles() -> None:
    for fraction in (0.0, 0.3, 0.7, 1.0):
        zmp = fraction * (0.6 + 0.16j)
        assert SUPPORT.clamp(zmp, 0.6 + 0.16j, 0.0, other=0.0) == pytest.approx(zmp)
    assert SUPPORT.clamp(0.3 + 0.08j, 0.6 + 0.16j, 0.0) != pytest.approx(0.3 + 0.08j)


@given(st.floats(-3.0, 3.0))
def test_between_two_feet_an_error_sideways_has_a_greater_weight_than_one_forward(heading: float) -> None:
    u = cmath.exp(1j * heading)
    stance, old = 0.5 * u, 0.16j * u
    outward, back = (SUPPORT.clamp(stance + error * u, stance, heading, old) for error in (-0.2 - 0.2j, -0.2))
    # Only the stance foot corrects an outward error.
    assert abs(outward - stance) < SUPPORT.back + SUPPORT.half_width
    assert abs(back - stance) > SUPPORT.back + SUPPORT.half_width


@given(points, points, points, headings)
def test_both_feet_hold_a_dcm_that_the_zero_moment_point_can_be_at(
    dcm: complex, stance: complex, other: complex, heading: float
) -> None:
    within = SUPPORT.clamp(dcm, stance, heading, other)
    assert SUPPORT.outside(dcm, stance, heading, other) == pytest.approx(dcm - within, abs=2e-9)
    assert SUPPORT.outside(stance, stance, heading, other) == 0.0


def test_the_nominal_zero_moment_point_is_ahead_of_the_ankle() -> None:
    assert SUPPORT.center_of(1.0, cmath.pi / 2) == pytest.approx(1.0 + 1j * SUPPORT.center)


@given(st.complex_numbers(max_magnitude=1.0), st.floats(0.0, 8.0))
def test_the_zero_moment_point_corrects_small_errors_and_no_more_than_the_foot_allows(
    error: complex, growth: float
) -> None:
    support = BaseOfSupport()
    corrected = support.correctable(error, growth)
    assert abs(corrected.real) <= growth * (support.center + support.back) + 1e-12
    assert abs(corrected.imag) <= growth * support.half_width + 1e-12
    assert abs(error - corrected) <= abs(error) + 1e-12
    assert support.correctable(0.001 * corrected, growth) == pytest.approx(0.001 * corrected)
