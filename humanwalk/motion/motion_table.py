"""Recorded motion as a table over time: read from OpenSim's .mot and .sto and from .csv, written as .mot and .sto.

A recording may come from anybody: time and memory to read one are bounded by its size, and a file that cannot be used
gives a one-line error.
"""

import csv
import io
import itertools
import math
from array import array
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from humanwalk.files import read_regular
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, number_of, printable

MAX_BYTES = 50_000_000
"""Largest recording; a quarter of an hour of 50 channels at 100 Hz has 45 MB."""

MAX_LINE = 100_000
MAX_COLUMNS = 2_000
MAX_ROWS = 100_000
"""Longest line in characters, and largest table; a quarter of an hour at 100 Hz has 90,000 rows."""

MAX_NUMBER = 1e10
"""Largest magnitude of a number, in any unit; seconds since 1970 are below it."""

MIN_TIME_STEP = 1e-4
"""Shortest time between two rows [s]; motion capture runs at up to 10 kHz."""

FORMATS = (".mot", ".sto", ".csv")

HEADER = ("nrows", "ncolumns", "indegrees")
"""Keys of an OpenSim header that are read, in lower case."""

TIME_NAMES = ("time", "time_s")


@dataclass(frozen=True)
class MotionTable:
    """Named columns over time.

    Attributes:
        columns: Names, without time.
        time: [s], increasing, shape (rows,).
        data: Shape (rows, columns).
        in_degrees: Whether angles are in degrees; None where the file does not specify it.
    """

    columns: tuple[str, ...]
    time: Array
    data: Array
    in_degrees: bool | None

    def column(self, name: str) -> Array:
        """One column, shape (rows,) (ValueError if it does not exist)."""
        values: Array = self.data[:, self.columns.index(name)]
        return values


def storage_text(name: str, table: MotionTable) -> str:
    """A table as OpenSim's storage file, version 1, with 12 significant digits."""
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
    """Read a .mot, .sto or .csv file; time [s] is the column named time or time_s, in any case, else the first.

    Raises:
        ParameterError: The file cannot be read, or a value in it cannot be used; the message has the line number.
    """
    name, suffix = printable(path), path.suffix.lower()
    if suffix not in FORMATS:
        raise ParameterError(f"{name}: unknown recording format; allowed: {', '.join(FORMATS)}; convert the file")
    try:
        return parse_motion_table(read_regular(path, MAX_BYTES), name, is_csv=suffix == ".csv")
    except UnicodeDecodeError:
        raise ParameterError(f"{name}: not UTF-8 text; allowed: {', '.join(FORMATS)}; convert the file") from None


def parse_motion_table(content: bytes, name: str, *, is_csv: bool) -> MotionTable:
    """Parse the content of a .csv file, or of a .mot or .sto file.

    Args:
        content: UTF-8 text.
        name: Name of the file, for messages.
        is_csv: Whether it is comma-separated without a header; else it is an OpenSim storage file.

    Raises:
        ParameterError: See `read_motion_table`.
        UnicodeDecodeError: The content is not UTF-8.
    """
    lines = _lines(content, name)
    header = None if is_csv else _read_header(lines, name)
    rows = ((number, _split(line, is_csv)) for number, line in lines if line.strip())
    number, names = next(rows, (0, []))
    _check_names(names, f"{name}: line {number}")
    if is_csv and len(names) == 1:
        raise ParameterError(
            f"{name}: line {number}: one column, {brief(names[0])}; allowed: a time and angles; separate columns by "
            "commas, and write decimals with a point"
        )
    time_column = next((i for i, column in enumerate(names) if column.lower() in TIME_NAMES), 0)
    data = array("d")
    for row, (number, cells) in enumerate(rows):
        place = f"{name}: line {number}"
        if row == MAX_ROWS:
            raise ParameterError(f"{place}: more than {MAX_ROWS} rows; allowed: up to that; shorten or thin it out")
        if len(cells) != len(names):
            raise ParameterError(f"{place} has {len(cells)} numbers; allowed: {len(names)}, one per column")
        data.extend(_numbers(cells, names, place))
        _check_time(data, time_column, len(names), f"{place}: {brief(names[time_column])}")
    if len(data) < 2 * len(names) or not names:
        raise ParameterError(f"{name}: fewer than two rows of numbers; allowed: a row of names, then at least two")
    table = np.frombuffer(data).reshape(-1, len(names))
    if header is not None:
        _require_size(header, table.shape, name)
    columns = tuple(column for i, column in enumerate(names) if i != time_column)
    in_degrees = {"yes": True, "no": False}.get((header or {}).get("indegrees", ""))
    return MotionTable(columns, table[:, time_column].copy(), np.delete(table, time_column, axis=1), in_degrees)


