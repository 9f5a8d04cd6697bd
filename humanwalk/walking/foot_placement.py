"""Where the next foot goes: where balance requires it, within reach, and clear of the other leg.

A foothold is a complex number x + iy [m] in the frame of the step: origin at the stance ankle, x along the heading.
The limits were found with simulated pushes (docs/balance_trials.md, "What do traced falls show?").
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.sides import OUTWARD, Side, other_side

SPEEDUP_SHARE = 0.95
"""Share of the largest step length beyond which the clock runs faster."""


@dataclass(frozen=True)
class StepPlacement:
    """Limits of the footholds."""

    step_width: float = quantity(0.155, "m", 0.08, 0.4)
    """Nominal sideways distance of the ankles."""

    min_width: float = quantity(0.09, "m", 0.0, 0.3)
    """Minimum sideways distance of a foothold beside the stance foot, where the legs would touch."""

    max_crossover: float = quantity(0.2, "m", -0.3, 0.3)
    """Largest distance of a foothold across the stance foot: one leg in front of the other."""

    max_width: float = quantity(0.85, "m", 0.2, 1.0)
    """Maximum sideways distance."""

    speedup_crossing: float = quantity(0.07, "m", 0.0, 0.3)
    """The clock runs faster when the desired foothold is narrower than `min_width` by more than this."""

    speedup_width: float = quantity(0.5, "m", 0.2, 2.0)
    """The clock runs faster when the desired foothold is wider than this. With 0.35 m wide, quick steps can sustain
    themselves."""

    passing_distance: float = quantity(0.12, "m", 0.0, 0.3)
    """Sideways distance at which a foot that comes from across passes the stance foot."""

    passing_acceleration: float = quantity(80.0, "m/s2", 10.0, 1e4)
    """Largest sideways acceleration on the way to that distance; the whole-body program follows up to 100 m/s2. Without
    it a foot reaches 9 m/s, is thrown aside by half a meter, and pushes the body over (docs/balance_trials.md, "What do
    traced falls show?")."""

    max_com_distance: float = quantity(0.38, "m", 0.1, 1.0)
    """Largest distance of a foothold ahead of or behind the center of mass at touchdown. A foot that lands farther
    ahead brakes the body so much that it falls backward (docs/balance_trials.md, "What do traced falls show?")."""

    max_length: float = quantity(1.0, "m", 0.1, 2.0)
    """Largest distance of a foothold ahead of or behind the stance foot."""

    abreast: float = quantity(0.15, "m", 0.01, 0.5)
    """Distance ahead of or behind the stance foot up to which the legs are side by side."""

    min_own_side_offset: float = quantity(0.05, "m", 0.0, 0.3)
    """A foot that stands less than this on its own side of the stance foot is across it, and cannot step across."""

    filter_time: float = quantity(0.02, "s", 0.0, 0.5)
    """Time constant of the low-pass filter of the foothold."""

    rise_filter_time: float = quantity(0.06, "s", 0.0, 0.5)
    """Time constant of the low-pass filter of the heights of a swing whose foothold moves to another face: a leg that
    is lifted faster throws the body up."""

    freeze_time: float = quantity(0.05, "s", 0.0, 0.5)
    """The foothold is constant for this long before touchdown."""

    face_freeze_time: float = quantity(0.25, "s", 0.0, 0.5)
    """The face of the foothold does not change for this long before touchdown. With 0.15 s a sinking foot goes back to
    an upper tread too late, and its heel catches the edge (docs/decisions/0055-slow-walks.md)."""

    def min_step_width(self, x: float) -> float:
        """Minimum sideways distance [m] of a foot that is x [m] ahead of the stance foot."""
        return max(self.min_width - max(abs(x) - self.abreast, 0.0), -self.max_crossover)

    def clear_length(self, x: float, width: float) -> float:
        """Distance ahead of the stance foot [m] of a foothold that would be x ahead and too narrow there.

        It moves by half of the missing width: forward, or backward if x is more than `abreast` behind. Beyond `abreast`
        a foot may be nearer to the other side the farther it is, and the next step corrects a length more easily than a
        crossing.
        """
        farthest = self.abreast + self.min_width + self.max_crossover
        if abs(x) >= farthest:
            return x
        missing = max(self.min_step_width(x) - width, 0.0)
        return clip(x + math.copysign(0.5 * missing, x + self.abreast), -farthest, farthest)

    def is_across(self, foot: complex, stance: Side) -> bool:
        """Whether a foot stands across the stance foot, or nearly so."""
        return OUTWARD[other_side(stance)] * foot.imag < self.min_own_side_offset

    def passing_waypoint(
        self, start: complex, way: Sequence[complex], stance: Side, toe_in: float
    ) -> tuple[complex, float] | None:
        """Waypoint for a swinging foot whose way, or the straight way, would hit the stance foot.

        It is beside the stance foot. For a foot that comes from across it is up to `abreast` before that, where the
        toes reach the heel of the stance foot, but still `abreast` ahead of the foot, which needs room to move aside.

        Args:
            start: Where the foot left the ground.
            way: Places on the way of the swinging foot, from where it is to its foothold.
            stance: The stance foot.
            toe_in: Distance by which its toes are nearer to the stance foot than its ankle [m].

        Returns:
            The waypoint, and its fraction of the line to the foothold; None if the way is clear.
        """
        foot, foothold, outward = way[0], way[-1], OUTWARD[other_side(stance)]
        if foot.real * foothold.real >= 0.0:
            return None
        length = foot.real - foothold.real
        # The straight way, too: a foot that already moves aside would be released too early, and overshoot.
        beside = foot + foot.real / length * (foothold - foot)
        if all(outward * place.imag - toe_in >= self.min_step_width(place.real) for place in (beside, *way)):
            return None
        before = clip(abs(foot.real) - self.abreast, 0.0, self.abreast) if self.is_across(start, stance) else 0.0
        x = math.copysign(before, foot.real)
        return complex(x, outward * (self.passing_distance + toe_in)), (foot.real - x) / length

    def double_support_excess(self, desired: complex, stance: Side, foot: complex) -> float:
        """Distance by which a desired foothold calls for a faster clock in double support [m].

        It calls for one if it is wider than `speedup_width`, or across the stance foot. A foot that is itself across
        has to come out from behind before it can step across.

        Args: See `within_reach`.
        """
        outward = OUTWARD[other_side(stance)]
        width = outward * desired.imag
        crossing = 0.0 if self.is_across(foot, stance) else -width
        return max(width - self.speedup_width, crossing, 0.0)

    def within_reach(self, desired: complex, stance: Side, foot: complex) -> tuple[complex, float]:
        """Nearest foothold that is within reach and clear of the stance leg.

        Args:
            desired: Foothold that balance requires.
            stance: The stance foot.
            foot: Position of the swinging foot, which crosses only after it has passed the stance foot.

        Returns:
            The foothold, and the distance by which the desired one calls for a faster clock [m].
        """
        outward = OUTWARD[other_side(stance)]
        width = outward * desired.imag
        sideways_excess = max(self.min_width - self.speedup_crossing - width, width - self.speedup_width)
        excess = max(sideways_excess, abs(desired.real) - SPEEDUP_SHARE * self.max_length, 0.0)
        x = self.clear_length(clip(desired.real, -self.max_length, self.max_length), width)
        has_passed = foot.real * x > 0.0
        min_width = max(self.min_step_width(x), self.min_step_width(foot.real)) if has_passed else self.min_width
        return complex(x, outward * clip(width, min_width, self.max_width)), excess

    def near_com(self, foothold: complex, com: complex) -> complex:
        """The foothold, limited to `max_com_distance` from the center of mass at touchdown."""
        limit = self.max_com_distance
        return complex(clip(foothold.real, com.real - limit, com.real + limit), foothold.imag)


def foothold_gain(frequency: float, double_support: float) -> float:
    """Displacement of the foothold per error of the DCM at touchdown.

    It is greater than 1 because the zero-moment point reaches the new foot only at the end of double support.

    Args:
        frequency: Natural frequency of the pendulum [1/s].
        double_support: Duration of double support [s].
    """
    wt = frequency * double_support
    return wt / (1.0 - math.exp(-wt))
