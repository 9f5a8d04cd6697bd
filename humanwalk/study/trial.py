"""One trial of a tuning, as a worker simulates it: its runs in order, and none after too many falls."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from humanwalk.scenario import Scenario
from humanwalk.study.row import Job, Row, simulate_row
from humanwalk.study.study import Study
from humanwalk.walking.push import all_pushes

RECOVERY = 3.0
"""A push counts as survived if the walker is upright this long after it [s]: five to six steps."""

RUNS = "runs"
"""Key of the rows of the runs in what a worker returns of a trial."""


@dataclass(frozen=True)
class Trial:
    """What a worker needs of a trial.

    Attributes:
        index: number of the trial.
        runs: in the order in which they are simulated.
        falls: number of falls after which no further run is simulated.
    """

    index: int
    runs: Study
    falls: int


def simulate_trial(trial: Trial) -> Row:
    """The rows of the runs that were simulated: all of them, or those up to the last fall that is allowed.

    Raises:
        ParameterError: a scenario cannot be simulated.
    """
    rows: list[Row] = []
    falls = 0
    for index, point in enumerate(trial.runs.points):
        scenario = trial.runs.scenario_at(point)
        row = simulate_row(Job(index, scenario))
        rows.append(row | {name: measure(scenario, row) for name, measure in OF_RUNS.items()})
        falls += not row["survived"]
        if falls >= trial.falls:
            break
    return {RUNS: rows}


def upright_share(scenario: Scenario, row: Row) -> float:
    """Share of the duration of a run until its fall; 1 without a fall."""
    return 1.0 if row["survived"] else float(min(row["duration_s"] / scenario.duration, 1.0))


def pushes_survived_share(scenario: Scenario, row: Row) -> float:
    """Share of the pushes of a run after which the walker was upright for RECOVERY; `survived` without pushes."""
    times = [push.time for push in all_pushes(scenario.pushes, scenario.seed) if push.time < scenario.duration]
    if row["survived"] or not times:
        return float(row["survived"])
    return float(np.mean(np.array(times) + RECOVERY < row["duration_s"]))


def speed_error(scenario: Scenario, row: Row) -> float | None:
    """Distance of the mean speed from the commanded one [m/s]."""
    speed, commanded = row["mean_speed_m_s"], row["commanded_speed_m_s"]
    return None if speed is None or commanded is None else float(abs(speed - commanded))


OF_RUNS: dict[str, Callable[[Scenario, Row], float | None]] = {
    "upright_share": upright_share,
    "pushes_survived_share": pushes_survived_share,
    "speed_error_m_s": speed_error,
}
"""Measures of a run beside the columns of a study."""
