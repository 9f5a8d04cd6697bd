"""A tuning with a function of the parameters instead of a simulation, and one that simulates."""

import os
import re
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import dask
import pytest
from distributed import Client, LocalCluster

from humanwalk.choices import BalancedController
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario
from humanwalk.study.cluster import SETTINGS
from humanwalk.study.row import Row, run_columns
from humanwalk.study.search import SAMPLERS
from humanwalk.study.trial import OF_RUNS, RUNS, Trial
from humanwalk.study.trials import TRIALS, best, read_trials, write_best
from humanwalk.study.tune import tune
from humanwalk.study.tuning import Tuning, parse_tuning, start_values

PARAMETERS = ("dcm_gain", "double_support_gain")
OPTIMUM = 1.4

TUNING = """
runs: {scenario: walk, set: {duration: 0.3}, factors: {seed: {seeds: {count: 3}}}}
parameters:
  controller.balanced.planner.dcm_gain: {low: 0.5, high: 2.0}
  controller.balanced.planner.double_support_gain: {low: 1.0, high: 4.0, log: true}
objectives: {cost_of_transport: {}}
bounds: {upright_share: {low: 0.9}}
population: 4
"""


def tuning(**replaced: str) -> Tuning:
    lines = [line for line in TUNING.splitlines() if line.partition(":")[0] not in replaced]
    return parse_tuning("\n".join([*lines, *(f"{name}: {value}" for name, value in replaced.items())]))


def run_of(survived: bool, **measures: float) -> Row:
    defaults = {"survived": survived, "end": "completed" if survived else "fell", "host": "test", "wall_time_s": 1.0}
    return dict.fromkeys((*run_columns(), *OF_RUNS)) | defaults | measures


def sphere(trial: Trial) -> Row:
    """The squared distance of the parameters from OPTIMUM as cost of transport; far from it the walker falls."""
    gains = [trial.runs.base["controller"]["balanced"]["planner"][name] for name in PARAMETERS]
    distance = sum((gain - OPTIMUM) ** 2 for gain in gains)
    if gains[0] < 0.9:
        return {RUNS: [run_of(False, upright_share=gains[0])]}
    return {RUNS: [run_of(True, upright_share=1.0, cost_of_transport=distance) for _ in trial.runs.points]}


def slow_for_odd_trials(trial: Trial) -> Row:
    time.sleep(0.02 * (trial.index % 2))
    return sphere(trial)


def broken(trial: Trial) -> Row:
    raise ZeroDivisionError("of the scenario")


@contextmanager
def threads(number: int) -> Iterator[Client]:
    """A cluster within this process, whose workers find the functions of this module, with the settings of studies."""
    options = {"processes": False, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with (
        dask.config.set(SETTINGS),
        LocalCluster(n_workers=number, **options) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def one_worker() -> Iterator[Client]:
    with threads(1) as client:
        yield client


def rows(folder: Path) -> list[Row]:
    return read_trials(folder)[1]


def test_it_finds_the_optimum(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="41"), tmp_path, one_worker, function=sphere)
    found = best(*read_trials(tmp_path))
    assert found is not None
    assert found["feasible"]
    assert found["cost"] < 0.1 * rows(tmp_path)[0]["cost"]


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_any_number_of_workers_gives_the_same_trials(sampler: str, tmp_path: Path, one_worker: Client) -> None:
    wanted = tuning(trials="17", sampler=sampler)
    tune(wanted, tmp_path / "one", one_worker, function=sphere)
    with threads(3) as three_workers:
        tune(wanted, tmp_path / "three", three_workers, function=slow_for_odd_trials)
    assert rows(tmp_path / "three") == rows(tmp_path / "one")


def test_the_first_trial_is_the_scenario_itself(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="1"), tmp_path, one_worker, function=sphere)
    (first,) = rows(tmp_path)
    for name, value in start_values(tuning()).items():
        assert first[f"parameters.{name}"] == value


