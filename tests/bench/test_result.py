"""Repeats put together, files and comparisons."""

import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from humanwalk.bench import measure
from humanwalk.bench.measure import bench, put_together
from humanwalk.bench.profile import UPSTREAM
from humanwalk.bench.result import (
    COLUMNS,
    BenchResult,
    ScenarioCost,
    comparison_table,
    cost_table,
    machine,
    ratios,
    read_result,
    system_table,
    write_result,
)
from humanwalk.quantity import ParameterError


def repeat(full: list[float], unrecorded: list[float], bare: list[float], **profile: Any) -> Any:
    """Measures of one repeat; every turn takes twice as long on the clock as on the processor."""
    turns = {"full": full, "unrecorded": unrecorded, "bare": bare}
    return {
        "startup_s": 2.0,
        "peak_memory_MB": 200.0,
        "profile": profile,
        "turns": {name: [(2 * cpu, cpu) for cpu in cpus] for name, cpus in turns.items()},
    }


COST = put_together(
    [repeat([0.05, 0.06], [0.04, 0.05], [0.02, 0.03], InverseKinematicsSolver=0.01, GaitPlanner=0.004, upstream=9.0)],
    duration=0.2,
)
RESULT = BenchResult({"thesis": COST}, 1, {"thesis": 1}, {"duration": "0.2"}, machine())
PART = replace(RESULT, repeats=2, done={"thesis": 1, "walk": 0})


def test_the_parts_of_a_cost() -> None:
    assert COST.wall == pytest.approx(2 * 0.11 / 0.2)
    assert COST.cpu == pytest.approx(0.11 / 0.2)
    assert COST.plant == pytest.approx(0.05 / 0.2)
    assert COST.solvers == pytest.approx(0.01 / 0.2)
    assert COST.logging == pytest.approx(0.02 / 0.2)
    assert COST.systems == pytest.approx((0.09 - 0.05 - 0.01) / 0.2)
    assert COST.by_system == pytest.approx({"InverseKinematicsSolver": 0.05, "GaitPlanner": 0.02})
    assert UPSTREAM not in COST.by_system
    assert COST.above_plant == pytest.approx(0.11 / 0.05 - 1)
    assert COST.realtime_factor == pytest.approx(0.2 / 0.22)


times = st.lists(st.floats(1e-3, 1.0), min_size=3, max_size=3)


@given(st.lists(st.tuples(times, times, times), min_size=1, max_size=5))
def test_the_parts_are_the_whole(repeats: list[tuple[list[float], list[float], list[float]]]) -> None:
    cost = put_together([repeat(*turns, WholeBodyController=0.1) for turns in repeats], 0.3)
    assert cost.plant + cost.solvers + cost.systems + cost.logging == pytest.approx(cost.cpu)


def test_a_disturbance_of_one_turn_of_one_repeat_does_not_count() -> None:
    calm = [0.05, 0.06, 0.07]
    disturbed = [[9.0, 0.06, 0.07], [0.05, 9.0, 0.07], [0.05, 0.06, 9.0]]
    cost = put_together([repeat(turns, turns, turns) for turns in disturbed], 0.3)
    assert cost.cpu == pytest.approx(sum(calm) / 0.3)


def test_a_file_holds_the_whole_result(tmp_path: Path) -> None:
    write_result(tmp_path / "bench.json", RESULT)
    assert read_result(tmp_path / "bench.json") == RESULT


def test_incomplete_results_are_marked(tmp_path: Path) -> None:
    assert RESULT.complete
    assert not PART.complete
    write_result(tmp_path / "bench.json", PART)
    assert read_result(tmp_path / "bench.json") == PART
    assert "not complete: 1 of 4 repeats" in cost_table(PART).title  # type: ignore[operator]
    assert "complete" not in cost_table(RESULT).title  # type: ignore[operator]
    assert "new has 1 of 4 repeats" in comparison_table(RESULT, PART).title  # type: ignore[operator]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        '{"kind": "run"}',
        '{"kind": "humanwalk bench 1"}',
        '{"kind": "humanwalk bench 1", "scenarios": {"a": 1}}',
    ],
)
def test_files_of_other_kinds_are_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "other.json"
    file.write_text(text)
    with pytest.raises(ParameterError, match=r"other\.json.*restore"):
        read_result(file)


def test_a_file_of_another_version_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "bench.json"
    write_result(file, RESULT)
    file.write_text(file.read_text().replace("humanwalk bench 1", "humanwalk bench 0"))
    with pytest.raises(ParameterError, match="not a result of this version"):
        read_result(file)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 0.0, -1.0, "1", True, None, 10**400, []], ids=repr)
