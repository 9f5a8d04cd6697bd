"""Objectives and bounds of a tuning: one number each of the measures of a trial's runs, and the score that a search
compares.

A trial is a list of runs in a fixed order. After some of them have fallen the rest is not simulated. Measures of falls
(`NOT_SIMULATED`) count over all runs; every other measure counts over the runs that survived.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from humanwalk.quantity import ParameterError, quantity
from humanwalk.study.design import Point
from humanwalk.study.row import Row

NOT_SIMULATED = {"survived": 0.0, "upright_share": 0.0, "pushes_survived_share": 0.0}
"""Measures of falls: they count over all runs of a trial, with these values for the ones that were not simulated."""

NO_LIMIT = 1e9
"""A bound without limit on that side."""

FALLEN_COST = 1000.0
"""Cost of a trial that was upright to the end but has no value for an objective or bound; one that falls at once costs
twice as much, and a trial with all values has to cost less."""

AGGREGATES: dict[str, Callable[[Sequence[float]], float]] = {
    "mean": lambda values: float(np.mean(values)),
    "max": max,
    "min": min,
}
"""How the values of several runs become one number."""


@dataclass(frozen=True)
class Measured:
    """A measure over the runs of a trial."""

    measure: str = ""
    """Column of a study's table: cost_of_transport, upright_share, peak_torque_N_m.<joint>. Empty: the name under which
    this stands in the file."""

    over: Literal["mean", "max", "min"] = "mean"
    """How the values of several runs become one; the share of runs that survived is the mean of `survived`."""

    runs: Mapping[str, str] = field(default_factory=dict)
    """Only the runs with these levels of factors count. Empty: all."""

    def counts(self, point: Point) -> bool:
        """Whether the run at a point counts."""
        return all(str(point.get(factor)) == level for factor, level in self.runs.items())


@dataclass(frozen=True)
class Objective(Measured):
    """A measure to minimize or to maximize."""

    goal: Literal["minimize", "maximize"] = "minimize"

    weight: float = quantity(1.0, "", 1e-9, 1e9)
    """Weight in the cost of a search with one goal; nsga2 does not weight objectives against each other."""

    def loss(self, value: float) -> float:
        """The value with the sign with which it is to be minimized."""
        return value if self.goal == "minimize" else -value


@dataclass(frozen=True)
class Bound(Measured):
    """Limits of a measure: a penalty in the cost of cma_es, a constraint of nsga2."""

    low: float = quantity(-NO_LIMIT, "", -NO_LIMIT, NO_LIMIT)
    high: float = quantity(NO_LIMIT, "", -NO_LIMIT, NO_LIMIT)
    penalty: float = quantity(10.0, "", 0.0, 1e9)
    """Cost per unit of the measure beyond a limit."""

    def __post_init__(self) -> None:
        """Raise ParameterError without a limit, and unless low <= high."""
        if self.low <= -NO_LIMIT and self.high >= NO_LIMIT:
            raise ParameterError("low: no limit, and no high; allowed: low, high or both; write one of them")
        if self.low > self.high:
            raise ParameterError(f"low: {self.low:g} is above high; allowed: up to {self.high:g}; swap them")

    @property
    def allowed(self) -> str:
        """The allowed range as text."""
        low, high = (f"{limit:g}" if abs(limit) < NO_LIMIT else "" for limit in (self.low, self.high))
        return f"{low} to {high}" if low and high else f"from {low}" if low else f"up to {high}"

    def violation(self, value: float) -> float:
        """Distance from the allowed range; 0 within."""
        return max(self.low - value, value - self.high, 0.0)


@dataclass(frozen=True)
class Score:
    """What a search compares.

    Attributes:
        losses: of every objective, to be minimized.
        violations: constraints by name, satisfied at 0: of every bound, and `unfinished`, which is 0 if there are
            all values, else 1 for a trial that was upright to its end, up to 2 for one that fell at once.
        cost: weighted sum of the losses and penalties.
    """

    losses: tuple[float, ...]
    violations: Mapping[str, float]
    cost: float

    @property
    def feasible(self) -> bool:
        """Whether every bound holds, and there are all values."""
        return not any(self.violations.values())


def measured(name: str, what: Measured, points: Sequence[Point], rows: Sequence[Row | None]) -> float | None:
    """A measure over the runs of a trial.

    Args:
        name: of the objective or bound.
        what: which measure, over which runs.
        points: levels of the factors of every run of the trial.
        rows: measures of every run; None for one that was not simulated.

    Returns:
        The value; None where no run that counts has survived with a value.
    """
    column = what.measure or name
    counted = [row for point, row in zip(points, rows, strict=True) if what.counts(point)]
    if column in NOT_SIMULATED:
        values = [NOT_SIMULATED[column] if row is None else row[column] for row in counted]
    else:
        values = [row[column] for row in counted if row is not None and row["survived"] and row[column] is not None]
    return AGGREGATES[what.over]([float(value) for value in values]) if values else None


def score(
    objectives: Mapping[str, Objective], bounds: Mapping[str, Bound], values: Mapping[str, float | None], upright: float
) -> Score:
    """The score of a trial.

    Args:
        objectives, bounds: by name.
        values: of all of them by name.
        upright: share of the time of all runs of the trial until their falls.
    """
    unfinished = 2.0 - upright if None in values.values() else 0.0
    violations = {name: 0.0 if (v := values[name]) is None else bound.violation(v) for name, bound in bounds.items()}
    penalty = sum(bounds[name].penalty * violation for name, violation in violations.items())
    violations["unfinished"] = unfinished
    if unfinished:
        return Score((FALLEN_COST * unfinished,) * len(objectives), violations, FALLEN_COST * unfinished + penalty)
    losses = {name: objective.loss(values[name] or 0.0) for name, objective in objectives.items()}
    cost = sum(objectives[name].weight * loss for name, loss in losses.items()) + penalty
    return Score(tuple(losses.values()), violations, cost)
