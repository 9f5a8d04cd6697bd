"""Curves of able-bodied people over the gait cycle, at three speeds.

Schwartz, Rozumalski, Trost (2008), "The effect of walking speed on the gait of typically developing children",
J. Biomech. 41(8) 1639-1650. Curves of different bodies compare at the same dimensionless speed v / sqrt(g leg length):
Hof (1996), Gait Posture 4(3) 222-223.
"""

import csv
import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Literal

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY

CYCLE = np.linspace(0.0, 100.0, 101)
"""Points of the gait cycle at which curves are compared [%]."""

PEOPLE_DATA = "models/normative_gait/schwartz2008_slow_free_fast.csv"

PEOPLE_LEG = 0.75
"""Leg length of the people [m]. The source's children are 4 to 17 years old; this is the leg of one of 10.5 years and
1.41 m, with the share of the stature that it has in our adults (docs/likeness.md, "What is measured, and what is not").
"""

SpeedGroup = Literal["slow", "free", "fast"]

SPEED_GROUPS: dict[SpeedGroup, tuple[float, float]] = {
    "slow": (0.227, 0.363),
    "free": (0.363, 0.500),
    "fast": (0.500, 0.636),
}
"""Dimensionless speeds of the groups of Schwartz et al. (2008); free is the speed that the subjects chose."""


@dataclass(frozen=True)
class Band:
    """A human curve at the points of CYCLE: mean and standard deviation between people, shape (101,) each."""

    mean: Array
    sd: Array


@cache
def people(quantity: str, group: SpeedGroup) -> Band:
    """A human curve of PEOPLE_DATA in its units: deg, N mm/kg or W/kg.

    Args:
        quantity: Name of the curve in the data.
        group: Speed at which the people walked.
    """
    text = files("humanwalk").joinpath(PEOPLE_DATA).read_text(encoding="utf-8")
    rows = [
        row
        for row in csv.DictReader(text.splitlines())
        if row["quantity"] == quantity and row["speed"].lower() == group
    ]
    cycle, mean, sd = (np.array([float(row[key]) for row in rows]) for key in ("gait_cycle_percent", "mean", "sd"))
    return Band(np.interp(CYCLE, cycle, mean), np.interp(CYCLE, cycle, sd))


def moment_scale(leg: float) -> float:
    """Factor from people's moments per body mass to those of dynamically similar bodies with a leg length [m].

    Moments are in proportion to body weight times leg length (Hof 1996).
    """
    return leg / PEOPLE_LEG


def power_scale(leg: float) -> float:
    """The same for powers: in proportion to body weight times sqrt(g leg length)."""
    return math.sqrt(leg / PEOPLE_LEG)


def dimensionless_speed(speed: float, leg: float) -> float:
    """Speed [m/s] over sqrt(g times the leg length [m]); the leg length is the height of the hip joint in standing."""
    return speed / math.sqrt(GRAVITY * leg)


def speed_group(dimensionless: float) -> SpeedGroup:
    """The group whose dimensionless speeds contain a speed, else the nearest one."""
    return min(SPEED_GROUPS, key=lambda group: _distance(dimensionless, *SPEED_GROUPS[group]))


def is_measured(dimensionless: float) -> bool:
    """Whether a dimensionless speed is within those of the groups."""
    return _distance(dimensionless, *SPEED_GROUPS[speed_group(dimensionless)]) == 0.0


def _distance(value: float, low: float, high: float) -> float:
    """Distance from a range, 0 within."""
    return max(low - value, value - high, 0.0)
