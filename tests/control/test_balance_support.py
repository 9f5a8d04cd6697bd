"""Balance support: a linear spring-damper between the pelvis and its reference."""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from scipy.spatial.transform import Rotation

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.control.balance_support import BalanceSupportParameters, largest_support_step, support_wrench
from humanwalk.control.joint_gains import JointGains, joint_gains
from humanwalk.control.pd_control import PD_LAWS, PdLaw
from humanwalk.numerics import Array

K_ROTATION, K, D_ROTATION, D = 5000.0, 30000.0, 300.0, 2500.0
SUPPORT = BalanceSupportParameters(
    stiffness=K, damping=D, rotational_stiffness=K_ROTATION, rotational_damping=D_ROTATION
)
REFERENCE = RigidTransform(RollPitchYaw(0.1, -0.2, 0.7), [1.0, 2.0, 0.9])
ZERO = np.zeros(6)


def floating_base(X: RigidTransform) -> Array:
    return np.concatenate((X.rotation().ToQuaternion().wxyz(), X.translation()))


def wrench_at(X: RigidTransform, V: Array, V_reference: Array, parameters: BalanceSupportParameters = SUPPORT) -> Array:
    return support_wrench(floating_base(X), V, np.concatenate((floating_base(REFERENCE), V_reference)), parameters)


small = st.floats(-1e-4, 1e-4)


def displaced(error: Array) -> RigidTransform:
    """The reference rotated about the axes of W by error[:3] and translated by error[3:]."""
    turn = RotationMatrix(RollPitchYaw(error[:3]))
    return RigidTransform(turn @ REFERENCE.rotation(), REFERENCE.translation() + error[3:])


finite = st.floats(-1.0, 1.0)
vectors = st.tuples(finite, finite, finite).map(np.array)
rotations = (
    st.tuples(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0)).map(RollPitchYaw).map(RotationMatrix)  # type: ignore[arg-type]
)
poses = st.builds(RigidTransform, rotations, vectors)
velocities = st.tuples(*[finite] * 6).map(np.array)


@given(X=poses, V=velocities)
def test_no_wrench_on_the_reference(X: RigidTransform, V: Array) -> None:
    wrench = support_wrench(floating_base(X), V, np.concatenate((floating_base(X), V)), SUPPORT)
    np.testing.assert_allclose(wrench, 0.0, atol=1e-9 * K)


def energy(wrench_of_springs: Array) -> Any:
    """Energy of two linear springs that pull by a wrench [J]."""
    torque, force = np.split(wrench_of_springs, 2)
    return torque @ torque / (2 * K_ROTATION) + force @ force / (2 * K)


@given(X=poses, V=velocities)
def test_without_damping_the_power_is_the_loss_of_the_energy_of_the_springs(X: RigidTransform, V: Array) -> None:
    springs, reference = (
        replace(SUPPORT, damping=0.0, rotational_damping=0.0),
        np.concatenate((floating_base(REFERENCE), ZERO)),
    )

    def wrench(dt: Any) -> Array:
        R = RotationMatrix(Rotation.from_rotvec(dt * V[:3]).as_matrix())
        moved = RigidTransform(R @ X.rotation(), X.translation() + dt * V[3:])
        return support_wrench(floating_base(moved), V, reference, springs)

    # At half a turn the shorter way changes sides.
    assume(np.linalg.norm(wrench(0.0)[:3]) < 3.1 * K_ROTATION)
    dt = 1e-6
    rate = (energy(wrench(dt)) - energy(wrench(-dt))) / (2 * dt)
    assert wrench(0.0) @ V == pytest.approx(-rate, rel=1e-5, abs=1e-2)


@given(X=poses, X_reference=poses, V=velocities, V_reference=velocities, R=rotations, shift=vectors)
def test_the_wrench_does_not_depend_on_the_frame(
    X: RigidTransform, X_reference: RigidTransform, V: Array, V_reference: Array, R: RotationMatrix, shift: Array
) -> None:
    def rotated(spatial: Any) -> Array:
        return np.concatenate([R @ part for part in np.split(spatial, 2)])

    def wrench(X: Any, V: Array, X_reference: RigidTransform, V_reference: Array) -> Array:
        return support_wrench(floating_base(X), V, np.concatenate((floating_base(X_reference), V_reference)), SUPPORT)

    here = wrench(X, V, X_reference, V_reference)
    # At half a turn the shorter way changes sides.
    assume(np.linalg.norm(here[:3] + D_ROTATION * (V - V_reference)[:3]) < 3.1 * K_ROTATION)
    X_VW = RigidTransform(R, shift)
    there = wrench(X_VW @ X, rotated(V), X_VW @ X_reference, rotated(V_reference))
    np.testing.assert_allclose(there, rotated(here), atol=1e-9 * K)


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_displacement_causes_an_opposite_wrench_along_its_own_axis(axis: int, sign: float) -> None:
    error = sign * 0.01 * np.eye(6)[axis]
    stiffness = K_ROTATION if axis < 3 else K
    wrench = wrench_at(displaced(error), ZERO, ZERO)
    np.testing.assert_allclose(wrench, -stiffness * error, atol=1e-9)


