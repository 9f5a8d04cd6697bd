"""Courses: faces tile the ground, height and normal belong together, and Drake has the same ground."""

import dataclasses
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.geometry import Role, SceneGraph, Sphere
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import DiagramBuilder

from humanwalk.contact.ground_properties import ground_properties
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, check
from humanwalk.terrain import PIECES, TERRAINS, Course, Piece, highest_along
from humanwalk.terrain.face import ENDLESS
from humanwalk.terrain.piece import MAX_FACES
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.steps import Curb, Obstacle, Stairs, Stones

SEEDS = st.integers(0, 2**32 - 1)
DIRECTIONS = st.sampled_from(["up", "down"])
FRICTION = st.floats(0.05, 1.3)
PIECE = st.one_of(
    st.builds(Flat, FRICTION, length=st.floats(0.1, 5.0)),
    st.builds(Slope, FRICTION, st.floats(-0.5, 0.5), st.floats(0.1, 5.0), st.floats(-0.3, 0.3)),
    st.builds(Stairs, FRICTION, DIRECTIONS, st.floats(0.01, 0.4), st.floats(0.1, 0.6), st.integers(1, 8)),
    st.builds(Curb, FRICTION, DIRECTIONS, st.floats(0.01, 0.4), st.floats(0.1, 3.0)),
    st.builds(Rough, FRICTION, st.floats(0.0, 0.4), st.floats(0.1, 3.0), st.floats(0.2, 2.0), SEEDS),
    st.builds(Obstacle, FRICTION, st.floats(0.01, 0.5), st.floats(0.02, 0.5), st.floats(0.6, 3.0)),
    st.builds(
        Stones,
        FRICTION,
        st.floats(0.05, 1.0),
        st.floats(0.02, 0.5),
        st.integers(1, 8),
        st.floats(0.0, 0.2),
        st.floats(0.05, 2.0),
        SEEDS,
    ),
)
COURSES = st.builds(Course, st.lists(PIECE, max_size=4).map(tuple), st.floats(1.0, 6.0), st.floats(0.5, 3.0))

ALL = Course(
    (
        Slope(slope=0.15, friction_coefficient=0.9),
        Slope(cross_slope=0.1, slope=-0.1),
        Stairs(number=3),
        Stairs(number=3, direction="down"),
        Curb(),
        Rough(height=0.05, length=2.0),
        Obstacle(),
        Stones(number=3),
        Flat(friction_coefficient=0.1),
    ),
    width=3.0,
)
"""Every piece but the height map, which needs a file."""


def end_of(course: Course) -> float:
    return course.faces[-1].lower[0]


def points(course: Course, number: int, seed: int = 0) -> Array:
    """Points within the strip, from before its first piece to behind its last."""
    half = 0.5 * course.width
    return np.random.default_rng(seed).uniform((-1.0, -half), (end_of(course) + 1.0, half), (number, 2))


def inside(course: Course, xy: Array, margin: float) -> Array:
    """Those of the points that are so far from the edges of their faces."""
    return np.array([p for p in xy if course.face_at(p).margin(p) > margin])


class InDrake:
    """The ground of a course in a scene graph of its own, and queries to it."""

    def __init__(self, course: Course, properties: Any = ground_properties) -> None:
        self.scene_graph, self._plant = SceneGraph(), MultibodyPlant(time_step=0.0)
        self._plant.RegisterAsSourceForSceneGraph(self.scene_graph)
        course.add_to(self._plant, properties)
        self._plant.Finalize()
        self._context = self.scene_graph.CreateDefaultContext()
        self.query = self.scene_graph.get_query_output_port().Eval(self._context)
        self.inspector = self.scene_graph.model_inspector()


# Pieces.


