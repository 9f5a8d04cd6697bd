"""The ground as a function: heights along the normal, axes that are a rotation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.terrain.ground import HeightGround, PlaneGround

SLOPES = st.floats(-1.0, 1.0)
POINTS = np.random.default_rng(0).uniform(-1.0, 1.0, (4, 5, 3))


def test_level_ground_measures_z():
    height, R_SW = PlaneGround()(POINTS)
    np.testing.assert_allclose(height, POINTS[..., 2])
    np.testing.assert_allclose(R_SW, np.eye(3))


@given(a=SLOPES, b=SLOPES, c=SLOPES)
def test_a_linear_height_function_is_a_plane(a, b, c):
    plane = PlaneGround((-a, -b, 1.0), c / np.sqrt(1.0 + a * a + b * b))
    function = HeightGround(lambda x, y: a * x + b * y + c)
    for of_plane, of_function in zip(plane(POINTS), function(POINTS), strict=True):
        np.testing.assert_allclose(np.broadcast_to(of_plane, of_function.shape), of_function, atol=1e-9)


@pytest.mark.parametrize("ground", [PlaneGround((0.3, -0.2, 2.0)), HeightGround(lambda x, y: 0.1 * np.sin(5 * x) * y)])
def test_axes_are_a_rotation_whose_normal_looks_up(ground):
    _, R_SW = ground(POINTS)
    np.testing.assert_allclose(R_SW @ R_SW.swapaxes(-1, -2), np.broadcast_to(np.eye(3), R_SW.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(R_SW), 1.0)
    assert (R_SW[..., 2, 2] > 0.0).all()
