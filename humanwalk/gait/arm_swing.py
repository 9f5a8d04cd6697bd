"""Arms that swing against the legs, for looks.

Ours: the thesis only says that the hands may swing (chapters 3 and 5).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from humanwalk.quantity import check, quantity


@dataclass(frozen=True)
class ArmSwingParameters:
    """Size of the arm swing at full speed.

    shoulder_amplitude: flexion to either side of hanging [rad], 0..1.
    elbow_flexion: mean flexion, kept at rest too [rad], 0..1.5.
    elbow_amplitude: to either side of the mean, largest when the arm is in front [rad], 0..0.5;
        not above elbow_flexion in effect, since the elbow does not bend backwards.
    """

    shoulder_amplitude: float = quantity(0.35, "rad", 0.0, 1.0)
    elbow_flexion: float = quantity(0.35, "rad", 0.0, 1.5)
    elbow_amplitude: float = quantity(0.1, "rad", 0.0, 0.5)

    def __post_init__(self) -> None:
        check(self)


class JointSwing(NamedTuple):
    """Middle of a joint's swing [rad], and what times the right arm's swing is added to it [rad]."""

    middle: float
    amplitude: float


def arm_joints(parameters: ArmSwingParameters) -> dict[str, JointSwing]:
    """How shoulders and elbows swing, by the thesis' way of naming joints."""
    elbow_amplitude = min(parameters.elbow_amplitude, parameters.elbow_flexion)
    joints = {}
    # The left foot, and so the left arm, is half a cycle off: a sinusoid with the other sign.
    for side, sign in (("Right", 1.0), ("Left", -1.0)):
        joints[f"{side}ArmShoulderMotion"] = JointSwing(0.0, sign * parameters.shoulder_amplitude)
        joints[f"{side}ArmElbowMotion"] = JointSwing(parameters.elbow_flexion, sign * elbow_amplitude)
    return joints


def arm_swing(
    phase_right: float, phase_rate: float, speed_fraction: float = 1.0, speed_fraction_rate: float = 0.0
) -> tuple[float, float]:
    """Swing of the right arm as a share of its amplitude, forward positive, and its time derivative [1/s].

    phase_right: phase of the right foot, 0 at its touchdown, when the arm is furthest back.
    phase_rate: [1/s], speed / walked stride.
    speed_fraction: speed as a share of full speed; the swing grows with it from hanging at rest.
    speed_fraction_rate: its time derivative [1/s].
    """
    angle = 2.0 * math.pi * phase_right
    cosine, sine = math.cos(angle), math.sin(angle)
    return (
        -speed_fraction * cosine,
        speed_fraction * sine * 2.0 * math.pi * phase_rate - speed_fraction_rate * cosine,
    )
