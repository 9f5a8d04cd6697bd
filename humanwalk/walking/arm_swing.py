"""Arms that swing against the legs; ours, since the thesis only mentions that the hands may swing (chapters 3, 5)."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from humanwalk.body.limbs import ARMS
from humanwalk.quantity import check, quantity


@dataclass(frozen=True)
class ArmSwingParameters:
    """Size of the arm swing at full speed."""

    shoulder_amplitude: float = quantity(0.35, "rad", 0.0, 1.0)
    """Flexion of the shoulder to either side of hanging."""

    elbow_flexion: float = quantity(0.35, "rad", 0.0, 1.5)
    """Mean flexion of the elbow, also at rest."""

    elbow_amplitude: float = quantity(0.1, "rad", 0.0, 0.5)
    """Flexion of the elbow to either side of the mean, largest when the arm is in front; limited to `elbow_flexion`,
    since the elbow does not extend beyond straight."""

    def __post_init__(self) -> None:
        check(self)


class JointSwing(NamedTuple):
    """Mean of a joint's swing [rad], and the factor of the right arm's swing in it [rad]."""

    middle: float
    amplitude: float


def arm_joints(parameters: ArmSwingParameters) -> dict[str, JointSwing]:
    """Swing of shoulders and elbows, by joint."""
    elbow_amplitude = min(parameters.elbow_amplitude, parameters.elbow_flexion)
    joints = {}
    # The left foot, and so the left arm, is half a cycle behind: a sinusoid with the opposite sign.
    for arm, sign in ((ARMS["Right"], 1.0), (ARMS["Left"], -1.0)):
        joints[arm.shoulder_flexion] = JointSwing(0.0, sign * parameters.shoulder_amplitude)
        joints[arm.elbow] = JointSwing(parameters.elbow_flexion, sign * elbow_amplitude)
    return joints


def arm_swing(
    phase_right: float, phase_rate: float, speed_fraction: float = 1.0, speed_fraction_rate: float = 0.0
) -> tuple[float, float]:
    """Swing of the right arm as a fraction of its amplitude, forward positive, and its time derivative [1/s].

    Args:
        phase_right: phase of the right foot, 0 at its touchdown, when the arm is farthest back.
        phase_rate: speed / stride [1/s].
        speed_fraction: speed as a fraction of full speed; the swing is proportional to it.
        speed_fraction_rate: its time derivative [1/s].
    """
    angle = 2.0 * math.pi * phase_right
    cosine, sine = math.cos(angle), math.sin(angle)
    rate = speed_fraction * sine * 2.0 * math.pi * phase_rate - speed_fraction_rate * cosine
    return -speed_fraction * cosine, rate
