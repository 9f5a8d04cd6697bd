"""Arc length: integrated and inverted to rounding."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.splines import CubicHermite
from humanwalk.gait.thesis_path import thesis_path

SIZES_CM = (50.0, 20.0, 5.0)
CURVES = {path: thesis_path(path, *SIZES_CM) for path in ("forward", "backward")}
BOTH_CURVES = pytest.mark.parametrize("spline", CURVES.values(), ids=CURVES.keys())


def arc(spline: CubicHermite, start: float, stop: float) -> float:
    """Independent arc length: adaptive integration, segment by segment."""
    joints = [start, *np.arange(np.floor(start) + 1, np.ceil(stop)), stop]
    return sum(
        quad(lambda u: float(np.linalg.norm(spline.derivative(u))), a, b, epsabs=1e-12, epsrel=1e-12)[0]
        for a, b in pairwise(joints)
    )


@BOTH_CURVES
def test_length_agrees_with_adaptive_integration(spline: CubicHermite) -> None:
    assert ArcLength(spline).length == pytest.approx(arc(spline, 0.0, spline.segments), abs=1e-9)


@BOTH_CURVES
def test_resampling_is_at_equal_arc_lengths(spline: CubicHermite) -> None:
    """E16 corrected: 1.4 m/s at 0.01 s is exactly a point every 1.4 cm."""
    walk = ArcLength(spline)
    u = walk.parameter_at(np.arange(0.0, walk.length, 1.4))
    steps = [arc(spline, a, b) for a, b in pairwise(u[:41])]
    np.testing.assert_allclose(steps, 1.4, rtol=0, atol=1e-9)
    np.testing.assert_allclose(walk.resample(1.4)[: len(u)], spline.position(u), rtol=0, atol=1e-12)


@BOTH_CURVES
@settings(max_examples=10)
@given(fraction=st.floats(0.0, 1.0))
def test_length_and_parameter_are_inverse(spline: CubicHermite, fraction: float) -> None:
    walk = ArcLength(spline)
    s = fraction * walk.length
    assert arc(spline, 0.0, float(walk.parameter_at(s))) == pytest.approx(s, abs=1e-9)


def test_a_straight_line_is_its_own_arc_length() -> None:
    walk = ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]]))
    assert walk.length == pytest.approx(10.0, abs=1e-12)
    np.testing.assert_allclose(walk.position(2.5), [1.5, 2.0], atol=1e-12)
    assert len(walk.resample(2.5)) == 5


def test_a_cusp_is_inverted_too() -> None:
    """The speed is 0 in the middle of this curve; Newton's method alone would divide by it."""
    walk = ArcLength(CubicHermite([[0, 0], [1, 1], [2, 0]], [[1, 1], [0, 0], [1, -1]]))
    s = np.linspace(0.0, walk.length, 33)
    lengths = [arc(walk.spline, 0.0, u) for u in walk.parameter_at(s)]
    np.testing.assert_allclose(lengths, s, rtol=0, atol=1e-9)


@pytest.mark.parametrize("s", [-1.0, 10.1, np.nan])
def test_a_distance_outside_the_curve_is_rejected(s: float) -> None:
    with pytest.raises(ValueError, match=r"s = .* outside"):
        ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]])).position(s)


@pytest.mark.parametrize("ds", [0.0, -1.0, 11.0, np.nan])
def test_an_unusable_spacing_is_rejected(ds: float) -> None:
    with pytest.raises(ValueError, match=r"ds = .* outside"):
        ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]])).resample(ds)


def test_a_curve_without_length_is_rejected() -> None:
    with pytest.raises(ValueError, match="length 0"):
        ArcLength(CubicHermite([[1, 1], [1, 1]]))