@pytest.mark.parametrize("axis", range(6))
def test_each_velocity_error_causes_an_opposite_wrench_along_its_own_axis(axis: int) -> None:
    V_reference = np.arange(6.0)
    error = 0.3 * np.eye(6)[axis]
    damping = D_ROTATION if axis < 3 else D
    wrench = wrench_at(REFERENCE, V_reference + error, V_reference)
    np.testing.assert_allclose(wrench, -damping * error, atol=1e-9)


@given(a=st.tuples(*[small] * 6), b=st.tuples(*[small] * 6))
def test_small_errors_add(a: Any, b: Any) -> None:
    def wrench(error: Any) -> Array:
        return wrench_at(displaced(error), ZERO, ZERO)

    a, b = np.array(a), np.array(b)
    # Rotations commute up to the product of their angles.
    np.testing.assert_allclose(wrench(a + b), wrench(a) + wrench(b), atol=4 * K_ROTATION * 1e-8)


def test_the_rotation_error_is_the_shorter_way() -> None:
    """A rotation by 350 degrees is one of -10 degrees."""
    wrench = wrench_at(displaced(np.array([0, 0, np.deg2rad(350), 0, 0, 0])), ZERO, ZERO)
    np.testing.assert_allclose(wrench[2], K_ROTATION * np.deg2rad(10), rtol=1e-9)


def test_sign_and_length_of_the_quaternion_do_not_matter() -> None:
    X = displaced(np.array([0.3, -0.2, 0.1, 0.0, 0.1, 0.0]))
    q, reference = floating_base(X), np.concatenate((floating_base(REFERENCE), ZERO))
    expected = support_wrench(q, ZERO, reference, SUPPORT)
    for factor in (-1.0, 1.0001, -0.9999):
        q[:4] = factor * floating_base(X)[:4]
        np.testing.assert_allclose(support_wrench(q, ZERO, reference, SUPPORT), expected, rtol=1e-12, atol=1e-9)


def test_its_damping_for_the_reference_body_is_as_documented() -> None:
    mass, p = 70.0, BalanceSupportParameters()
    assert p.damping / (2 * np.sqrt(p.stiffness * mass)) == pytest.approx(0.88, abs=0.005)


# Stability.


@pytest.mark.parametrize("law", ["implicit", "semi_implicit"])
def test_the_default_support_is_stable_at_two_milliseconds_with_a_margin(plant: MultibodyPlant, law: PdLaw) -> None:
    M = base_first_mass_matrix(plant)
    kp, kd = joint_gains(plant, JointGains())
    impedance = partial(PD_LAWS[law].impedance, kp=kp, kd=kd)
    assert largest_support_step(M, kp, impedance, BalanceSupportParameters()) > 1.05 * 0.002


@given(mass=st.floats(1.0, 100.0), damping=st.floats(1e3, 1e5))
def test_the_stable_step_of_a_damped_block_is_that_of_explicit_euler(mass: float, damping: float) -> None:
    """Without joints or stiffness each direction is v' = (1 - h d / m) v."""
    support = BalanceSupportParameters(stiffness=0.0, damping=damping, rotational_stiffness=0.0, rotational_damping=0.0)
    step = largest_support_step(
        mass * np.eye(6), np.array([]), lambda h: (np.array([]), np.array([])), support, upper=1.0
    )
    assert step == pytest.approx(min(1.0, 2.0 * mass / damping), rel=0.011)


def test_stiff_joints_let_the_support_take_longer_steps(plant: MultibodyPlant) -> None:
    """Held joints make the pelvis carry more inertia."""
    M = base_first_mass_matrix(plant)
    n = M.shape[0] - 6
    support = BalanceSupportParameters()
    loose = largest_support_step(M, np.zeros(n), lambda h: (np.zeros(n), np.zeros(n)), support)
    held = largest_support_step(
        M, np.full(n, 1e4), lambda h: (h * np.full(n, 1e2) + h * h * np.full(n, 1e4), np.zeros(n)), support
    )
    assert loose < held
