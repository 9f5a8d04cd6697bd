"""The two balance levels of the thesis' control flow (section 4.3, Fig 4.9 and 4.10).

The thesis names both and gives no law or gain for either (E23); these laws are the simplest that fit its description.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class FootForceBalanceParameters:
    """Level 1: the targets of the soles move toward desired ground reaction forces."""

    enabled: bool = False
    """Whether level 1 acts."""

    compliance: float = quantity(2e-5, "m/N", 0.0, 1e-3)
    """Shift of a target per force error: 1.4 cm for the weight of the body."""

    time_constant: float = quantity(0.1, "s", 0.001, 10.0)
    """Time constant of the first-order lag of the shift."""

    max_shift: float = quantity(0.02, "m", 0.0, 0.2)
    """Maximum shift along each axis."""


@dataclass(frozen=True)
class UpperBodyBalanceParameters:
    """Level 2: the spine bends against alpha."""

    enabled: bool = False
    """Whether level 2 acts."""

    pitch_gain: float = quantity(0.5, "", 0.0, 10.0)
    """Extension of the spine per forward alpha."""

    roll_gain: float = quantity(0.5, "", 0.0, 10.0)
    """Lateral bend of the spine per lateral alpha; the thesis mentions different gains (section 4.3)."""

    time_constant: float = quantity(0.1, "s", 0.001, 10.0)
    """Time constant of the first-order filter of alpha."""


def desired_foot_forces(contact_schedule: Array, weight: float) -> Array:
    """Ground reaction forces [N], shape (2, 3), that distribute the weight evenly over the feet in stance.

    Args:
        contact_schedule: 1 for a foot in stance, 0 in swing, shape (2,).
        weight: m g of the body [N].
    """
    forces = np.zeros((2, 3))
    stance_feet = contact_schedule.sum()
    if stance_feet > 0:
        forces[:, 2] = weight * contact_schedule / stance_feet
    return forces


def foot_shift_rate(shift: Array, force_error: Array, parameters: FootForceBalanceParameters) -> Array:
    """Rate [m/s] of the shift of the sole targets, same shape as `shift`.

    To increase the force along an axis, the target moves in the opposite direction, into the ground.

    Args:
        shift: of the targets [m].
        force_error: desired minus measured ground reaction force on each foot [N].
        parameters: compliance, time constant and maximum.
    """
    goal = np.clip(-parameters.compliance * force_error, -parameters.max_shift, parameters.max_shift)
    rate: Array = (goal - shift) / parameters.time_constant
    return rate


def lean_angles(p_WMidfeet: Array, p_WCom: Array) -> Array:
    """alpha [rad], shape (2,): forward and leftward lean of the line from the middle of the feet to the center of mass.

    These are the sagittal and the frontal part of the angle between this line and the vertical (thesis Fig 4.9).
    """
    d = p_WCom - p_WMidfeet
    return np.array([np.arctan2(d[0], d[2]), np.arctan2(d[1], d[2])])
