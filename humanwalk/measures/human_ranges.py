"""Human ranges of measures of a walk, by its speed and leg length, each with its source."""

import math
from dataclasses import dataclass

import numpy as np

from humanwalk.body import human
from humanwalk.gait.normative import SpeedGroup, dimensionless_speed, speed_group
from humanwalk.measures.curves import ANGLES, late_stance_knee

PERRY = "Perry, Burnfield (2010), Gait Analysis"
ORENDURFF = "Orendurff et al. (2004), JRRD 41(6A) 829"
SCHWARTZ = "Schwartz et al. (2008)"
SCHULZ = "Schulz (2012), J. Neuroeng. Rehabil. 9:69"
KIRTLEY = "Kirtley, Whittle, Jefferson (1985), J. Biomed. Eng. 7(4) 282"

WALK_RATIOS = (0.64 / 117.0, 0.73 / 111.0)
"""Step length per cadence of women and of men at their own speed [m min]: Perry and Burnfield (2010).

The walk ratio does not depend on speed above 1.03 m/s, and is greater below: Murakami, Otaka (2017), J. Phys. Ther.
Sci. 29(4) 722.
"""

STANCE_SHARE = (0.642, -0.035, 0.02)
"""Stance share extrapolated to rest, change per m/s: Kirtley et al. (1985). Standard deviation between people: 1.9 to
2.5 % of the stride in the data at clinicalgaitanalysis.com/data/stance.html."""

STEP_WIDTH = (0.140, 0.031)
"""Mean and standard deviation at a free speed [leg lengths]: table 1 of Schulz (2012)."""

COM_EXCURSIONS = {
    "vertical": ((2.74e-2, 0.52e-2), (4.83e-2, 0.92e-2)),
    "lateral": ((6.99e-2, 1.34e-2), (3.85e-2, 1.41e-2)),
}
COM_SPEEDS = (0.7, 1.6)
"""Human mean and standard deviation at two speeds [m], and the speeds [m/s]; abstract of Orendurff et al. (2004)."""


@dataclass(frozen=True)
class Pace:
    """How fast a body walks: what human ranges depend on.

    Attributes:
        speed: mean speed of the strides [m/s].
        leg: leg length, the height of the hip joints in standing [m].
    """

    speed: float
    leg: float

    @property
    def dimensionless(self) -> float:
        """Speed over sqrt(g leg length)."""
        return dimensionless_speed(self.speed, self.leg)

    @property
    def legs(self) -> float:
        """Leg length over that of an adult."""
        return self.leg / human().hip_height

    @property
    def adult_speed(self) -> float:
        """Speed of a dynamically similar adult [m/s]."""
        return self.speed / math.sqrt(self.legs)

    @property
    def group(self) -> SpeedGroup:
        """People who walk at this dimensionless speed."""
        return speed_group(self.dimensionless)


@dataclass(frozen=True)
class People:
    """Human range of a measure; for a mean with standard deviation, one standard deviation to either side."""

    low: float
    high: float
    source: str


def people_com_excursion(direction: str, pace: Pace) -> People | None:
    """Human range of the center of mass [m]; None outside of the two speeds of the source."""
    speed = pace.adult_speed
    if not COM_SPEEDS[0] <= speed <= COM_SPEEDS[1]:
        return None
    mean, sd = (
        pace.legs * float(np.interp(speed, COM_SPEEDS, ends)) for ends in zip(*COM_EXCURSIONS[direction], strict=True)
    )
    return People(mean - sd, mean + sd, f"{ORENDURFF}, at this speed and leg length")


def people_speed(pace: Pace) -> People:
    """Human speed, as women and men choose it [m/s]; it does not depend on the speed of the walk."""
    scale = math.sqrt(pace.legs)
    return People(1.28 * scale, 1.43 * scale, f"{PERRY}, women and men at their own speed, at this leg length")


def people_steps(pace: Pace) -> tuple[People, People]:
    """Human step length [m] and cadence [1/min].

    With the walk ratio r, the length is sqrt(60 r speed), and the cadence 60 speed / length. Dynamically similar bodies
    have walk ratios in proportion to the leg length to the power 1.5.
    """
    scale = pace.legs**1.5
    low, high = (math.sqrt(60.0 * scale * ratio * pace.speed) for ratio in WALK_RATIOS)
    source = f"{PERRY}: walk ratio, from women's to men's, at this speed and leg length"
    return People(low, high, source), People(60.0 * pace.speed / high, 60.0 * pace.speed / low, source)


def people_stance(pace: Pace) -> People:
    """Human share of stance."""
    at_rest, slope, sd = STANCE_SHARE
    mean = at_rest + slope * pace.adult_speed
    return People(mean - sd, mean + sd, f"{KIRTLEY}, at this speed and leg length")


def people_double_support(pace: Pace) -> People:
    """Human share of double support, of a symmetric gait."""
    stance = people_stance(pace)
    return People(2.0 * stance.low - 1.0, 2.0 * stance.high - 1.0, f"{KIRTLEY}: twice the stance minus the stride")


def people_step_width(pace: Pace) -> People:
    """Human step width [m]."""
    mean, sd = STEP_WIDTH
    return People((mean - sd) * pace.leg, (mean + sd) * pace.leg, SCHULZ)


def people_late_stance_knee(pace: Pace) -> People:
    """Human least knee flexion in terminal stance [deg]."""
    band = ANGLES["knee"].people(pace.group)
    low, high = late_stance_knee(np.array([band.mean - band.sd, band.mean + band.sd]))
    return People(float(low), float(high), SCHWARTZ)
