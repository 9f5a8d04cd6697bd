"""The table of a run's signals: one row per sample, one named column with a unit per number."""

import re
from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, near_names

TIME = "time_s"

UNITS = {
    "kg_m2": "kg m2",
    "N_m_kg": "N m/kg",
    "W_kg": "W/kg",
    "N_m": "N m",
    "rad_s": "rad/s",
    "m_s": "m/s",
    "1_min": "1/min",
    "rad": "rad",
    "deg": "deg",
    "m": "m",
    "N": "N",
    "kg": "kg",
    "s": "s",
    "J": "J",
    "BW": "BW",
}
"""Units by how the name of a signal or measure ends."""
ENDINGS = {unit: ending for ending, unit in UNITS.items()}
"""Ends of names, by unit."""

UNIT = re.compile(f"_({'|'.join(UNITS)})$")


def unit_of(column: str) -> str:
    """Unit of a column, "" for a pure number: "N m" of RightLegTibiaMotion.torque_N_m."""
    found = UNIT.search(column)
    return UNITS[found[1]] if found else ""


def column_of(columns: Sequence[str], name: str) -> str:
    """The column of a name with or without its unit.

    Raises:
        ParameterError: there is none.
    """
    if name in columns:
        return name
    for column in columns:
        if UNIT.sub("", column) == name:
            return column
    allowed = f"the {len(columns)} of the run, signals.column_names"
    raise ParameterError(f"{name}: no such signal; allowed: {allowed}{near_names(str(name), columns)}")


def matrix(signals: pa.Table, columns: Sequence[str]) -> Array:
    """Columns of a table as an array, shape (rows, len(columns))."""
    if not columns:
        return np.empty((signals.num_rows, 0))
    return np.column_stack([signals[column].to_numpy() for column in columns])