def test_a_time_that_is_not_positive_and_finite_is_refused(tmp_path: Path, value: Any) -> None:
    file = tmp_path / "bench.json"
    write_result(file, RESULT)
    data = json.loads(file.read_text())
    data["scenarios"]["thesis"]["cpu"] = value
    file.write_text(json.dumps(data))
    with pytest.raises(ParameterError, match=r"thesis|not JSON"):
        read_result(file)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="No such file"):
        read_result(tmp_path / "none.json")


def faster(times: float) -> BenchResult:
    return replace(RESULT, scenarios={"thesis": replace(COST, wall=COST.wall / times), "walk": COST})


def test_a_comparison_is_new_over_old_of_what_is_in_both() -> None:
    found = ratios(RESULT, faster(2.0))
    assert list(found) == ["thesis"]
    assert found["thesis"]["wall"] == pytest.approx(0.5)
    assert found["thesis"]["x real"] == pytest.approx(2.0)
    assert found["thesis"]["plant"] == 1.0


def test_results_without_a_scenario_in_common_are_refused() -> None:
    with pytest.raises(ParameterError, match="no scenario is in both"):
        ratios(RESULT, replace(RESULT, scenarios={"walk": COST}))


def test_a_comparison_names_different_conditions() -> None:
    assert comparison_table(RESULT, faster(2.0)).title == "new / old"
    other = replace(RESULT, machine=RESULT.machine | {"processor": "another"})
    assert "processor" in comparison_table(RESULT, other).title  # type: ignore[operator]


def test_tables_have_a_row_for_every_scenario_and_fit_a_terminal() -> None:
    result = faster(2.0)
    out = io.StringIO()
    Console(file=out, width=80).print(cost_table(result), system_table(result))
    text = out.getvalue()
    for name, cost in result.scenarios.items():
        assert f"{name} " in text
        assert all(f"{system} " in text for system in cost.by_system)
    assert all(word in text for heading, _, _ in COLUMNS for word in heading.split())


def test_results_come_after_every_repeat(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scenarios by turns; what is there of one is its cost so far."""
    costs = iter([0.1, 0.5, 0.3, 0.7])
    monkeypatch.setattr(measure, "_repeat", lambda scenario, overrides: repeat(*[[next(costs)]] * 3))
    results = []
    final = bench(["thesis", "walk"], {"duration": "1"}, 2, on_result=results.append)
    assert [result.done for result in results] == [
        {"thesis": 1, "walk": 0},
        {"thesis": 1, "walk": 1},
        {"thesis": 2, "walk": 1},
        {"thesis": 2, "walk": 2},
    ]
    assert [list(result.scenarios) for result in results] == [["thesis"], *[["thesis", "walk"]] * 3]
    assert [result.scenarios["thesis"].cpu for result in results] == pytest.approx([0.1, 0.1, 0.2, 0.2])
    assert [result.complete for result in results] == [False, False, False, True]
    assert final == results[-1]


def test_the_machine_has_a_name() -> None:
    found = machine()
    assert found["processor"]
    assert found["cores"] >= 1


@pytest.mark.slow
def test_a_scenario_is_measured_in_a_process_of_its_own() -> None:
    progress = []
    result = bench(["stand"], {"duration": "0.02"}, 1, lambda *what: progress.append(what))
    (cost,) = result.scenarios.values()
    assert progress == [("stand", 0, 1)]
    assert {"WholeBodyController", "GaitPlanner"} <= set(cost.by_system)
    assert cost.peak_memory_MB > 50
    assert all(np.isfinite([cost.wall, cost.plant, cost.startup_s]))
    assert isinstance(cost, ScenarioCost)


@pytest.mark.slow
def test_a_walk_that_does_not_last_is_refused_in_a_line() -> None:
    with pytest.raises(ParameterError, match=r"thesis: duration: .* shorten --duration") as refusal:
        bench(
            ["thesis"],
            {"duration": "2", "controller.thesis.balance.support.enabled": "false", "start.pelvis_lift": "0.5"},
            1,
        )
    assert len(str(refusal.value).splitlines()) == 1


def test_an_unknown_scenario_is_refused_before_anything_is_measured() -> None:
    with pytest.raises(ParameterError, match="thesiss"):
        bench(["thesis", "thesiss"], {}, 1, lambda *_: pytest.fail("measured"))
