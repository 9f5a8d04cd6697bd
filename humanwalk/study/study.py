"""The study: a base scenario, factors and a design. One dataclass is the file format.

    description: Step height against support force
    scenario: thesis
    set: {duration: 8}
    factors:
      controller.thesis.gait.path.step_height: {range: {low: 0.05, high: 0.25, number: 9}}
      seed: {seeds: {count: 5}}
    design: full_factorial

`scenario` is a shipped name, a path relative to the study file, or the fields of a scenario. Names of factors are
fields of the scenario as with `--set`; entries of lists are named by their index: `pushes.given.0.direction`.
"""

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from humanwalk.parameter_file import anchor_paths, build, dump, located, plain, read_fields, rebuild
from humanwalk.parameter_override import replace_value
from humanwalk.quantity import ParameterError, choice, choices_by_name, is_within, printable
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios
from humanwalk.shipped_files import named_file, shipped_files
from humanwalk.study.design import DESIGNS, Design, FullFactorial, Point
from humanwalk.study.factors import FACTORS, Factor, Values
from humanwalk.yaml_text import index_of, read_yaml, shown

Keep = Literal["summary", "runs"]


@dataclass(frozen=True)
class Study:
    """Runs of one scenario that differ in factors."""

    description: str = ""
    """One line for people."""

    scenario: Scenario = Scenario()
    """What the runs have in common."""

    set: Mapping[str, Any] = field(default_factory=dict)
    """Fields of the scenario that are replaced in every run, by dotted name."""

    factors: Mapping[str, Factor] = choices_by_name(FACTORS)
    """What differs between the runs, by dotted name of the field."""

    design: Design = choice(DESIGNS, FullFactorial())
    """How factors are combined."""

    keep: Keep = "summary"
    """`summary`: one row of the table for each run. `runs`: also the run folders, without replay and plots."""

    @cached_property
    def points(self) -> Sequence[Point]:
        """The points of the design; the index of a point is that of its row in the table.

        Raises:
            ParameterError: the factors do not fit the design, or are too many points.
        """
        return self.design.points(self.factors)

    @cached_property
    def base(self) -> dict[str, Any]:
        """The scenario with `set` as a mapping, every field written out."""
        data = plain(self.scenario)
        for name, value in self.set.items():
            replace_value(Scenario, data, name, value)
        return data

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Names of the factors, or with the design `rows` of the file's columns."""
        return tuple(dict.fromkeys([*self.factors, *(name for point in self.points for name in point)]))

    def value_at(self, point: Point, name: str) -> Any:
        """Value of a factor at a point; that of the scenario where the point has none, None for no variant."""
        if name in point:
            return point[name]
        value: Any = self.base
        for part in name.split("."):
            key: Any = index_of(part) if isinstance(value, list) else part
            try:
                value = value[key]
            except (KeyError, IndexError, TypeError):
                return None
        return value

    def overrides(self, point: Point) -> dict[str, Any]:
        """Values of scenario fields at a point, by dotted name.

        Raises:
            ParameterError: a factor replaces what one before it has set; the table would name a value that is not used.
        """
        values: dict[str, Any] = {}
        for name, level in point.items():
            own = self.factors.get(name, _FIELD).overrides(name, level)
            lost = next((earlier for earlier in values for field in own if is_within(earlier, field)), None)
            if lost is not None:
                raise ParameterError(
                    f"factors: {name} replaces {lost}, which a factor before it sets; allowed: each field once, or a "
                    "group before a field in it; change the order, or remove one"
                )
            values |= own
        return values

    def scenario_at(self, point: Point) -> Scenario:
        """The scenario of a run.

        Raises:
            ParameterError: a value that cannot be used; the message begins with the values of the point, if it has any.
        """
        try:
            data, values = dict(self.base), self.overrides(point)
            for name, value in values.items():
                replace_value(Scenario, data, name, value)
            sections = {name.partition(".")[0] for name in (*self.set, *values)}
            return rebuild(self.scenario, {name: data[name] for name in data if name in sections})
        except ParameterError as error:
            at = ", ".join(f"{name}: {shown(value)}" for name, value in point.items())
            raise ParameterError(f"point ({printable(at, 300)}): {error}" if at else str(error)) from None

    def scenarios(self) -> Iterator[Scenario]:
        """The scenarios of all points in order; see `scenario_at`."""
        return map(self.scenario_at, self.points)

    def require_valid(self) -> None:
        """Raise ParameterError for the first point whose scenario cannot be used; see `scenario_at`."""
        _ = self.warnings

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of the scenarios, each with the number of points that have it; see `Scenario.warnings`.

        Raises:
            ParameterError: as `require_valid`.
        """
        counts = Counter(line for scenario in self.scenarios() for line in scenario.warnings)
        return tuple(f"{line} ({count} of {len(self.points)} points)" for line, count in counts.items())


_FIELD = Values((None,))
"""Stands for a column of the design `rows`: a field of the scenario."""


def shipped_studies() -> dict[str, Path]:
    """Files of the studies that come with humanwalk, by name."""
    return shipped_files("studies")


def load_study(name_or_path: str | Path) -> Study:
    """Load a shipped study by name, or any study by the path of its file.

    Raises:
        ParameterError: no such study, not a study, or a value that cannot be used; one line.
    """
    path = named_file("study", name_or_path, shipped_studies())
    return parse_study(read_fields(path), path.name, path.parent)


def parse_study(text: str, name: str = "study", folder: Path = Path()) -> Study:
    """Study from YAML text; relative paths in it count from `folder`. See `load_study`."""
    data = complete(read_yaml(text, name), folder)
    with located(text, name):
        return build(Study, data)


def complete(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The mapping of a study file without shorthands; relative paths in it count from `folder`."""
    folder = Path(os.path.abspath(folder))
    anchor_paths(Study, data, folder)
    scenario = data.get("scenario")
    if isinstance(scenario, str):
        data["scenario"] = plain(load_scenario(scenario if scenario in shipped_scenarios() else folder / scenario))
    factors = data.get("factors")
    if isinstance(factors, dict):
        # The shorthand for a list of values.
        data["factors"] = {
            key: {"values": entry} if isinstance(entry, list) else entry for key, entry in factors.items()
        }
    return data


def dump_study(study: Study) -> str:
    """The complete study as YAML, every field written out; `parse_study` reads it back to an equal one."""
    return dump(study)