@given(piece=PIECE, width=st.floats(1.0, 6.0))
def test_faces_of_a_piece_tile_it(piece: Piece, width: float) -> None:
    faces = piece.faces(width)
    lower, upper = (np.array(corners) for corners in zip(*[(face.lower, face.upper) for face in faces], strict=True))
    assert (upper > lower).all()
    np.testing.assert_allclose(lower.min(axis=0), (0.0, -0.5 * width), atol=1e-12)
    length = upper[:, 0].max()
    assert upper[:, 1].max() == pytest.approx(0.5 * width)
    assert np.prod(upper - lower, axis=1).sum() == pytest.approx(length * width)
    overlap = np.minimum(upper[:, None], upper) - np.maximum(lower[:, None], lower)
    np.fill_diagonal(overlap[..., 0], -1.0)
    assert not (overlap > 1e-9).all(axis=-1).any()


@given(course=COURSES)
def test_each_piece_begins_at_the_height_at_which_the_last_one_ends(course: Course) -> None:
    x, z = course.run_up, 0.0
    for piece in course.pieces:
        own = piece.faces(course.width)
        begin = next(face for face in own if face.margin(np.array((1e-6, 1e-6))) > 0.0)
        here = np.array((x + 1e-6, 1e-6))
        assert course.height(here) == pytest.approx(z + float(begin.height(np.array((1e-6, 1e-6)))), abs=1e-5)
        x, z = x + max(face.upper[0] for face in own), z + piece.end_height
    assert course.height(np.array((x + 0.5, 0.0))) == pytest.approx(z, abs=1e-9)


@pytest.mark.parametrize(("piece", "rise"), [(Stairs(), 0.85), (Stairs(direction="down"), -0.85), (Curb(), 0.12)])
def test_steps_rise_and_fall(piece: Piece, rise: float) -> None:
    assert piece.end_height == pytest.approx(rise)
    assert piece.faces(2.0)[-1].intercept == pytest.approx(rise)


@pytest.mark.parametrize("kind", [Rough, Stones])
def test_random_heights_are_those_of_the_seed_and_in_range(kind: Any) -> None:
    one, again, other = (kind(seed=seed, height=0.1).faces(3.0) for seed in (3, 3, 4))
    assert one == again
    assert one != other
    heights = np.array([face.intercept for face in one if face.color == kind.color])
    assert np.ptp(heights) > 0.05
    assert np.abs(heights).max() <= 0.1


# The surface.


@settings(max_examples=40)
@given(course=COURSES, seed=SEEDS)
def test_the_normal_is_the_gradient_of_the_height(course: Course, seed: int) -> None:
    e = 1e-4
    xy = inside(course, points(course, 20, seed), 2 * e)
    slopes = np.stack([(course.height(xy + step) - course.height(xy - step)) / (2 * e) for step in e * np.eye(2)], -1)
    normal = np.column_stack((-slopes, np.ones(len(xy))))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(course.axes(xy)[:, 2], normal, atol=1e-7)


@settings(max_examples=40)
@given(course=COURSES, seed=SEEDS)
def test_the_face_at_a_point_contains_it_and_has_its_height_normal_and_friction(course: Course, seed: int) -> None:
    for xy in points(course, 10, seed):
        face = course.face_at(xy)
        assert face.margin(xy) >= -1e-9
        assert face.height(xy) == pytest.approx(float(course.height(xy)), abs=1e-9)
        np.testing.assert_allclose(face.R_SW, course.axes(xy), atol=1e-12)
        assert face.friction == course.friction(xy)


@settings(max_examples=40)
@given(course=COURSES, seed=SEEDS)
def test_the_ground_is_one_plane_all_over_a_face(course: Course, seed: int) -> None:
    random = np.random.default_rng(seed)
    for xy in points(course, 5, seed):
        face = course.face_at(xy)
        low, high = np.maximum(face.lower, xy - 3.0), np.minimum(face.upper, xy + 3.0)
        within = random.uniform(low, high, (10, 2))
        np.testing.assert_allclose(course.height(within), face.height(within), atol=1e-8)


