"""Ground that the feet feel: heights and slopes converge to those under a foot, and are expected to go on."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.numerics import Array
from humanwalk.terrain import Plane
from humanwalk.terrain.terrain import Touch
from humanwalk.walking.felt_ground import ALIGNED, MAX_SLOPE, Feeling, FeltGround

DT = 0.006
slopes = st.floats(-0.15, 0.15)
heights = st.floats(-0.1, 0.1)


def touch_on(plane: Plane, height: float, foot: int = 0, x: float = 0.0, **changes: Any) -> Touch:
    """A sole that lies on a plane raised by a height [m], with its pressure in the middle."""
    axes = plane.axes(np.zeros(2))
    heel, pressure = (surface_point(plane, np.array((x + along, 0.0)), height) for along in (-0.05, 0.04))
    touch = Touch(foot, heel, axes[0], axes[2], pressure, 0.04, 0.04, is_rolling=False, is_still=False)
    return touch._replace(**changes)


def surface_point(plane: Plane, xy: Array, height: float) -> Array:
    return np.array((*xy, plane.height(xy) + height))


def felt(touches: tuple[Touch, ...], duration: float, ground: FeltGround | None = None) -> FeltGround:
    ground = FeltGround(Plane()) if ground is None else ground
    for _ in range(round(duration / DT)):
        ground = ground.felt(touches, DT)
    return ground


@settings(max_examples=20)
@given(slopes, slopes, heights)
def test_a_foot_that_stands_flat_finds_the_plane_under_it(slope: float, cross_slope: float, height: float) -> None:
    plane = Plane(slope=slope, cross_slope=cross_slope)
    ground = felt((touch_on(plane, height),), 8.0 * Feeling.trend_time)
    for xy in np.array(((0.0, 0.0), (0.1, 0.05), (0.6, -0.2))):
        assert ground.height(xy) == pytest.approx(plane.height(xy) + height, abs=1e-4)
        np.testing.assert_allclose(ground.axes(xy), plane.axes(xy), atol=1e-4)


@given(slopes)
def test_the_slope_of_one_step_is_not_expected_far_from_the_foot(slope: float) -> None:
    ground = felt((touch_on(Plane(slope=slope), 0.0),), 0.4 * Feeling.trend_time)
    assert ground.face_at(np.array((0.1, 0.0))).gradient[0] == pytest.approx(slope, rel=0.02, abs=1e-4)
    assert abs(ground.face_at(np.array((0.8, 0.0))).gradient[0]) <= 0.5 * abs(slope)


@given(slopes, st.floats(0.0, 6.3))
def test_its_height_does_not_jump_where_the_slopes_of_the_last_steps_begin(slope: float, angle: float) -> None:
    ground = felt((touch_on(Plane(slope=slope), 0.0),), 0.4 * Feeling.trend_time)
    way = np.array((math.cos(angle), math.sin(angle)))
    (place,) = (anchor.place for anchor in ground.anchors if anchor is not None)
    before, after = (float(ground.height(np.array(place) + (Feeling.near + d) * way)) for d in (-1e-6, 1e-6))
    assert before == pytest.approx(after, abs=1e-6)


def test_each_foot_has_a_height_of_its_own() -> None:
    ground = felt((touch_on(Plane(), 0.02), touch_on(Plane(), -0.03, foot=1, x=0.5)), 0.5)
    assert ground.height(np.array(((0.1, 0.0), (0.45, 0.0), (0.9, 0.0)))) == pytest.approx(
        [0.02, -0.03, -0.03], abs=1e-4
    )


@given(st.floats(0.02, 0.1))
def test_under_a_landing_foot_without_load_the_ground_is_lower(gap: float) -> None:
    touch = touch_on(Plane(), -gap, pressure=None)
    ground = felt((touch,), DT)
    assert ground.height(touch.heel[:2]) == pytest.approx(-gap - Feeling.below)


def test_a_foot_above_the_ground_does_not_raise_it() -> None:
    touch = touch_on(Plane(), 0.1, pressure=None)
    assert felt((touch,), DT).height(touch.heel[:2]) == pytest.approx(0.0, abs=1e-9)


def test_a_heel_alone_expects_the_ground_ahead_lower_and_lower() -> None:
    touch = touch_on(Plane(), 0.0, pressure=np.array((-0.04, 0.0, 0.0)), pressure_ahead=-0.04)
    ground = felt((touch,), 0.02)
    assert float(ground.height(np.array((0.15, 0.0)))) < -0.002
    assert float(ground.height(np.array((-0.04, 0.0)))) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("is_still, slope", [(True, 0.1), (False, 0.0)])
def test_a_foot_that_stands_still_on_its_heel_with_its_toes_up_has_something_under_its_ball(
    is_still: bool, slope: float
) -> None:
    heel = np.array((-0.04, 0.0, -0.004))
    touch = touch_on(Plane(slope=0.1), 0.0, pressure=heel, pressure_ahead=-0.04, is_still=is_still)
    ground = felt((touch,), 0.2)
    # Within the angle to which heel and ball touch the ground.
    assert ground.face_at(np.zeros(2)).gradient[0] == pytest.approx(slope, abs=1.1 * ALIGNED)


def test_pressure_on_the_heel_that_was_planned_there_shows_nothing() -> None:
    touch = touch_on(Plane(), 0.0, pressure=np.array((-0.04, 0.0, 0.0)), pressure_ahead=-0.04, planned_ahead=-0.04)
    assert float(felt((touch,), 0.02).height(np.array((0.15, 0.0)))) == pytest.approx(0.0, abs=1e-9)


def test_a_foot_that_rolls_over_its_ball_shows_neither_slope_nor_height() -> None:
    pitched = np.array((math.cos(0.5), 0.0, -math.sin(0.5))), np.array((math.sin(0.5), 0.0, math.cos(0.5)))
    touch = touch_on(Plane(), 0.01, is_rolling=True, forward=pitched[0], normal=pitched[1])
    ground = felt((touch,), 0.1)
    np.testing.assert_allclose(ground.axes(np.zeros(2)), np.eye(3), atol=1e-9)
    assert float(ground.height(np.zeros(2))) == pytest.approx(0.0, abs=1e-9)


def test_slopes_are_limited() -> None:
    ground = felt((touch_on(Plane(slope=0.5), 0.0),), 1.0)
    assert ground.face_at(np.zeros(2)).gradient[0] == pytest.approx(MAX_SLOPE)
