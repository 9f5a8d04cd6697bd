"""Rotations as 3 x 3 matrices and as rotation vectors."""

import math

import numpy as np
from pydrake.common.eigen_geometry import AngleAxis

from humanwalk.numerics import Array

_LEVI_CIVITA = -np.cross(np.eye(3)[:, None], np.eye(3)).reshape(3, 9)


def rotation_vector(R_WA: Array, R_WB: Array) -> Array:
    """Axis times angle [rad], in W, of the rotation that turns frame A into frame B; shape (3,)."""
    rotation = AngleAxis(R_WB @ R_WA.T)
    vector: Array = rotation.angle() * rotation.axis()
    return vector


def quaternion_rotation_vector(q_WA: Array, q_WB: Array) -> Array:
    """Axis times angle [rad], in W, of the rotation that turns frame A into frame B the shorter way; shape (3,).

    Args:
        q_WA, q_WB: quaternions wxyz, shape (4,), of any length and sign.
    """
    # q_WB times the conjugate of q_WA: [cosine; sine * axis] of half the angle.
    cosine, sines = q_WA @ q_WB, q_WA[0] * q_WB[1:] - q_WB[0] * q_WA[1:] + cross_matrix(q_WA[1:]) @ q_WB[1:]
    sine = math.hypot(*sines)
    vector: Array = sines * (math.copysign(2.0, cosine) * math.atan2(sine, abs(cosine)) / sine if sine > 0 else 0.0)
    return vector


def yaw_pitch(yaw: float, pitch: float) -> Array:
    """Rz(yaw) Ry(pitch), shape (3, 3)."""
    c, s, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    return np.array(((c * cp, -s, c * sp), (s * cp, c, s * sp), (-sp, 0.0, cp)))


def yaw_roll(yaw: float, roll: float) -> Array:
    """Rz(yaw) Rx(roll), shape (3, 3)."""
    c, s, cr, sr = math.cos(yaw), math.sin(yaw), math.cos(roll), math.sin(roll)
    return np.array(((c, -s * cr, s * sr), (s, c * cr, -c * sr), (0.0, sr, cr)))


def cross_matrix(a: Array) -> Array:
    """The matrix of the cross product a x; shape (..., 3, 3) for (..., 3)."""
    matrix: Array = (a @ _LEVI_CIVITA).reshape(*a.shape, 3)
    return matrix
