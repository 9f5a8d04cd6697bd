"""The base of support: where the zero-moment point is on a foot, and how far it can be moved there.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

import cmath
from dataclasses import dataclass

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity

CORRECTING = 0.7
"""Share of the distance of the nominal zero-moment point from the edge of the base of support that is there for
corrections (our choice)."""

ROUNDING = 1e-9
"""Distance from the base of support up to which a point is within it [m]."""


@dataclass(frozen=True)
class BaseOfSupport:
    """The part of a foot that the zero-moment point may use, relative to the ankle."""

    center: float = quantity(0.046, "m", -0.05, 0.1)
    """Distance of the nominal zero-moment point ahead of the ankle."""

    roll: float = quantity(0.091, "s", 0.0, 0.3)
    """Distance by which the nominal zero-moment point moves forward in single support, per speed."""

    pivot: float = quantity(0.0655, "s", 0.0, 0.2)
    """Distance of the centroidal moment pivot behind the nominal zero-moment point when a foot leaves the ground, and
    ahead of it at touchdown, per speed: the rate of the angular momentum of the swinging leg, over the weight."""

    descent: float = quantity(0.17, "m", 0.0, 0.3)
    """Distance of the nominal centroidal moment pivot ahead of the ankle in a step down, while the heel is up. The
    center of pressure is below the ball, 13 cm ahead, and the leg that sinks in front moves the pivot on."""

    back: float = quantity(0.04, "m", 0.0, 0.1)
    """Limit behind the ankle."""

    ball: float = quantity(0.0815, "m", 0.0, 0.2)
    """Lower limit ahead of the ankle while the heel is up."""

    front: float = quantity(0.2, "m", 0.0, 0.4)
    """Limit ahead of the ankle."""

    half_width: float = quantity(0.03, "m", 0.0, 0.1)
    """Limit to either side."""

    lateral_weight: float = quantity(3.0, "", 0.1, 30.0)
    """Weight of a sideways error relative to a forward error between two feet: the next step corrects a forward error
    with any foothold, a sideways error only with one farther out."""

    def __post_init__(self) -> None:
        """Raise ParameterError if the nominal point or the limit of a raised heel is not between the limits."""
        for name, low, limits in (("center", -self.back, "back or front"), ("ball", 0.0, "front")):
            if not low <= (value := getattr(self, name)) <= self.front:
                raise ParameterError(
                    f"{name}: {value:g} is outside the base of support; allowed: {low:g} to {self.front:g} m; change "
                    f"{name}, {limits}"
                )

    def correctable(self, error: complex, growth: float) -> complex:
        """The part of an error that the zero-moment point can correct by the end of the step [m].

        Args:
            error: Of the DCM at the end of the step, along and across the heading [m].
            growth: Displacement of the DCM at the end of the step by a unit displacement of the zero-moment point.
        """
        along, across = CORRECTING * growth * (self.center + self.back), CORRECTING * growth * self.half_width
        return complex(clip(error.real, -along, along), clip(error.imag, -across, across))

    def center_of(self, ankle: complex, heading: float) -> complex:
        """The nominal zero-moment point on a foot."""
        return ankle + self.center * cmath.exp(1j * heading)

    def outside(self, dcm: complex, stance: complex, heading: float, other: complex) -> complex:
        """Displacement of a DCM from the base of support of both feet [m], 0 within it; arguments as in `clamp`."""
        found = dcm - self.clamp(dcm, stance, heading, other)
        return found if abs(found) > ROUNDING else 0.0

    def clamp(
        self, zmp: complex, stance: complex, heading: float, other: complex | None = None, on_ball: bool = False
    ) -> complex:
        """The zero-moment point, limited to the stance foot, to its front, or to both feet and the area between them.

        Args:
            zmp: Desired zero-moment point.
            stance: Ankle of the stance foot.
            heading: Heading of that foot.
            other: Ankle of the other foot in double support, else None.
            on_ball: Whether the heel is up.
        """
        u = cmath.exp(1j * heading)
        anchor = stance
        if other is not None:
            # The nearest point of the line between the ankles, in the weighted norm.
            line, goal = ((point - other) / u for point in (stance, zmp))
            weight = self.lateral_weight**2
            square = line.real**2 + weight * line.imag**2
            along = (line.real * goal.real + weight * line.imag * goal.imag) / max(square, 1e-6)
            anchor = other + clip(along, 0.0, 1.0) * (stance - other)
        local = (zmp - anchor) / u
        x = clip(local.real, self.ball if on_ball else -self.back, self.front)
        y = clip(local.imag, -self.half_width, self.half_width)
        return anchor + u * complex(x, y)
