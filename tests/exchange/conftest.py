"""A run of made-up signals, all of them different, written to a folder without a simulation."""

import numpy as np
import pyarrow as pa
import pytest
from scipy.spatial.transform import Rotation

from humanwalk.measures.signals import TIME
from humanwalk.run.folder import Run
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import load_scenario

ROWS = 81
PERIOD = 0.005
PERIODS = {"recording.signal_period": str(PERIOD), "simulation.time_step": "0.001"}


def made_up_signals(columns: tuple[str, ...]) -> pa.Table:
    """Every column a wave of its own; a pelvis that turns; a right foot that lands twice, a left one never."""
    time = PERIOD * np.arange(ROWS)
    names = columns
    data = {name: 0.3 + 0.2 * np.sin(3 * time + i) for i, name in enumerate(names)}
    turns = Rotation.from_euler("zyx", np.column_stack((2 * time, 0.3 * time, -0.2 * time)))
    quaternion = turns.as_quat(scalar_first=True).T
    data |= {f"pelvis.quaternion_{axis}": quaternion[i] for i, axis in enumerate("wxyz")}
    down = (time < 0.1) | (time > 0.25)
    for foot, loaded in (("right_foot", down), ("left_foot", np.zeros(ROWS, dtype=bool))):
        data[f"{foot}.loaded"] = loaded.astype(float)
        data[f"{foot}.force_x_N"] = np.where(loaded, 40 * np.cos(9 * time), 0.0)
        data[f"{foot}.force_y_N"] = np.where(loaded, 15.0, 0.0)
        data[f"{foot}.force_z_N"] = np.where(loaded, 700 + 90 * np.sin(20 * time), 0.5)
        data[f"{foot}.cop_x_m"] = np.where(loaded, 1.5 * time, 0.0)
        data[f"{foot}.cop_y_m"] = np.where(loaded, -0.1, 0.0)
        data[f"{foot}.cop_z_m"] = np.zeros(ROWS)
        data[f"{foot}.free_moment_N_m"] = np.where(loaded, 3 * np.sin(time), 0.0)
    return pa.table({TIME: time, **data})


@pytest.fixture(scope="session")
def signals(columns: tuple[str, ...]) -> pa.Table:
    return made_up_signals(columns)


@pytest.fixture(scope="session")
def run(signals: pa.Table, tmp_path_factory: pytest.TempPathFactory) -> Run:
    scenario = load_scenario("thesis", {"subject.stature": "1.68", "subject.mass": "61", **PERIODS})
    return Outcome(scenario, signals, "completed", 1.0).write(tmp_path_factory.mktemp("run"), "made up")
