"""Statistics of the rows of a study: survival with its confidence interval, spread of measures, effects of factors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np
from scipy import stats

from humanwalk.numerics import Array, Indices, Mask, Texts

CONFIDENCE = 0.95
"""Of the interval of survival."""

SIGNIFICANCE = 0.05
"""Probability of a share of variance at least as great without an effect, below which an effect is not chance."""

FactorArray = Array | Texts
"""Values of a factor, one a row, shape (rows,): floats or texts."""

MAX_LEVELS = 25
"""Most distinct values of a factor that are levels of their own; more are put into classes."""

CLASSES = 6
"""Number of classes otherwise."""


@dataclass(frozen=True)
class Survival:
    """Number of rows that survived, and the share with its interval.

    Attributes:
        survived: rows that completed their duration.
        runs: all rows.
        low, high: Wilson score interval of the share at CONFIDENCE: Wilson (1927), J. Am. Stat. Assoc. 22(158) 209-212.
    """

    survived: int
    runs: int
    low: float
    high: float

    @property
    def share(self) -> float:
        """Share of the rows that survived."""
        return self.survived / self.runs

    @staticmethod
    def of(survived: Mask) -> "Survival":
        """Survival of at least one row, shape (rows,)."""
        count, runs = int(np.sum(survived)), len(survived)
        interval = stats.binomtest(count, runs).proportion_ci(CONFIDENCE, method="wilson")
        return Survival(count, runs, float(interval.low), float(interval.high))


@dataclass(frozen=True)
class Spread:
    """Mean, standard deviation and quantiles of a measure; values that are not finite do not count."""

    count: int
    mean: float
    standard_deviation: float
    percentile_5: float
    median: float
    percentile_95: float

    @property
    def numbers(self) -> tuple[float, ...]:
        """Mean, standard deviation, 5th percentile, median and 95th percentile."""
        return (self.mean, self.standard_deviation, self.percentile_5, self.median, self.percentile_95)

    @staticmethod
    def of(values: Array) -> "Spread | None":
        """Spread of values, shape (n,); None without a finite one. The standard deviation of one value is NaN."""
        finite = values[np.isfinite(values)]
        if not finite.size:
            return None
        deviation = finite.std(ddof=1) if finite.size > 1 else math.nan
        return Spread(finite.size, *map(float, (finite.mean(), deviation, *np.percentile(finite, (5, 50, 95)))))


@dataclass(frozen=True)
class Level:
    """Rows with the same value of a factor, or with values of the same class.

    Attributes:
        label: the value, or the ends of the class.
        position: on an axis: the value, the mean of the class, or the place of a text among the others.
        rows: indices of the rows, increasing.
    """

    label: str
    position: float
    rows: Indices


def factor_array(values: Sequence[Any]) -> FactorArray:
    """Values of a factor as floats if all are numbers, else as texts; true and false are texts."""
    numeric = all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)
    return np.array(values, dtype=float) if numeric else np.array([str(value) for value in values])


def is_numeric(values: FactorArray) -> TypeGuard[Array]:
    """Whether the values of a factor are numbers."""
    return values.dtype.kind == "f"


def levels_of(values: FactorArray, classes: int = CLASSES) -> list[Level]:
    """Levels of a factor: its distinct values, numbers in order and texts by their first row.

    Numbers that are samples are put into classes of about equal size instead: more than MAX_LEVELS distinct numbers,
    or more than `classes` of which most come once.

    Args:
        values: shape (rows,), from `factor_array`.
        classes: their number.
    """
    if not is_numeric(values):
        names = dict.fromkeys(values.tolist())
        return [Level(name, float(place), np.flatnonzero(values == name)) for place, name in enumerate(names)]
    distinct = np.unique(values)
    if distinct.size <= (MAX_LEVELS if 2 * distinct.size <= values.size else classes):
        return [Level(f"{value:.4g}", float(value), np.flatnonzero(values == value)) for value in distinct]
    edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, classes + 1)[1:-1]))
    places = np.searchsorted(edges, values, side="right")
    return [_class(values, np.flatnonzero(places == place)) for place in np.unique(places)]


def _class(numbers: Array, rows: Indices) -> Level:
    inside = numbers[rows]
    return Level(f"{inside.min():.3g} to {inside.max():.3g}", float(inside.mean()), rows)


@dataclass(frozen=True)
class Effect:
    """Effect of one factor on a measure.

    Attributes:
        factor: its name.
        share: share of the measure's variance that is between the levels of the factor, from 0 to 1; of independent
            factors it is the first-order Sobol index.
        p_value: probability of at least this share if the factor has no effect, by the F-test, which assumes the same
            variance on every level.
        rank_correlation: Spearman's, from -1 to 1; not a number for a factor of texts.
    """

    factor: str
    share: float
    p_value: float
    rank_correlation: float

    @property
    def significant(self) -> bool:
        """Whether the share is greater than chance explains."""
        return self.p_value < SIGNIFICANCE


def varies(values: Array) -> bool:
    """Whether finite values differ by more than rounding, which alone makes a constant vary."""
    return bool(values.size and np.ptp(values) > 1e-9 * np.abs(values).max())


def ranked_effects(factors: Mapping[str, FactorArray], measure: Array) -> list[Effect]:
    """Effects of factors on a measure, the greatest first.

    The share of variance is Pearson's correlation ratio eta^2 = SS_between / SS_total over the levels of a factor. It
    is the first-order Sobol index estimated from any sample of independent factors (Plischke, Borgonovo, Smith (2013),
    Eur. J. Oper. Res. 226(3) 536-550), does not need a straight or monotonic relation, and takes texts. Kelley's
    correction (1935, PNAS 21(9) 554-559) removes what M levels of N rows explain by chance:
    epsilon^2 = 1 - (1 - eta^2) (N - 1) / (N - M), not below 0.

    Args:
        factors: values by name, each of shape (rows,), from `factor_array`.
        measure: values, shape (rows,); rows that are not finite do not count.

    Returns:
        One effect for each factor that varies; none where the measure does not vary.
    """
    finite = np.flatnonzero(np.isfinite(measure))
    y = measure[finite]
    if y.size < 3 or not varies(y):
        return []
    effects = (_effect(name, values[finite], y) for name, values in factors.items())
    return sorted((effect for effect in effects if effect is not None), key=lambda effect: -effect.share)


def _effect(name: str, values: FactorArray, y: Array) -> Effect | None:
    # Rice's rule for the number of classes.
    levels = levels_of(values, round(2.0 * len(values) ** (1.0 / 3.0)))
    n, m = y.size, len(levels)
    if m < 2 or m == n:
        return None
    means = np.array([y[level.rows].mean() for level in levels])
    sizes = np.array([level.rows.size for level in levels])
    between = sizes @ (means - y.mean()) ** 2
    within = sum(((y[level.rows] - mean) ** 2).sum() for level, mean in zip(levels, means, strict=True))
    unexplained = within / (between + within)
    share = max(0.0, 1.0 - unexplained * (n - 1) / (n - m))
    ratio = (between / (m - 1)) / (within / (n - m)) if within > 0.0 else np.inf
    correlation = float(stats.spearmanr(values, y).statistic) if is_numeric(values) else math.nan
    return Effect(name, float(share), float(stats.f.sf(ratio, m - 1, n - m)), correlation)
