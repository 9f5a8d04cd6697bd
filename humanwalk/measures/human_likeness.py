"""Comparison with human gait, stride by stride: angles, moments and powers over the gait cycle, and single measures.

People's curves are those of `humanwalk.gait.normative` at the dimensionless speed of the walk; their moments and powers
are scaled to its leg length. Other measures have human values where a source is known
(`humanwalk.measures.human_ranges`).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from humanwalk.body import Side
from humanwalk.gait.normative import Band, SpeedGroup
from humanwalk.measures.curves import CURVES, JOINTS
from humanwalk.measures.signals import matrix
from humanwalk.measures.symmetry import Asymmetry, asymmetries
from humanwalk.measures.walk_measures import MEASURES, Measure, Walk
from humanwalk.motion.recorded_strides import MAX_HEADING
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario

SCORED = tuple(f"{joint}{quantity}" for quantity in ("", " moment", " power") for joint in JOINTS)
"""Curves of the overall score."""

MIN_STRIDES = 2
"""Number of strides of each leg that a comparison needs."""


@dataclass(frozen=True)
class Likeness:
    """Agreement of a curve with people's, one number per stride, shape (strides,).

    Attributes:
        correlation: Pearson's with the human mean, over the cycle; NaN where the curve is constant.
        difference: mean of the curve minus the human mean [unit of the curve].
        rms: root mean square of the curve minus the human mean [unit of the curve].
        distance: mean over the cycle of the distance from the human mean [standard deviations between people].
        inside: share of the cycle within one standard deviation of the human mean; 0.68 for people.
        inside_2: share of the cycle within two; 0.95 for people.
        peak_ratio: greatest magnitude of the curve over that of the human mean.
    """

    correlation: Array
    difference: Array
    rms: Array
    distance: Array
    inside: Array
    inside_2: Array
    peak_ratio: Array

    @staticmethod
    def of(strides: Array, people: Band) -> "Likeness":
        """Of a curve over strides, shape (strides, 101), and people's in the same unit."""
        apart = strides - people.mean
        distance = np.abs(apart) / people.sd
        swing, peoples = strides - strides.mean(axis=1, keepdims=True), people.mean - people.mean.mean()
        norms = np.linalg.norm(swing, axis=1) * np.linalg.norm(peoples)
        return Likeness(
            correlation=np.divide(swing @ peoples, norms, out=np.full(len(strides), np.nan), where=norms > 1e-6),
            difference=apart.mean(axis=1),
            rms=np.sqrt((apart**2).mean(axis=1)),
            distance=distance.mean(axis=1),
            inside=(distance <= 1.0).mean(axis=1),
            inside_2=(distance <= 2.0).mean(axis=1),
            peak_ratio=np.abs(strides).max(axis=1) / np.abs(people.mean).max(),
        )


def pooled(sides: Mapping[Side, Likeness], name: str) -> Array:
    """One attribute of the likeness of both legs' strides, shape (all strides,)."""
    return np.concatenate([getattr(likeness, name) for likeness in sides.values()])


@dataclass(frozen=True)
class Comparison:
    """A walk compared with human gait.

    Attributes:
        strides: their number, by leg.
        dimensionless_speed: mean speed of the strides over sqrt(g leg length).
        group: whose curves it is compared with.
        curves: agreement of each leg's strides by name of the curve in CURVES.
        measures: of steps, ground force, center of pressure, center of mass and effort.
        asymmetries: measures of both legs, by name.
        style: tag of the joint angles that the walker follows; None for a controller without steps and balance.
    """

    strides: Mapping[Side, int]
    dimensionless_speed: float
    group: SpeedGroup
    curves: Mapping[str, Mapping[Side, Likeness]]
    measures: tuple[Measure, ...]
    asymmetries: Mapping[str, Asymmetry]
    style: str | None = None

    def mean(self, curve: str, name: str) -> float:
        """Mean of an attribute of the likeness over the strides of both legs; those without a value do not count."""
        values = pooled(self.curves[curve], name)
        found = values[np.isfinite(values)]
        return float(found.mean()) if found.size else np.nan

    @property
    def score(self) -> float:
        """Share of the cycle within one standard deviation of people's mean, averaged over SCORED: 0 to 1."""
        return self._over_scored("inside")

    @property
    def distance(self) -> float:
        """Distance from people's mean, averaged over the cycle and SCORED [standard deviations between people]."""
        return self._over_scored("distance")

    def _over_scored(self, name: str) -> float:
        return float(np.mean([self.mean(curve, name) for curve in SCORED]))


def compare(signals: pa.Table, scenario: Scenario) -> Comparison:
    """Compare the steady part of a walk with human gait.

    Raises:
        ParameterError: fewer than MIN_STRIDES strides of a leg, or a walk that does not go straight ahead.
    """
    walk = Walk.of(signals, scenario)
    _require_walk(walk)
    pace = walk.pace
    curves = {
        name: {side: Likeness.of(walk.strides_of(name, side), curve.people(pace.group, pace.leg)) for side in walk.feet}
        for name, curve in CURVES.items()
    }
    return Comparison(
        strides={side: len(foot.strides) for side, foot in walk.feet.items()},
        dimensionless_speed=pace.dimensionless,
        group=pace.group,
        curves=curves,
        measures=tuple(kind.of_walk(walk) for kind in MEASURES),
        asymmetries=asymmetries(walk),
        style=scenario.controller.followed_style,
    )


def _require_walk(walk: Walk) -> None:
    counts = {side: len(foot.strides) for side, foot in walk.feet.items()}
    if min(counts.values()) < MIN_STRIDES:
        raise ParameterError(
            f"strides: {counts['Right']} of the right leg and {counts['Left']} of the left in the steady "
            f"walk, from {walk.begin:g} s on; allowed: from {MIN_STRIDES} of each on; walk longer at one speed"
        )
    for side, foot in walk.feet.items():
        places = matrix(walk.signals, [f"{side.lower()}_sole.{axis}_m" for axis in "xy"])
        ways = np.array([places[end] - places[begin] for begin, end in foot.strides])
        angle = float(np.abs(np.arctan2(ways[:, 1], ways[:, 0])).max())
        if angle > MAX_HEADING:
            raise ParameterError(
                f"strides: {np.degrees(angle):.0f} deg from straight ahead (x); allowed: up to "
                f"{np.degrees(MAX_HEADING):.0f} deg, as people's were measured; compare a straight walk"
            )
