"""The balance that the thesis assumes: a spring-damper between the pelvis and its walking reference."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from humanwalk.control.pd_control import StepImpedance, linear_update
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import quaternion_rotation_vector
from humanwalk.numerics.stability import largest_stable_step
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class BalanceSupportParameters:
    """Spring-damper between the pelvis and its walking reference; ours, since the thesis gives no law (E23).

    The softest values with which both feet of the scenario `thesis` stay within 0.5 cm of their lines and the pelvis
    within 1 cm rms of its reference, and which are stable at steps up to 2 ms. Values are for the reference body.
    """

    enabled: bool = True
    """Whether the support acts."""

    stiffness: float = quantity(50000.0, "N/m", 0.0, 1e6)
    """Force per displacement of the pelvis."""

    damping: float = quantity(3300.0, "N s/m", 0.0, 1e5)
    """Force per velocity error: 0.88 of critical for 70 kg."""

    rotational_stiffness: float = quantity(30000.0, "N m/rad", 0.0, 1e5)
    """Torque per rotation of the pelvis."""

    rotational_damping: float = quantity(270.0, "N m s/rad", 0.0, 1e4)
    """Torque per angular-velocity error."""

    @cached_property
    def K(self) -> Array:
        """Stiffness of rotation, then translation, shape (6,) [N m/rad, N/m]."""
        return np.repeat((self.rotational_stiffness, self.stiffness), 3)

    @cached_property
    def D(self) -> Array:
        """Damping of rotation, then translation, shape (6,) [N m s/rad, N s/m]."""
        return np.repeat((self.rotational_damping, self.damping), 3)


def support_wrench(q_WP: Array, V_WP: Array, reference: Array, parameters: BalanceSupportParameters) -> Array:
    """Spatial force -K x - D (V - V_d) on the pelvis at Po, in W.

    x is the displacement from the reference: rotation vector (the shorter way) and translation, in W.

    Args:
        q_WP: pose of the pelvis [quaternion wxyz; position [m]], shape (7,). The quaternion need not have unit length.
        V_WP: [angular; translational] velocity of the pelvis in W, shape (6,) [rad/s, m/s].
        reference: pose and velocity of the reference in the same order, shape (13,).
        parameters: stiffness and damping.

    Returns:
        [torque; force], shape (6,) [N m, N].
    """
    rotation = quaternion_rotation_vector(reference[:4], q_WP[:4])
    displacement = np.concatenate((rotation, q_WP[4:] - reference[4:7]))
    wrench: Array = -parameters.K * displacement - parameters.D * (V_WP - reference[7:])
    return wrench


def largest_support_step(
    M: Array, kp: Array, impedance: StepImpedance, parameters: BalanceSupportParameters, upper: float = 0.1
) -> float:
    """Largest step [s] at which the support, which acts explicitly, is stable on a body with joint PD.

    Linearized at rest: the joints act as their discretization of the PD law, the support adds h D to what is explicit.

    Args:
        M: mass matrix, shape (6 + n, 6 + n), the pelvis' rows [rotation; translation] first.
        kp: stiffness of the n joints [N m/rad].
        impedance: of the joints' law in a step, see `StepImpedance`.
        parameters: the support.
        upper: longest step that is considered [s].
    """
    K = np.concatenate((parameters.K, kp))

    def update(h: float) -> Array:
        implicit, explicit = impedance(h)
        return linear_update(
            h, M, np.concatenate((np.zeros(6), implicit)), np.concatenate((h * parameters.D, explicit)), K
        )

    return largest_stable_step(update, upper)
