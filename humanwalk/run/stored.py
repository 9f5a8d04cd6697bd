"""Signals and summary of a run folder from others: checked, and read within bounded memory."""

import re
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from humanwalk.body import SIDES
from humanwalk.body.anatomy import human
from humanwalk.files import read_regular
from humanwalk.measures.signals import TIME
from humanwalk.measures.summary import Summary
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.provenance import Provenance, signals_hash
from humanwalk.run.schema import read_json
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import COM_COLUMNS, SOLE_COLUMNS
from humanwalk.systems.foot_signals import foot_columns
from humanwalk.systems.signal import floating_base

MAX_ROWS = 200_000
"""Longest record [rows]: 16 minutes at the default signal period, 0.5 GB of numbers."""

MAX_COLUMNS = 1000
"""A record has some 320."""

COLUMN_NAME = re.compile(rf"(?!{TIME}\.)[A-Za-z]\w{{0,62}}\.[A-Za-z]\w{{0,62}}", re.ASCII)
"""Names of columns but the time: no formula of a spreadsheet, and two names of fields for MATLAB, which end at 63
characters and of which the first is not that of the time."""

MAX_SIGNALS_BYTES = 1_000_000_000
MAX_SUMMARY_BYTES = 1_000_000
"""A summary has 20 kB."""

MAX_MAGNITUDE = 1e9
"""Largest value of a signal in SI units; beyond it the state has run away, and the record ends."""

MIN_QUATERNION = 1e-3
"""Smallest norm of an orientation; a recorded one has 1."""


class RunSummary(Summary):
    """The whole of summary.json."""

    provenance: Provenance


def before_runaway(signals: pa.Table) -> pa.Table:
    """Rows of a record before the first with a value that is not finite or beyond MAX_MAGNITUDE."""
    usable = np.all([np.abs(signals[name].to_numpy()) <= MAX_MAGNITUDE for name in signals.column_names], axis=0)
    return signals.slice(0, int(usable.argmin())) if not usable.all() else signals


def read_summary(path: Path) -> RunSummary:
    """Read summary.json.

    Raises:
        ParameterError: it is no summary, or a number in it is not finite.
    """
    summary: RunSummary = read_json(path, MAX_SUMMARY_BYTES, RunSummary)
    joints = {joint.name for joint in human().joints}
    for name in ("peak_torque_N_m", "saturated_share", "tracking_error_rad"):
        if summary[name].keys() != (joints if summary["physics"] else set()):
            raise _refusal(path, f"{name} does not have the joints of the body")
    return summary


def read_signals(path: Path, scenario: Scenario, sha256: str) -> pa.Table:
    """Read signals.parquet; size, columns and types are checked before the numbers are loaded.

    Raises:
        ParameterError: it is no record of this scenario, or was changed: its `signals_hash` is not `sha256`.
    """
    content = pa.BufferReader(read_regular(path, MAX_SIGNALS_BYTES))
    try:
        file = pq.ParquetFile(content)
        _check_metadata(path, file.metadata, file.schema_arrow, scenario.controller.physics)
        table = file.read(use_threads=False)
    except ParameterError:
        raise
    except (pa.ArrowException, OSError, ValueError, MemoryError, KeyError, TypeError):
        raise _refusal(path, "not a Parquet file, or a damaged one") from None
    _check_values(path, table, scenario)
    if signals_hash(table) != sha256:
        raise _refusal(path, "changed since the run: its SHA-256 is not that of summary.json")
    return table


def required_columns(physics: bool) -> set[str]:
    """Columns of every record: pelvis, joints, soles and center of mass; with physics also torques and forces."""
    columns = {TIME, *floating_base("pelvis."), *SOLE_COLUMNS, *COM_COLUMNS}
    joint_signals = ["angle_rad", "velocity_rad_s"]
    if physics:
        columns |= set(foot_columns(SIDES))
        joint_signals += ["desired_angle_rad", "desired_velocity_rad_s", "torque_N_m", "saturated"]
    return columns | {f"{joint.name}.{signal}" for joint in human().joints for signal in joint_signals}


def _check_metadata(path: Path, metadata: pq.FileMetaData, schema: pa.Schema, physics: bool) -> None:
    if not 0 < metadata.num_rows <= MAX_ROWS:
        raise _refusal(path, f"{metadata.num_rows} rows; allowed: 1 to {MAX_ROWS}")
    if metadata.num_columns > MAX_COLUMNS:
        raise _refusal(path, f"{metadata.num_columns} columns; allowed: up to {MAX_COLUMNS}")
    groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
    if sum(group.num_rows for group in groups) != metadata.num_rows:
        raise _refusal(path, "parts that do not add up to its rows")
    bound = 16 * metadata.num_rows * metadata.num_columns + 100_000 * metadata.num_columns
    if sum(group.total_byte_size for group in groups) > bound:
        raise _refusal(path, "more bytes than its rows and columns need")
    names = schema.names
    for field in schema:
        if field.type != pa.float64():
            raise _refusal(path, f"column {printable(field.name)} is of type {printable(field.type, 40)}")
        if field.name != TIME and not COLUMN_NAME.fullmatch(field.name):
            raise _refusal(path, f"column {printable(field.name, 40)} is not named thing.quantity_unit")
    if len(set(names)) < len(names):
        double = next(name for i, name in enumerate(names) if name in names[:i])
        raise _refusal(path, f"column {printable(double)} comes twice")
    missing = sorted(required_columns(physics).difference(names))
    if missing:
        raise _refusal(path, f"{len(missing)} columns are missing, first {missing[0]}")


def _check_values(path: Path, table: pa.Table, scenario: Scenario) -> None:
    for name in table.column_names:
        values = table[name].to_numpy()
        if table[name].null_count or not (np.abs(values) <= MAX_MAGNITUDE).all():
            raise _refusal(path, f"column {name} has a value that is not finite or beyond {MAX_MAGNITUDE:g}")
    period = scenario.recording.signal_period
    if not np.allclose(table[TIME].to_numpy(), period * np.arange(table.num_rows), rtol=0.0, atol=1e-3 * period):
        raise _refusal(path, f"{TIME} is not a multiple of the scenario's recording.signal_period, {period:g} s")
    square = sum(table[f"pelvis.quaternion_{axis}"].to_numpy() ** 2 for axis in "wxyz")
    if (square < MIN_QUATERNION**2).any():
        raise _refusal(path, "pelvis.quaternion is zero somewhere")


def _refusal(path: Path, reason: str) -> ParameterError:
    return ParameterError(
        f"{printable(path)}: {reason}; allowed: the file as humanwalk walk wrote it; restore it, or walk again"
    )