def test_ground_in_one_plane_is_one_face() -> None:
    """The start, the two flat pieces and the ground behind."""
    course = Course((Flat(), Flat(friction_coefficient=0.1)))
    assert (course.face_at(np.zeros(2)).lower[0], course.face_at(np.zeros(2)).upper[0]) == (-ENDLESS, 5.0 + ENDLESS)
    assert [course.face_at(np.array((x, 0.0))).friction for x in (0.0, 3.5)] == [0.7, 0.1]
    stepped = Course((Flat(), Curb(), Flat()))
    assert stepped.face_at(np.zeros(2)).upper[0] == 3.0
    assert stepped.face_at(np.array((3.1, 0.0))).lower[0] == 3.0


@settings(max_examples=20)
@given(course=COURSES)
def test_many_points_have_the_values_of_each(course: Course) -> None:
    xy = points(course, 6).reshape(3, 2, 2)
    for function, shape in ((course.height, ()), (course.friction, ()), (course.axes, (3, 3))):
        many = function(xy)
        assert many.shape == (3, 2, *shape)
        np.testing.assert_array_equal(many[1, 1], function(xy[1, 1]))


@given(x=st.floats(-1e3, 1e3), y=st.floats(1.51, 1e3), sign=st.sampled_from((-1.0, 1.0)))
def test_beside_the_strip_the_ground_is_lower(x: float, y: float, sign: float) -> None:
    beside = np.array((x, sign * y))
    assert ALL.height(beside) == min(face.lowest for face in ALL.faces) - 0.5
    np.testing.assert_array_equal(ALL.axes(beside), np.eye(3))


def test_friction_is_that_of_the_piece() -> None:
    xy = np.array([(0.0, 0.0), (2.0, 1.0), (end_of(ALL) - 0.1, 0.0), (end_of(ALL) + 0.1, 0.0)])
    np.testing.assert_allclose(ALL.friction(xy), (0.7, 0.9, 0.1, 0.7))


# The highest ground under a strip.


@settings(max_examples=40)
@given(course=COURSES, seed=SEEDS)
def test_no_point_of_a_strip_is_higher_than_the_highest(course: Course, seed: int) -> None:
    """But for what is nearer to the edge of the strip than two samples."""
    start, end = points(course, 2, seed)
    highest = highest_along(course, np.array((start, end)), 0.1)
    s, c = np.random.default_rng(seed).uniform((0.0, -0.08), (1.0, 0.08), (50, 2)).T
    along = end - start
    normal = np.array((-along[1], along[0])) / np.hypot(*along)
    # Within a sample's distance a slope of 0.5 across and along rises by this much.
    assert course.height(start + s[:, None] * along + c[:, None] * normal).max() <= highest + 0.5 * 0.02


def test_a_swing_over_an_obstacle_finds_its_top() -> None:
    course = Course((Obstacle(height=0.15, thickness=0.02),))
    path = np.array(((1.6, 0.1), (2.4, 0.1)))
    assert highest_along(course, path, 0.05) == pytest.approx(0.15)
    assert highest_along(course, path - np.array((0.7, 0.0)), 0.05) == pytest.approx(0.0)


# Walls.


@pytest.mark.parametrize(
    ("point", "distance", "normal"),
    [
        ((1.001, 0.0, 0.05), -0.001, (-1.0, 0.0, 0.0)),
        ((1.05, 0.0, 0.119), -0.001, (0.0, 0.0, 1.0)),
        ((1.05, 1.499, 0.0), -0.001, (0.0, 1.0, 0.0)),
        ((1.05, -1.499, 0.0), -0.001, (0.0, -1.0, 0.0)),
        ((2.4, 0.0, 0.13), 0.01, (0.0, 0.0, 1.0)),
        ((2.499, 0.0, 0.05), -0.001, (1.0, 0.0, 0.0)),
        ((0.999, 0.0, -0.01), -0.01, (0.0, 0.0, 1.0)),
    ],
)
def test_in_a_step_the_nearest_surface_may_be_its_wall(point: Any, distance: float, normal: Any) -> None:
    """A curb up and one down, between x = 1 and 2.5; below the level of the ground around it a wall is buried."""
    course = Course((Curb(), Curb(direction="down")), width=3.0)
    surface = course.nearest(np.array([point]))
    assert surface.distance[0] == pytest.approx(distance, abs=1e-9)
    np.testing.assert_allclose(surface.R_SW[0, 2], normal, atol=1e-12)


