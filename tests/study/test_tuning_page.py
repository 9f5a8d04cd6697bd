"""What `tune show` prints and writes."""

import html
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from humanwalk.cli.main import app
from humanwalk.scenario import load_scenario
from humanwalk.study.results import MAX_MAGNITUDE
from humanwalk.study.row import Row
from humanwalk.study.trial import RUNS
from humanwalk.study.trials import (
    BEST,
    TRIAL,
    best,
    open_table,
    pareto_front,
    read_trials,
    score_of,
    trial_row,
    write_best,
)
from humanwalk.study.tuning import Tuning, parse_tuning, start_values
from humanwalk.study.tuning_figures import parameters
from humanwalk.study.tuning_page import PAGE, parameter_rows, value_rows, write_tuning_page
from humanwalk.view.plots.drawing import save

TUNING = """
description: Cheap & <b>stable</b>
runs: {scenario: walk, factors: {seed: {seeds: {count: 2}}}}
parameters:
  controller.balanced.planner.dcm_gain: {low: 0.5, high: 2.0}
  controller.balanced.whole_body.com_weight: {low: 100.0, high: 900.0, log: true}
objectives:
  "<script>alert(1)</script>": {measure: cost_of_transport}
  speed_error_m_s: {weight: 0.1}
bounds: {upright_share: {low: 0.9}}
sampler: SAMPLER
"""


def run_of(cost: float, error: float, upright: float) -> Row:
    survived = upright == 1.0
    measures = {"cost_of_transport": cost, "speed_error_m_s": error, "upright_share": upright}
    return measures | {
        "survived": survived,
        "end": "completed" if survived else "fell",
        "wall_time_s": 9.0,
        "host": "x",
    }


def filled(folder: Path, sampler: str, trials: int, falling: float = 0.2) -> Tuning:
    """A folder of trials with random numbers, a share of which fall."""
    tuning = parse_tuning(TUNING.replace("SAMPLER", sampler))
    random = np.random.default_rng(1)
    with open_table(folder, tuning) as table:
        for trial in range(trials):
            gain, weight = float(random.uniform(0.5, 2.0)), float(random.uniform(100.0, 900.0))
            values = {"controller.balanced.planner.dcm_gain": gain, "controller.balanced.whole_body.com_weight": weight}
            runs = (
                [run_of(gain, abs(weight - 400.0), 1.0)] * 2 if random.random() >= falling else [run_of(9.0, 9.0, 0.3)]
            )
            table.append(trial, trial_row(tuning, trial, values, {RUNS: runs}))
    return tuning


@pytest.mark.parametrize(("sampler", "pictures"), [("cma_es", 4), ("nsga2", 4)])
def test_the_page_shows_the_best_trial_and_every_figure(sampler: str, pictures: int, tmp_path: Path) -> None:
    filled(tmp_path, sampler, 40)
    tuning, rows = read_trials(tmp_path)
    found = best(tuning, rows)
    assert found is not None
    page = write_tuning_page(tmp_path, tuning, rows).read_text(encoding="utf-8")
    assert f"Best: trial {found[TRIAL]}" in page
    assert f"{found['parameters.controller.balanced.planner.dcm_gain']:.4g}" in page
    assert page.count("<img ") == pictures


@pytest.mark.parametrize("name", [BEST, PAGE])
def test_a_file_that_cannot_be_written_is_refused_before_the_tables(name: str, tmp_path: Path) -> None:
    filled(tmp_path, "cma_es", 4)
    (tmp_path / name).mkdir()
    result = CliRunner().invoke(app, ["tune", "show", str(tmp_path)])
    assert str(result.exception) == f"{tmp_path / name}: a folder or device; allowed: a file; move it away"
    assert result.stdout == ""


def test_texts_of_the_file_are_no_markup(tmp_path: Path) -> None:
    filled(tmp_path, "nsga2", 30)
    page = write_tuning_page(tmp_path, *read_trials(tmp_path)).read_text(encoding="utf-8")
    assert "<script" not in page
    assert "<b>stable" not in page
    assert html.escape("<script>alert(1)</script>") in page


