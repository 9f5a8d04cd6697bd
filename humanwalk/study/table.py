"""The table of a study on disk: a journal that grows row by row, and the same rows as Parquet.

    study.yaml      the complete study
    points.csv      the points of a study with the design `rows`
    table.csv       one line per finished run; in the order of the points once all are finished
    table.parquet   the rows in the order of the points; written at the end, and every minute or less often
    runs/000012/    the run folder of row 12, with `keep: runs`

One process at a time writes: it holds a lock on the folder. `humanwalk.study.journal` has the guarantees of table.csv.
"""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from humanwalk.files import (
    file_of,
    locked,
    make_folder,
    read_regular,
    require_empty,
    require_inside,
    write_text,
    write_whole,
)
from humanwalk.parameter_file import MAX_KEPT_SIZE, read_fields
from humanwalk.quantity import ParameterError, printable
from humanwalk.study import journal
from humanwalk.study.design import MAX_CSV_BYTES, Rows
from humanwalk.study.factors import Variants
from humanwalk.study.row import Row, run_columns
from humanwalk.study.study import Study, dump_study, parse_study

STUDY = "study.yaml"
POINTS = "points.csv"
TABLE = "table.csv"
PARQUET = "table.parquet"
RUNS = "runs"
"""Names inside the folder of a study."""

ROW = "row"
"""Column of a row's index."""

NOT_REPRODUCED = ("wall_time_s", "realtime_factor", "host")
"""Columns that differ when a run is repeated."""

PARQUET_PERIOD = 60.0
"""Time between two writings of the Parquet file [s]; longer where one takes more than a hundredth of it."""


def table_columns(study: Study) -> dict[str, type]:
    """Columns of a study's table with their types: index, factors, measures, origin.

    Raises:
        ParameterError: a factor has the name of another column. Only the field `seed`, a measure as well, may.
    """
    measures = dict(run_columns())
    for name in study.columns:
        is_seed = name == "seed" and not isinstance(study.factors.get(name), Variants)
        if name == ROW or (name in measures and not is_seed):
            raise ParameterError(
                f"factors.{name}: the table has another column of that name; allowed: fields of the scenario, other "
                "names for variants; rename it"
            )
    factors = {name: _type_of([study.value_at(point, name) for point in study.points]) for name in study.columns}
    return {ROW: int} | factors | measures


def _type_of(values: list[Any]) -> type:
    """The narrowest type of a column that holds values; text also holds lists and groups, as JSON."""
    kinds = {type(value) for value in values if value is not None}
    return next(kind for kind, fits in _FITTING.items() if kinds <= fits)


_FITTING: dict[type, set[type]] = {
    int: {int},
    float: {int, float},
    bool: {bool},
    str: {int, float, bool, str, list, dict},
}
"""By type of a column: types of values that it can hold."""


@dataclass
class Journal:
    """The table of a study that is being filled; see the guarantees of this module.

    Attributes:
        folder: of the study; locked.
        study: whose points have rows.
        done: indices of the rows that the table has.
    """

    folder: Path
    study: Study
    done: set[int]
    _kinds: dict[str, type]
    _next_parquet: float = 0.0

    def append(self, index: int, row: Row) -> None:
        """Add the row of a finished run; a value that it does not have is an empty cell.

        Raises:
            ParameterError: it cannot be written; the table is as before.
        """
        assert index not in self.done
        point = self.study.points[index]
        factors = {name: self.study.value_at(point, name) for name in self.study.columns}
        values = row | {ROW: index} | {name: value for name, value in factors.items() if value is not None}
        journal.append(self.folder / TABLE, self._kinds, values)
        self.done.add(index)
        if time.monotonic() >= self._next_parquet:
            # A disk that is full now may have room at the end.
            with suppress(ParameterError):
                self.write_parquet()

    def write_parquet(self) -> None:
        """Write the rows so far, in the order of the points, as Parquet."""
        begin = time.monotonic()
        table = journal.read(self.folder / TABLE, self._kinds, len(self.study.points))
        write_whole(self.folder / PARQUET, lambda beside: pq.write_table(table, beside, compression="zstd"))
        end = time.monotonic()
        self._next_parquet = end + max(PARQUET_PERIOD, 100.0 * (end - begin))

    def finish(self) -> None:
        """Put the lines of a complete table in the order of the points, and write the Parquet file."""
        journal.sort(self.folder / TABLE, len(self.study.points))
        self.write_parquet()


