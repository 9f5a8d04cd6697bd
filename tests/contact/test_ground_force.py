"""Ground reaction on a foot, as measured by a force plate tangent to the terrain."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact.ground_force import UNLOADED_N, FootForce, foot_force
from humanwalk.numerics import Array
from humanwalk.terrain import Plane

LEVEL = Plane()
PLACES = st.floats(-3.0, 3.0)
PUSHES = st.floats(-500.0, 500.0)
LOADS = st.floats(2.0, 2000.0)
SLOPES = st.floats(-0.5, 0.5)
PLANES = st.builds(Plane, slope=SLOPES, cross_slope=SLOPES)
WRENCHES = st.lists(st.tuples(*[PLACES] * 3, *[PUSHES] * 2, LOADS, *[PUSHES] * 3), min_size=1, max_size=6)


def reaction(
    terrain: Any,
    points: list[Array | tuple[float, float, float]],
    forces: list[Array | tuple[float, float, float]],
    moments: float | list[tuple[float, float, float]] = 0.0,
) -> FootForce:
    return foot_force(np.array(points, dtype=float), np.array(forces, dtype=float), terrain, np.array(moments))


def of_wrenches(wrenches: list[tuple[float, ...]], terrain: Plane) -> tuple[FootForce, Array, Array]:
    p, f, m = np.array(wrenches).reshape(-1, 3, 3).swapaxes(0, 1)
    return foot_force(p, f, terrain, m), f.sum(axis=0), (np.cross(p, f) + m).sum(axis=0)


@given(x=PLACES, y=PLACES, fx=PUSHES, fy=PUSHES, fz=LOADS, spin=st.floats(-50.0, 50.0))
def test_center_of_pressure_and_free_moment_of_a_known_wrench(
    x: float, y: float, fx: float, fy: float, fz: float, spin: float
) -> None:
    foot = reaction(LEVEL, [(x, y, 0.0)], [(fx, fy, fz)], [(0.0, 0.0, spin)])
    assert foot.loaded
    np.testing.assert_allclose(foot.f_W, (fx, fy, fz))
    np.testing.assert_allclose(foot.p_WCop, (x, y, 0.0), atol=1e-9)
    assert foot.free_moment == pytest.approx(spin, abs=1e-8)


@given(wrenches=WRENCHES, terrain=PLANES)
def test_about_the_center_of_pressure_the_moment_is_along_the_normal(
    wrenches: list[tuple[float, ...]], terrain: Plane
) -> None:
    foot, f, tau_Wo = of_wrenches(wrenches, terrain)
    if foot.loaded:
        normal = terrain.axes(foot.p_WCop[:2])[2]
        about_cop = tau_Wo - np.cross(foot.p_WCop, f)
        np.testing.assert_allclose(about_cop, foot.free_moment * normal, atol=1e-7 * (1.0 + np.abs(tau_Wo).max()))


@given(wrenches=WRENCHES, terrain=PLANES)
def test_the_center_of_pressure_lies_on_the_plane(wrenches: list[tuple[float, ...]], terrain: Plane) -> None:
    foot, *_ = of_wrenches(wrenches, terrain)
    if foot.loaded:
        assert foot.p_WCop[2] == pytest.approx(terrain.height(foot.p_WCop[:2]), abs=1e-9 * np.abs(foot.p_WCop).max())


@given(slope=SLOPES, cross_slope=SLOPES, f=st.tuples(PUSHES, PUSHES, LOADS), spin=PUSHES)
def test_on_a_slope_the_measurement_is_that_on_level_ground_rotated(
    slope: float, cross_slope: float, f: tuple[float, float, float], spin: float
) -> None:
    terrain = Plane(slope, cross_slope)
    R_SW = terrain.axes(np.zeros(2))
    points, forces = np.array([(0.2, 0.1, 0.0), (0.0, 0.1, 0.0)]), np.array([f, f])
    moments = np.array([(0.0, 0.0, spin)])
    level = foot_force(points, forces, LEVEL, moments)
    sloped = foot_force(points @ R_SW, forces @ R_SW, terrain, moments @ R_SW)
    np.testing.assert_allclose(sloped.p_WCop, level.p_WCop @ R_SW, atol=1e-9)
    assert sloped.free_moment == pytest.approx(level.free_moment, abs=1e-8)
    assert sloped.friction_use == pytest.approx(level.friction_use)


@given(x=st.floats(-3.0, 3.0), y=st.floats(-3.0, 3.0))
def test_on_curved_ground_the_plane_is_tangent_below_the_foot(waves: type[Any], x: float, y: float) -> None:
    terrain, xy = waves(), np.array((x, y))
    p_WS, normal = np.array((x, y, terrain.height(xy))), terrain.axes(xy)[2]
    foot = reaction(terrain, [p_WS], [100.0 * normal])
    np.testing.assert_allclose(foot.p_WCop, p_WS, atol=1e-9)
    assert foot.friction_use == pytest.approx(0.0, abs=1e-9)


@given(x1=PLACES, x2=PLACES, f1=LOADS, f2=LOADS)
def test_the_center_of_two_vertical_forces_divides_their_distance(x1: float, x2: float, f1: float, f2: float) -> None:
    foot = reaction(LEVEL, [(x1, 0.1, 0.0), (x2, 0.1, 0.0)], [(0.0, 0.0, f1), (0.0, 0.0, f2)])
    np.testing.assert_allclose(foot.p_WCop, [(f1 * x1 + f2 * x2) / (f1 + f2), 0.1, 0.0], atol=1e-9)


def test_an_oblique_force_above_the_ground_acts_where_its_line_meets_the_ground() -> None:
    foot = reaction(LEVEL, [(0.2, 0.0, 0.5)], [(100.0, 0.0, 700.0)])
    np.testing.assert_allclose(foot.p_WCop, (0.2 - 0.5 / 7.0, 0.0, 0.0), atol=1e-12)


@pytest.mark.parametrize("fz", [0.0, UNLOADED_N, -700.0])
def test_an_unloaded_foot_has_a_force_only(fz: float) -> None:
    foot = reaction(LEVEL, [(0.1, 0.2, 0.0)], [(3.0, 0.0, fz)])
    assert not foot.loaded
    np.testing.assert_array_equal(foot.vector, [3.0, 0.0, fz, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert foot.friction_use == 0.0


def test_a_foot_without_contacts_is_unloaded() -> None:
    foot = foot_force(np.zeros((0, 3)), np.zeros((0, 3)), LEVEL)
    np.testing.assert_array_equal(foot.vector, np.zeros(8))


@given(terrain=PLANES, mu=st.floats(0.1, 1.3), tangent=st.tuples(PUSHES, PUSHES), normal=LOADS)
def test_friction_use_is_the_tangential_force_over_mu_times_the_normal_force(
    terrain: Plane, mu: float, tangent: tuple[float, float], normal: float
) -> None:
    terrain = dataclasses.replace(terrain, friction_coefficient=mu)
    foot = reaction(terrain, [(0.0, 0.0, 0.0)], [np.array((*tangent, normal)) @ terrain.axes(np.zeros(2))])
    assert foot.friction_use == pytest.approx(np.hypot(*tangent) / (mu * normal))


def test_the_vector_holds_force_center_of_pressure_free_moment_and_loaded() -> None:
    foot = reaction(LEVEL, [(0.07, 0.05, 0.0)], [(1.0, 2.0, 100.0)], [(0.0, 0.0, 3.0)])
    np.testing.assert_allclose(foot.vector, [1.0, 2.0, 100.0, 0.07, 0.05, 0.0, 3.0, 1.0])