def test_numbers_at_a_logarithmic_axis_are_no_formulas(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "cma_es", 10)
    rows = read_trials(tmp_path)[1]
    found = best(tuning, rows)
    assert found is not None
    figure = parameters(tuning, rows, found, start_values(tuning))
    save(figure, tmp_path / "parameters.png")
    weight = figure.axes[1]
    assert weight.get_xscale() == "log"
    texts = [tick.get_text() for tick in (*weight.get_xticklabels(), *weight.get_xticklabels(minor=True))]
    assert "200" in texts
    assert not any("$" in text for text in texts)


def test_the_largest_numbers_of_a_table_are_drawn(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "nsga2", 25)
    for sign in (-1.0, 1.0):
        name = f"values.{next(iter(tuning.objectives))}"
        row = read_trials(tmp_path)[1][0] | {name: sign * MAX_MAGNITUDE, "cost": -sign * MAX_MAGNITUDE}
        with open_table(tmp_path, tuning) as table:
            table.append(len(table.rows), row | {TRIAL: len(table.rows)})
    assert write_tuning_page(tmp_path, *read_trials(tmp_path)).is_file()


@pytest.mark.parametrize("trials", [0, 1, 2])
def test_a_young_tuning_has_a_page(trials: int, tmp_path: Path) -> None:
    filled(tmp_path, "cma_es", trials)
    page = write_tuning_page(tmp_path, *read_trials(tmp_path)).read_text(encoding="utf-8")
    assert f"{trials} of 200 trials" in page


def test_a_tuning_in_which_all_fall_has_a_page_and_no_best(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "cma_es", 25, falling=1.0)
    rows = read_trials(tmp_path)[1]
    assert best(tuning, rows) is None
    assert "No trial has walked yet" in write_tuning_page(tmp_path, tuning, rows).read_text(encoding="utf-8")


def test_the_best_is_the_cheapest_within_the_bounds(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "cma_es", 40)
    rows = read_trials(tmp_path)[1]
    found = best(tuning, rows)
    assert found is not None
    assert found["cost"] == min(row["cost"] for row in rows if row["feasible"])
    assert found["falls"] == 0


def test_no_trial_is_better_in_all_than_one_of_the_front(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "nsga2", 60)
    rows = read_trials(tmp_path)[1]
    front = pareto_front(tuning, rows)
    losses = {row[TRIAL]: np.array(score_of(tuning, row).losses) for row in rows if row["feasible"]}
    better = {
        row[TRIAL]: any(
            (other <= losses[row[TRIAL]]).all() and (other < losses[row[TRIAL]]).any() for other in losses.values()
        )
        for row in rows
        if row["feasible"]
    }
    assert [row[TRIAL] for row in front] == [trial for trial, beaten in better.items() if not beaten]
    assert 0 < len(front) < len(losses)


def test_the_tables_have_a_row_for_everything(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "cma_es", 30)
    rows = read_trials(tmp_path)[1]
    found = best(tuning, rows)
    assert found is not None
    assert [cells[0] for cells in parameter_rows(tuning, found)] == list(tuning.parameters)
    assert [(cells[0], cells[-1]) for cells in value_rows(tuning, rows[0], found)] == [
        ("<script>alert(1)</script>", "minimize"),
        ("speed_error_m_s", "minimize"),
        ("upright_share", "from 0.9"),
    ]
    gain = f"{found['parameters.controller.balanced.planner.dcm_gain']:.4g}"
    assert parameter_rows(tuning, found)[0][1:] == ("0.5", "1", gain, "2")


def test_the_best_scenario_names_its_trial(tmp_path: Path) -> None:
    tuning = filled(tmp_path, "cma_es", 10)
    found = best(tuning, read_trials(tmp_path)[1])
    assert found is not None
    assert f"trial {found[TRIAL]} of a tuning" in load_scenario(write_best(tmp_path, tuning, found)).description
