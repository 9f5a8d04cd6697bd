"""The implicit step: kinematics of points, and the law that it evaluates."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import (
    ContactMemory,
    Contacts,
    ContactStep,
    body_mobility,
    mobility_factor,
    point_jacobians,
)
from humanwalk.numerics import Array
from humanwalk.terrain import Plane
from humanwalk.terrain.face import surface_axes

LAW = AsperityParameters()
LEVEL = Plane()
AREA = np.full((1, 4), 0.015)
R = np.array([[x, y, -0.05] for x in (-0.1, 0.1) for y in (-0.07, 0.07)])
MOBILITY = np.linalg.inv(np.diag([0.03, 0.08, 0.1, 10.0, 10.0, 10.0]))
"""Of a block of 10 kg, 0.3 x 0.2 x 0.1 m, on four points."""

SLOPES = st.floats(-0.5, 0.5)
SPEEDS = st.floats(-1.0, 1.0)
DEPTHS = st.floats(-1e-3, 1e-3)


def step(
    depth: float,
    V: Any,
    mobility: Array = MOBILITY,
    h: Any = 1e-3,
    terrain: Any = LEVEL,
    R_WS: Any = None,
    origin: Array | tuple[float, float, float] = (0.0, 0.0, 0.0),
    steps: int = 1,
    law: AsperityParameters = LAW,
) -> Contacts:
    """Contacts after some steps of a block on the terrain; depth and velocities in the surface frame at the origin."""
    R_WS = np.eye(3) if R_WS is None else R_WS
    p_WB = np.array([R_WS @ [0.0, 0.0, 0.05 - depth]]) + origin
    p_WQ, V = p_WB + R @ R_WS.T, (np.array(V, dtype=float).reshape(2, 3) @ R_WS.T).ravel()
    Z = mobility_factor(np.kron(np.eye(2), R_WS) @ mobility @ np.kron(np.eye(2), R_WS.T), 6)
    contact_step, memory = ContactStep(law, terrain, AREA, h), ContactMemory.untouched(p_WQ, V)
    for _ in range(steps):
        contacts = contact_step(p_WB, p_WQ, V, memory, Z, 0.0)
        memory = contacts.memory
    return contacts


@given(seed=st.integers(0, 1000))
def test_point_jacobians_give_the_velocity_of_a_rigid_body(seed: int) -> None:
    random = np.random.default_rng(seed)
    r, V = random.normal(size=(2, 3, 3)), random.normal(size=(2, 6))
    R_SW = surface_axes(random.uniform(-1, 1, (2, 3, 3)) + np.array([0.0, 0.0, 2.0]))
    expected = np.matvec(R_SW, V[:, None, 3:] + np.cross(V[:, None, :3], r))
    np.testing.assert_allclose(np.matvec(point_jacobians(r, R_SW), V[:, None]), expected, atol=1e-12)


@given(seed=st.integers(0, 1000))
def test_the_factor_of_a_mobility_has_a_column_for_each_degree_of_freedom(seed: int) -> None:
    """Two bodies that one joint connects: seven velocities."""
    random = np.random.default_rng(seed)
    J, inertia = random.normal(size=(12, 7)), np.diag(random.uniform(0.1, 10.0, 7))
    G = body_mobility(inertia, J, np.zeros(7))
    Z = mobility_factor(G, 7)
    assert Z.shape == (12, 7)
    np.testing.assert_allclose(Z @ Z.T, G, atol=1e-10 * G.max())


@given(slope=SLOPES, cross_slope=SLOPES, depth=DEPTHS, spin=SPEEDS, speed=SPEEDS, sink=SPEEDS)
def test_an_inclined_plane_acts_as_level_ground_rotated(
    slope: float, cross_slope: float, depth: float, spin: float, speed: float, sink: float
) -> None:
    terrain, V = Plane(slope, cross_slope), [0.1, -spin, spin, speed, 0.2, -sink]
    R_WS = terrain.axes(np.zeros(2)).T
    level, inclined = step(depth, V, steps=3), step(depth, V, terrain=terrain, R_WS=R_WS, steps=3)
    tolerance = 1e-9 * (1.0 + np.abs(level.f_S).max())
    np.testing.assert_allclose(inclined.f_S, level.f_S, atol=tolerance)
    np.testing.assert_allclose(inclined.f_W, level.f_W @ R_WS.T, atol=tolerance)
    np.testing.assert_allclose(inclined.memory.anchor, level.memory.anchor @ R_WS.T, atol=1e-12)


@given(x=st.floats(-3.0, 3.0), y=st.floats(-3.0, 3.0), depth=st.floats(1e-4, 1e-3), speed=SPEEDS)
def test_nearly_flat_ground_acts_as_its_tangent_plane(
    waves: type[Any], x: float, y: float, depth: float, speed: float
) -> None:
    """Curved by 1e-6 / m, that is 1e-8 m below the points."""
    terrain, xy = waves(amplitude=1e-6), np.array((x, y))
    V = [0.0, 0.0, 0.0, speed, 0.0, -0.1]
    origin = np.array((x, y, terrain.height(xy)))
    curved = step(depth, V, terrain=terrain, R_WS=terrain.axes(xy).T, origin=origin)
    level = step(depth, V)
    np.testing.assert_allclose(curved.f_S, level.f_S, rtol=1e-3, atol=1e-2)


def test_each_point_has_the_friction_of_the_ground_below_it() -> None:
    class Patches(Plane):
        def friction(self, xy: Array) -> Array:
            return np.where(xy[..., 0] > 0.0, 0.2, 0.6)

    contacts = step(1e-4, [0, 0, 0, 3.0, 0, 0], terrain=Patches())
    f_t, f_n = np.hypot(*contacts.f_S[:, :2].T), contacts.f_S[:, 2]
    # From the first step on only the newest part of the mean normal force bounds friction.
    np.testing.assert_allclose(f_t, (1.0 - LAW.averaging) * np.array((0.6, 0.6, 0.2, 0.2)) * f_n, rtol=1e-6)


def test_without_mobility_the_law_is_explicit() -> None:
    contacts = step(1e-4, [0, 0, 0, 0, 0, -0.01], np.zeros((6, 6)), h=1e-9)
    np.testing.assert_allclose(contacts.f_S[:, 2], 0.015 * (5e7 * 1e-4 + 4e5 * 0.01), rtol=1e-6)


@pytest.mark.parametrize("rate", [-0.01, 0.01])
def test_damping_is_reduced_by_its_separation_factor_at_points_that_rise(rate: float) -> None:
    law = AsperityParameters(separation_damping=0.5)
    contacts = step(1e-3, [0, 0, 0, 0, 0, rate], np.zeros((6, 6)), h=1e-9, law=law)
    damping = law.normal_damping * (0.5 if rate > 0.0 else 1.0)
    np.testing.assert_allclose(contacts.f_S[:, 2], AREA[0] * (law.normal_stiffness * 1e-3 - damping * rate), rtol=1e-6)


@given(slope=SLOPES, speed=SPEEDS)
def test_the_spatial_force_on_a_body_is_that_of_its_points(slope: float, speed: float) -> None:
    terrain = Plane(slope)
    contacts = step(1e-4, [0.1, 0, 0, speed, 0.1, -0.01], terrain=terrain, R_WS=terrain.axes(np.zeros(2)).T)
    p_WB = contacts.p_WQ.mean(axis=0) + terrain.axes(np.zeros(2))[2] * 0.05
    expected = [*np.cross(contacts.p_WQ - p_WB, contacts.f_W).sum(axis=0), *contacts.f_W.sum(axis=0)]
    np.testing.assert_allclose(contacts.memory.F, expected, rtol=1e-6, atol=1e-6)


@given(speed=st.floats(0.0, 3.0), depth=DEPTHS, sink=SPEEDS)
def test_friction_stays_in_its_cone_and_takes_energy(speed: float, depth: float, sink: float) -> None:
    contacts = step(depth, [0, 0, 0, speed, 0, -sink])
    f_t, f_n = contacts.f_S[:, :2], contacts.f_S[:, 2]
    assert (f_n >= 0.0).all()
    assert (np.hypot(*f_t.T) <= LEVEL.friction_coefficient * f_n * (1 + 1e-9) + 1e-12).all()
    assert f_t[:, 0].sum() <= 1e-9


@given(sink=st.floats(0.01, 2.0))
def test_a_stiff_contact_stops_a_block_and_does_not_throw_it_back(sink: float) -> None:
    """Explicitly, 4e5 N s/m3 on 0.06 m2 would change 10 kg by 2.4 times its velocity in a step."""
    contacts = step(1e-5, [0, 0, 0, 0, 0, -sink])
    after = -sink + 1e-3 * contacts.memory.F[5] / 10.0
    assert -sink < after <= 0.0


def test_a_sticking_point_keeps_its_anchor_and_a_sliding_one_drags_it() -> None:
    held, sliding = (step(1e-3, [0, 0, 0, v, 0, 0], np.zeros((6, 6)), h=1e-3) for v in (0.0, 1.0))
    np.testing.assert_allclose(held.memory.anchor, held.p_WQ, atol=1e-12)
    # The spring is stretched to its limit at the end of the step, 1 mm ahead; the mean load begins at 0.
    bound = (1.0 - LAW.averaging) * LEVEL.friction_coefficient * sliding.f_S[:, 2]
    stretch = LAW.breaking_factor * bound / (LAW.spring_stiffness * 0.015)
    np.testing.assert_allclose(sliding.p_WQ[:, 0] + 1e-3 - sliding.memory.anchor[:, 0], stretch, rtol=1e-3)
