"""The balance that the thesis assumes: a spring-damper between the pelvis and its walking reference."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from pydrake.math import RigidTransform

from humanwalk.control.inverse_kinematics import pose_error
from humanwalk.quantity import quantity

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class BalanceSupportParameters:
    """Spring-damper between the pelvis and its walking reference; the thesis gives no law (E23), so this is ours."""

    enabled: bool = True
    """Whether the support acts at all."""

    stiffness: float = quantity(30000.0, "N/m", 0.0, 1e6)
    """Force per displacement of the pelvis."""

    damping: float = quantity(2500.0, "N s/m", 0.0, 1e5)
    """Force per velocity error: 0.86 of critical for 70 kg."""

    rotational_stiffness: float = quantity(10000.0, "N m/rad", 0.0, 1e5)
    """Torque per rotation of the pelvis."""

    rotational_damping: float = quantity(400.0, "N m s/rad", 0.0, 1e4)
    """Torque per angular-velocity error."""

    @cached_property
    def diagonals(self) -> tuple[Array, Array]:
        """Stiffness and damping of the six directions [rotation; translation], shape (6,) each."""
        return (
            np.repeat((self.rotational_stiffness, self.stiffness), 3),
            np.repeat((self.rotational_damping, self.damping), 3),
        )


def support_wrench(
    X_WP: RigidTransform,
    V_WP: Array,
    X_WPref: RigidTransform,
    V_WPref: Array,
    parameters: BalanceSupportParameters,
) -> Array:
    """Spatial force [torque; force] on the pelvis at Po, in W, shape (6,) [N m, N].

    Args:
        X_WP, X_WPref: pose of the pelvis and its reference.
        V_WP, V_WPref: [angular; translational] velocities in W, shape (6,) [rad/s, m/s].
        parameters: stiffness and damping.
    """
    K, D = parameters.diagonals
    wrench: Array = -K * pose_error(X_WP, X_WPref) - D * (V_WP - V_WPref)
    return wrench
