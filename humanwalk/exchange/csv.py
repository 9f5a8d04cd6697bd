"""A run as comma-separated values: one row per sample, one column per signal, units in the columns' names."""

from pathlib import Path

from pyarrow import csv

from humanwalk.files import write_whole
from humanwalk.run.folder import Run


def write_csv(run: Run, folder: Path) -> list[Path]:
    """Write signals.csv; numbers keep all their digits."""
    path = folder / "signals.csv"
    write_whole(path, lambda beside: csv.write_csv(run.signals, beside))
    return [path]
