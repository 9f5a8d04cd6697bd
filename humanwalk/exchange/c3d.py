"""A run as a C3D file: markers as points and two force plates, in W (x forward, y left, z up).

Lengths are in millimeters and numbers in single precision, as usual in C3D files.
"""

from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from humanwalk.body import Side
from humanwalk.body.markers import markers
from humanwalk.exchange.motion import GroundForce, ground_forces, marker_paths, sample_rate
from humanwalk.extras import missing_package
from humanwalk.files import write_whole
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.folder import Run

MAX_FRAMES = 65_535
"""Most frames that the 16 bits of a C3D header count; readers drop the rest."""

R_WF: Array = np.diag([-1.0, 1.0, -1.0])
"""From a force plate's frame F, whose z points down by convention, to W."""


def write_c3d(run: Run, folder: Path) -> list[Path]:
    """Write run.c3d.

    Each foot has its own plate, right then left, both as large as the walk. They are of type 2: channels are force and
    moment about the center of the plate's surface.

    Raises:
        ParameterError: ezc3d is not installed, or the run is too long.
    """
    path = folder / "run.c3d"
    if run.time.size > MAX_FRAMES:
        raise ParameterError(
            f"{printable(run.path)}: {run.time.size} samples; allowed in C3D: up to {MAX_FRAMES}; export csv or mat, "
            "or walk with a longer recording.signal_period"
        )
    c3d = _c3d(_ezc3d(), run)
    write_whole(path, lambda beside: c3d.write(str(beside)))
    return [path]


def _ezc3d() -> ModuleType:
    try:
        import ezc3d
    except ImportError:
        raise missing_package("ezc3d", "c3d") from None
    module: ModuleType = ezc3d
    return module


def _c3d(ezc3d: ModuleType, run: Run) -> Any:
    """The file in memory, an ezc3d.c3d."""
    paths, loads, rate = marker_paths(run), ground_forces(run), sample_rate(run)
    landmarks = {marker.name: marker.landmark for marker in markers(run.scenario.subject.skeleton)}
    file = ezc3d.c3d()
    point = file["parameters"]["POINT"]
    point["UNITS"]["value"] = ["mm"]
    point["RATE"]["value"] = [rate]
    point["LABELS"]["value"] = list(paths)
    point["DESCRIPTIONS"]["value"] = [landmarks[name] for name in paths]
    file.add_parameter("POINT", "X_SCREEN", "+X")
    file.add_parameter("POINT", "Y_SCREEN", "+Z")
    rows = next(iter(paths.values())).shape[0]
    points = np.ones((4, len(paths), rows))
    for i, path in enumerate(paths.values()):
        points[:3, i] = 1000.0 * path.T
    file["data"]["points"] = points

    names = [f"{quantity}{axis}{i}" for i in (1, 2) for quantity in "FM" for axis in "xyz"]
    analog = file["parameters"]["ANALOG"]
    analog["RATE"]["value"] = [rate]
    analog["LABELS"]["value"] = names
    analog["UNITS"]["value"] = [unit for _ in loads for unit in (*["N"] * 3, *["Nmm"] * 3)]
    analog["SCALE"]["value"] = [1.0] * len(names)
    analog["OFFSET"]["value"] = [0] * len(names)
    analog["GEN_SCALE"]["value"] = [1.0]
    file["data"]["analogs"] = np.vstack([_channels(load) for load in loads.values()])[None]

    corners = _corners(loads)
    plates = file["parameters"]["FORCE_PLATFORM"]
    plates["USED"]["value"] = [len(loads)]
    plates["TYPE"]["value"] = [2] * len(loads)
    plates["ZERO"]["value"] = [1, 0]
    plates["CORNERS"]["value"] = np.stack([corners] * len(loads), axis=2)
    plates["ORIGIN"]["value"] = np.zeros((3, len(loads)))
    plates["CHANNEL"]["value"] = np.arange(1, 6 * len(loads) + 1).reshape(len(loads), 6).T
    return file


def _channels(load: GroundForce) -> Array:
    """Force [N] and moment about W's origin [N mm] on the foot, in the plate's frame; shape (6, rows)."""
    moment = np.cross(load.point, load.force) + load.free_moment
    return np.vstack((R_WF.T @ load.force.T, 1000.0 * R_WF.T @ moment.T))


def _corners(loads: Mapping[Side, GroundForce]) -> Array:
    """Corners of a plate around Wo that contains every center of pressure [mm], shape (3, 4), in F's order."""
    reach = np.ceil(np.max([np.abs(load.point).max(axis=0) for load in loads.values()], axis=0) + 0.5)
    signs = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    return np.asarray(1000.0 * R_WF @ (signs * reach).T)
