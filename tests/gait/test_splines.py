"""Cubic Hermite splines: the weights of the thesis' programs, interpolation, smoothness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from humanwalk.gait.splines import CubicHermite, hermite_tangents
from humanwalk.numerics import Array

U = np.linspace(0.0, 1.0, 21)

points_2d = st.integers(4, 9).flatmap(lambda n: arrays(np.float64, (n, 2), elements=st.floats(-50.0, 50.0)))

BACKWARD_CYCLE = np.array(
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
"""Second cycle of appendix B at L 50, H 20 [cm]."""


def test_hermite_weights_are_those_of_the_appendices() -> None:
    points, tangents = np.array([[2.0, -1.0], [5.0, 3.0]]), np.array([[1.0, 4.0], [-2.0, 0.5]])
    basis = np.column_stack([1 - 3 * U**2 + 2 * U**3, U - 2 * U**2 + U**3, 3 * U**2 - 2 * U**3, U**3 - U**2])
    expected = basis @ np.array([points[0], tangents[0], points[1], tangents[1]])
    np.testing.assert_allclose(CubicHermite(points, tangents).position(U), expected, atol=1e-14)


def test_hermite_tangents_are_half_the_difference_of_the_neighbors() -> None:
    points = np.array([[0.0, 0.0], [1.0, 4.0], [4.0, 2.0], [5.0, 9.0]])
    expected = [[0.5, 2.0], [2.0, 1.0], [2.0, 2.5], [0.5, 3.5]]
    np.testing.assert_allclose(hermite_tangents(points), expected)
    joints = np.arange(4.0)
    np.testing.assert_allclose(CubicHermite(points).derivative(joints), expected, atol=1e-14)


@given(points=points_2d)
def test_moving_all_points_moves_the_curve(points: Array) -> None:
    shift = np.array([3.0, -7.0])
    u = np.linspace(0, len(points) - 1, 50)
    moved = CubicHermite(points + shift).position(u)
    np.testing.assert_allclose(moved, CubicHermite(points).position(u) + shift, rtol=0, atol=1e-11)


@given(points=points_2d)
def test_hermite_passes_through_its_points(points: Array) -> None:
    spline = CubicHermite(points)
    u = np.arange(len(points), dtype=float)
    np.testing.assert_allclose(spline.position(u), points, rtol=0, atol=1e-12)


@given(points=points_2d)
def test_position_and_tangent_continue_over_the_knots(points: Array) -> None:
    spline, step = CubicHermite(points), 1e-9
    knots = np.arange(1.0, spline.segments)
    for order in (0, 1):
        before, after = spline.derivative(knots - step, order), spline.derivative(knots, order)
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-5)


def test_the_curvature_jumps_at_a_knot() -> None:
    spline = CubicHermite(BACKWARD_CYCLE)
    jump = spline.derivative(1.0, 2) - spline.derivative(1.0 - 1e-9, 2)
    assert np.linalg.norm(jump) > 1.0


@pytest.mark.parametrize("order", [1, 2])
@given(points=points_2d, fraction=st.floats(0.05, 0.95))
def test_derivative_is_the_limit_of_differences(order: int, points: Array, fraction: float) -> None:
    spline = CubicHermite(points)
    u, h = np.arange(spline.segments) + fraction, 1e-4
    ahead, behind = (spline.derivative(u + s, order - 1) for s in (h, -h))
    np.testing.assert_allclose(spline.derivative(u, order), (ahead - behind) / (2 * h), rtol=0, atol=2e-5)


@given(points=points_2d, fraction=st.floats(0.0, 1.0))
def test_coefficients_are_those_of_the_powers_of_u_in_each_segment(points: Array, fraction: float) -> None:
    spline = CubicHermite(points)
    powers = fraction ** np.arange(4)
    u = np.arange(spline.segments) + fraction
    np.testing.assert_allclose(spline.coefficients @ powers, spline.position(u), rtol=0, atol=1e-10)


def test_shapes_follow_the_parameter() -> None:
    spline = CubicHermite(BACKWARD_CYCLE)
    assert spline.position(0.5).shape == (2,)
    assert spline.position(np.zeros((3, 4))).shape == (3, 4, 2)


@pytest.mark.parametrize("u", [-0.1, 11.5, np.nan])
def test_a_parameter_outside_the_curve_is_rejected(u: float) -> None:
    with pytest.raises(ValueError, match=r"u = .* outside \[0, 11\]"):
        CubicHermite(BACKWARD_CYCLE).position(u)


@pytest.mark.parametrize("points", [[[0.0, 1.0]], [0.0, 1.0, 2.0], [[0.0, np.nan], [1.0, 1.0], [1.0, 2.0], [0.0, 0.0]]])
def test_unusable_control_points_are_rejected(points: list[float | list[float]]) -> None:
    with pytest.raises(ValueError, match="control_points has shape"):
        CubicHermite(points)


def test_tangents_must_match_the_points() -> None:
    with pytest.raises(ValueError, match="tangents has shape"):
        CubicHermite([[0, 0], [1, 1]], tangents=[[0, 0]])
