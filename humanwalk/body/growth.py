"""Proportions of children, relative to those of adults.

Shares of the body mass follow R. K. Jensen (1989), Changes in segment inertia proportions between 4 and 20 years, J
Biomech 22:529-536, quadratic in age. The regressions were read in public transcriptions; they agree with Jensen's
values at 12 and 18 years to the printed digit, and the head's with the six-year-old dummy of the NHTSA (.171 and .172).
Jensen cuts the limbs elsewhere than de Leva. Only the ratio to the share at 18 years is used here, so that the
proportions of adults are reached without a step.

Legs are shorter in children: the sitting height is .556 of the stature in the dummy of six years (25.0 of 45.0 in), and
.52 in adults, which children reach at about 14 years, at the peak of their growth. Between the two ages the share falls
linearly (our interpolation). Arms keep their ratio to the legs: .76 of the height of the iliac spine at all ages (Brush
study, Acta Orthop 2017, 88:185-191). The head's length is proportional to the cube root of its share of the mass. The
rest of the stature is the trunk. Centers of mass and radii of gyration keep their shares of the segments' lengths; of
the lower leg this was measured between 5 and 18 years (Lebiedowska and Polisiakiewicz 1997, J Biomech 30:723-728).
"""

from dataclasses import dataclass

import numpy as np

ADULT_AGE = 18.0
"""Age from which proportions are those of adults [years]."""
MIN_AGE = 6.0
"""Youngest age [years]."""

MASS_SHARE: dict[str, tuple[float, ...]] = {
    "head": (0.27881, -0.021152, 0.00053168),
    "upper_arm": (0.02344, 0.000696),
    "forearm": (0.0140, 0.000261),
    "hand": (0.0088,),
    "thigh": (0.04309, 0.0088978, -0.00027425),
    "shank": (0.03512, 0.0063207, -0.00026119),
    "foot": (0.03512, 0.0063207, -0.00026119),
}
"""Share of the body mass: coefficients of the powers of the age [years]. Shank and foot have one for both together."""

SITTING_HEIGHT = ((6.0, 0.556), (14.0, 0.52))
"""Age [years] and sitting height over stature."""


@dataclass(frozen=True)
class Growth:
    """Proportions at an age over those of adults.

    Attributes:
        mass: Share of the body mass, by region; the trunk has the rest.
        limbs: Lengths of arms and legs over stature.
        head: Length of head and neck over stature.
    """

    mass: dict[str, float]
    limbs: float
    head: float


def growth(age: float) -> Growth:
    """Return the proportions at an age [years], all 1 from `ADULT_AGE` on."""
    mass = {region: _share(c, min(age, ADULT_AGE)) / _share(c, ADULT_AGE) for region, c in MASS_SHARE.items()}
    ages, shares = zip(*SITTING_HEIGHT, strict=True)
    limbs = (1.0 - float(np.interp(age, ages, shares))) / (1.0 - shares[-1])
    return Growth(mass, limbs, mass["head"] ** (1.0 / 3.0))


def _share(coefficients: tuple[float, ...], age: float) -> float:
    return float(np.polynomial.polynomial.polyval(age, coefficients))