def _lines(content: bytes, name: str) -> Iterator[tuple[int, str]]:
    """Lines of UTF-8 text with their numbers from 1, decoded one at a time."""
    file = io.TextIOWrapper(io.BytesIO(content), encoding="utf-8-sig", newline=None)
    for number in itertools.count(1):
        line = file.readline(MAX_LINE + 1)
        if not line:
            return
        if len(line) > MAX_LINE:
            raise ParameterError(f"{name}: line {number} has over {MAX_LINE} characters; allowed: up to that; split it")
        yield number, line


def _read_header(lines: Iterator[tuple[int, str]], name: str) -> dict[str, str]:
    """Read an OpenSim header up to its last line; returns the values of HEADER that it has, in lower case."""
    header: dict[str, str] = {}
    for number, line in lines:
        key, _, value = (word.strip().lower() for word in line.partition("="))
        if key == "endheader":
            return header
        if key == "indegrees" and value not in ("yes", "no"):
            raise ParameterError(f"{name}: line {number}: inDegrees={brief(value)}; allowed: yes or no; correct it")
        if key in HEADER:
            header[key] = value
    raise ParameterError(f"{name}: no line `endheader`; allowed: an OpenSim storage file; rename a table to .csv")


def _require_size(header: Mapping[str, str], shape: tuple[int, ...], name: str) -> None:
    """Raise ParameterError where a header states another size than the table has: a file may have been truncated."""
    for key, shown, count in zip(HEADER, ("nRows", "nColumns"), shape, strict=False):
        stated = header.get(key, str(count))
        if stated != str(count):
            raise ParameterError(
                f"{name}: {shown}={brief(stated)}, but there are {count}; allowed: the number in the file; get the "
                "whole file, or correct the header"
            )


def _split(line: str, is_csv: bool) -> list[str]:
    if is_csv:
        return [cell.strip() for cell in next(csv.reader([line]))]
    # Older OpenSim files separate by spaces.
    return [cell.strip() for cell in line.rstrip().split("\t")] if "\t" in line.strip() else line.split()


def _check_names(names: Sequence[str], place: str) -> None:
    if len(names) > MAX_COLUMNS:
        raise ParameterError(f"{place} has {len(names)} columns; allowed: up to {MAX_COLUMNS}; remove some")
    for name, count in Counter(names).items():
        if count > 1:
            raise ParameterError(f"{place}: column {brief(name)} occurs twice; allowed: unique names; rename one")


def _check_time(data: Sequence[float], column: int, columns: int, place: str) -> None:
    """Check the time of the last row against the row before."""
    if len(data) > columns:
        before, time = data[column - 2 * columns], data[column - columns]
        if time <= before:
            raise ParameterError(
                f"{place} {time:g} is not after {before:g}; allowed: increasing times [s]; sort the rows, remove "
                "duplicates"
            )
        if time - before < MIN_TIME_STEP:
            raise ParameterError(
                f"{place} {time:g} is less than {MIN_TIME_STEP:g} s after {before:g}; allowed: seconds; remove a row"
            )


def _numbers(cells: Sequence[str], names: Sequence[str], place: str) -> list[float]:
    """Values of one row."""
    values = [_number(cell) for cell in cells]
    for name, cell, value in zip(names, cells, values, strict=True):
        # Also refuses NaN.
        if not abs(value) <= MAX_NUMBER:
            raise ParameterError(
                f"{place}, column {brief(name)}: '{printable(cell, 20)}' is not a number; allowed: finite numbers "
                f"up to {MAX_NUMBER:g}; fill the gap"
            )
    return values


def _number(cell: str) -> float:
    try:
        return number_of(cell)
    except ValueError:
        return math.nan


def brief(name: str) -> str:
    """A name from a file for a message: at most 40 printable characters."""
    return printable(name, 40)


def first_names(names: Sequence[str]) -> str:
    """The first eight column names, for a message."""
    return ", ".join(map(brief, names[:8])) + (", ..." if len(names) > 8 else "")
