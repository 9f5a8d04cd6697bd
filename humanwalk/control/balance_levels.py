"""The two balance levels of the thesis' control flow (section 4.3, Fig 4.9 and 4.10).

The thesis names both and gives no law or gain for either (E23); the laws here are the simplest that do what it says.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class FootForceBalanceParameters:
    """Level 1: foot targets move towards desired ground contact forces."""

    enabled: bool = False
    """Whether level 1 acts."""

    compliance: float = quantity(2e-5, "m/N", 0.0, 1e-3)
    """Shift of the target per missing force: 1.4 cm for the body's whole weight."""

    time_constant: float = quantity(0.1, "s", 0.001, 10.0)
    """First-order lag of the shift."""

    max_shift: float = quantity(0.02, "m", 0.0, 0.2)
    """Largest shift in each direction."""


@dataclass(frozen=True)
class UpperBodyBalanceParameters:
    """Level 2: the upper body turns against alpha."""

    enabled: bool = False
    """Whether level 2 acts."""

    pitch_gain: float = quantity(0.5, "", 0.0, 10.0)
    """Extension of the spine per forward alpha."""

    roll_gain: float = quantity(0.5, "", 0.0, 10.0)
    """Side bend of the spine per sideways alpha: 'different gains push back' (section 4.3)."""

    time_constant: float = quantity(0.1, "s", 0.001, 10.0)
    """First-order lag of alpha."""


def desired_foot_forces(contact_schedule: Array, weight: float) -> Array:
    """Ground forces [N], shape (2, 3), that carry the weight [N] evenly on the feet in stance.

    Args:
        contact_schedule: 1 for a foot in stance, 0 in swing, shape (2,).
        weight: m g of the body.
    """
    forces = np.zeros((2, 3))
    feet_down = contact_schedule.sum()
    if feet_down > 0:
        forces[:, 2] = weight * contact_schedule / feet_down
    return forces


def foot_shift_rate(shift: Array, missing_force: Array, parameters: FootForceBalanceParameters) -> Array:
    """Rate [m/s] of the foot targets' shift, same shape as `shift`.

    A foot that should feel more force along an axis presses its target the other way into the ground.

    Args:
        shift: present shift of the targets [m].
        missing_force: desired minus measured ground force on the foot [N].
        parameters: compliance, lag and bound.
    """
    goal = np.clip(-parameters.compliance * missing_force, -parameters.max_shift, parameters.max_shift)
    rate: Array = (goal - shift) / parameters.time_constant
    return rate


def lean_angles(p_WMidfeet: Array, p_WCom: Array) -> Array:
    """alpha [rad], shape (2,): forward and leftward lean of the line from mid-feet to the centre of gravity.

    The angle that this line makes with the ground normal z (thesis Fig 4.9), split into its sagittal and its
    frontal part.
    """
    d = p_WCom - p_WMidfeet
    return np.array([np.arctan2(d[0], d[2]), np.arctan2(d[1], d[2])])
