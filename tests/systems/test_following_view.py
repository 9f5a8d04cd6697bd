"""FollowingView alone: where Meshcat's scene and the force arrows are."""

import struct
from typing import Any

import numpy as np
import pytest
from pydrake.geometry import Meshcat, SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body.limbs import PELVIS
from humanwalk.body.plant import add_human
from humanwalk.body.subject import Subject
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.systems.following_view import LATERAL_SLACK, SCENE, FollowingView
from humanwalk.systems.force_arrow import HEAD_LENGTH, LENGTH_PER_FORCE
from humanwalk.terrain import Course, Plane, Terrain
from humanwalk.terrain.steps import Curb
from humanwalk.view.replay import make_meshcat

P_WP = np.array([3.0, 0.4, 1.2])
RIGHT = [30.0, 0.0, 600.0, 3.1, -0.1, 0.0, 0.0, 1.0]
LEFT_IN_THE_AIR = [0.0] * 8


@pytest.fixture(scope="module")
def meshcat() -> Meshcat:
    return make_meshcat()


def doubles(packed: bytes, count: int) -> Array:
    """The last numbers of a msgpack message, each a tag and eight bytes."""
    return np.array([struct.unpack(">d", packed[len(packed) - 9 * i + 1 :][:8])[0] for i in range(count, 0, -1)])


def transform(meshcat: Any, path: Any) -> RigidTransform:
    return RigidTransform(doubles(meshcat._GetPackedTransform(path), 16).reshape(4, 4).T)


def show(
    meshcat: Meshcat,
    terrain: Terrain,
    forces: list[float] | None = None,
    following: bool = True,
    **inputs: list[float],
) -> None:
    """Publish the human standing at P_WP once."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, time_step=0.0)
    add_human(plant, Subject())
    plant.Finalize()
    plant.SetDefaultFloatingBaseBodyPose(plant.GetBodyByName(PELVIS), RigidTransform(P_WP))
    view = builder.AddSystem(FollowingView(meshcat, 32.0, terrain))
    builder.Connect(scene_graph.get_query_output_port(), view.GetInputPort("query_object"))
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    inputs |= {} if forces is None else {"foot_forces": forces}
    for name, values in inputs.items():
        view.GetInputPort(name).FixValue(view.GetMyContextFromRoot(context), np.array(values))
    view.follow(view.GetMyMutableContextFromRoot(context), following)
    Simulator(diagram, context).Initialize()


def test_ports(meshcat: Meshcat) -> None:
    view = FollowingView(meshcat, 32.0, Plane())
    sizes = {"query_object": 0, "foot_forces": 16, "push": 3, "support_wrench": 6}
    assert {view.get_input_port(i).get_name(): view.get_input_port(i).size() for i in range(4)} == sizes
    assert view.num_output_ports() == 0


@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_scene_moves_against_the_walker_and_down_with_the_ground(meshcat: Meshcat, slope: float) -> None:
    show(meshcat, Plane(slope=slope))
    expected = [-P_WP[0], LATERAL_SLACK - P_WP[1], -P_WP[0] * np.tan(slope)]
    np.testing.assert_allclose(transform(meshcat, SCENE).translation(), expected, atol=1e-12)


def test_scene_rises_gradually_with_a_step(meshcat: Meshcat) -> None:
    """The curb is 0.3 m ahead of the pelvis: a quarter of the ground around is above it."""
    show(meshcat, Course((Curb(height=0.2),), run_up=P_WP[0] + 0.3))
    assert transform(meshcat, SCENE).translation()[2] == pytest.approx(-0.25 * 0.2, abs=0.01)


def test_arrow_starts_at_the_center_of_pressure_and_points_along_the_force(meshcat: Any) -> None:
    show(meshcat, Plane(), RIGHT + LEFT_IN_THE_AIR)
    force = np.array(RIGHT[:3])
    X_WA = transform(meshcat, f"{SCENE}/foot_force/Right")
    np.testing.assert_allclose(X_WA.translation(), RIGHT[3:6], atol=1e-12)
    np.testing.assert_allclose(X_WA.rotation().col(2), force / np.linalg.norm(force), atol=1e-12)
    length = LENGTH_PER_FORCE * np.linalg.norm(force)
    head = transform(meshcat, f"{SCENE}/foot_force/Right/head")
    np.testing.assert_allclose(head.translation(), [0.0, 0.0, length], atol=1e-12)
    scale = doubles(meshcat._GetPackedProperty(f"{SCENE}/foot_force/Right/shaft", "scale"), 3)
    np.testing.assert_allclose(scale, [1.0, 1.0, length])


def test_arrow_of_an_unloaded_foot_is_invisible(meshcat: Any) -> None:
    show(meshcat, Plane(), RIGHT + LEFT_IN_THE_AIR)
    visible = {side: meshcat._GetPackedProperty(f"{SCENE}/foot_force/{side}", "visible") for side in ("Right", "Left")}
    # Msgpack's true and false.
    assert {side: packed[-1] for side, packed in visible.items()} == {"Right": 0xC3, "Left": 0xC2}


def test_scene_stays_where_it_is_unless_it_follows(meshcat: Meshcat) -> None:
    meshcat.SetTransform(SCENE, RigidTransform(np.array([5.0, 6.0, 0.0])))
    show(meshcat, Plane(), following=False)
    np.testing.assert_allclose(transform(meshcat, SCENE).translation(), [5.0, 6.0, 0.0], atol=1e-12)


def test_arrow_of_a_push_ends_at_the_chest_and_is_visible_while_it_acts(meshcat: Any) -> None:
    show(meshcat, Plane(), push=[0.0, 300.0, 0.0])
    X_WA = transform(meshcat, f"{SCENE}/push")
    np.testing.assert_allclose(X_WA.rotation().col(2), [0.0, 1.0, 0.0], atol=1e-12)
    # Between the shoulders of a human that stands upright above the pelvis.
    tip = X_WA @ np.array([0.0, 0.0, 300.0 * LENGTH_PER_FORCE + HEAD_LENGTH])
    np.testing.assert_allclose(tip[:2], P_WP[:2], atol=0.1)
    assert 0.1 < tip[2] - P_WP[2] < 0.6
    assert meshcat._GetPackedProperty(f"{SCENE}/push", "visible")[-1] == 0xC3
    show(meshcat, Plane(), push=[0.0, 0.0, 0.0])
    assert meshcat._GetPackedProperty(f"{SCENE}/push", "visible")[-1] == 0xC2


def test_arrow_of_the_external_support_begins_at_the_pelvis(meshcat: Any) -> None:
    show(meshcat, Plane(), support_wrench=[9.0, 9.0, 9.0, 0.0, 0.0, 150.0])
    np.testing.assert_allclose(transform(meshcat, f"{SCENE}/external_support").translation(), P_WP, atol=1e-12)
    head = transform(meshcat, f"{SCENE}/external_support/head")
    np.testing.assert_allclose(head.translation(), [0.0, 0.0, 150.0 * LENGTH_PER_FORCE], atol=1e-12)


def test_scene_without_a_human_is_refused(meshcat: Meshcat) -> None:
    builder = DiagramBuilder()
    scene_graph = builder.AddSystem(SceneGraph())
    view = builder.AddSystem(FollowingView(meshcat, 32.0, Plane()))
    builder.Connect(scene_graph.get_query_output_port(), view.GetInputPort("query_object"))
    with pytest.raises(ParameterError, match="no body Pelvis"):
        Simulator(builder.Build()).Initialize()