def test_a_tuning_that_was_stopped_resumes_with_the_same_trials(tmp_path: Path, one_worker: Client) -> None:
    wanted = tuning(trials="17")
    tune(wanted, tmp_path / "whole", one_worker, function=sphere)
    for stop in (1, 4, 7, 17):
        done: list[int] = []

        def count(found: object, done: list[int] = done) -> None:
            done.append(len(rows(tmp_path / "parts")))

        tune(
            wanted,
            tmp_path / "parts",
            one_worker,
            on_trial=count,
            should_stop=lambda stop=stop, done=done: bool(done) and done[-1] >= stop,  # type: ignore[misc]
            function=sphere,
        )
        assert stop <= len(rows(tmp_path / "parts"))
    assert rows(tmp_path / "parts") == rows(tmp_path / "whole")


def test_more_trials_continue_a_tuning(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="7"), tmp_path / "parts", one_worker, function=sphere)
    tune(tuning(trials="13"), tmp_path / "parts", one_worker, function=sphere)
    tune(tuning(trials="13"), tmp_path / "whole", one_worker, function=sphere)
    assert rows(tmp_path / "parts") == rows(tmp_path / "whole")


def test_fewer_trials_than_are_done_are_refused(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="5"), tmp_path, one_worker, function=sphere)
    refusal = rf"^trials: 4 is less than the 5 of .*{TRIALS}; allowed: from 5 on; write trials: 5$"
    with pytest.raises(ParameterError, match=refusal):
        tune(tuning(trials="4"), tmp_path, one_worker, function=sphere)
    assert read_trials(tmp_path)[0].trials == len(rows(tmp_path)) == 5
    # Nor does an edit of its own file lose count.
    file = tmp_path / "tuning.yaml"
    file.write_text(file.read_text().replace("trials: 5", "trials: 4"))
    with pytest.raises(ParameterError, match=refusal):
        read_trials(tmp_path)


def test_fewer_trials_than_were_planned_end_a_tuning(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="9"), tmp_path, one_worker, should_stop=lambda: len(rows(tmp_path)) >= 5, function=sphere)
    done = rows(tmp_path)
    tune(tuning(trials=str(len(done))), tmp_path, one_worker, function=broken)
    assert rows(tmp_path) == done


def test_a_line_that_was_cut_is_repeated(tmp_path: Path, one_worker: Client) -> None:
    wanted = tuning(trials="9")
    tune(wanted, tmp_path, one_worker, function=sphere)
    table, whole = tmp_path / TRIALS, rows(tmp_path)
    table.write_bytes(table.read_bytes()[:-20])
    assert len(rows(tmp_path)) == 8
    tune(wanted, tmp_path, one_worker, function=sphere)
    assert rows(tmp_path) == whole


def test_a_trial_that_falls_costs_more_than_any_that_walks(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="25", seed="1"), tmp_path, one_worker, function=sphere)
    fallen = [row for row in rows(tmp_path) if row["falls"]]
    walking = [row for row in rows(tmp_path) if not row["falls"]]
    assert min(row["cost"] for row in fallen) > max(row["cost"] for row in walking)
    assert not any(row["feasible"] for row in fallen)
    assert all(row["upright_share"] < 1 / 3 for row in fallen)


def test_the_file_of_the_same_tuning_is_left_as_its_author_wrote_it(tmp_path: Path, one_worker: Client) -> None:
    mine, more = (f"# mine\n{TUNING}trials: {trials}\n" for trials in (1, 2))
    (tmp_path / "tuning.yaml").write_text(mine)
    tune(parse_tuning(mine), tmp_path, one_worker, function=sphere)
    assert (tmp_path / "tuning.yaml").read_text() == mine
    tune(parse_tuning(more), tmp_path, one_worker, function=sphere)
    assert read_trials(tmp_path)[0].trials == len(rows(tmp_path)) == 2


def test_the_folder_of_another_tuning_is_refused_in_a_line(tmp_path: Path, one_worker: Client) -> None:
    tune(tuning(trials="1"), tmp_path, one_worker, function=sphere)
    with pytest.raises(ParameterError, match=r"holds another tuning; allowed: a new folder"):
        tune(tuning(trials="1", seed="5"), tmp_path, one_worker, function=sphere)


