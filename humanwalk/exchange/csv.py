"""A run as comma-separated values: one row per sample, one column per signal, units in the column names.

No cell is a formula to a spreadsheet: values are numbers, and column names begin with a letter (`read_signals`).
"""

from pathlib import Path

from pyarrow import csv

from humanwalk.files import write_whole
from humanwalk.run.folder import Run


def write_csv(run: Run, folder: Path) -> list[Path]:
    """Write signals.csv, with all digits of every number."""
    path = folder / "signals.csv"
    write_whole(path, lambda beside: csv.write_csv(run.signals, beside))
    return [path]