@settings(max_examples=40)
@given(course=COURSES, seed=SEEDS)
def test_nearest_surface_has_right_handed_axes_and_is_the_ground_above_it(course: Course, seed: int) -> None:
    xy = points(course, 20, seed)
    z = course.height(xy) + np.random.default_rng(seed).uniform(-0.3, 0.3, 20)
    distance, R_SW, friction = course.nearest(np.column_stack((xy, z)))
    np.testing.assert_allclose(np.linalg.det(R_SW), 1.0)
    np.testing.assert_allclose(R_SW @ R_SW.swapaxes(1, 2), np.broadcast_to(np.eye(3), R_SW.shape), atol=1e-12)
    to_top = (z - course.height(xy)) * course.axes(xy)[:, 2, 2]
    above = z > course.height(xy)
    np.testing.assert_allclose(distance[above], to_top[above], atol=1e-12)
    assert ((distance >= to_top - 1e-12) & ((distance <= 0.0) | above)).all()
    np.testing.assert_array_equal(friction, course.friction(xy))


# Drake's ground.


@pytest.mark.parametrize("properties", [ground_properties, partial(ground_properties, hydroelastic=True)])
def test_a_ray_downward_meets_drakes_ground_at_the_height(properties: Any) -> None:
    """Drake's distance is that of the nearest solid: just above the middle of a face, the face's."""
    ground = InDrake(ALL, properties)
    for xy in inside(ALL, points(ALL, 150), 0.02):
        normal = ALL.axes(xy)[2]
        height = float(ALL.height(xy))
        for rise in (0.01, 1e-4):
            p_WQ = np.array((*xy, height)) + rise * normal
            nearest = min(ground.query.ComputeSignedDistanceToPoint(p_WQ, 0.02), key=lambda found: found.distance)
            assert nearest.distance == pytest.approx(rise, abs=1e-9)
            np.testing.assert_allclose(nearest.grad_W, normal, atol=1e-6)


@settings(max_examples=15)
@given(course=COURSES)
def test_drake_has_no_gap_between_solids_and_nothing_above_the_ground(course: Course) -> None:
    """On both sides of every edge of a face, 0.1 mm below the surface is inside, and above it is not.

    But for the upper end of a slope, where the lower edge of its slab is ahead of the upper one.
    """
    ground = InDrake(course)
    ends = np.array([x for face in course.faces if not face.is_level for x in (face.lower[0], face.upper[0])])
    edges = np.concatenate([face.corners[:, :2] for face in course.faces])
    edges = edges[np.abs(edges[:, 0]) < 100.0]
    corners = 2e-4 * np.array(((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)))
    for xy in (edges[:20, None] + corners).reshape(-1, 2):
        height = float(course.height(xy))
        below = ground.query.ComputeSignedDistanceToPoint(np.array((*xy, height - 1e-4)), 0.01)
        assert min(found.distance for found in below) < 0.0
        if not (np.abs(ends - xy[0]) < 0.03).any():
            above = ground.query.ComputeSignedDistanceToPoint(np.array((*xy, height + 1e-4)), 0.01)
            assert all(found.distance > 0.0 for found in above)


