"""Designs of experiments: which combinations of the factors' values a study simulates.

Points are pure functions of design and factors: the same study has the same points in the same order everywhere.
"""

import csv
import io
import json
import math
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from scipy.stats import qmc

from humanwalk.files import read_text
from humanwalk.numerics import Array
from humanwalk.parameter_file import build_value
from humanwalk.quantity import ParameterError, file_path, printable, quantity
from humanwalk.study.factors import Factor, Variants
from humanwalk.yaml_text import shown

Point = Mapping[str, Any]
"""Values by the names of the factors; a factor without a value keeps what the scenario has."""

MAX_POINTS = 200_000
"""Points of a study; more are several studies."""

MAX_VALUES = 5_000_000
"""Points times factors."""

MAX_CSV_BYTES = 50_000_000


@dataclass(frozen=True)
class Design(ABC):
    """How factors are combined."""

    @abstractmethod
    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        """The points in order.

        Raises:
            ParameterError: too many, or a factor that does not fit the design.
        """


@dataclass(frozen=True)
class FullFactorial(Design):
    """Every combination of all levels; the last factor changes fastest."""

    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        _require_number(math.prod(_level_counts(factors)), len(factors))
        levels = [factor.levels() for factor in factors.values()]
        return [dict(zip(factors, values, strict=True)) for values in product(*levels)]


@dataclass(frozen=True)
class OneAtATime(Design):
    """The scenario without changes, then each level of each factor alone."""

    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        _require_number(1 + sum(_level_counts(factors)), len(factors))
        return [{}, *({name: level} for name, factor in factors.items() for level in factor.levels())]


@dataclass(frozen=True)
class LatinHypercube(Design):
    """A Latin hypercube: each factor has one sample in each of `number` equal shares of its distribution."""

    number: int = quantity(100, "", 1, MAX_POINTS)
    seed: int = quantity(0, "", 0, 2**32 - 1)

    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        _require_factors(factors)
        _require_number(self.number, len(factors))
        return _sampled(factors, qmc.LatinHypercube(len(factors), rng=self.seed).random(self.number))


@dataclass(frozen=True)
class Sobol(Design):
    """A scrambled Sobol' sequence; its number is a power of two, which keeps it balanced."""

    number: int = quantity(128, "", 1, MAX_POINTS)
    seed: int = quantity(0, "", 0, 2**32 - 1)

    def __post_init__(self) -> None:
        """Raise ParameterError for a number that is no power of two."""
        if self.number >= 1 and self.number & (self.number - 1):
            above = 1 << self.number.bit_length()
            raise ParameterError(
                f"number: {self.number} is no power of two; allowed: 1, 2, 4, ...; write {above // 2} or {above}"
            )

    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        _require_factors(factors)
        _require_number(self.number, len(factors))
        if len(factors) > qmc.Sobol.MAXDIM:
            raise ParameterError(f"factors: {len(factors)}; allowed with design sobol: up to {qmc.Sobol.MAXDIM}")
        return _sampled(factors, qmc.Sobol(len(factors), rng=self.seed).random(self.number))


@dataclass(frozen=True)
class Rows(Design):
    """The rows of a CSV file: its columns are fields of the scenario, or factors of the kind `variants`.

    A cell is a number, true, false, a list or group in JSON, or text. An empty cell keeps the scenario's value.
    """

    file: str = file_path()

    def points(self, factors: Mapping[str, Factor]) -> Sequence[Point]:
        for name, factor in factors.items():
            if not isinstance(factor, Variants):
                raise ParameterError(
                    f"factors.{name}: has values of its own; allowed with design rows: variants; remove it, or choose "
                    "another design"
                )
        where = printable(self.file)
        if not self.file:
            raise ParameterError("design.rows.file: empty; allowed: the path of a CSV file; write it")
        header, rows = _read_rows(Path(self.file), where)
        if not rows:
            raise ParameterError(f"{where}: 0 points below the header; allowed: one row or more; add rows")
        _require_number(len(rows), len(header))
        points = [
            {
                name: _cell(cell, f"{where}: row {number}, column {printable(name)}")
                for name, cell in zip(header, cells, strict=True)
                if cell.strip()
            }
            for number, cells in enumerate(rows, 1)
        ]
        _require_different(points, where)
        return points


