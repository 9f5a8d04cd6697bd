"""Recorded motion as a table over time: read from OpenSim's .mot and .sto and from .csv, written as .mot and .sto."""

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError

LARGEST_FILE = 200_000_000
"""Of a recording [bytes]; an hour of 50 channels at 100 Hz has 180 MB."""

FORMATS = (".mot", ".sto", ".csv")


@dataclass(frozen=True)
class MotionTable:
    """Named columns over time.

    Attributes:
        columns: names, without time.
        time: [s], increasing, shape (rows,).
        data: shape (rows, columns).
        in_degrees: whether angles are in degrees; None where the file does not say (a .csv).
    """

    columns: tuple[str, ...]
    time: Array
    data: Array
    in_degrees: bool | None

    def column(self, name: str) -> Array:
        """One column, shape (rows,) (ValueError if there is none)."""
        values: Array = self.data[:, self.columns.index(name)]
        return values


def storage_text(name: str, table: MotionTable) -> str:
    """A table as OpenSim's storage file, version 1: numbers with 12 digits."""
    assert table.in_degrees is not None
    head = (
        f"{name}\nversion=1\nnRows={table.time.size}\nnColumns={len(table.columns) + 1}\n"
        f"inDegrees={'yes' if table.in_degrees else 'no'}\nendheader\n"
    )
    text = io.StringIO()
    text.write(head + "\t".join(("time", *table.columns)) + "\n")
    np.savetxt(text, np.column_stack((table.time, table.data)), fmt="%.12g", delimiter="\t")
    return text.getvalue()


def read_motion_table(path: Path) -> MotionTable:
    """Read a .mot, .sto or .csv file whose first column, or one called time or time_s, is time [s].

    Raises:
        ParameterError: it cannot be read, or a number in it cannot be used; with the line.
    """
    if path.suffix.lower() not in FORMATS:
        raise ParameterError(f"{path}: unknown kind of recording; allowed: {', '.join(FORMATS)}; convert it to one")
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):
            # A pipe or a device may never end.
            raise ParameterError(f"{path}: is no file; allowed: a recording that can be read")
        if path.stat().st_size > LARGEST_FILE:
            raise ParameterError(f"{path}: too large; allowed: up to {LARGEST_FILE // 10**6} MB; cut or thin it out")
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ParameterError(f"{path}: {error.strerror or error}; allowed: a recording that can be read") from None
    except ParameterError:
        raise
    except ValueError:
        # Not UTF-8, or a path that holds a zero.
        raise ParameterError(f"{str(path)!r}: is not text; allowed: {', '.join(FORMATS)}") from None
    lines = text.splitlines()
    if path.suffix.lower() == ".csv":
        return _parse(path, lines, 0, None, ",")
    head = next((i for i, line in enumerate(lines) if line.strip().lower() == "endheader"), None)
    if head is None:
        raise ParameterError(f"{path}: no line `endheader`; allowed: an OpenSim storage file; is it a .csv?")
    flags = {key.strip().lower(): value.strip().lower() for key, _, value in (s.partition("=") for s in lines[:head])}
    return _parse(path, lines, head + 1, flags.get("indegrees") == "yes", None)


def _parse(path: Path, lines: list[str], first: int, in_degrees: bool | None, delimiter: str | None) -> MotionTable:
    def split(line: str) -> list[str]:
        if delimiter is None:
            # Older OpenSim files separate by spaces.
            return [cell.strip() for cell in (line.split("\t") if "\t" in line else line.split())]
        return [cell.strip() for cell in next(csv.reader([line]))]

    numbered = [(i + 1, line) for i, line in enumerate(lines) if i >= first and line.strip()]
    if len(numbered) < 3:
        raise ParameterError(f"{path}: fewer than two rows of numbers; allowed: a line of names and two rows or more")
    names = split(numbered[0][1])
    doubled = next((name for name in names if names.count(name) > 1), None)
    if doubled is not None:
        raise ParameterError(f"{path}: column {doubled!r} comes twice; allowed: every name once; rename one")
    data = np.empty((len(numbered) - 1, len(names)))
    for row, (number, line) in enumerate(numbered[1:]):
        cells = split(line)
        if len(cells) != len(names):
            raise ParameterError(f"{path}: line {number} has {len(cells)} numbers; allowed: {len(names)}, one a column")
        for i, cell in enumerate(cells):
            data[row, i] = _number(path, number, names[i], cell)
    place = next((names.index(name) for name in ("time", "time_s") if name in names), 0)
    time = data[:, place]
    backwards = np.flatnonzero(np.diff(time) <= 0)
    if backwards.size:
        row = int(backwards[0]) + 1
        raise ParameterError(
            f"{path}: line {numbered[row + 1][0]}: {names[place]} {time[row]:g} does not come after {time[row - 1]:g}; "
            "allowed: increasing times [s]; sort the rows, and remove doubled ones"
        )
    columns = tuple(name for i, name in enumerate(names) if i != place)
    return MotionTable(columns, time, np.delete(data, place, axis=1), in_degrees)


def _number(path: Path, line: int, column: str, cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ParameterError(
            f"{path}: line {line}, column {column}: {cell[:20]!r} is no number; allowed: finite numbers; fill the gap"
        )
    return value


def nearest_names(names: Sequence[str]) -> str:
    """The first names of many, for a message."""
    return ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