def test_a_table_of_another_search_is_refused_in_a_line(tmp_path: Path, one_worker: Client) -> None:
    wanted = tuning(trials="2")
    tune(wanted, tmp_path, one_worker, function=sphere)
    table = tmp_path / TRIALS
    head, first, second = table.read_text(encoding="utf-8").splitlines()
    second = re.sub(r"^1,[^,]*,", "1,0.77,", second)
    table.write_text("\n".join([head, first, second, ""]), encoding="utf-8")
    with pytest.raises(ParameterError, match=r"trial 1 has .*dcm_gain = 0\.77, the search has .*; allowed: "):
        tune(wanted, tmp_path, one_worker, function=sphere)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("0,1.0,", "0,,", 1), "dcm_gain has a cell that is empty or not within 0.5 to 2"),
        (lambda text: text.replace("0,1.0,", "0,nan,", 1), "dcm_gain has a cell that is empty or not within"),
        (lambda text: text.replace("0,1.0,", "0,2.5,", 1), "dcm_gain has a cell that is empty or not within 0.5 to 2"),
        (lambda text: re.sub("(\n0,.*?,.*?),.*?,", r"\1,-1e308,", text), r"values.* not within -1e\+100 to 1e\+100"),
        (lambda text: text.replace("0,1.0,", "0,one,", 1), "allowed: the file as humanwalk"),
        (lambda text: text.replace("trial", "row", 1), "columns of another study or tuning"),
        (lambda text: text + text.splitlines()[1] + "\n", "a row twice"),
    ],
)
def test_a_table_that_was_changed_is_refused_in_a_line(
    change: Callable[[str], str], message: str, tmp_path: Path, one_worker: Client
) -> None:
    tune(tuning(trials="1"), tmp_path, one_worker, function=sphere)
    table = tmp_path / TRIALS
    table.write_text(change(table.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(ParameterError, match=message) as caught:
        read_trials(tmp_path)
    assert "\n" not in str(caught.value)


def test_a_scenario_that_cannot_be_simulated_ends_the_tuning_in_a_line(tmp_path: Path, one_worker: Client) -> None:
    with pytest.raises(ParameterError, match=r"trial 0, the scenario: error: ZeroDivisionError: of the scenario; "):
        tune(tuning(trials="5"), tmp_path, one_worker, function=broken)


def test_the_best_trial_is_a_scenario(tmp_path: Path, one_worker: Client) -> None:
    wanted = tuning(trials="9")
    tune(wanted, tmp_path, one_worker, function=sphere)
    found = best(wanted, rows(tmp_path))
    assert found is not None
    scenario = load_scenario(write_best(tmp_path, wanted, found))
    assert scenario.duration == 0.3
    assert isinstance(scenario.controller, BalancedController)
    assert scenario.controller.planner.dcm_gain == found["parameters.controller.balanced.planner.dcm_gain"]


def test_kill_9_loses_no_trial(tmp_path: Path, one_worker: Client) -> None:
    """The command is killed while it appends; what it left is a part of the undisturbed table, and resumes to it."""
    program = f"""
        from distributed import Client, LocalCluster
        from pathlib import Path
        import runpy
        test = runpy.run_path({str(Path(__file__))!r})
        def slow(trial):
            import time
            time.sleep(0.02)
            return test["sphere"](trial)
        with test["threads"](1) as client:
            test["tune"](test["tuning"](trials="400"), Path({str(tmp_path / "killed")!r}), client, function=slow)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(program)])
    table = tmp_path / "killed" / TRIALS
    while not (table.exists() and len(table.read_bytes().splitlines()) > 7):
        assert process.poll() is None
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    left = rows(tmp_path / "killed")
    wanted = tuning(trials=str(len(left) + 10))
    tune(wanted, tmp_path / "killed", one_worker, function=sphere)
    tune(wanted, tmp_path / "whole", one_worker, function=sphere)
    whole = rows(tmp_path / "whole")
    assert rows(tmp_path / "killed") == whole
    assert all(row == whole[row["trial"]] for row in left)


def test_two_trials_of_simulations(tmp_path: Path, one_worker: Client) -> None:
    objective = "{peak_torque_N_m.LeftLegTibiaMotion: {over: max}, upright_share: {goal: maximize}}"
    tune(tuning(trials="2", objectives=objective, bounds="{}"), tmp_path, one_worker)
    first, second = rows(tmp_path)
    for row in (first, second):
        assert row["runs"] == 3
        assert row["values.upright_share"] == 1.0
        assert row["values.peak_torque_N_m.LeftLegTibiaMotion"] > 1.0
        assert row["end"] == "completed"
    assert first["cost"] != second["cost"]
