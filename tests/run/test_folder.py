"""Run folders: complete or refused, never overwritten."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from humanwalk.measures.signals import TIME
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import RUNS, SCENARIO, SIGNALS, SUMMARY, Run, kept_name, new_run_folder
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import load_scenario


@pytest.fixture
def outcome(columns: tuple[str, ...]) -> Outcome:
    time = 0.01 * np.arange(50)
    signals = pa.table({TIME: time, **{name: np.full_like(time, i) for i, name in enumerate(columns)}})
    return Outcome(load_scenario("thesis", {"seed": "5", "duration": "0.5"}), signals, "completed", wall_time=1.0)


def test_run_that_was_written_is_read_back(outcome: Outcome, tmp_path: Path) -> None:
    outcome.write(tmp_path, "thesis")
    run = Run.open(tmp_path)
    assert run.scenario == outcome.scenario
    assert run.signals.equals(outcome.signals)
    assert run.summary["scenario"] == "thesis"
    assert run.summary["seed"] == 5
    assert {path.name for path in tmp_path.iterdir()} == {SCENARIO, SIGNALS, SUMMARY}
    assert run.plots.parent == tmp_path
    with pytest.raises(ParameterError, match="make it with: humanwalk replay"):
        _ = run.replay
    (tmp_path / "replay.html").touch()
    assert run.replay.parent == tmp_path


def test_a_scenario_that_was_changed_since_the_run_is_read_with_one_warning(
    outcome: Outcome, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    outcome.write(tmp_path, "thesis")
    assert Run.open(tmp_path).scenario.subject.mass == 70.0
    assert caplog.text == ""
    file = tmp_path / SCENARIO
    file.write_text(file.read_text().replace("mass: 70.0", "mass: 140.0"))
    run = Run.open(tmp_path)
    assert run.scenario.subject.mass == run.scenario.subject.mass == 140.0
    (record,) = caplog.records
    assert "scenario.yaml was changed since the run" in record.message


def test_a_file_with_a_long_suffix_is_kept_under_a_name_that_a_file_can_have() -> None:
    assert kept_name("controller.recorded.angles", "walk.MOT") == "controller.recorded.angles.mot"
    assert kept_name("controller.recorded.mapping", "m." + 240 * "x") == "controller.recorded.mapping"


def test_signals_know_where_they_come_from(outcome: Outcome, tmp_path: Path) -> None:
    metadata = json.loads(outcome.write(tmp_path, "thesis").signals.schema.metadata[b"humanwalk"])
    assert metadata["scenario"] == "thesis"
    assert metadata["seed"] == 5
    assert {"humanwalk", "drake", "numpy"} <= metadata["versions"].keys()


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("com.xx", "near: com.x_m, "),
        ("com.", "near: com.x_m, com.y_m, com.z_m$"),
        ("?", "column_names$"),
        (None, "column_names$"),
    ],
)
def test_an_unknown_signal_is_refused_with_near_ones_if_there_are_any(
    outcome: Outcome, tmp_path: Path, name: Any, near: str
) -> None:
    with pytest.raises(ParameterError, match=rf"no such signal; allowed: the \d+ of the run, signals\..*{near}"):
        outcome.save(tmp_path / "run")[name]


@pytest.mark.parametrize("missing", [SCENARIO, SIGNALS, SUMMARY])
def test_incomplete_folder_is_no_run(outcome: Outcome, tmp_path: Path, missing: str) -> None:
    outcome.write(tmp_path, "thesis")
    (tmp_path / missing).unlink()
    with pytest.raises(ParameterError, match=f"no run, {missing} is missing") as raised:
        Run.open(tmp_path)
    assert len(str(raised.value).splitlines()) == 1


def test_missing_folder_is_no_run(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="no run"):
        Run.open(tmp_path / "none")


def test_new_folders_are_numbered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = [new_run_folder(None, RUNS / "thesis")[0].name for _ in range(3)]
    assert names == ["thesis", "thesis-2", "thesis-3"]
    assert sorted(path.name for path in (tmp_path / "runs").iterdir()) == names
    assert new_run_folder(None, RUNS / "other")[0].name == "other"


def test_a_file_in_the_way_is_not_overwritten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "thesis").write_text("mine")
    assert new_run_folder(None, RUNS / "thesis")[0].name == "thesis-2"


def test_wanted_folder_may_be_new_or_empty(tmp_path: Path) -> None:
    wanted = tmp_path / "a" / "b"
    assert new_run_folder(wanted, RUNS / "thesis") == (wanted, [wanted, wanted.parent])
    assert new_run_folder(wanted, RUNS / "thesis") == (wanted, [])


def test_wanted_folder_that_holds_something_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x")
    with pytest.raises(ParameterError, match="holds files already") as raised:
        new_run_folder(tmp_path, RUNS / "thesis")
    assert len(str(raised.value).splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_wanted_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x")
    with pytest.raises(ParameterError):
        new_run_folder(tmp_path / "mine", RUNS / "thesis")
    assert (tmp_path / "mine").read_text() == "x"
