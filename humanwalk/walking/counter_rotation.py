"""Rotation of pelvis, chest and arms with and against the legs, and the drop of the pelvis."""

import cmath
import math
from dataclasses import dataclass

from humanwalk.quantity import quantity
from humanwalk.walking.walking_reference import BodyState


@dataclass(frozen=True)
class CounterRotation:
    """Angles per distance between the feet along the heading, and the drop of the pelvis per speed."""

    pelvis: float = quantity(0.09, "rad/m", 0.0, 1.0)
    """Yaw of the pelvis, with the leading leg."""

    drop: float = quantity(0.04, "rad s/m", 0.0, 0.3)
    """Largest drop of the pelvis toward the swinging leg per forward speed; people have 0.06 (Schwartz et al. 2008)."""

    drop_share: float = quantity(0.9, "", 0.1, 1.0)
    """Share of the step, from touchdown on, during which the pelvis is dropped."""

    chest: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Yaw of the chest, against it."""

    head: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Yaw of the head relative to the chest, against it: with the value of the chest the head is steady in space."""

    arms: float = quantity(0.7, "rad/m", 0.0, 2.0)
    """Flexion of the shoulder opposite to the leading leg."""

    def drop_at(self, progress: float, speed: float) -> float:
        """Drop of the pelvis toward the swinging leg [rad] at a share of the step and a forward speed [m/s]."""
        bump = 0.5 - 0.5 * math.cos(2.0 * math.pi * min(progress / self.drop_share, 1.0))
        return self.drop * max(speed, 0.0) * bump


def foot_lead(body: BodyState, heading: float) -> tuple[float, float]:
    """Distance of the left foot ahead of the right one along a heading [rad], and its rate [m, m/s]."""
    u = cmath.exp(1j * heading)
    lead = (body.left.position - body.right.position) / u
    rate = (body.left.velocity - body.right.velocity) / u
    return lead.real, rate.real
