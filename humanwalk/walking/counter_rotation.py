"""How pelvis, chest and arms turn with the legs and against them."""

from __future__ import annotations

from dataclasses import dataclass

from humanwalk.quantity import quantity


@dataclass(frozen=True)
class CounterRotation:
    """Turns per distance between the feet along the way of the walk."""

    pelvis: float = quantity(0.12, "rad/m", 0.0, 1.0)
    """Of the pelvis, with the leading leg."""

    chest: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Of the chest, against it."""

    arms: float = quantity(0.6, "rad/m", 0.0, 2.0)
    """Flexion of the shoulder opposite to the leading leg."""
