"""Where the next foot goes: as the error of the pendulum asks, within reach, and never into the other leg.

Points of the ground plane are complex numbers x + iy [m]; a foothold is seen from the stance ankle along its heading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from humanwalk.body import Side
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class StepPlacement:
    """Where feet go."""

    width: float = quantity(0.16, "m", 0.08, 0.4)
    """Between the lines of the two feet."""

    narrowest: float = quantity(0.09, "m", 0.0, 0.3)
    """Least sideways distance of a foothold beside the stance foot: below, the legs would touch."""

    beside: float = quantity(0.15, "m", 0.0, 0.5)
    """A foothold farther than this before or behind the stance foot may be narrower, by as much as it is farther."""

    across: float = quantity(0.1, "m", -0.3, 0.3)
    """So far may it be across at most: one leg in front of the other."""

    uncrossed: float = quantity(0.05, "m", -0.3, 0.3)
    """A foot that is less than this beside the other before it leaves takes its time to leave."""

    widest: float = quantity(0.85, "m", 0.2, 1.0)
    """Greatest sideways distance."""

    longest: float = quantity(1.0, "m", 0.2, 1.5)
    """Greatest distance forward or backward."""

    hurry_narrower: float = quantity(0.07, "m", 0.0, 0.3)
    """The clock hurries when the foothold that balance wants would miss `narrowest` by more than this."""

    hurry_wider: float = quantity(0.35, "m", 0.2, 1.0)
    """The clock hurries when that foothold is farther sideways than this."""

    passing: float = quantity(0.12, "m", 0.0, 0.3)
    """A foot that comes from behind the other one passes it at this distance."""

    reach: float = quantity(0.45, "m", 0.1, 1.0)
    """Greatest distance of a foothold before or behind the centre of mass as it will be then: a leg that is stretched
    farther hangs in the air, however soon its time is over."""

    smoothing: float = quantity(0.02, "s", 0.0, 0.2)
    """Time constant of the foothold."""

    freeze: float = quantity(0.04, "s", 0.0, 0.2)
    """The foothold is settled this long before touchdown."""

    def least_width(self, x: float) -> float:
        """Least sideways distance of a foot that is x before the stance foot, or -x behind it [m]."""
        return max(self.narrowest - max(abs(x) - self.beside, 0.0), -self.across)

    def way_round(self, place: complex, foothold: complex, stance: Side) -> tuple[complex, float] | None:
        """Where a foot that would run into the other must pass it, and the share of its way until there; else None.

        Args:
            place: where the swinging foot is.
            foothold: where it is going.
            stance: the foot that carries.
        """
        outward = -1.0 if stance == "Left" else 1.0
        if outward * place.imag >= self.narrowest or place.real * foothold.real >= 0.0:
            return None
        return 1j * outward * self.passing, place.real / (place.real - foothold.real)

    def late_lift_off(self, wanted: complex, stance: Side, place: complex) -> float:
        """How far the wanted foothold is across the stance foot [m]: then the foot that is to go there should be in the
        air already. Nothing where it stands across itself: it must come out from behind first.

        Args: see `within_reach`.
        """
        outward = -1.0 if stance == "Left" else 1.0
        width = outward * wanted.imag
        if outward * place.imag < self.uncrossed:
            return 0.0
        return max(-width, 0.0)

    def within_reach(self, wanted: complex, stance: Side, place: complex) -> tuple[complex, float]:
        """The nearest foothold that legs reach without touching, and by how much the wanted one calls for a hurry [m].

        Args:
            wanted: foothold.
            stance: the foot that carries.
            place: where the swinging foot is; it must pass beside the other before it may cross.
        """
        outward = -1.0 if stance == "Left" else 1.0
        width = outward * wanted.imag
        beyond = max(
            self.narrowest - self.hurry_narrower - width,
            width - self.hurry_wider,
            abs(wanted.real) - 0.95 * self.longest,
            0.0,
        )
        x = clip(wanted.real, -self.longest, self.longest)
        has_passed = place.real * x > 0.0
        narrowest = max(self.least_width(x), self.least_width(place.real)) if has_passed else self.narrowest
        foothold = complex(x, outward * clip(width, narrowest, self.widest))
        return foothold, beyond

    def near_body(self, foothold: complex, com: complex) -> complex:
        """The foothold, not farther before or behind the centre of mass at touchdown than a leg that carries reaches.

        Args:
            foothold, com: along the heading, seen from the stance foot [m].
        """
        return complex(clip(foothold.real, com.real - self.reach, com.real + self.reach), foothold.imag)


def foothold_gain(frequency: float, double_support: float) -> float:
    """How far the foothold follows the error of the DCM at touchdown.

    The DCM counts from where the zero-moment point will be, which leaves the old foot only during double support.

    Args:
        frequency: of the pendulum [1/s].
        double_support: its duration [s].
    """
    wt = frequency * double_support
    return wt / (1.0 - math.exp(-wt))
