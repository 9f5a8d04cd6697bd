"""Runs a tuning: its search, and its trials on Dask workers.

The search is repeated from the table when a tuning resumes, so that an interrupted tuning has the same trials as one
that was not.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from distributed import Client

from humanwalk.quantity import ParameterError, printable, require_kind
from humanwalk.study.execute import never, run_jobs
from humanwalk.study.objectives import Score
from humanwalk.study.row import Row
from humanwalk.study.search import Asked, search
from humanwalk.study.trial import RUNS, Trial, simulate_trial
from humanwalk.study.trials import TrialTable, open_table, score_of, trial_row
from humanwalk.study.tuning import Tuning, start_values

SAME = 1e-4
"""Relative difference up to which a stored parameter is the one that is asked for: the last of its digits may differ
between machines."""


def tune(
    tuning: Tuning,
    folder: Path | str,
    client: Client,
    on_trial: Callable[[Mapping[int, Row]], None] = lambda rows: None,
    should_stop: Callable[[], bool] = never,
    function: Callable[[Trial], Row] = simulate_trial,
) -> None:
    """Simulate the trials of a tuning that its folder has no rows of.

    Args:
        tuning: the tuning.
        folder: of its table; a new one, or that of the same tuning, which resumes.
        client: of the Dask cluster; see `humanwalk.study.cluster`.
        on_trial: called with the rows of all finished trials by number, first of all and after each trial.
        should_stop: asked several times a second; true ends the tuning, which can be resumed.
        function: what a worker does with a trial.

    Raises:
        ParameterError: the tuning or the folder cannot be used, the scenario itself fails, or the scheduler is gone;
            finished trials are kept.
    """
    require_kind(tuning, Tuning, "tune", 'load_tuning("cost_of_transport"), ...')
    starts = start_values(tuning)
    with open_table(Path(folder), tuning) as table:
        on_trial(table.rows)

        def add(trial: Trial, returned: Row) -> None:
            if trial.index == 0 and RUNS not in returned:
                raise ParameterError(f"trial 0, the scenario: {returned['end']}; allowed: one that runs; correct it")
            table.append(trial.index, trial_row(tuning, trial.index, batch[trial.index], returned))
            on_trial(table.rows)

        batch: dict[int, Mapping[str, float]] = {}

        def evaluate(asked: Sequence[Asked]) -> Sequence[Score] | None:
            batch.clear()
            for trial, coordinates in asked:
                batch[trial] = tuning.values_at(coordinates, starts)
                _require_same_values(table, trial, batch[trial])
            missing = [trial for trial in batch if trial not in table.rows]
            jobs = (Trial(trial, tuning.with_values(batch[trial]), tuning.falls) for trial in missing)
            run_jobs(client, function, jobs, add, should_stop)
            done = all(trial in table.rows for trial in batch)
            return [score_of(tuning, table.rows[trial]) for trial in batch] if done else None

        search(
            tuning.sampler,
            tuning.seed,
            tuning.population,
            list(tuning.parameters),
            len(tuning.objectives),
            tuning.trials,
            evaluate,
        )


def _require_same_values(table: TrialTable, trial: int, values: Mapping[str, float]) -> None:
    row = table.rows.get(trial)
    if row is None:
        return
    for name, value in values.items():
        if not math.isclose(row[f"parameters.{name}"], value, rel_tol=SAME, abs_tol=1e-12):
            raise ParameterError(
                f"{printable(table.path)}: trial {trial} has {name} = {row[f'parameters.{name}']:g}, the search has "
                f"{value:g}; allowed: a table as this version of humanwalk, Optuna and cmaes wrote it; choose another "
                "folder with -o"
            )
