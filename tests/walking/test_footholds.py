"""A foothold has room for the whole sole on one face, and is the nearest such place within reach."""

import cmath
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.choices.thesis import GaitParameters
from humanwalk.numerics import Array
from humanwalk.terrain import Course, Face, Plane
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.steps import Obstacle, Stairs, Stones
from humanwalk.walking.footholds import FREE, LEVEL, Foothold, FootholdSearch, lies_on, nearest_foothold, places_on

SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)
LENGTH = SOLE.back + SOLE.front
SEARCH = FootholdSearch()
yaws = st.floats(-3.1, 3.1)
points = st.builds(complex, st.floats(-2.0, 2.0), st.floats(-1.0, 1.0))


def corners(ankle: complex, yaw: float) -> Array:
    """Corners of a sole, x and y [m], shape (4, 2)."""
    u = cmath.exp(1j * yaw)
    local = [complex(x, y) for x in (-SOLE.back, SOLE.front) for y in (-SOLE.half_width, SOLE.half_width)]
    return np.array([((ankle + u * corner).real, (ankle + u * corner).imag) for corner in local])


def under(foothold: Foothold) -> Array:
    """Points under a sole with heading 0, x and y [m], shape (points, 2). Its outline may touch a riser."""
    x, y = np.meshgrid(np.linspace(FREE - SOLE.back, SOLE.front - FREE, 50), (-SOLE.half_width, SOLE.half_width))
    return np.stack((foothold.position.real + x.ravel(), foothold.position.imag + y.ravel()), axis=-1)


def face(length: float, width: float = 1.0) -> Face:
    return LEVEL._replace(lower=(0.0, -0.5 * width), upper=(length, 0.5 * width))


def anywhere(place: complex, height: float) -> bool:
    return True


@given(points, yaws)
def test_on_a_large_face_the_sole_keeps_its_distance_from_the_edges(desired: complex, yaw: float) -> None:
    (place,) = places_on(face(1.0), desired, yaw, SOLE, SEARCH)
    assert face(1.0).margin(corners(place, yaw)).min() >= SEARCH.edge_margin - 1e-9


@given(points, yaws)
def test_a_place_with_enough_room_is_not_moved(desired: complex, yaw: float) -> None:
    if face(1.0).margin(corners(desired, yaw)).min() > SEARCH.edge_margin:
        assert places_on(face(1.0), desired, yaw, SOLE, SEARCH) == [desired]


@given(points, yaws)
def test_a_sole_lies_on_a_face_when_no_corner_is_beyond_an_edge(place: complex, yaw: float) -> None:
    margin = face(1.0).margin(corners(place, yaw)).min()
    if abs(margin) > 1e-9:
        assert lies_on(face(1.0), place, yaw, SOLE) == (margin > 0.0)


def test_on_a_face_without_room_for_the_margin_the_sole_is_in_the_middle() -> None:
    (place,) = places_on(face(0.28), 0.0, 0.0, SOLE, SEARCH)
    assert place.real - SOLE.back == pytest.approx(0.28 - (place.real + SOLE.front))


SHORT = st.floats(LENGTH - SEARCH.max_overhang + 1e-6, LENGTH + SEARCH.heel_room - 1e-6)
"""Lengths of faces on which the heel cannot keep its distance without the toes protruding, or nearly so."""


@given(SHORT)
def test_on_a_short_face_the_heel_keeps_its_distance_or_the_toes_are_on_the_face(length: float) -> None:
    heel_first, toes_first = places_on(face(length), 0.0, 0.0, SOLE, SEARCH)
    behind, protruding = heel_first.real - SOLE.back, toes_first.real + SOLE.front - length
    assert 0.5 * SEARCH.heel_room - 1e-9 <= behind <= SEARCH.heel_room + 1e-9
    assert protruding <= 1e-9


@given(SHORT)
def test_a_foot_that_walks_back_has_the_mirrored_places(length: float) -> None:
    there = places_on(face(length), 0.0, 0.0, SOLE, SEARCH)
    back = places_on(face(length), 0.0, np.pi, SOLE, SEARCH)
    np.testing.assert_allclose([length - place.real for place in back], [place.real for place in there], atol=1e-9)


@pytest.mark.parametrize("room", [0.0, SEARCH.heel_room])
def test_places_do_not_jump_with_the_length_of_a_face(room: float) -> None:
    less, more = (places_on(face(LENGTH + room + d), 0.0, 0.0, SOLE, SEARCH) for d in (-1e-6, 1e-6))
    assert more[0] == pytest.approx(less[0], abs=1e-5)
    assert more[-1] == pytest.approx(less[-1], abs=1e-5)


