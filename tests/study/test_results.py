"""Rows by what they are: factors that vary, measures of survivors, labels with units."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.quantity import ParameterError
from humanwalk.study.design import Point
from humanwalk.study.results import AS_IN_SCENARIO, SURVIVAL, Results
from humanwalk.study.row import Row

SPEED = "controller.balanced.command.points.0.forward"
STUDY = f"""
scenario: walk
set: {{pushes.given: [{{impulse: 60}}]}}
factors:
  {SPEED}: [0.7, 1.0, 1.4]
  pushes.given.0.time: [8.0]
  seed: {{seeds: {{count: 2}}}}
"""


def cost(point: Point) -> Row:
    return {"survived": point[SPEED] < 1.2 or point["seed"] == 0, "cost_of_transport": point[SPEED] + point["seed"]}


def values_of(results: Results) -> dict[str, list[Any]]:
    return {name: values.tolist() for name, values in results.factors.items()}


@pytest.fixture
def results(make_results: Callable[..., Results]) -> Results:
    return make_results(STUDY, cost)


def test_a_factor_varies_and_is_not_the_seed(results: Results) -> None:
    assert values_of(results) == {SPEED: [0.7, 0.7, 1.0, 1.0, 1.4, 1.4]}


def test_measures_are_those_of_the_runs_that_survived(results: Results) -> None:
    assert results.measure("cost_of_transport") == pytest.approx([0.7, 1.7, 1.0, 2.0, 1.4, np.nan], nan_ok=True)
    assert results.measure(SURVIVAL).tolist() == [100.0] * 5 + [0.0]
    assert results.ends == {"completed": 5, "fell": 1}


def test_numbers_whose_squares_overflow_are_left_out(make_results: Callable[..., Results]) -> None:
    values = iter([1e308, 1.0, -1e308, 2.0, float("inf"), 3.0])
    made = make_results(STUDY, lambda point: {"cost_of_transport": next(values)})
    assert made.measure("cost_of_transport") == pytest.approx([np.nan, 1.0, np.nan, 2.0, np.nan, 3.0], nan_ok=True)


def test_without_names_the_usual_measures_that_vary_are_shown(results: Results) -> None:
    assert results.measures() == ["cost_of_transport"]
    names = ["mean_speed", "gait.cadence_1_min", "peak_torque.LeftLegTibiaMotion"]
    assert results.measures(names) == ["mean_speed_m_s", "gait.cadence_1_min", "peak_torque_N_m.LeftLegTibiaMotion"]


def test_an_unknown_measure_is_refused_in_one_line(results: Results) -> None:
    with pytest.raises(
        ParameterError, match=r"--measure costs_of_transport: no such measure; .*near: cost_of_transport"
    ):
        results.measures(["costs_of_transport"])
    with pytest.raises(ParameterError, match="near: cost_of_transport"):
        results.measures(["cost"])
    with pytest.raises(ParameterError, match="no such measure"):
        results.measures(["host"])


@pytest.mark.parametrize("name", ["end", "host", "row", SPEED])
def test_a_column_that_is_no_measure_is_refused_with_some_that_are(results: Results, name: str) -> None:
    refusal = (
        rf"^--measure {name}: .* the column has no measured numbers; allowed: measured numbers in table.csv, like "
        "mean_speed"
    )
    with pytest.raises(ParameterError, match=refusal):
        results.measures([name])


@pytest.mark.parametrize(
    ("name", "label"),
    [
        (SPEED, "forward [m/s]"),
        ("pushes.given.0.time", "time [s]"),
        (SURVIVAL, "survived [%]"),
        ("cost_of_transport", "cost of transport"),
        ("mean_speed_m_s", "mean speed [m/s]"),
        ("gait.step_time_s.right", "step time, right [s]"),
        ("gait.cadence_1_min", "cadence [1/min]"),
        ("peak_torque_N_m.LeftLegTibiaMotion", "peak torque, LeftLegTibiaMotion [N m]"),
        ("likeness.knee.rms_deg", "likeness, knee, rms [deg]"),
    ],
)
def test_labels_have_units(results: Results, name: str, label: str) -> None:
    assert results.label(name) == label


def test_labels_of_similar_fields_differ(make_results: Callable[..., Results]) -> None:
    fields = ("controller.thesis.gait.path.step_height", "start.joint_noise", "start.rate_noise")
    factors = "\n".join(f"  {name}: [0.1, 0.2]" for name in fields)
    made = make_results(f"factors:\n{factors}\n  pushes.given: [[], [{{time: 1.0}}]]", lambda point: {})
    labels = [made.label(name) for name in made.factors]
    assert labels == ["step height [m]", "joint noise [rad]", "rate noise [rad/s]", "given"]
    both = "pushes.given: [{time: 1.0}, {time: 2.0}]"
    times = "  pushes.given.0.time: [1.0, 1.1]\n  pushes.given.1.time: [2.0, 2.1]"
    made = make_results(f"set: {{{both}}}\nfactors:\n{times}", lambda point: {})
    assert [made.label(name) for name in made.factors] == ["pushes.given.0.time [s]", "pushes.given.1.time [s]"]


def test_factors_that_change_together_are_one(make_results: Callable[..., Results], tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    file.write_text("duration,start.joint_noise,start.rate_noise\n1,0.1,0\n2,0.08,0\n3,0.02,1\n2,0.08,1\n")
    made = make_results(f"design: {{rows: {{file: {file}}}}}", lambda point: {})
    assert values_of(made) == {"duration": [1, 2, 3, 2], "start.rate_noise": [0, 0, 1, 1]}
    assert made.label("duration") == "duration [s] with joint noise [rad]"
    assert made.label("start.rate_noise") == "rate noise [rad/s]"


def test_a_row_without_a_variant_has_a_level_of_its_own(make_results: Callable[..., Results]) -> None:
    text = "factors: {ground: {variants: {soft: {}, hard: {}}}, duration: [1.0, 2.0]}\ndesign: one_at_a_time"
    made = make_results(text, lambda point: {})
    assert values_of(made) == {
        "ground": [AS_IN_SCENARIO, "soft", "hard", AS_IN_SCENARIO, AS_IN_SCENARIO],
        "duration": [15.0, 15.0, 15.0, 1.0, 2.0],
    }