DESIGNS: dict[str, type[Design]] = {
    "full_factorial": FullFactorial,
    "latin_hypercube": LatinHypercube,
    "sobol": Sobol,
    "one_at_a_time": OneAtATime,
    "rows": Rows,
}
"""The designs that a study file can name."""


def _level_counts(factors: Mapping[str, Factor]) -> Iterator[int]:
    for name, factor in factors.items():
        try:
            yield factor.level_count()
        except ParameterError as error:
            raise ParameterError(f"factors.{name}: {error}") from None


def _sampled(factors: Mapping[str, Factor], samples: Array) -> list[Point]:
    """Points from samples of the unit cube, shape (points, factors)."""
    columns = [factor.quantiles(shares) for factor, shares in zip(factors.values(), samples.T, strict=True)]
    return [dict(zip(factors, values, strict=True)) for values in zip(*columns, strict=True)]


def _require_factors(factors: Mapping[str, Factor]) -> None:
    """Raise ParameterError for a sample without factors: its runs would be the same."""
    if not factors:
        raise ParameterError("factors: empty; allowed with a design that samples: one or more; write one to sample")


def _require_number(points: int, factors: int) -> None:
    if points * factors > MAX_VALUES:
        raise ParameterError(
            f"design: {shown(points)} points of {factors} factors; allowed: up to {MAX_VALUES} values; use fewer"
        )
    if not 1 <= points <= MAX_POINTS:
        raise ParameterError(
            f"design: {points} points; allowed: 1 to {MAX_POINTS}; use fewer levels, or another design, or several "
            "studies"
        )


def _require_different(points: Sequence[Point], where: str) -> None:
    """Raise ParameterError for a row of a file that comes twice: its runs would be the same."""
    numbers: dict[Any, int] = {}
    for number, point in enumerate(points, 1):
        first = numbers.setdefault(_hashable(point), number)
        if first != number:
            raise ParameterError(f"{where}: row {number} is row {first} again; allowed: every row once; remove one")


def _hashable(value: Any) -> Any:
    """A hashable copy of the value of a cell; equal values have equal copies."""
    if isinstance(value, Mapping):
        return frozenset((name, _hashable(entry)) for name, entry in value.items())
    return tuple(map(_hashable, value)) if isinstance(value, list) else value


def _read_rows(path: Path, where: str) -> tuple[list[str], list[list[str]]]:
    """Header and rows of a CSV file, read no farther than a study may go; `where` names it in errors."""
    lines = filter(None, csv.reader(io.StringIO(read_text(path, MAX_CSV_BYTES)), strict=True))
    rows: list[list[str]] = []
    try:
        header = next(lines, [])
        if len(set(header)) < len(header) or not all(name and name.isprintable() for name in header):
            raise ParameterError(f"{where}: the header is empty or has a name twice; allowed: every field once")
        most = min(MAX_POINTS, MAX_VALUES // max(len(header), 1))
        for number, cells in enumerate(lines, 1):
            if number > most:
                raise ParameterError(
                    f"{where}: more than {most} rows of {len(header)} values; allowed: up to that; use several studies"
                )
            if len(cells) != len(header):
                raise ParameterError(
                    f"{where}: row {number} has {len(cells)} values; allowed: {len(header)}, one for each column; "
                    "correct the row"
                )
            rows.append(cells)
    except csv.Error:
        header = []
    if not header:
        raise ParameterError(
            f"{where}: not CSV with a header; allowed: names of fields, then rows of values; correct the file"
        )
    return header, rows


def _cell(text: str, place: str) -> Any:
    """A CSV cell as a value: JSON where it is JSON, else text; `place` is for errors."""
    try:
        value = json.loads(text, object_pairs_hook=_group)
    except ParameterError as error:
        raise ParameterError(f"{place}: {error}") from None
    except (ValueError, RecursionError):
        value = text.strip()
    return build_value(value, place)


def _group(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A group in JSON; JSON readers silently keep the last of equal names."""
    group = dict(pairs)
    if len(group) < len(pairs):
        ((name, _),) = Counter(name for name, _ in pairs).most_common(1)
        raise ParameterError(f"{shown(name)} comes twice; allowed: every field once in its group; remove one")
    return group
