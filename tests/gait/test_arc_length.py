"""Arc length: integrated and inverted to rounding, on all the splines."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.splines import CubicHermite, UniformCubicBSpline, UniformQuadraticBSpline
from humanwalk.gait.thesis_path import backward_control_points, forward_control_points

SIZES_CM = (50.0, 20.0, 5.0)
CURVES = {
    f"{kind.__name__}-{points.__name__}": kind(points(*SIZES_CM))
    for kind in (CubicHermite, UniformQuadraticBSpline, UniformCubicBSpline)
    for points in (forward_control_points, backward_control_points)
}
EVERY_CURVE = pytest.mark.parametrize("spline", CURVES.values(), ids=CURVES.keys())


def arc(spline, start, stop):
    """Independent arc length: adaptive integration, a segment at a time."""
    joints = [start, *np.arange(np.floor(start) + 1, np.ceil(stop)), stop]
    return sum(
        quad(lambda u: float(np.linalg.norm(spline.derivative(u))), a, b, epsabs=1e-12, epsrel=1e-12)[0]
        for a, b in pairwise(joints)
    )


@EVERY_CURVE
def test_length_agrees_with_adaptive_integration(spline):
    assert ArcLength(spline).length == pytest.approx(arc(spline, 0.0, spline.segments), abs=1e-9)


@EVERY_CURVE
def test_resampling_is_at_equal_arc_lengths(spline):
    """The mended E16: 1.4 m/s at 0.01 s is a point every 1.4 cm, exactly."""
    walk = ArcLength(spline)
    u = walk.parameter_at(np.arange(0.0, walk.length, 1.4))
    steps = [arc(spline, a, b) for a, b in pairwise(u[:41])]
    np.testing.assert_allclose(steps, 1.4, rtol=0, atol=1e-9)
    np.testing.assert_allclose(walk.resample(1.4)[: len(u)], spline.position(u), rtol=0, atol=1e-12)


@EVERY_CURVE
@given(share=st.floats(0.0, 1.0))
def test_length_and_parameter_are_inverse(spline, share):
    walk = ArcLength(spline)
    s = share * walk.length
    assert float(walk.length_to(walk.parameter_at(s))) == pytest.approx(s, abs=1e-10)


@EVERY_CURVE
def test_tangent_is_the_unit_derivative_of_position(spline):
    walk, h = ArcLength(spline), 1e-5
    s = np.linspace(0.1, walk.length - 0.1, 101)
    tangent = walk.tangent(s)
    np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1.0, atol=1e-14)
    # A tangent turns within 2h of arc by the curvature there, which is below 40 per cm.
    differences = (walk.position(s + h) - walk.position(s - h)) / (2 * h)
    np.testing.assert_allclose(tangent, differences, rtol=0, atol=1e-3)


def test_a_straight_line_is_its_own_arc_length():
    walk = ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]]))
    assert walk.length == pytest.approx(10.0, abs=1e-12)
    np.testing.assert_allclose(walk.position(2.5), [1.5, 2.0], atol=1e-12)
    assert len(walk.resample(2.5)) == 5


def test_a_cusp_is_inverted_too():
    """The speed is 0 in the middle of this curve; Newton alone would divide by it."""
    walk = ArcLength(CubicHermite([[0, 0], [1, 1], [2, 0]], [[1, 1], [0, 0], [1, -1]]))
    s = np.linspace(0.0, walk.length, 257)
    np.testing.assert_allclose(walk.length_to(walk.parameter_at(s)), s, rtol=0, atol=1e-12)


@pytest.mark.parametrize("s", [-1.0, 10.1, np.nan])
def test_a_distance_off_the_curve_is_refused(s):
    with pytest.raises(ValueError, match=r"s = .* outside"):
        ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]])).position(s)


@pytest.mark.parametrize("ds", [0.0, -1.0, 11.0, np.nan])
def test_an_unusable_spacing_is_refused(ds):
    with pytest.raises(ValueError, match=r"ds = .* outside"):
        ArcLength(CubicHermite([[0, 0], [3, 4], [6, 8]])).resample(ds)


def test_a_curve_without_length_is_refused():
    with pytest.raises(ValueError, match="length 0"):
        ArcLength(CubicHermite([[1, 1], [1, 1]]))
