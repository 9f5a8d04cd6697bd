"""A tuning as data: the runs of one trial, the parameters with their ranges, the objectives, and how it is searched.

    runs:
      scenario: walk
      set: {duration: 9.0}
    parameters:
      controller.balanced.planner.dcm_gain: {low: 0.5, high: 2.0}
    objectives:
      cost_of_transport: {}
    bounds:
      upright_share: {low: 1.0}

A search starts from the values of the scenario.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from humanwalk.parameter_file import build, dump, located, read_fields
from humanwalk.quantity import REQUIRED, ParameterError, did_you_mean, quantity
from humanwalk.scenario import Scenario
from humanwalk.shipped_files import named_file, shipped_files
from humanwalk.study.design import Rows
from humanwalk.study.objectives import Bound, Measured, Objective
from humanwalk.study.row import run_columns
from humanwalk.study.study import Study, complete
from humanwalk.study.table import NOT_REPRODUCED
from humanwalk.study.trial import OF_RUNS
from humanwalk.yaml_text import read_yaml, shown

DIGITS = 6
"""Significant digits of a parameter: more than a gain needs, and few enough to be read."""

MAX_TRIALS = 100_000


@dataclass(frozen=True)
class Range:
    """Where a parameter may lie."""

    low: float = quantity(REQUIRED, "", -1e9, 1e9)
    high: float = quantity(REQUIRED, "", -1e9, 1e9)

    log: bool = False
    """Whether its logarithm is searched: for weights and stiffnesses, whose order of magnitude counts."""

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise ParameterError(f"high: {self.high:g} is not above low; allowed: above {self.low:g}; swap them")
        if self.log and self.low <= 0.0:
            raise ParameterError(f"low: {self.low:g} has no logarithm; allowed: above 0; set log: false")

    def value(self, coordinate: float, start: float) -> float:
        """The parameter at a coordinate of the search: `low` at -1, `start` at 0, `high` at 1, linear in between."""
        scale, inverse = (math.log, math.exp) if self.log else (float, float)
        origin, end = scale(start), scale(self.low if coordinate < 0.0 else self.high)
        value = inverse(origin + abs(coordinate) * (end - origin))
        return min(max(float(f"{value:.{DIGITS}g}"), self.low), self.high)


@dataclass(frozen=True)
class Tuning:
    """A search for parameters of a scenario."""

    description: str = ""
    """One line for people."""

    runs: Study = Study()
    """The runs of one trial, in the order in which they are simulated."""

    parameters: Mapping[str, Range] = field(default_factory=dict)
    """Fields of the scenario that are searched, by dotted name as in --set."""

    objectives: Mapping[str, Objective] = field(default_factory=dict)
    """What is minimized or maximized."""

    bounds: Mapping[str, Bound] = field(default_factory=dict)
    """What has to hold."""

    sampler: Literal["cma_es", "nsga2"] = "cma_es"
    """CMA-ES minimizes the weighted sum of the objectives; NSGA-II looks for the Pareto front of several."""

    seed: int = quantity(0, "", 0, 2**32 - 1)
    """Of the sampler."""

    trials: int = quantity(200, "", 1, MAX_TRIALS)
    """Number of trials, the first of which is the scenario itself."""

    population: int = quantity(12, "", 4, 1000)
    """Trials that are asked for at once: a multiple of the number of workers keeps all of them busy."""

    falls: int = quantity(1, "", 1, 1000)
    """Number of falls after which the remaining runs of a trial are not simulated."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a tuning without parameters or objectives, and for measures that cannot be used."""
        if not self.parameters:
            raise ParameterError("parameters: empty; allowed: from one field on; write FIELD: {low: 0.5, high: 2.0}")
        if not self.objectives:
            raise ParameterError("objectives: empty; allowed: from one measure on; write cost_of_transport: {}")
        _require_searchable(self.runs, self.parameters)
        for name in self.objectives.keys() & self.bounds.keys():
            raise ParameterError(f"bounds.{name}: is an objective too; allowed: one use of a name; rename one of them")
        for group, entries in (("objectives", self.objectives), ("bounds", self.bounds)):
            for name, what in entries.items():
                _require_measure(f"{group}.{name}", what.measure or name)
                if not any(what.counts(point) for point in self.runs.points):
                    raise ParameterError(
                        f"{group}.{name}.runs: no run of a trial has {shown(dict(what.runs))}; allowed: levels of the "
                        f"factors {', '.join(self.runs.columns)}; correct them"
                    )

    @property
    def measured(self) -> Mapping[str, Measured]:
        """Objectives and bounds by name."""
        return {**self.objectives, **self.bounds}

    def values_at(self, coordinates: Mapping[str, float], starts: Mapping[str, float]) -> dict[str, float]:
        """The parameters at coordinates of the search."""
        return {name: self.parameters[name].value(at, starts[name]) for name, at in coordinates.items()}

    def with_values(self, values: Mapping[str, float]) -> Study:
        """The runs of a trial with these values of the parameters."""
        return replace(self.runs, set={**self.runs.set, **values})

    def scenario(self, values: Mapping[str, float]) -> Scenario:
        """The scenario of a trial without the factors of its runs."""
        return self.with_values(values).scenario_at({})


