"""Factors of a study: what differs between its runs.

A factor has the name of a field of the scenario, as with `--set`; only `variants` has a name of its own choice. Each
gives levels to designs that combine them, and quantiles to designs that sample; a factor without levels or quantiles
raises ParameterError.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import truncnorm

from humanwalk.numerics import Array
from humanwalk.quantity import REQUIRED, ParameterError, did_you_mean, only, printable, quantity
from humanwalk.yaml_text import shown

MAX_LEVELS = 100_000

SIGNIFICANT_DIGITS = 12
"""Levels of ranges are rounded: 0.15, not 0.15000000000000002."""


@dataclass(frozen=True)
class Factor:
    """What differs between the runs of a study."""

    def levels(self) -> Sequence[Any]:
        """The values in order.

        Raises:
            ParameterError: a distribution, which has none.
        """
        raise ParameterError(
            "a distribution has no levels; allowed: with design latin_hypercube or sobol; choose one of them, or a "
            "range or list"
        )

    def level_count(self) -> int:
        """Number of levels, known before they are made; raises as `levels`."""
        return len(self.levels())

    def quantiles(self, shares: Array) -> list[Any]:
        """The values below which shares u, 0 <= u < 1, of all values are; each level has an equal share."""
        levels = self.levels()
        return [levels[min(int(u * len(levels)), len(levels) - 1)] for u in shares.tolist()]

    def overrides(self, name: str, level: Any) -> Mapping[str, Any]:
        """Values of scenario fields by dotted name, for a level of the factor `name`."""
        return {name: level}


@dataclass(frozen=True)
class Values(Factor):
    """A list of values: `[0.1, 0.2]` or `{values: [0.1, 0.2]}`."""

    values: tuple[Any, ...] = only()

    def __post_init__(self) -> None:
        """Raise ParameterError for an empty list, and for a value that comes twice: its runs would be the same."""
        if not self.values:
            raise ParameterError("no values; allowed: one or more; write a list of them")
        for index, value in enumerate(self.values):
            if value in self.values[:index]:
                raise ParameterError(f"{shown(value)} comes twice; allowed: every value once; remove one")

    def levels(self) -> Sequence[Any]:
        return self.values


@dataclass(frozen=True)
class Uniform(Factor):
    """A uniform distribution between low and high."""

    low: float
    high: float

    def __post_init__(self) -> None:
        """Raise ParameterError unless low < high."""
        _require_order(self.low, self.high)

    def quantiles(self, shares: Array) -> list[Any]:
        return [self.low + u * (self.high - self.low) for u in shares.tolist()]


@dataclass(frozen=True)
class Range(Uniform):
    """Equally spaced numbers from low to high; samples are uniformly distributed between them."""

    number: int = quantity(5, "", 2, MAX_LEVELS)

    def levels(self) -> Sequence[Any]:
        return _rounded(np.linspace(self.low, self.high, self.number))

    def level_count(self) -> int:
        return self.number


@dataclass(frozen=True)
class LogRange(Factor):
    """Positive numbers from low to high with equal ratios; samples have uniformly distributed logarithms."""

    low: float
    high: float
    number: int = quantity(5, "", 2, MAX_LEVELS)

    def __post_init__(self) -> None:
        """Raise ParameterError unless 0 < low < high."""
        _require_order(self.low, self.high)
        if self.low <= 0.0:
            raise ParameterError(f"low: {self.low:g} is out of range; allowed: above 0; write a positive number")

    def levels(self) -> Sequence[Any]:
        return _rounded(np.geomspace(self.low, self.high, self.number))

    def level_count(self) -> int:
        return self.number

    def quantiles(self, shares: Array) -> list[Any]:
        return [float(self.low * (self.high / self.low) ** u) for u in shares.tolist()]


@dataclass(frozen=True)
class Normal(Factor):
    """A normal distribution, truncated to low and high where these are given."""

    mean: float
    standard_deviation: float = quantity(REQUIRED, "", 1e-12, 1e12)
    low: float = -math.inf
    high: float = math.inf

    def __post_init__(self) -> None:
        """Raise ParameterError unless low < high and the bounds leave a part of the distribution."""
        if not math.isfinite(self.mean):
            raise ParameterError(f"mean: {self.mean:g} is out of range; allowed: finite numbers; write one")
        if not self.low < self.high:
            raise ParameterError(f"low: {self.low:g} is not below high: {self.high:g}; write the smaller number as low")
        if self.standard_deviation > 0.0 and not math.isfinite(*self.quantiles(np.array([0.5]))):
            raise ParameterError(
                f"low: {self.low:g} and high: {self.high:g} leave nothing of the distribution; allowed: bounds within "
                "some standard deviations of the mean; move them"
            )

    def quantiles(self, shares: Array) -> list[Any]:
        a, b = ((bound - self.mean) / self.standard_deviation for bound in (self.low, self.high))
        # Without a bound there is no smallest value.
        values = truncnorm.ppf(np.maximum(shares, 1e-12), a, b, loc=self.mean, scale=self.standard_deviation)
        return [float(value) for value in values]


@dataclass(frozen=True)
class Seeds(Factor):
    """Consecutive whole numbers; the factor's name is `seed`."""

    first: int = quantity(0, "", 0, 2**32 - 1)
    count: int = quantity(10, "", 1, MAX_LEVELS)

    def levels(self) -> Sequence[Any]:
        return range(self.first, self.first + self.count)


@dataclass(frozen=True)
class Variants(Factor):
    """Named sets of overrides, each of several fields: `{variants: {none: {}, front: {pushes.given: [...]}}}`."""

    variants: Mapping[str, Mapping[str, Any]] = only()

    def __post_init__(self) -> None:
        """Raise ParameterError without variants."""
        if not self.variants:
            raise ParameterError("no variants; allowed: one or more; write name: {field: value, ...}")

    def levels(self) -> Sequence[Any]:
        return tuple(self.variants)

    def overrides(self, name: str, level: Any) -> Mapping[str, Any]:
        """The overrides of a variant.

        Raises:
            ParameterError: there is no such variant.
        """
        if not isinstance(level, str) or level not in self.variants:
            raise ParameterError(
                f"{name}: {printable(level, 40)} is unknown; allowed: {', '.join(self.variants)}"
                f"{did_you_mean(str(level), tuple(self.variants))}"
            )
        return self.variants[level]


FACTORS: dict[str, type[Factor]] = {
    "values": Values,
    "range": Range,
    "log_range": LogRange,
    "uniform": Uniform,
    "normal": Normal,
    "seeds": Seeds,
    "variants": Variants,
}
"""The kinds of factors that a study file can name."""


def _require_order(low: float, high: float) -> None:
    if not (math.isfinite(low) and math.isfinite(high) and low < high and math.isfinite(high - low)):
        raise ParameterError(
            f"low: {low:g} and high: {high:g} are no range; allowed: finite numbers, low below high; correct them"
        )


def _rounded(values: Any) -> tuple[float, ...]:
    return tuple(float(f"{value:.{SIGNIFICANT_DIGITS}g}") for value in values)
