"""A run states its origin; a re-run states whether the results match."""

import json
import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from humanwalk.cli.main import app
from humanwalk.run.folder import SCENARIO, SIGNALS, SUMMARY, Run
from humanwalk.run.provenance import scenario_hash, signals_hash, versions
from humanwalk.run.reproduce import reproduce
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Run:
    scenario = load_scenario("thesis", {"duration": "0.1", "seed": "5", "start.joint_noise": "0.01"})
    return simulate(scenario).save(tmp_path_factory.mktemp("made") / "run")


@pytest.fixture
def run(made: Run, tmp_path: Path) -> Run:
    """A copy to change."""
    return Run.open(shutil.copytree(made.path, tmp_path / "run"))


def change_summary(run: Run, change: Callable[..., Any]) -> Run:
    summary = json.loads((run.path / SUMMARY).read_text())
    change(summary)
    (run.path / SUMMARY).write_text(json.dumps(summary))
    return Run.open(run.path)


def change_signal(run: Run, name: str, factor: float) -> Run:
    table = pq.read_table(run.path / SIGNALS)
    column = pa.array(factor * table[name].to_numpy())
    changed = table.set_column(table.column_names.index(name), name, column)
    pq.write_table(changed, run.path / SIGNALS)
    return change_summary(run, lambda summary: summary["provenance"].update(signals_sha256=signals_hash(changed)))


def test_run_states_its_origin(made: Run) -> None:
    origin = made.summary["provenance"]
    assert origin["seed"] == 5
    assert origin["scenario_sha256"] == scenario_hash(made.scenario)
    assert origin["signals_sha256"] == signals_hash(made.signals)
    assert origin["versions"] == versions()
    assert {"humanwalk", "drake", "numpy", "python", "machine"} == set(origin["versions"])
    assert json.loads(made.signals.schema.metadata[b"humanwalk"])["scenario_sha256"] == origin["scenario_sha256"]


def test_hash_of_signals_depends_on_bits_and_names_only() -> None:
    table = pa.table({"a": [1.0, 2.0], "b": [3.0, 4.0]})
    assert signals_hash(table) == signals_hash(table.select(["b", "a"]))
    assert signals_hash(table) != signals_hash(table.rename_columns(["a", "c"]))
    assert signals_hash(table) != signals_hash(pa.table({"a": [1.0, np.nextafter(2.0, 3)], "b": [3.0, 4.0]}))


def test_results_of_a_rerun_match_exactly(run: Run) -> None:
    result = reproduce(run)
    assert (result.bits_agree, result.measures_agree, result.notes) == (True, True, ())


@pytest.mark.parametrize("end", ["interrupted", "unfinished"])
def test_run_that_was_cut_short_is_repeated_up_to_its_end(run: Run, end: str) -> None:
    stopped = change_summary(run, lambda summary: summary.update(end=end))
    text = (run.path / SCENARIO).read_text()
    (run.path / SCENARIO).write_text(text.replace("duration: 0.1", "duration: 60.0"))
    result = reproduce(Run.open(stopped.path))
    assert (result.bits_agree, result.measures_agree, result.notes) == (True, True, ())
    assert result.verdict == "the same bits in every signal"


def test_other_bits_with_the_same_measures_are_distinguished(run: Run) -> None:
    result = reproduce(change_signal(run, "Head_Motion.torque_N_m", 1 + 1e-12))
    assert not result.bits_agree
    assert result.measures_agree
    assert "1 signals differ, first Head_Motion.torque_N_m" in " ".join(result.notes)
    assert "other bits, the same measures" in result.verdict


def test_other_measures_are_named(run: Run) -> None:
    result = reproduce(change_signal(run, "RightLegTibiaMotion.torque_N_m", 1.5))
    assert not result.measures_agree
    assert "peak_torque_N_m.RightLegTibiaMotion" in " ".join(result.notes)
    assert result.verdict == "other measures"


def test_another_end_is_another_measure_of_the_same_bits(run: Run) -> None:
    result = reproduce(change_summary(run, lambda summary: summary.update(end="fell")))
    assert (result.bits_agree, result.measures_agree) == (True, False)
    assert "end: completed where it was fell" in result.notes
    assert result.verdict == "the same bits in every signal, but other measures"


def test_later_changes_are_noted(run: Run, caplog: pytest.LogCaptureFixture) -> None:
    changed = change_summary(
        run,
        lambda summary: summary["provenance"].update(
            scenario_sha256="0", versions=summary["provenance"]["versions"] | {"drake": "1.0"}
        ),
    )
    notes = " ".join(reproduce(changed).notes)
    assert "scenario.yaml was changed" in caplog.text
    assert "was 1.0" in notes


def test_command_prints_the_verdict_and_fails_if_results_differ(run: Run) -> None:
    result = CliRunner().invoke(app, ["reproduce", str(run.path)])
    assert result.exit_code == 0, result.output
    assert "the same bits in every signal" in result.output
    change_signal(run, "RightLegTibiaMotion.torque_N_m", 1.5)
    assert CliRunner().invoke(app, ["reproduce", str(run.path)]).exit_code == 1


def test_run_with_signals_of_another_version_does_not_match(run: Run) -> None:
    table = pq.read_table(run.path / SIGNALS)
    other = table.rename_columns([name.replace("support.force_x", "support.pull_x") for name in table.column_names])
    pq.write_table(other, run.path / SIGNALS)
    changed = change_summary(run, lambda summary: summary["provenance"].update(signals_sha256=signals_hash(other)))
    result = reproduce(changed)
    assert not result.bits_agree
    assert "only one of them has: support.force_x_N, support.pull_x_N" in " ".join(result.notes)


def test_an_interrupted_repetition_has_no_verdict(run: Run) -> None:
    def interrupt(time: float) -> None:
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        reproduce(run, on_progress=interrupt)