@pytest.mark.parametrize("slope", [-0.2, -0.035, 0.035, 0.2])
@pytest.mark.parametrize("cross_slope", [0.0, 0.1])
def test_a_sphere_pressed_into_a_slope_is_pushed_out_along_its_normal(slope: float, cross_slope: float) -> None:
    """Of the size of a sole's, down to 8 mm deep; a convex solid in place of boxes fails here."""
    course = Course((Slope(slope=slope, cross_slope=cross_slope, length=20.0),), run_up=0.5)
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder := DiagramBuilder(), 0.0)
    course.add_to(plant, ground_properties)
    body, radius = plant.AddRigidBody("sphere", SpatialInertia.SolidSphereWithMass(1.0, 0.012)), 0.012
    plant.RegisterCollisionGeometry(body, RigidTransform(), Sphere(radius), "sphere", ground_properties(0.7))
    plant.Finalize()
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    of_plant, of_scene = plant.GetMyMutableContextFromRoot(context), scene_graph.GetMyContextFromRoot(context)
    for x, y, depth in np.random.default_rng(0).uniform((0.55, -1.5, 1e-5), (10.0, 1.5, 8e-3), (100, 3)):
        xy = np.array((x, y))
        normal = course.axes(xy)[2]
        p_WS = np.array((x, y, float(course.height(xy)))) + (radius - depth) * normal
        plant.SetFloatingBaseBodyPoseInWorldFrame(of_plant, body, RigidTransform(p_WS))
        found = scene_graph.get_query_output_port().Eval(of_scene).ComputePointPairPenetration()
        deepest = max(found, key=lambda pair: pair.depth)
        assert deepest.depth == pytest.approx(depth, abs=1e-9)
        np.testing.assert_allclose(np.abs(deepest.nhat_BA_W @ normal), 1.0, atol=1e-9)


def test_friction_of_each_piece_is_that_of_its_solids() -> None:
    """Drake combines it with the sole's to that of the piece."""
    sole = 0.7
    drake = InDrake(ALL)
    for xy in inside(ALL, points(ALL, 50), 0.02):
        below = np.array((*xy, float(ALL.height(xy)) - 1e-3))
        nearest = min(drake.query.ComputeSignedDistanceToPoint(below, 0.0), key=lambda found: abs(found.distance))
        properties = drake.inspector.GetProximityProperties(nearest.id_G)
        ground = properties.GetProperty("material", "coulomb_friction").static_friction()
        assert 2.0 * sole * ground / (sole + ground) == pytest.approx(float(ALL.friction(xy)))


def test_pictures_have_one_mesh_for_each_color() -> None:
    drake = InDrake(ALL)
    inspector = drake.inspector
    drawn = inspector.GetAllGeometryIds(Role.kIllustration)
    colors = [inspector.GetIllustrationProperties(i).GetProperty("phong", "diffuse") for i in drawn]
    assert 8 < len(colors) < 30
    assert len({(color.r(), color.g(), color.b()) for color in colors}) == len(colors)


# Files.


def test_a_scenario_can_name_every_piece() -> None:
    assert TERRAINS["course"] is Course
    assert {type(piece) for piece in ALL.pieces} | {PIECES["height_map"]} == set(PIECES.values())
    check(ALL)


@pytest.mark.parametrize("piece", [Rough(length=1000.0, cell_size=0.05), Rough(length=12.0, cell_size=0.2)])
def test_a_course_of_too_many_faces_is_refused(piece: Piece) -> None:
    course = Course((piece, piece))
    with pytest.raises(ParameterError, match=rf"^terrain\.course\.pieces\.[01]\.rough.*allowed: up to {MAX_FACES}"):
        course.height(np.zeros(2))


def test_a_beam_longer_than_its_piece_is_refused() -> None:
    course = Course((Flat(), Obstacle(length=0.5, thickness=0.5)))
    with pytest.raises(ParameterError, match=r"^terrain\.course\.pieces\.1\.obstacle\.length: 0\.5 m is too short"):
        course.height(np.zeros(2))


def test_a_course_without_pieces_is_level_ground() -> None:
    np.testing.assert_array_equal(Course().height(np.array([(0.0, 0.0), (50.0, 1.0)])), 0.0)


@pytest.mark.parametrize("piece", ALL.pieces)
def test_a_value_out_of_range_is_refused_with_its_place(piece: Piece) -> None:
    for field in dataclasses.fields(piece):
        if "low" in field.metadata:
            wrong = dataclasses.replace(piece, **{field.name: 1e12})
            with pytest.raises(ParameterError, match=rf"^pieces\.0\.\w+\.{field.name}: 1e\+12 is out of range"):
                check(Course((wrong,)))
