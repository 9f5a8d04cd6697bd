"""The table of a tuning on disk: its trials with parameters, values and cost.

The folder of a tuning:

    tuning.yaml     the complete tuning
    trials.csv      one line per finished trial; see `humanwalk.study.journal` for its guarantees
    best.yaml       the scenario of the best trial, by `tune show`
    tuning.html     the page, by `tune show`
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from humanwalk.files import (
    file_of,
    locked,
    make_folder,
    require_empty,
    require_inside,
    write_text,
)
from humanwalk.measures.ends import COMPLETED
from humanwalk.parameter_file import MAX_KEPT_SIZE, read_fields
from humanwalk.quantity import ParameterError, printable
from humanwalk.scenario import dump_scenario
from humanwalk.study import journal
from humanwalk.study.objectives import Score, measured, score
from humanwalk.study.results import MAX_MAGNITUDE
from humanwalk.study.row import Row
from humanwalk.study.trial import RUNS
from humanwalk.study.tuning import MAX_TRIALS, Tuning, dump_tuning, parse_tuning

TUNING = "tuning.yaml"
TRIALS = "trials.csv"
BEST = "best.yaml"
"""Names inside the folder of a tuning."""

TRIAL = "trial"
"""Column of a trial's number."""


def trial_columns(tuning: Tuning) -> dict[str, type]:
    """Columns of the table of trials with their types."""
    parameters = {f"parameters.{name}": float for name in tuning.parameters}
    values = {f"values.{name}": float for name in tuning.measured}
    outcome = {"upright_share": float, "runs": int, "falls": int, "end": str, "wall_time_s": float, "host": str}
    return {TRIAL: int} | parameters | values | {"cost": float, "feasible": bool} | outcome


def trial_row(tuning: Tuning, trial: int, parameters: Mapping[str, float], returned: Row) -> Row:
    """The row of a finished trial.

    Args:
        tuning: the tuning.
        trial: number of the trial.
        parameters: values by field.
        returned: by the worker; without RUNS if the trial failed as a whole.
    """
    points = tuning.runs.points
    simulated: Sequence[Row] = returned.get(RUNS, [])
    rows = [*simulated, *[None] * (len(points) - len(simulated))]
    values = {name: measured(name, what, points, rows) for name, what in tuning.measured.items()}
    upright = sum(row["upright_share"] for row in simulated) / len(points)
    found = score(tuning.objectives, tuning.bounds, values, upright)
    ends = [row["end"] for row in simulated if not row["survived"]]
    return (
        {TRIAL: trial}
        | {f"parameters.{name}": value for name, value in parameters.items()}
        | {f"values.{name}": value for name, value in values.items()}
        | {"cost": found.cost, "feasible": found.feasible, "upright_share": upright}
        | {"runs": len(simulated), "falls": len(ends)}
        | {"end": returned.get("end") or (ends[0] if ends else COMPLETED)}
        | {"wall_time_s": sum(row["wall_time_s"] for row in simulated)}
        | {"host": simulated[0]["host"] if simulated else ""}
    )


def score_of(tuning: Tuning, row: Row) -> Score:
    """The score of a trial from its row."""
    values = {name: row[f"values.{name}"] for name in tuning.measured}
    return score(tuning.objectives, tuning.bounds, values, row["upright_share"])


@dataclass
class TrialTable:
    """The table of a tuning that is being filled; its folder is locked.

    Attributes:
        path: of the file.
        tuning: whose trials it holds.
        rows: of the finished trials by number.
    """

    path: Path
    tuning: Tuning
    rows: dict[int, Row]

    def append(self, trial: int, row: Row) -> None:
        """Add the row of a finished trial."""
        journal.append(self.path, trial_columns(self.tuning), row)
        self.rows[trial] = row


@contextmanager
def open_table(folder: Path, tuning: Tuning) -> Iterator[TrialTable]:
    """Make the folder of a tuning or open one to resume it; within the block no other process writes into it.

    After the block the lines of the table are in the order of the trials.

    Raises:
        ParameterError: the folder holds something else, is in use, or cannot be written.
    """
    make_folder(folder)
    busy = f"-o {printable(folder)}: another tuning writes into it; allowed: one at a time; wait, or choose another"
    with locked(folder, busy):
        _claim(folder, tuning)
        path = require_inside(folder, folder / TRIALS)
        table = journal.start(path, trial_columns(tuning), MAX_TRIALS)
        yield TrialTable(path, tuning, {row[TRIAL]: row for row in _checked(path, tuning, table)})
        journal.sort(path, MAX_TRIALS)