@pytest.mark.parametrize("direction", ["up", "down"])
@given(tread=SHORT, ahead=st.floats(0.8, 1.6))
def test_on_short_treads_the_sole_protrudes_over_the_lower_one(direction: Any, tread: float, ahead: float) -> None:
    course = Course(pieces=(Stairs(tread=tread, direction=direction, number=8),), run_up=0.5)
    foothold = nearest_foothold(course, complex(ahead), 0.0, SOLE, SEARCH, anywhere)
    assert (course.height(under(foothold)) <= foothold.ground + 1e-9).all()
    heel = foothold.position.real - SOLE.back - foothold.face.lower[0]
    assert heel >= (0.5 * SEARCH.heel_room if direction == "down" else -SEARCH.max_overhang) - 1e-9


@pytest.mark.parametrize("direction", ["up", "down"])
def test_for_the_held_walk_a_third_of_the_sole_may_protrude_over_the_lower_tread(direction: Any) -> None:
    held = GaitParameters().footholds
    assert held.max_overhang == pytest.approx(LENGTH / 3.0, rel=0.05)
    course = Course(pieces=(Stairs(tread=0.24, direction=direction),), run_up=0.5)
    foothold = nearest_foothold(course, complex(1.0), 0.0, SOLE, held, anywhere)
    assert (course.height(under(foothold)) <= foothold.ground + 1e-9).all()


def test_a_face_that_is_much_shorter_than_the_sole_is_no_foothold() -> None:
    shortest = LENGTH - SEARCH.max_overhang
    assert places_on(face(shortest + 1e-6), 0.0, 0.0, SOLE, SEARCH)
    assert not places_on(face(shortest - 1e-6), 0.0, 0.0, SOLE, SEARCH)


COURSES = [
    Course(pieces=(Rough(length=6.0, height=0.05, seed=3),), run_up=0.5),
    Course(pieces=(Stairs(number=12),), run_up=0.5),
    Course(pieces=(Obstacle(), Obstacle(), Obstacle()), run_up=0.5),
    Course(pieces=(Stones(number=9),), run_up=0.5),
]


@pytest.mark.parametrize("course", COURSES)
@given(x=st.floats(1.0, 4.0), y=st.floats(-0.5, 0.5), yaw=st.floats(-0.1, 0.1))
def test_footholds_on_every_piece_lie_within_a_face_at_its_height(
    course: Course, x: float, y: float, yaw: float
) -> None:
    foothold = nearest_foothold(course, complex(x, y), yaw, SOLE, SEARCH, anywhere)
    xy = corners(foothold.position, yaw)
    assert foothold.face.margin(xy).min() > -0.01
    inside = xy[foothold.face.margin(xy) > 1e-6]
    np.testing.assert_allclose(course.height(inside), foothold.ground, atol=1e-9)


def test_the_current_face_is_preferred_to_one_that_is_a_little_nearer() -> None:
    course = COURSES[3]
    gap = course.run_up + 0.2 + 0.3 + 0.1 - 0.5 * (SOLE.front - SOLE.back)
    before, behind = (nearest_foothold(course, gap + off, 0.0, SOLE, SEARCH, anywhere) for off in (-0.01, 0.01))
    assert before.position.real < gap < behind.position.real
    assert nearest_foothold(course, gap + 0.01, 0.0, SOLE, SEARCH, anywhere, current=before.face) == before
    far = nearest_foothold(course, gap + 0.1, 0.0, SOLE, SEARCH, anywhere, current=before.face)
    assert far == behind


def test_a_foothold_out_of_reach_is_not_chosen() -> None:
    course = COURSES[1]
    desired = complex(2.0, 0.1)
    height = nearest_foothold(course, desired, 0.0, SOLE, SEARCH, anywhere).ground
    lower = nearest_foothold(course, desired, 0.0, SOLE, SEARCH, lambda place, at: at < height - 1e-6)
    assert lower.ground < height
    assert nearest_foothold(course, desired, 0.0, SOLE, SEARCH, lambda place, at: False).position == desired


@given(points)
def test_on_a_plane_every_place_is_a_foothold(position: complex) -> None:
    plane = Plane(slope=0.1, cross_slope=-0.05)
    foothold = nearest_foothold(plane, position, 0.3, SOLE, SEARCH, anywhere)
    assert foothold == Foothold.on(plane, position)
    assert foothold.position == position
    np.testing.assert_allclose(foothold.R_WS[:, 2], plane.axes(np.zeros(2))[2])


def test_a_step_on_a_slope_has_no_rise_and_one_on_stairs_has_that_of_the_stairs() -> None:
    slope, stairs = Plane(slope=0.15), Course(pieces=(Stairs(rise=0.18, tread=0.3),), run_up=0.5)
    assert Foothold.on(slope, 0.2j).step_to(Foothold.on(slope, 0.6)) == pytest.approx(0.0, abs=1e-12)
    assert Foothold.on(stairs, 0.6).step_to(Foothold.on(stairs, 0.9)) == pytest.approx(0.18)
