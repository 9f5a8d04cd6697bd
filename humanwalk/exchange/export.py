"""Writes a run in the formats of other programs."""

from collections.abc import Callable
from pathlib import Path

from humanwalk.exchange.c3d import write_c3d
from humanwalk.exchange.csv import write_csv
from humanwalk.exchange.mat import write_mat
from humanwalk.exchange.opensim import write_opensim
from humanwalk.files import make_folder
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run

NEED_PHYSICS = ("opensim", "c3d")
"""Formats that contain forces."""

FORMATS: dict[str, Callable[[Run, Path], list[Path]]] = {
    "opensim": write_opensim,
    "c3d": write_c3d,
    "csv": write_csv,
    "mat": write_mat,
}
"""Formats by name: functions that write the files of a run into a folder and return their paths."""


def export_run(run: Run, to: str, output: Path | None = None) -> list[Path]:
    """Write a run in a format into a folder, each file whole or not at all.

    Args:
        run: What to write.
        to: One of FORMATS.
        output: Folder; by default one inside the run's, named by the format.

    Raises:
        ParameterError: Unknown format, a run without the required forces, a missing optional package, or a file that
            cannot be written.
    """
    if to not in FORMATS:
        raise ParameterError(f"--to {to}: unknown; allowed: {', '.join(FORMATS)}; choose one of them")
    if to in NEED_PHYSICS:
        run.require_physics()
    folder = run.subfolder(to) if output is None else output
    make_folder(folder)
    return FORMATS[to](run, folder)