def _claim(folder: Path, tuning: Tuning) -> None:
    """Write the tuning into an empty folder, or raise ParameterError unless the folder is of the same tuning."""
    if (folder / TUNING).exists():
        found = read_tuning(folder)
        if found == tuning:
            # It may be the file that the user wrote, with comments.
            return
        # More trials continue a tuning.
        if replace(found, trials=tuning.trials) != tuning:
            raise ParameterError(
                f"-o {printable(folder)}: holds another tuning; allowed: a new folder, or that of the same tuning, "
                "which resumes; choose another"
            )
        if (folder / TRIALS).exists():
            _rows(folder, tuning)
    else:
        require_empty(folder, "a new or empty folder, or that of the same tuning", lambda name: name.startswith("."))
    write_text(folder / TUNING, dump_tuning(tuning))


def read_tuning(folder: Path) -> Tuning:
    """The tuning of a folder.

    Raises:
        ParameterError: the folder holds no tuning, or one that cannot be read.
    """
    path = file_of(folder, TUNING, "tuning", "humanwalk tune")
    return parse_tuning(read_fields(path, MAX_KEPT_SIZE), path.name, path.parent)


def read_trials(folder: Path) -> tuple[Tuning, list[Row]]:
    """The tuning of a folder, and the rows of its trials so far in order.

    Raises:
        ParameterError: the folder holds no tuning, or its table was changed.
    """
    tuning = read_tuning(folder)
    return tuning, _rows(folder, tuning)


def _rows(folder: Path, tuning: Tuning) -> list[Row]:
    path = require_inside(folder, folder / TRIALS)
    return _checked(path, tuning, journal.read(path, trial_columns(tuning), MAX_TRIALS))


def _checked(path: Path, tuning: Tuning, table: pa.Table) -> list[Row]:
    """The rows of a table; a value of an objective or bound may be missing, nothing else, and numbers are in range.

    Raises:
        ParameterError: a cell cannot be used, or the tuning has fewer trials than the table.
    """
    ranges = {f"parameters.{name}": (limits.low, limits.high) for name, limits in tuning.parameters.items()}
    for name in table.column_names:
        column, (low, high) = table[name], ranges.get(name, (-MAX_MAGNITUDE, MAX_MAGNITUDE))
        values = column.drop_null().to_numpy()
        missing = column.null_count and not name.startswith("values.") and name not in ("end", "host")
        if missing or (column.type == pa.float64() and not ((low <= values) & (values <= high)).all()):
            raise ParameterError(
                f"{printable(path)}: column {printable(name)} has a cell that is empty or not within {low:g} to "
                f"{high:g}; allowed: the file as humanwalk tune wrote it; restore it, or choose another folder with -o"
            )
    rows: list[Row] = table.to_pylist()
    done = rows[-1][TRIAL] + 1 if rows else 0
    if done > tuning.trials:
        raise ParameterError(
            f"trials: {tuning.trials} is less than the {done} of {printable(path)}; allowed: from {done} on; write "
            f"trials: {done}"
        )
    return rows


def walked(tuning: Tuning, row: Row) -> bool:
    """Whether a trial has a value for every objective and bound."""
    return all(row[f"values.{name}"] is not None for name in tuning.measured)


def best(tuning: Tuning, rows: Sequence[Row]) -> Row | None:
    """The trial of least cost of those within all bounds, else of those that walk; None if no trial walks.

    With several objectives of nsga2 it is one point of the Pareto front, chosen by the weights.
    """
    walking = [row for row in rows if walked(tuning, row)]
    return min(walking, key=lambda row: (not row["feasible"], row["cost"], row[TRIAL]), default=None)


def pareto_front(tuning: Tuning, rows: Sequence[Row]) -> list[Row]:
    """The trials within all bounds of which no other one is better in an objective and in none worse, in order;
    of equal ones the first.
    """
    feasible = [row for row in rows if row["feasible"]]
    losses = np.array([score_of(tuning, row).losses for row in feasible]).reshape(-1, len(tuning.objectives))
    front: dict[tuple[float, ...], Row] = {}
    for row, own in zip(feasible, losses, strict=True):
        if not ((losses <= own).all(axis=1) & (losses < own).any(axis=1)).any():
            front.setdefault(tuple(own), row)
    return list(front.values())


def number(value: float | None) -> str:
    """Four digits; a dash for a value that a trial does not have."""
    return "-" if value is None else f"{value:.4g}"


def write_best(folder: Path, tuning: Tuning, row: Row) -> Path:
    """Write the scenario of a trial into the folder of a tuning."""
    path = folder / BEST
    scenario = tuning.scenario({name: row[f"parameters.{name}"] for name in tuning.parameters})
    text = f"trial {row[TRIAL]} of a tuning: {tuning.description}"
    write_text(path, dump_scenario(replace(scenario, description=text)))
    return path
