"""The finished rows of a study by what they are: factors that vary, survival, measures with units."""

import json
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from humanwalk.measures.signals import UNIT, unit_of
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import ParameterError, near_names, numbers_of, printable
from humanwalk.study.row import has_result, run_columns
from humanwalk.study.statistics import FactorArray, factor_array, is_numeric, varies
from humanwalk.study.study import Study
from humanwalk.study.table import ROW, read_study, read_table

SEED = "seed"
"""The factor whose levels are repetitions."""

USUAL_MEASURES = (
    "mean_speed_m_s",
    "path_deviation_m",
    "cost_of_transport",
    "support_force_rms_N",
    "support_torque_rms_N_m",
)
"""What is shown of a study that does not name measures."""

SURVIVAL = "survived"
"""The measure that every row has."""

MAX_ENDS = 12

MAX_MAGNITUDE = 1e100
"""Numbers from this on are left out: sums of their squares would overflow. No run gives one; a changed table may."""

AS_IN_SCENARIO = "as in the scenario"
"""Level of a row that has no variant."""


@dataclass(frozen=True)
class Results:
    """The rows of a study.

    Attributes:
        name: of the study.
        study: what was simulated.
        table: the rows with a result in the order of the points, at least one.
    """

    name: str
    study: Study
    table: pa.Table

    @staticmethod
    def read(folder: Path) -> "Results":
        """The results in the folder of a study.

        Raises:
            ParameterError: the folder holds no study, its table was changed, or no run has finished.
        """
        study, table = read_study(folder), read_table(folder)
        table = table.filter(pa.array([has_result(end) for end in table["end"].to_pylist()], pa.bool_()))
        if not table.num_rows:
            raise ParameterError(f"{printable(folder)}: no run has finished; allowed: one or more; run the study first")
        return Results(printable(folder.resolve().name), study, table)

    @cached_property
    def factors(self) -> dict[str, FactorArray]:
        """Values of every factor that varies, one a row, by name.

        The seed only repeats and is left out, as are numbers that rise or fall with those of another factor in every
        row: their effects cannot be told apart.
        """
        return {name: values for name, values in self._varying.items() if name not in self._followers}

    @cached_property
    def _varying(self) -> dict[str, FactorArray]:
        points = [self.study.points[row] for row in self.table[ROW].to_pylist()]
        columns = {
            name: factor_array([_level(self.study.value_at(point, name)) for point in points])
            for name in self.study.columns
            if name != SEED
        }
        return {name: values for name, values in columns.items() if (values != values[0]).any()}

    @cached_property
    def _followers(self) -> dict[str, str]:
        """The factor of which each factor that is left out is a monotonic function."""
        leaders: dict[bytes, str] = {}
        followers = {}
        for name, values in self._varying.items():
            if is_numeric(values) and (leader := leaders.setdefault(_order(values), name)) != name:
                followers[name] = leader
        return followers

    @cached_property
    def survived(self) -> Mask:
        """Whether each row completed its duration."""
        return np.array(self.table[SURVIVAL].to_pylist(), dtype=bool)

    def measure(self, name: str) -> Array:
        """A measure of the rows that survived, not a number where a row does not have it; or SURVIVAL of all [%]."""
        if name == SURVIVAL:
            return np.where(self.survived, 100.0, 0.0)
        values = np.array([np.nan if value is None else value for value in self.table[name].to_pylist()], dtype=float)
        return np.where(self.survived & (np.abs(values) < MAX_MAGNITUDE), values, np.nan)

    def measures(self, names: Sequence[str] = ()) -> list[str]:
        """Columns of measures by name, with or without unit; without names the usual ones that vary.

        Raises:
            ParameterError: there is no such measure.
        """
        return [self._measure_of(name) for name in names] or [name for name in USUAL_MEASURES if self.varies(name)]

    def _measure_of(self, name: str) -> str:
        columns = [column for column, kind in run_columns().items() if kind is not str]
        for column in columns:
            if name in (column, _without_units(column)):
                return column
        wanted, allowed = f"--measure {printable(name)}", "allowed: measured numbers in table.csv"
        if name in self.table.column_names:
            raise ParameterError(
                f"{wanted}: no such measure, the column has no measured numbers; {allowed}, like "
                f"{', '.join(USUAL_MEASURES)}"
            )
        raise ParameterError(f"{wanted}: no such measure; {allowed}{near_names(name, columns)}")

    def varies(self, name: str) -> bool:
        """Whether a measure differs between rows by more than rounding."""
        values = self.measure(name)
        return varies(values[np.isfinite(values)])

    @cached_property
    def _units(self) -> dict[str, str]:
        point = self.study.points[0]
        return {name: metadata["unit"] for name, _, metadata in numbers_of(self.study.scenario_at(point))}

    def label(self, name: str) -> str:
        """A factor or measure with its unit: "forward [m/s]", "peak torque, LeftLegTibiaMotion [N m]"."""
        if name == SURVIVAL:
            return "survived [%]"
        if name in self.study.columns:
            text, unit = _shortest(name, list(self.study.columns)), self._units.get(name, "")
        else:
            text, unit = _without_units(name), next(filter(None, map(unit_of, name.split("."))), "")
            text = text.removeprefix("gait.").replace(".", ", ")
        text = printable(text.replace("_", " "), 60)
        text += f" [{unit}]" if unit else ""
        followers = [self.label(follower) for follower, leader in self._followers.items() if leader == name]
        return f"{text} with {', '.join(followers)}" if followers else text

    @cached_property
    def ends(self) -> dict[str, int]:
        """Number of rows by how they ended, the most frequent first, at most MAX_ENDS."""
        return dict(Counter(printable(end) for end in self.table["end"].to_pylist()).most_common(MAX_ENDS))


def _order(values: Array) -> bytes:
    """The ranks of values, the same for values that rise or fall with these."""
    ranks = np.unique(values, return_inverse=True)[1]
    return min(ranks.tobytes(), (ranks.max() - ranks).tobytes())


def _level(value: Any) -> Any:
    """A value of a factor as a number or text."""
    if value is None:
        return AS_IN_SCENARIO
    if isinstance(value, int | float):
        return value
    return printable(value if isinstance(value, str) else json.dumps(value), 60)


def _without_units(name: str) -> str:
    return ".".join(UNIT.sub("", part) for part in name.split("."))


def _shortest(name: str, names: Sequence[str]) -> str:
    """The shortest end of a dotted name, without indices, that no other name has."""
    parts = [part for part in name.split(".") if not part.isdecimal()]
    others = [re.sub(r"\.\d+(?=\.|$)", "", other) for other in names if other != name]
    for first in range(len(parts) - 1, 0, -1):
        end = ".".join(parts[first:])
        if not any(f".{other}".endswith(f".{end}") for other in others):
            return end
    return name
