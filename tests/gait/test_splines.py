"""Splines: the weights of the thesis, what they interpolate, how smooth they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from humanwalk.gait.splines import (
    CubicHermite,
    UniformCubicBSpline,
    UniformQuadraticBSpline,
    hermite_tangents,
)

KINDS = (CubicHermite, UniformQuadraticBSpline, UniformCubicBSpline)
U = np.linspace(0.0, 1.0, 21)

points_2d = st.integers(4, 9).flatmap(lambda n: arrays(np.float64, (n, 2), elements=st.floats(-50.0, 50.0)))

# Second cycle of appendix B at L 50, H 20 [cm].
BACKWARD_LOOP = np.array(
    [
        (0, 0),
        (50 / 6, 20 / 3),
        (12.5, 10),
        (50 / 3, 40 / 3),
        (25, 20),
        (100 / 3, 40 / 3),
        (37.5, 10),
        (250 / 6, 20 / 3),
        (50, 0),
        (250 / 6, 0),
        (25, 0),
        (50 / 6, 0),
    ]
)


def weights(kind, count):
    """Weights of the first segment on its points, over U: splines are linear in their points."""
    return kind(np.eye(count)).position(U)


def test_quadratic_b_spline_weights_are_eq_4_10_to_4_13():
    printed = np.column_stack([0.5 - U + 0.5 * U**2, 0.5 + U - U**2, 0.5 * U**2])
    np.testing.assert_allclose(weights(UniformQuadraticBSpline, 3), printed, atol=1e-15)


def test_cubic_b_spline_weights_are_eq_4_17_to_4_20():
    printed = np.column_stack(
        [
            1 - 3 * U + 3 * U**2 - U**3,
            4 - 6 * U**2 + 3 * U**3,
            1 + 3 * U + 3 * U**2 - 3 * U**3,
            U**3,
        ]
    )
    np.testing.assert_allclose(weights(UniformCubicBSpline, 4), printed / 6, atol=1e-15)


def test_quadratic_matrix_of_eq_4_13_has_the_same_weights():
    matrix = 0.5 * np.array([[1, -2, 1], [-2, 2, 0], [1, 1, 0]])
    printed = np.column_stack([U**2, U, np.ones_like(U)]) @ matrix
    np.testing.assert_allclose(weights(UniformQuadraticBSpline, 3), printed, atol=1e-15)


def test_hermite_weights_are_those_of_the_appendices():
    points, tangents = np.array([[2.0, -1.0], [5.0, 3.0]]), np.array([[1.0, 4.0], [-2.0, 0.5]])
    basis = np.column_stack([1 - 3 * U**2 + 2 * U**3, U - 2 * U**2 + U**3, 3 * U**2 - 2 * U**3, U**3 - U**2])
    expected = basis @ np.array([points[0], tangents[0], points[1], tangents[1]])
    np.testing.assert_allclose(CubicHermite(points, tangents).position(U), expected, atol=1e-14)


def test_hermite_tangents_are_half_the_difference_of_the_neighbours():
    points = np.array([[0.0, 0.0], [1.0, 4.0], [4.0, 2.0], [5.0, 9.0]])
    expected = [[0.5, 2.0], [2.0, 1.0], [2.0, 2.5], [0.5, 3.5]]
    np.testing.assert_allclose(hermite_tangents(points), expected)
    joints = np.arange(4.0)
    np.testing.assert_allclose(CubicHermite(points).derivative(joints), expected, atol=1e-14)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("closed", [False, True])
@given(points=points_2d)
def test_weights_sum_to_one(kind, closed, points):
    """Moving all points moves the curve along."""
    shift = np.array([3.0, -7.0])
    u = np.linspace(0, kind(points, closed=closed).segments, 50)
    moved = kind(points + shift, closed=closed).position(u)
    np.testing.assert_allclose(moved, kind(points, closed=closed).position(u) + shift, rtol=0, atol=1e-11)


@given(points=points_2d)
def test_hermite_passes_through_its_points(points):
    spline = CubicHermite(points)
    u = np.arange(len(points), dtype=float)
    np.testing.assert_allclose(spline.position(u), points, rtol=0, atol=1e-12)


def test_the_cubic_weights_of_the_thesis_miss_their_points():
    """E5: the backward loop would reach x 2.78 to 47.22 and y 17.78 instead of 0 to 50 and 20."""
    spline = UniformCubicBSpline(BACKWARD_LOOP, closed=True)
    curve = spline.position(np.linspace(0, spline.segments, 12001))
    np.testing.assert_allclose(
        [curve[:, 0].min(), curve[:, 0].max(), curve[:, 1].max()], [2.78, 47.22, 17.78], atol=5e-3
    )
    hermite = CubicHermite(BACKWARD_LOOP, closed=True)
    assert hermite.position(np.linspace(0, 12, 12001))[:, 1].max() == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("kind", "smoothness"),
    [(CubicHermite, 1), (UniformQuadraticBSpline, 1), (UniformCubicBSpline, 2)],
)
@pytest.mark.parametrize("closed", [False, True])
@given(points=points_2d)
def test_derivatives_continue_over_the_joints(kind, smoothness, closed, points):
    spline = kind(points, closed=closed)
    joints = np.arange(1.0, spline.segments)
    step = 1e-9
    for order in range(smoothness + 1):
        before = spline.derivative(joints - step, order)
        after = spline.derivative(joints, order)
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-5)
        if closed:
            np.testing.assert_allclose(
                spline.derivative(spline.segments - step, order),
                spline.derivative(0.0, order),
                rtol=0,
                atol=1e-5,
            )


def test_hermite_curvature_jumps_at_a_joint():
    spline = CubicHermite(BACKWARD_LOOP)
    jump = spline.derivative(1.0, 2) - spline.derivative(1.0 - 1e-9, 2)
    assert np.linalg.norm(jump) > 1.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", [1, 2])
@given(points=points_2d, share=st.floats(0.05, 0.95))
def test_derivative_is_the_limit_of_differences(kind, order, points, share):
    spline = kind(points)
    u, h = np.arange(spline.segments) + share, 1e-4
    ahead, behind = (spline.derivative(u + s, order - 1) for s in (h, -h))
    np.testing.assert_allclose(spline.derivative(u, order), (ahead - behind) / (2 * h), rtol=0, atol=2e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_shapes_follow_the_parameter(kind):
    spline = kind(BACKWARD_LOOP)
    assert spline.dimension == 2
    assert spline.position(0.5).shape == (2,)
    assert spline.position(np.zeros((3, 4))).shape == (3, 4, 2)


@pytest.mark.parametrize("u", [-0.1, 11.5, np.nan])
def test_a_parameter_off_the_curve_is_refused(u):
    with pytest.raises(ValueError, match=r"u = .* outside \[0, 11\]"):
        CubicHermite(BACKWARD_LOOP).position(u)


@pytest.mark.parametrize("points", [[[0.0, 1.0]], [0.0, 1.0, 2.0], [[0.0, np.nan], [1.0, 1.0], [1.0, 2.0], [0.0, 0.0]]])
@pytest.mark.parametrize("kind", KINDS)
def test_unusable_control_points_are_refused(kind, points):
    with pytest.raises(ValueError, match="control_points has shape"):
        kind(points)


def test_tangents_must_match_the_points():
    with pytest.raises(ValueError, match="tangents has shape"):
        CubicHermite([[0, 0], [1, 1]], tangents=[[0, 0]])
