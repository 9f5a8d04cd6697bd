"""A run as a file for MATLAB and Octave."""

from pathlib import Path
from typing import Any

from scipy.io import savemat

from humanwalk.files import write_whole
from humanwalk.run.folder import Run
from humanwalk.scenario import dump_scenario


def write_mat(run: Run, folder: Path) -> list[Path]:
    """Write run.mat.

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
