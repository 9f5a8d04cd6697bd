"""Rotation vectors and matrices agree with each other and with Drake's classes."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from pydrake.math import RollPitchYaw, RotationMatrix

from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix, quaternion_rotation_vector, rotation_vector, yaw_pitch

angles = st.floats(-3.1, 3.1)
rotations = st.builds(lambda r, p, y: RotationMatrix(RollPitchYaw(r, p, y)).matrix(), angles, angles, angles)
vectors = st.tuples(*[st.floats(-10.0, 10.0)] * 3).map(np.array)


@given(rotations, vectors)
def test_the_rotation_vector_turns_the_first_frame_into_the_second(R_WA: Array, axis: Array) -> None:
    length = np.linalg.norm(axis)
    angle = min(length, 3.0)
    if length < 1e-6:
        return
    turn = RotationMatrix(rotation_of(angle * axis / length)).matrix()
    np.testing.assert_allclose(rotation_vector(R_WA, turn @ R_WA), angle * axis / length, atol=1e-6)


def rotation_of(vector: Array) -> Array:
    """Rodrigues' formula."""
    angle = np.linalg.norm(vector)
    K = cross_matrix(vector / angle)
    return np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * K @ K


@given(rotations)
def test_the_rotation_vector_of_a_frame_to_itself_is_zero(R: Array) -> None:
    np.testing.assert_allclose(rotation_vector(R, R), 0.0, atol=1e-12)


@given(angles, angles)
def test_yaw_pitch_is_a_turn_about_y_then_about_z(yaw: float, pitch: float) -> None:
    expected = RotationMatrix.MakeZRotation(yaw) @ RotationMatrix.MakeYRotation(pitch)
    np.testing.assert_allclose(yaw_pitch(yaw, pitch), expected.matrix(), atol=1e-15)


@given(vectors, vectors)
def test_the_cross_matrix_gives_the_cross_product(a: Array, b: Array) -> None:
    np.testing.assert_allclose(cross_matrix(np.array([a, b])) @ b, np.cross([a, b], b), atol=1e-12)


@given(rotations, rotations, st.sampled_from((1.0, -1.0, 0.9, -1.1)))
def test_quaternions_of_any_sign_and_length_give_the_rotation_vector_of_their_matrices(
    R_WA: Array, R_WB: Array, factor: float
) -> None:
    q_WA, q_WB = (RotationMatrix(R).ToQuaternion().wxyz() for R in (R_WA, R_WB))
    actual, expected = quaternion_rotation_vector(factor * q_WA, q_WB), rotation_vector(R_WA, R_WB)
    # At half a turn the shorter way changes sides.
    assume(np.linalg.norm(expected) < 3.1)
    np.testing.assert_allclose(actual, expected, atol=1e-6)
