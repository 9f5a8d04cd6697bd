"""The balance that the thesis assumes: a spring-damper between the pelvis and its walking reference."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from pydrake.math import atan2, sqrt
from pydrake.math import max as max_

from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class BalanceSupportParameters:
    """Spring-damper between the pelvis and its walking reference; the thesis gives no law (E23), so this is ours.

    Chosen as soft as keeps both feet of the scenario `thesis` within 0.5 cm of their lines and the pelvis within 1 cm
    rms of its reference, and stable at steps up to 2 ms. Values are for the reference body, see `scaled`.
    """

    enabled: bool = True
    """Whether the support acts at all."""

    stiffness: float = quantity(50000.0, "N/m", 0.0, 1e6)
    """Force per displacement of the pelvis."""

    damping: float = quantity(3300.0, "N s/m", 0.0, 1e5)
    """Force per velocity error: 0.88 of critical for 70 kg."""

    rotational_stiffness: float = quantity(30000.0, "N m/rad", 0.0, 1e5)
    """Torque per rotation of the pelvis."""

    rotational_damping: float = quantity(300.0, "N m s/rad", 0.0, 1e4)
    """Torque per angular-velocity error."""

    def scaled(self, mass_factor: float, length_factor: float) -> "BalanceSupportParameters":
        """The same support for a body of other mass and size: forces go with mass, torques with mass times length^2."""
        turning = mass_factor * length_factor**2
        return replace(
            self,
            stiffness=self.stiffness * mass_factor,
            damping=self.damping * mass_factor,
            rotational_stiffness=self.rotational_stiffness * turning,
            rotational_damping=self.rotational_damping * turning,
        )

    @cached_property
    def diagonals(self) -> tuple[Array, Array]:
        """Stiffness and damping of the six directions [rotation; translation], shape (6,) each."""
        return (
            np.repeat((self.rotational_stiffness, self.stiffness), 3),
            np.repeat((self.rotational_damping, self.damping), 3),
        )


def support_wrench(q_WP: Array, V_WP: Array, reference: Array, parameters: BalanceSupportParameters) -> Array:
    """Spatial force [torque; force] on the pelvis at Po, in W, shape (6,) [N m, N].

    Its part that is no product takes Drake's symbolic expressions, too.

    Args:
        q_WP: pose of the pelvis as Drake's floating base has it, [quaternion wxyz; position [m]], shape (7,); the
            quaternion may be a little off unit length, as Drake lets it drift.
        V_WP: its [angular; translational] velocity in W, shape (6,) [rad/s, m/s].
        reference: both of the reference, [q; V], shape (13,).
        parameters: stiffness and damping.
    """
    off = np.concatenate((q_WP[4:], V_WP)) - reference[4:]
    turn = relative_quaternion(q_WP[:4], reference[:4])
    wrench: Array = linear_gain(parameters) @ off
    wrench[:3] += turning_stiffness(turn, parameters) * turn[1:]
    return wrench


def linear_gain(parameters: BalanceSupportParameters) -> Array:
    """What the support makes of differences of position [m] and of spatial velocity [rad/s, m/s]; shape (6, 9)."""
    K, D = parameters.diagonals
    return np.hstack((-np.diag(K)[:, 3:], -np.diag(D)))


def relative_quaternion(wxyz: Array, wxyz_reference: Array) -> Array:
    """Quaternion in W that leads from the reference's orientation to the other one, not normalised; shape (4,)."""
    w, x, y, z = wxyz
    a, b, c, d = wxyz_reference
    # The product of the one with the conjugate of the other.
    return np.array(
        (
            w * a + x * b + y * c + z * d,
            -w * b + x * a - y * d + z * c,
            -w * c + x * d + y * a - z * b,
            -w * d - x * c + y * b + z * a,
        )
    )


def turning_stiffness(wxyz: Array, parameters: BalanceSupportParameters) -> Any:
    """What times the x, y, z of a quaternion, which need not be normalised, is the torque the shorter way [N m]."""
    cosine, i, j, k = wxyz
    # Near no rotation at all angle / sine goes to 2 / cosine.
    sine = max_(sqrt(i * i + j * j + k * k), 1e-12)
    # A quaternion and its negative are one orientation: both are multiplied by the cosine, which makes it positive.
    return -parameters.rotational_stiffness * 2.0 * atan2(sine * cosine, cosine * cosine) / sine


def largest_support_step(
    M: Array, kp: Array, kd: Array, parameters: BalanceSupportParameters, upper: float = 0.1
) -> float:
    """Largest step [s] at which the support, which acts explicitly, is stable on a body with implicit joint PD.

    Linearised at rest: (M + h kd + h^2 kp) v' = M v - h (support + kp q), q' = q + h v'.

    Args:
        M: mass matrix, shape (6 + n, 6 + n), the pelvis' rows [rotation; translation] first.
        kp, kd: gains of the n joints.
        parameters: the support.
        upper: step beyond which nothing is looked for [s].
    """
    m = M.shape[0]
    K_support, D_support = np.zeros(m), np.zeros(m)
    K_support[:6], D_support[:6] = parameters.diagonals
    K_joints, D_joints = (np.concatenate((np.zeros(6), gain)) for gain in (kp, kd))
    eye = np.eye(m)

    def update(h: float) -> Array:
        solved = np.linalg.inv(M + np.diag(h * D_joints + h * h * K_joints))
        v_of_v = solved @ (M - h * np.diag(D_support))
        v_of_q = -h * solved @ np.diag(K_support + K_joints)
        return np.block([[eye + h * v_of_q, h * v_of_v], [v_of_q, v_of_v]])

    return largest_stable_step(update, upper)
