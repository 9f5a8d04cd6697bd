"""Writes a run in another program's formats."""

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
"""Formats that hold forces."""

FORMATS: dict[str, Callable[[Run, Path], list[Path]]] = {
    "opensim": write_opensim,
    "c3d": write_c3d,
    "csv": write_csv,
    "mat": write_mat,
}
"""Every format by name; a function writes a run's files into a folder and returns their paths."""


def export_run(run: Run, to: str, output: Path | None = None) -> list[Path]:
    """Write a run in a format into a folder, each file whole or not at all.

    Args:
        run: what to write.
        to: one of FORMATS.
        output: folder; by default the format's name inside the run's.

    Raises:
        ParameterError: unknown format, a run without the forces that it holds, a missing optional package, or a file
            that cannot be written.
    """
    if to not in FORMATS:
        raise ParameterError(f"--to {to}: unknown; allowed: {', '.join(FORMATS)}; choose one of them")
    if to in NEED_PHYSICS:
        run.require_physics()
    folder = run.subfolder(to) if output is None else output
    make_folder(folder)
    return FORMATS[to](run, folder)
