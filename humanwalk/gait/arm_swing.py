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


class JointTarget(NamedTuple):
    """Angle [rad] and rate [rad/s] of a joint."""

    angle: float
    rate: float


def arm_targets(
    parameters: ArmSwingParameters,
    phase_right: float,
    phase_rate: float,
    speed_fraction: float = 1.0,
    speed_fraction_rate: float = 0.0,
) -> dict[str, JointTarget]:
    """Targets of shoulders and elbows, by the thesis' way of naming joints.

    phase_right: phase of the right foot, 0 at its touchdown; the left foot is half a cycle off.
    phase_rate: [1/s], speed / walked stride.
    speed_fraction: speed as a share of full speed; the swing grows with it from hanging at rest.
    speed_fraction_rate: its time derivative [1/s].

    The right arm is furthest back when the right foot lands in front. Rates are exact.
    """
    targets = {}
    for side, phase in (("Right", phase_right), ("Left", phase_right + 0.5)):
        angle = 2.0 * math.pi * phase
        swing = -speed_fraction * math.cos(angle)
        swing_rate = speed_fraction * math.sin(angle) * 2.0 * math.pi * phase_rate - speed_fraction_rate * math.cos(
            angle
        )
        elbow_amplitude = min(parameters.elbow_amplitude, parameters.elbow_flexion)
        targets[f"{side}ArmShoulderMotion"] = JointTarget(
            parameters.shoulder_amplitude * swing, parameters.shoulder_amplitude * swing_rate
        )
        targets[f"{side}ArmElbowMotion"] = JointTarget(
            parameters.elbow_flexion + elbow_amplitude * swing, elbow_amplitude * swing_rate
        )
    return targets
