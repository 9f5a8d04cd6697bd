"""Assumed balance: a linear spring-damper between the pelvis and its reference."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from humanwalk.control.balance_support import BalanceSupportParameters, support_wrench

K_ROTATION, K, D_ROTATION, D = 5000.0, 30000.0, 300.0, 2500.0
SUPPORT = BalanceSupportParameters(
    stiffness=K, damping=D, rotational_stiffness=K_ROTATION, rotational_damping=D_ROTATION
)
REFERENCE = RigidTransform(RollPitchYaw(0.1, -0.2, 0.7), [1.0, 2.0, 0.9])
ZERO = np.zeros(6)


def floating_base(X):
    return np.concatenate((X.rotation().ToQuaternion().wxyz(), X.translation()))


def wrench_at(X, V, V_reference, parameters=SUPPORT):
    return support_wrench(floating_base(X), V, np.concatenate((floating_base(REFERENCE), V_reference)), parameters)


small = st.floats(-1e-4, 1e-4)


def displaced(error):
    """The reference turned about W's axes by error[:3] and moved by error[3:]."""
    turn = RotationMatrix(RollPitchYaw(error[:3]))
    return RigidTransform(turn @ REFERENCE.rotation(), REFERENCE.translation() + error[3:])


def test_no_wrench_on_the_reference():
    V = np.arange(6.0)
    np.testing.assert_allclose(wrench_at(REFERENCE, V, V), 0.0, atol=1e-9)


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_displacement_is_pushed_back_along_itself_alone(axis, sign):
    error = sign * 0.01 * np.eye(6)[axis]
    stiffness = K_ROTATION if axis < 3 else K
    wrench = wrench_at(displaced(error), ZERO, ZERO)
    np.testing.assert_allclose(wrench, -stiffness * error, atol=1e-9)


@pytest.mark.parametrize("axis", range(6))
def test_each_velocity_error_is_braked_along_itself_alone(axis):
    V_reference = np.arange(6.0)
    error = 0.3 * np.eye(6)[axis]
    damping = D_ROTATION if axis < 3 else D
    wrench = wrench_at(REFERENCE, V_reference + error, V_reference)
    np.testing.assert_allclose(wrench, -damping * error, atol=1e-9)


@given(a=st.tuples(*[small] * 6), b=st.tuples(*[small] * 6))
def test_small_errors_add(a, b):
    def wrench(error):
        return wrench_at(displaced(error), ZERO, ZERO)

    a, b = np.array(a), np.array(b)
    # Rotations commute up to the product of their angles.
    np.testing.assert_allclose(wrench(a + b), wrench(a) + wrench(b), atol=4 * K_ROTATION * 1e-8)


def test_the_longest_way_round_is_not_taken():
    """A pelvis turned by 350 degrees is 10 degrees off, on the other side."""
    wrench = wrench_at(displaced(np.array([0, 0, np.deg2rad(350), 0, 0, 0])), ZERO, ZERO)
    np.testing.assert_allclose(wrench[2], K_ROTATION * np.deg2rad(10), rtol=1e-9)


def test_the_two_quaternions_of_an_orientation_are_one_and_a_length_a_little_off_does_no_harm():
    X = displaced(np.array([0.3, -0.2, 0.1, 0.0, 0.1, 0.0]))
    q, reference = floating_base(X), np.concatenate((floating_base(REFERENCE), ZERO))
    expected = support_wrench(q, ZERO, reference, SUPPORT)
    for factor in (-1.0, 1.0001, -0.9999):
        q[:4] = factor * floating_base(X)[:4]
        np.testing.assert_allclose(support_wrench(q, ZERO, reference, SUPPORT), expected, rtol=1e-12, atol=1e-9)


def test_its_damping_for_the_reference_body_is_as_documented():
    mass, p = 70.0, BalanceSupportParameters()
    assert p.damping / (2 * np.sqrt(p.stiffness * mass)) == pytest.approx(0.88, abs=0.005)


def test_a_heavier_taller_body_is_supported_alike():
    """Forces go with the mass, torques with mass times length squared, as the body's inertias do."""
    bigger = SUPPORT.scaled(2.0, 1.5)
    shift, turn = np.array([0, 0, 0, 0.01, 0, 0]), np.array([0, 0.01, 0, 0, 0, 0])
    for error, factor in ((shift, 2.0), (turn, 2.0 * 1.5**2)):
        reference = wrench_at(displaced(error), ZERO, ZERO)
        np.testing.assert_allclose(wrench_at(displaced(error), ZERO, ZERO, bigger), factor * reference, atol=1e-9)
