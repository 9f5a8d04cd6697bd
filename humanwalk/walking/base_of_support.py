"""What the feet give the zero-moment point: where the pendulum stands on a foot, and how far it may be moved there.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class BaseOfSupport:
    """The part of a foot that the zero-moment point may use, seen from the ankle."""

    middle: float = quantity(0.03, "m", -0.05, 0.1)
    """From the ankle forward to the point of the foot on which the pendulum stands."""

    roll: float = quantity(0.122, "s", 0.0, 0.3)
    """Zero-moment point when single support ends, before the point on which the pendulum stands, per speed."""

    back: float = quantity(0.04, "m", 0.0, 0.1)
    """The zero-moment point stays this near behind the ankle."""

    ball: float = quantity(0.09, "m", 0.0, 0.2)
    """The zero-moment point stays this far before the ankle while the heel is up."""

    front: float = quantity(0.2, "m", 0.0, 0.4)
    """And this near before it."""

    half_width: float = quantity(0.03, "m", 0.0, 0.1)
    """And this near beside it."""

    sideways: float = quantity(3.0, "", 0.1, 30.0)
    """How much more a place beside the wanted one counts than one before or behind it, on the line between two feet:
    the next step mends an error forward anywhere, one sideways only outward."""

    def middle_of(self, ankle: complex, heading: float) -> complex:
        """The point of a foot on which the pendulum stands."""
        return ankle + self.middle * cmath.exp(1j * heading)

    def supported(
        self, zmp: complex, stance: complex, heading: float, other: complex | None = None, on_ball: bool = False
    ) -> complex:
        """The zero-moment point, kept over the stance foot or its front, or over both feet and between.

        Args:
            zmp: where it should be.
            stance: ankle of the stance foot.
            heading: of that foot.
            other: ankle of the other foot where that carries too.
            on_ball: whether the heel is up.
        """
        u = cmath.exp(1j * heading)
        anchor = stance
        if other is not None:
            way, goal = ((point - other) / u for point in (stance, zmp))
            square = way.real**2 + (self.sideways * way.imag) ** 2
            along = (way.real * goal.real + self.sideways**2 * way.imag * goal.imag) / max(square, 1e-6)
            anchor = other + clip(along, 0.0, 1.0) * (stance - other)
        local = (zmp - anchor) / u
        x = clip(local.real, self.ball if on_ball else -self.back, self.front)
        y = clip(local.imag, -self.half_width, self.half_width)
        return anchor + u * complex(x, y)