def _require_searchable(runs: Study, parameters: Mapping[str, Range]) -> None:
    """Raise ParameterError for runs that read or keep files, and for a parameter that a factor replaces."""
    if isinstance(runs.design, Rows):
        raise ParameterError("runs.design: rows reads another file; allowed: other designs; write factors")
    if runs.keep != "summary":
        raise ParameterError("runs.keep: a tuning keeps no run folders; allowed: summary; remove it")
    replaced = {f"{name}." for point in runs.points for name in runs.overrides(point)}
    for name in parameters:
        for factor in replaced:
            if f"{name}.".startswith(factor):
                raise ParameterError(
                    f"parameters.{name}: a factor of the runs replaces {factor[:-1]}; allowed: fields that no factor "
                    "replaces; remove one of both"
                )


def _require_measure(place: str, measure: str) -> None:
    numbers = {name for name, kind in run_columns().items() if kind is not str and name not in NOT_REPRODUCED}
    numbers |= OF_RUNS.keys()
    if measure not in numbers:
        raise ParameterError(
            f"{place}: {measure} is not a measure of a run that repeats; allowed: measured numbers in the table of a "
            f"study, and {', '.join(OF_RUNS)}{did_you_mean(measure, tuple(numbers))}"
        )


def start_values(tuning: Tuning) -> dict[str, float]:
    """The scenario's own values of the parameters.

    Raises:
        ParameterError: it has no such field, the field is no number with decimals, or its value or an end of the
            range cannot be used.
    """
    starts = {name: _start_value(name, tuning.runs.base, limits) for name, limits in tuning.parameters.items()}
    tuning.runs.require_valid()
    for name, limits in tuning.parameters.items():
        for end in (limits.low, limits.high):
            tuning.scenario(starts | {name: end})
    return starts


def _start_value(name: str, scenario: Any, limits: Range) -> float:
    value = scenario
    for key in name.split("."):
        entries = dict(enumerate(value)) if isinstance(value, list) else value if isinstance(value, dict) else {}
        found = {str(entry): inner for entry, inner in entries.items()}
        if key not in found:
            raise ParameterError(
                f"parameters.{name}: the scenario has no {key} there; allowed: {', '.join(found) or 'nothing'}"
                f"{did_you_mean(key, tuple(found))}"
            )
        value = found[key]
    if not isinstance(value, float):
        raise ParameterError(
            f"parameters.{name}: {shown(value)} is not a number with decimals; allowed: a field that is; choose another"
        )
    if not limits.low < value < limits.high:
        raise ParameterError(
            f"parameters.{name}: the scenario's {value:g} is not within {limits.low:g} to {limits.high:g}; "
            "allowed: a range around it, for the search starts there; widen the range"
        )
    return value


def shipped_tunings() -> dict[str, Path]:
    """Files of the tunings that come with humanwalk, by name."""
    return shipped_files("tunings")


def load_tuning(name_or_path: str | Path) -> Tuning:
    """Load a shipped tuning by name, or any tuning by the path of its file.

    Raises:
        ParameterError: no such tuning, not a tuning, or a value that cannot be used; one line.
    """
    path = named_file("tuning", name_or_path, shipped_tunings())
    return parse_tuning(read_fields(path), path.name, path.parent)


def parse_tuning(text: str, name: str = "tuning", folder: Path = Path()) -> Tuning:
    """Tuning from YAML text; relative paths in it count from `folder`. See `load_tuning`."""
    data = read_yaml(text, name)
    if isinstance(data.get("runs"), dict):
        data["runs"] = complete(data["runs"], folder)
    with located(text, name):
        tuning = build(Tuning, data)
        start_values(tuning)
    return tuning


def dump_tuning(tuning: Tuning) -> str:
    """The complete tuning as YAML."""
    return dump(tuning)
