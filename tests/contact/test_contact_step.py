"""The implicit step: kinematics of points, the law that it evaluates, and when it is stable."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact import contact_step as module
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import (
    ContactMemory,
    ContactStep,
    body_mobility,
    largest_contact_step,
    mobility_factor,
    patch_impedance,
    point_jacobians,
)
from humanwalk.terrain.ground import HeightGround, PlaneGround, surface_axes

LAW = AsperityParameters()
LEVEL = PlaneGround()
AREA = np.full((1, 4), 0.015)
R = np.array([[[x, y, -0.05] for x in (-0.1, 0.1) for y in (-0.07, 0.07)]])
MASS = np.diag([0.03, 0.08, 0.1, 10.0, 10.0, 10.0])
"""Of a block of 10 kg, 0.3 x 0.2 x 0.1 m, on four points; the joint's velocities are its spatial velocity."""


def step(depth, V, mobility, h=1e-3, ground=LEVEL, law=LAW, memory=None):
    p_WB, V = np.array([[0.0, 0.0, 0.05 - depth]]), np.array(V, dtype=float)
    p_WQ = p_WB + R[0]
    Z = mobility_factor(mobility, 6)
    return ContactStep(law, ground, AREA, h, 6)(p_WB, p_WQ, V, memory or ContactMemory.fresh(p_WQ, V), Z, 0.0)


@given(seed=st.integers(0, 1000))
def test_point_jacobians_give_the_velocity_of_a_rigid_body(seed):
    random = np.random.default_rng(seed)
    r, V = random.normal(size=(2, 3, 3)), random.normal(size=(2, 6))
    R_SW = surface_axes(random.uniform(-1, 1, (2, 3, 3)) + np.array([0.0, 0.0, 2.0]))
    expected = np.matvec(R_SW, V[:, None, 3:] + np.cross(V[:, None, :3], r))
    np.testing.assert_allclose(np.matvec(point_jacobians(r, R_SW), V[:, None]), expected, atol=1e-12)


@given(seed=st.integers(0, 1000))
def test_the_factor_of_a_mobility_has_a_column_for_each_way_in_which_the_bodies_move(seed):
    """Two bodies that one joint connects: seven velocities."""
    random = np.random.default_rng(seed)
    J, inertia = random.normal(size=(12, 7)), np.diag(random.uniform(0.1, 10.0, 7))
    G = body_mobility(inertia, J, np.zeros(7))
    Z = mobility_factor(G, 7)
    assert Z.shape == (12, 7)
    np.testing.assert_allclose(Z @ Z.T, G, atol=1e-10 * G.max())


@given(depth=st.floats(-1e-3, 1e-3), spin=st.floats(-2.0, 2.0), speed=st.floats(-1.0, 1.0), sink=st.floats(-0.5, 1.0))
def test_a_height_function_that_is_level_acts_as_the_plane(depth, spin, speed, sink):
    V, mobility, level = [0.1, -spin, spin, speed, 0.2, -sink], np.linalg.inv(MASS), HeightGround(lambda x, y: 0.0 * x)
    plane, function = (step(depth, V, mobility, ground=ground) for ground in (LEVEL, level))
    np.testing.assert_allclose(function.force, plane.force, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(function.memory.anchor, plane.memory.anchor, atol=1e-12)


def test_without_mobility_the_law_is_explicit():
    contacts = step(1e-4, [0, 0, 0, 0, 0, -0.01], np.zeros((6, 6)), h=1e-9)
    np.testing.assert_allclose(contacts.normal, 0.015 * (5e7 * 1e-4 + 4e5 * 0.01), rtol=1e-6)


def test_total_is_the_sum_of_the_points():
    contacts = step(1e-4, [0.1, 0, 0, 0.3, 0.1, -0.01], np.linalg.inv(MASS))
    f, tau = contacts.total(slice(0, 1))
    np.testing.assert_allclose(f, contacts.force.sum(axis=0), rtol=1e-9)
    np.testing.assert_allclose(tau, np.cross(contacts.p_WQ, contacts.force).sum(axis=0), rtol=1e-6, atol=1e-9)
    assert 0.0 < contacts.friction_use(slice(0, 1)) <= 1.0


@given(speed=st.floats(0.0, 3.0), depth=st.floats(-1e-3, 1e-3), sink=st.floats(-1.0, 1.0))
def test_friction_stays_in_its_cone_and_takes_energy(speed, depth, sink):
    contacts = step(depth, [0, 0, 0, speed, 0, -sink], np.linalg.inv(MASS))
    assert (contacts.normal >= 0.0).all()
    assert (np.abs(contacts.friction) <= contacts.bound * (1 + 1e-9)).all()
    assert (contacts.bound <= LAW.friction * contacts.normal + 1e-12).all()
    assert contacts.friction.real.sum() <= 1e-9


@given(sink=st.floats(0.01, 2.0))
def test_a_stiff_contact_stops_a_block_and_does_not_throw_it_back(sink):
    """Explicitly, 4e5 N s/m3 on 0.06 m2 would change 10 kg by 2.4 times its velocity in a step."""
    contacts = step(1e-5, [0, 0, 0, 0, 0, -sink], np.linalg.inv(MASS))
    after = -sink + 1e-3 * contacts.memory.F[5] / 10.0
    assert -sink < after <= 0.0


def block_bound(stiffness, damping):
    K, C = (
        patch_impedance(R, AREA, np.eye(3), along, across)
        for along, across in ((stiffness, LAW.spring_stiffness), (damping, LAW.velocity_stiffness))
    )
    free = np.zeros(6)
    return largest_contact_step(MASS, np.eye(6), K, C, lambda h: (free, free), free)


@pytest.mark.parametrize("stiffness", [5e7, 2e8])
def test_a_free_block_is_stable_at_every_step_that_is_allowed(stiffness):
    assert block_bound(stiffness, 4e5) == module.LONGEST_STEP


def test_with_a_mobility_far_too_small_the_step_is_bounded_as_an_explicit_one(monkeypatch):
    """x' = x + h v', v' = v - h (C v + h C a + K x) / m with the velocity extrapolated: C h < m / 2 or so."""
    monkeypatch.setattr(module, "MOBILITY_MARGIN", 1e-6)
    bound = block_bound(5e7, 4e5)
    heaviest = 10.0 / (0.06 * LAW.velocity_stiffness)
    assert 0.1 * heaviest < bound < heaviest
