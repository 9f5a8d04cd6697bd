"""Ground force of a foot: what a force plate in level ground would show."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact.ground_force import UNLOADED_N, foot_force, friction_use

places = st.floats(-3.0, 3.0)
heights = st.floats(-1.0, 1.0)
pushes = st.floats(-500.0, 500.0)
loads = st.floats(2.0, 2000.0)


@given(x=places, y=places, height=heights, fx=pushes, fy=pushes, fz=loads, spin=st.floats(-50.0, 50.0))
def test_centre_of_pressure_and_free_moment_of_a_known_wrench(x, y, height, fx, fy, fz, spin):
    p, f = np.array([x, y, height]), np.array([fx, fy, fz])
    foot = foot_force(f, np.cross(p, f) + np.array([0.0, 0.0, spin]), height)
    assert foot.loaded
    np.testing.assert_array_equal(foot.f_W, f)
    np.testing.assert_allclose(foot.p_WCop, p, atol=1e-9)
    assert foot.free_moment == pytest.approx(spin, abs=1e-8)


@given(x1=places, x2=places, f1=loads, f2=loads)
def test_two_vertical_forces_press_between_their_points_nearer_to_the_larger(x1, x2, f1, f2):
    points, forces = np.array([[x1, 0.1, 0.0], [x2, 0.1, 0.0]]), np.array([[0.0, 0.0, f1], [0.0, 0.0, f2]])
    foot = foot_force(forces.sum(axis=0), np.cross(points, forces).sum(axis=0))
    np.testing.assert_allclose(foot.p_WCop, [(f1 * x1 + f2 * x2) / (f1 + f2), 0.1, 0.0], atol=1e-9)


def test_height_of_the_ground_matters_where_the_force_is_oblique():
    f = np.array([100.0, 0.0, 700.0])
    tau = np.cross([0.2, 0.0, 0.5], f)
    assert foot_force(f, tau, 0.5).p_WCop[0] == pytest.approx(0.2)
    # The same line of action meets the plane half a metre lower 0.5 * 100 / 700 m further back.
    assert foot_force(f, tau, 0.0).p_WCop[0] == pytest.approx(0.2 - 0.5 / 7.0)


@pytest.mark.parametrize("fz", [0.0, UNLOADED_N, -700.0])
def test_an_unloaded_foot_has_no_centre_of_pressure(fz):
    foot = foot_force(np.array([3.0, 0.0, fz]), np.array([5.0, 5.0, 5.0]))
    assert not foot.loaded
    assert foot.free_moment == 0.0
    np.testing.assert_array_equal(foot.p_WCop, 0.0)
    np.testing.assert_array_equal(foot.f_W, [3.0, 0.0, fz])


def test_friction_use_is_the_share_of_what_friction_could_give():
    assert friction_use(np.array([3.0, 4.0]), 10.0) == 0.5
    assert friction_use(np.array([1e-3, 0.0]), 1e-3) == 0.0


def test_the_vector_holds_the_force_the_centre_of_pressure_the_free_moment_and_whether_it_is_loaded():
    foot = foot_force(np.array([1.0, 2.0, 100.0]), np.array([5.0, -7.0, 3.0]))
    np.testing.assert_allclose(foot.vector, [1.0, 2.0, 100.0, 0.07, 0.05, 0.0, foot.free_moment, 1.0])
