"""A table on disk that grows row by row: CSV with typed columns, of which the first is the row's index.

Guarantees. A row is handed to the operating system as one line, before the next one: the rows survive the end of the
process, whatever ends it. A line that was cut by a full disk or by the end of the process is dropped when the table is
opened again. No index appears twice. A loss of power may cost the rows of the last seconds.
"""

import csv
import io
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv

from humanwalk.files import WRITABLE, file_errors, read_regular, write_whole
from humanwalk.quantity import ParameterError, printable

MAX_TABLE_BYTES = 4_000_000_000

ARROW: Mapping[type, pa.DataType] = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}

Columns = Mapping[str, type]
"""Types of the columns by name: bool, int, float or str; str also holds lists, groups and text that is not printable,
as JSON."""


def start(path: Path, columns: Columns, number: int) -> pa.Table:
    """Make a table, or open one to go on with it: a line that was cut at its end is removed.

    Args:
        path: the file.
        columns: of the table.
        number: of indices, from 0.

    Returns:
        The rows so far, in the order of their indices.
    """
    lines = whole_lines(path, number) if path.exists() else []
    if not lines:
        write_whole(path, lambda beside: beside.write_bytes(line_of(list(columns))))
        return read(path, columns, number)
    rows = read(path, columns, number)
    with file_errors(path, WRITABLE):
        os.truncate(path, sum(len(line) for line in lines))
    return rows


def append(path: Path, columns: Columns, row: Mapping[str, Any]) -> None:
    """Add a row; a value that it does not have is an empty cell.

    Raises:
        ParameterError: it cannot be written; the table is as before.
    """
    line = line_of([_cell(row.get(name), kind) for name, kind in columns.items()])
    with file_errors(path, WRITABLE), path.open("ab", buffering=0) as file:
        before = file.tell()
        written = 0
        try:
            while written < len(line):
                written += file.write(line[written:]) or 0
        except OSError:
            file.truncate(before)
            raise


def read(path: Path, columns: Columns, number: int) -> pa.Table:
    """The rows in the order of their indices; a line that was cut at the end is left out.

    Raises:
        ParameterError: it is no table with these columns and up to this number of rows.
    """
    header, *lines = whole_lines(path, number) or [b""]
    if header != line_of(list(columns)):
        raise _refusal(path, "columns of another study or tuning, or of another version of humanwalk")
    schema = {name: ARROW[kind] for name, kind in columns.items()}
    if not lines:
        return pa.schema(list(schema.items())).empty_table()
    options = pyarrow.csv.ConvertOptions(
        column_types=schema,
        null_values=[""],
        strings_can_be_null=True,
        true_values=["true"],
        false_values=["false"],
    )
    try:
        content = io.BytesIO(b"".join([header, *lines]))
        table = pyarrow.csv.read_csv(content, pyarrow.csv.ReadOptions(use_threads=False), convert_options=options)
    except (pa.ArrowException, ValueError) as error:
        raise _refusal(path, printable(error)) from None
    index = table.column(0)
    rows = index.to_numpy()
    if index.null_count or rows.min() < 0 or rows.max() >= number:
        raise _refusal(path, f"an index of a row that is not in 0 to {number - 1}")
    if [b"%d" % row for row in rows] != [line.partition(b",")[0] for line in lines]:
        raise _refusal(path, "a line that does not begin with the index of a row")
    if np.unique(rows).size < rows.size:
        raise _refusal(path, "a row twice")
    return table.take(np.argsort(rows))


def whole_lines(path: Path, number: int) -> list[bytes]:
    """Lines of a table with their ends, without one that was cut at the end.

    Raises:
        ParameterError: it cannot be read, or has more lines than a header and this number of rows.
    """
    content = read_regular(path, MAX_TABLE_BYTES)
    # Counted before they are split: a line as an object takes 40 bytes more than in the file.
    if content.count(b"\n") > number + 1:
        raise _refusal(path, f"more than {number} rows")
    lines = io.BytesIO(content).readlines()
    return lines if not lines or lines[-1].endswith(b"\n") else lines[:-1]


def sort(path: Path, number: int) -> None:
    """Put the lines of a table of up to this number of rows in the order of their indices."""
    header, *lines = whole_lines(path, number)
    ordered = sorted(lines, key=lambda line: int(line.partition(b",")[0]))
    if lines != ordered:
        content = b"".join([header, *ordered])
        write_whole(path, lambda beside: beside.write_bytes(content))


def line_of(cells: list[str]) -> bytes:
    """A line of CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue().encode()


def _cell(value: Any, kind: type) -> str:
    if value is None:
        return ""
    if kind is str:
        # JSON has no line ends, which would make two lines of a row, and writes what is no Unicode.
        return value if isinstance(value, str) and value.isprintable() else json.dumps(value)
    return repr(kind(value)).lower()


def _refusal(path: Path, reason: str) -> ParameterError:
    return ParameterError(
        f"{printable(path)}: {reason}; allowed: the file as humanwalk study or tune wrote it; restore it, or choose "
        "another folder with -o"
    )
