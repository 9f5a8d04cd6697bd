"""A plane as a terrain: its normal is the gradient of its height, its axes are a rotation, Drake has the same plane."""

import logging

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.systems.framework import DiagramBuilder

from humanwalk.contact.ground_properties import ground_properties
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, check
from humanwalk.terrain import TERRAINS, Plane
from humanwalk.terrain.face import surface_axes

SLOPES = st.floats(-0.5, 0.5)
COORDINATES = st.floats(-50.0, 50.0)
PLANES = st.builds(Plane, slope=SLOPES, cross_slope=SLOPES)
POINTS = st.builds(lambda x, y: np.array((x, y)), COORDINATES, COORDINATES)


@given(plane=PLANES, xy=POINTS)
def test_the_normal_is_the_gradient_of_the_height(plane: Plane, xy: Array) -> None:
    e = 1e-3
    slopes = [(plane.height(xy + step) - plane.height(xy - step)) / (2.0 * e) for step in e * np.eye(2)]
    normal = np.array((-slopes[0], -slopes[1], 1.0))
    np.testing.assert_allclose(plane.axes(xy)[2], normal / np.linalg.norm(normal), atol=1e-9)


@given(plane=PLANES, xy=POINTS)
def test_its_axes_lie_in_the_plane_and_x_above_the_world_x(plane: Plane, xy: Array) -> None:
    x, y, _ = plane.axes(xy)
    for axis in (x, y):
        assert plane.height(xy + axis[:2]) - plane.height(xy) == pytest.approx(axis[2], abs=1e-9)
    assert x[1] == pytest.approx(0.0, abs=1e-12)
    assert x[0] > 0.0


@given(normals=st.lists(st.tuples(SLOPES, SLOPES, st.floats(0.1, 10.0)), min_size=1, max_size=4))
def test_surface_axes_are_orthonormal_right_handed_and_point_upward(normals: list[tuple[float, float, float]]) -> None:
    R_SW = surface_axes(np.array(normals))
    np.testing.assert_allclose(R_SW @ R_SW.swapaxes(-1, -2), np.broadcast_to(np.eye(3), R_SW.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(R_SW), 1.0)
    assert (R_SW[:, 2, 2] > 0.0).all()


def test_level_ground_is_the_default() -> None:
    xy = np.array([[0.0, 0.0], [3.0, -2.0]])
    np.testing.assert_allclose(Plane().height(xy), 0.0)
    np.testing.assert_allclose(Plane().axes(xy), np.broadcast_to(np.eye(3), (2, 3, 3)))
    np.testing.assert_allclose(Plane().friction(xy), 0.7)


@given(plane=PLANES, xy=POINTS)
def test_many_points_have_the_values_of_each(plane: Plane, xy: Array) -> None:
    many = np.array([[xy], [-xy], [2.0 * xy]])
    assert (plane.height(many).shape, plane.friction(many).shape) == ((3, 1), (3, 1))
    assert plane.axes(many).shape == (3, 1, 3, 3)
    np.testing.assert_allclose(plane.height(many)[1, 0], plane.height(-xy))


@given(slope=SLOPES)
def test_it_goes_up_forward_by_its_slope_and_to_the_left_by_its_cross_slope(slope: float) -> None:
    assert Plane(slope=slope).height(np.array((1.0, 5.0))) == pytest.approx(np.tan(slope))
    assert Plane(cross_slope=slope).height(np.array((5.0, 1.0))) == pytest.approx(np.tan(slope))


@pytest.mark.parametrize("plane", [Plane(), Plane(slope=0.3), Plane(slope=-0.2, cross_slope=0.4)], ids=str)
def test_drake_measures_the_distance_from_the_same_plane(plane: Plane) -> None:
    """(z - height) n_z is the distance along the normal."""
    scene_graph = SceneGraph()
    plant = MultibodyPlant(time_step=0.0)
    plant.RegisterAsSourceForSceneGraph(scene_graph)
    plane.add_to(plant, ground_properties)
    plant.Finalize()
    query = scene_graph.get_query_output_port().Eval(scene_graph.CreateDefaultContext())
    for p_WQ in np.random.default_rng(0).uniform(-2.0, 2.0, (20, 3)):
        (measured,) = query.ComputeSignedDistanceToPoint(p_WQ)
        normal = plane.axes(p_WQ[:2])[2]
        assert (p_WQ[2] - plane.height(p_WQ[:2])) * normal[2] == pytest.approx(measured.distance, abs=1e-12)
        np.testing.assert_allclose(measured.grad_W, normal, atol=1e-12)


@pytest.mark.parametrize("field", ["slope", "cross_slope", "friction_coefficient"])
def test_a_value_out_of_range_is_refused(field: str) -> None:
    with pytest.raises(ParameterError, match=f"^{field}: 3 is out of range; allowed"):
        check(Plane(**{field: 3.0}))


def test_a_scenario_can_name_it() -> None:
    assert TERRAINS["plane"] is Plane


def test_drake_does_not_warn_of_the_half_space(caplog: pytest.LogCaptureFixture) -> None:
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.002)
    Plane().add_to(plant, ground_properties)
    plant.Finalize()
    with caplog.at_level(logging.WARNING, logger="drake"):
        builder.Build().CreateDefaultContext()
        logging.getLogger("drake").warning("another warning")
    assert caplog.messages == ["another warning"]
