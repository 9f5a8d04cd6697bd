"""Writes a run in the formats of other programs."""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pyarrow import csv
from scipy.io import savemat

from humanwalk.exchange.c3d import write_c3d
from humanwalk.exchange.opensim import write_opensim
from humanwalk.files import WRITABLE, file_errors, make_folder, require_new, require_replaceable, write_whole
from humanwalk.measures.signals import matrix
from humanwalk.measures.summary_rows import EXTERNAL_SUPPORT
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.scenario import dump_scenario
from humanwalk.systems.push_source import FORCE_COLUMNS


def write_csv(run: Run, folder: Path) -> list[Path]:
    """Write signals.csv: one row per sample, one column per signal, units in the column names, all digits.

    No cell is a formula to a spreadsheet: values are numbers, and column names begin with a letter (`read_signals`).
    """
    path = folder / "signals.csv"
    write_whole(path, lambda beside: csv.write_csv(run.signals, beside))
    return [path]


def write_mat(run: Run, folder: Path) -> list[Path]:
    """Write run.mat for MATLAB and Octave.

    `signals.JOINT.angle_rad` is the signal of that name, a column vector; `signals.time_s` is the time, and `scenario`
    the text of the scenario.
    """
    signals: dict[str, Any] = {}
    for name in run.signals.column_names:
        thing, dot, quantity = name.partition(".")
        values = run.signals[name].to_numpy()
        if dot:
            signals.setdefault(thing, {})[quantity] = values
        else:
            signals[name] = values
    data = {"signals": signals, "scenario": dump_scenario(run.scenario)}
    path = folder / "run.mat"
    write_whole(path, lambda beside: savemat(beside, data, long_field_names=True, oned_as="column"))
    return [path]


NEED_PHYSICS = ("opensim", "c3d")
"""Formats that contain forces."""

FORMATS: dict[str, Callable[[Run, Path], list[Path]]] = {
    "opensim": write_opensim,
    "c3d": write_c3d,
    "csv": write_csv,
    "mat": write_mat,
}
"""Formats by name: functions that write the files of a run into a folder and return their paths."""


def forces_left_out(run: Run, to: str) -> tuple[str, ...]:
    """Forces on the body that a format with the forces on the feet does not contain."""
    if to not in NEED_PHYSICS:
        return ()
    has_pushes = set(FORCE_COLUMNS) <= set(run.signals.column_names)
    acting = {
        EXTERNAL_SUPPORT: run.summary["external_support"],
        "pushes": has_pushes and matrix(run.signals, FORCE_COLUMNS).any(),
    }
    return tuple(name for name, acts in acting.items() if acts)


def export_run(run: Run, to: str, output: Path | None = None, *, overwrite: bool = False) -> list[Path]:
    """Write a run in a format into a folder, all files whole or none.

    Args:
        run: What to write.
        to: One of FORMATS.
        output: Folder; by default one inside the run's, named by the format, whose files are replaced.
        overwrite: Whether files of `output` may be replaced.

    Raises:
        ParameterError: Unknown format, a run without the required forces, a missing optional package, or a file that is
            there already or cannot be written.
    """
    if to not in FORMATS:
        raise ParameterError(f"--to {to}: unknown; allowed: {', '.join(FORMATS)}; choose one of them")
    if to in NEED_PHYSICS:
        run.require_physics()
    folder = run.subfolder(to) if output is None else output
    make_folder(folder)
    with file_errors(folder, WRITABLE), tempfile.TemporaryDirectory(prefix=".export-", dir=folder) as beside:
        written = {folder / file.name: file for file in FORMATS[to](run, Path(beside))}
        for path in written:
            if output is None:
                require_replaceable(path)
            else:
                require_new(path, overwrite)
        for path, file in written.items():
            file.replace(path)
    return list(written)
