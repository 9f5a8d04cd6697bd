"""Inertia of the two solids, against numerical integration and their own limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import Box, Cylinder

LENGTHS = st.floats(0.01, 2.0)
MASSES = st.floats(0.01, 100.0)
SHAPES = st.one_of(
    st.builds(Box, LENGTHS, LENGTHS, LENGTHS),
    st.builds(Cylinder, LENGTHS, LENGTHS, st.sampled_from("xyz")),
)


def inertia_of_grains(shape: Box | Cylinder, mass: float) -> np.ndarray:
    """Principal moments of many equal grains that fill the shape."""
    n = 60
    grid = (np.arange(n) + 0.5) / n - 0.5
    unit = np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), axis=-1).reshape(-1, 3)
    points = unit * shape.extent
    if isinstance(shape, Cylinder):
        across = [i for i, a in enumerate("xyz") if a != shape.axis]
        points = points[np.hypot(*points[:, across].T) < shape.radius]
    squares = (points**2).mean(axis=0)
    return mass * (squares.sum() - squares)


@pytest.mark.parametrize(
    "shape",
    [Box(0.2, 0.3, 0.1), Cylinder(0.1, 0.5, "x"), Cylinder(0.1, 0.5, "y"), Cylinder(0.2, 0.1, "z")],
    ids=str,
)
def test_inertia_is_that_of_the_filled_shape(shape: Box | Cylinder) -> None:
    np.testing.assert_allclose(shape.inertia(3.0), inertia_of_grains(shape, 3.0), rtol=5e-3)


@given(shape=SHAPES, mass=MASSES)
def test_moments_satisfy_the_strict_triangle_inequality(shape: Box | Cylinder, mass: float) -> None:
    a, b, c = np.sort(shape.inertia(mass))
    assert a > 0.0
    assert c < a + b


@given(shape=SHAPES, mass=MASSES, factor=st.floats(0.1, 10.0))
def test_inertia_goes_with_mass_and_the_square_of_length(shape: Box | Cylinder, mass: float, factor: float) -> None:
    bigger = shape.scaled(factor)
    np.testing.assert_allclose(bigger.extent, shape.extent * factor)
    np.testing.assert_allclose(bigger.inertia(mass), shape.inertia(1.0) * mass * factor**2)
