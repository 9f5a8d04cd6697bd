"""Rotation of pelvis, chest and arms with and against the legs."""

import cmath
from dataclasses import dataclass

from humanwalk.quantity import quantity
from humanwalk.walking.walking_reference import BodyState


@dataclass(frozen=True)
class CounterRotation:
    """Angles per distance between the feet along the heading."""

    pelvis: float = quantity(0.12, "rad/m", 0.0, 1.0)
    """Yaw of the pelvis, with the leading leg."""

    chest: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Yaw of the chest, against it."""

    head: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Yaw of the head relative to the chest, against it: with the value of the chest the head is steady in space."""

    arms: float = quantity(0.6, "rad/m", 0.0, 2.0)
    """Flexion of the shoulder opposite to the leading leg."""


def foot_lead(body: BodyState, heading: float) -> tuple[float, float]:
    """Distance of the left foot ahead of the right one along a heading [rad], and its rate [m, m/s]."""
    u = cmath.exp(1j * heading)
    lead = (body.left.position - body.right.position) / u
    rate = (body.left.velocity - body.right.velocity) / u
    return lead.real, rate.real