@contextmanager
def open_journal(folder: Path, study: Study) -> Iterator[Journal]:
    """Make the folder of a study or open one to resume it; within the block no other process writes into it.

    Raises:
        ParameterError: the folder holds something else, is in use, or cannot be written.
    """
    kinds = table_columns(study)
    make_folder(folder)
    busy = f"-o {printable(folder)}: another study writes into it; allowed: one at a time; wait, or choose another"
    with locked(folder, busy):
        _require_same(folder, study)
        path = require_inside(folder, folder / TABLE)
        done = set(journal.start(path, kinds, len(study.points))[ROW].to_pylist())
        yield Journal(folder, study, done, kinds, time.monotonic() + PARQUET_PERIOD)


def read_table(folder: Path | str) -> pa.Table:
    """The rows of a study so far, in the order of its points.

    Raises:
        ParameterError: the folder holds no study, or its table was changed.
    """
    study = read_study(folder)
    path = require_inside(Path(folder), Path(folder) / TABLE)
    return journal.read(path, table_columns(study), len(study.points))


def join(parts: Sequence[Path], folder: Path) -> pa.Table:
    """Put the rows of parts of a study into one folder, a new one or that of the same study, and return its table.

    A row that several parts have is taken from the first; run folders stay where they are.

    Raises:
        ParameterError: a part is of another study, or the folder cannot be used.
    """
    study, tables = read_study(parts[0]), []
    for part in parts:
        if not same_study(read_study(part), study):
            raise ParameterError(
                f"{printable(part)}: holds another study than {printable(parts[0])}; allowed: parts of one study; "
                "leave it out"
            )
        tables.append(read_table(part))
    with open_journal(folder, study) as whole:
        for table in tables:
            for row in table.to_pylist():
                if row[ROW] not in whole.done:
                    whole.append(row[ROW], row)
        whole.finish()
    return read_table(folder)


def same_study(one: Study, other: Study) -> bool:
    """Whether two studies have the same runs; the path of a file of points does not matter."""
    return _with_kept_points(one) == _with_kept_points(other) and one.points == other.points


def read_study(folder: Path | str) -> Study:
    """The study of a folder.

    Raises:
        ParameterError: the folder holds no study, or one that cannot be read.
    """
    path = file_of(Path(folder), STUDY, "study", "humanwalk study")
    study = parse_study(read_fields(path, MAX_KEPT_SIZE), path.name, path.parent)
    if isinstance(study.design, Rows):
        require_inside(Path(folder), Path(study.design.file))
    return study


def _require_same(folder: Path, study: Study) -> None:
    """Write the study into an empty folder, or raise ParameterError unless the folder is of the same study."""
    kept = _with_kept_points(study)
    if (folder / STUDY).exists():
        found = read_study(folder)
        if not same_study(found, study):
            raise ParameterError(
                f"-o {printable(folder)}: holds another study; allowed: a new folder, or that of the same study, which "
                "resumes; choose another"
            )
        return
    # A study that was killed while it was made leaves its points, or a hidden file.
    require_empty(
        folder,
        "a new or empty folder, or that of the same study",
        lambda name: name == POINTS or name.startswith("."),
    )
    if isinstance(study.design, Rows):
        content = read_regular(Path(study.design.file), MAX_CSV_BYTES)
        write_whole(folder / POINTS, lambda beside: beside.write_bytes(content))
    # The last: a folder with it is one of a study.
    write_text(folder / STUDY, dump_study(kept))


def _with_kept_points(study: Study) -> Study:
    """The study as its folder has it: points from a file are those of the copy."""
    design = study.design
    return replace(study, design=replace(design, file=POINTS)) if isinstance(design, Rows) else study
