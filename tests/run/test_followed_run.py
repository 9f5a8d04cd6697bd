"""A run that follows a recording holds all that it needs: it may be moved, and the recording may be lost."""

import logging
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from humanwalk.body.joint_map import JointMap
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.cli.main import app, run_command
from humanwalk.motion.followed import REQUIRED_JOINTS
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.run.provenance import file_hash, scenario_hash
from humanwalk.run.reproduce import reproduce
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario

TIME = np.arange(0, 0.301, 0.02)


def bend(knee: float = 20.0) -> dict[str, Array]:
    """Knees bend by some degrees within 0.3 s; OpenSim's names."""
    columns = {COORDINATES[name][0]: np.zeros_like(TIME) for name in REQUIRED_JOINTS}
    for side in "rl":
        columns[f"knee_angle_{side}"] = knee * TIME / TIME[-1]
    return columns


def write_mot(path: Path, columns: dict[str, Array]) -> Path:
    path.write_text(storage_text("t", MotionTable(tuple(columns), TIME, np.column_stack(list(columns.values())), True)))
    return path


def following(recording: Path | str, more: str = "") -> dict[str, str]:
    """Overrides for a scenario that follows a recording."""
    return {"controller": f"{{recorded: {{angles: {recording}, {more}}}}}"}


def motion_of(scenario: Any) -> RecordedMotion:
    return scenario.controller.motion(scenario.subject, scenario.terrain)


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The run of a followed recording with a mapping, walked by the command; both files are gone since."""
    lab = tmp_path_factory.mktemp("lab")
    recording = write_mot(lab / "Trial 3.MOT", bend())
    (lab / "lab.yaml").write_text("hold: {Head_Motion: 0.05}\n")
    hashes = file_hash(str(recording)), file_hash(str(lab / "lab.yaml"))
    files = ["--follow", str(recording), "--mapping", str(lab / "lab.yaml"), "-o", str(lab / "run")]
    result = CliRunner().invoke(app, ["walk", *files, "--no-replay", "--no-plots"])
    assert result.exit_code == 0, result.output
    recording.unlink()
    (lab / "lab.yaml").unlink()
    return lab / "run", hashes


@pytest.fixture
def run(walked: tuple[Path, tuple[str, str]], tmp_path: Path) -> Run:
    """A copy elsewhere, to change."""
    return Run.open(shutil.copytree(walked[0], tmp_path / "elsewhere"))


def test_recording_and_mapping_are_kept_with_their_hashes(run: Any, walked: tuple[Path, tuple[str, str]]) -> None:
    hashes = run.summary["provenance"]
    assert (
        hashes["files_sha256"]["controller.recorded.angles"],
        hashes["files_sha256"]["controller.recorded.mapping"],
    ) == walked[1]
    assert (
        file_hash(str(run.path / "controller.recorded.angles.mot"))
        == hashes["files_sha256"]["controller.recorded.angles"]
    )
    assert (
        file_hash(str(run.path / "controller.recorded.mapping.yaml"))
        == hashes["files_sha256"]["controller.recorded.mapping"]
    )
    assert run.scenario.controller.angles == str(run.path / "controller.recorded.angles.mot")
    assert {entry.name for entry in run.path.iterdir()} == {
        "scenario.yaml",
        "signals.parquet",
        "summary.json",
        "controller.recorded.angles.mot",
        "controller.recorded.mapping.yaml",
    }


def test_moved_run_is_repeated_to_the_bit(run: Run) -> None:
    result = reproduce(run)
    assert (result.bits_agree, result.notes) == (True, ())


def test_moved_run_is_walked_again_from_its_scenario(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    quick = ["--no-replay", "--no-plots", "--duration", "0.02"]
    result = CliRunner().invoke(app, ["walk", str(run.path / "scenario.yaml"), "-o", "again", *quick])
    assert result.exit_code == 0, result.output
    again = Run.open(tmp_path / "again")
    assert again.summary["provenance"]["files_sha256"] == run.summary["provenance"]["files_sha256"]
    np.testing.assert_array_equal(again["com.z"], run["com.z"][: again.signals.num_rows])


@pytest.mark.parametrize("name", ["controller.recorded.angles.mot", "controller.recorded.mapping.yaml"])
def test_copy_that_was_changed_is_noted(run: Run, name: str) -> None:
    (run.path / name).write_text((run.path / name).read_text() + "\n")
    assert [note for note in reproduce(run).notes if note.endswith(f"{name} was changed since the run")]


def test_missing_copy_is_a_one_line_error(run: Run) -> None:
    (run.path / "controller.recorded.angles.mot").unlink()
    with pytest.raises(ParameterError, match=r"angles\.mot is gone"):
        reproduce(Run.open(run.path))


def test_hash_of_a_scenario_is_independent_of_the_paths_of_its_files(tmp_path: Path) -> None:
    here, there = (load_scenario("thesis", following(f"{folder}/t.mot")) for folder in ("a", "b"))
    assert scenario_hash(here) == scenario_hash(there)
    assert scenario_hash(here) != scenario_hash(load_scenario("thesis", following("a/t.mot", "ease_in: 0.5")))


def test_files_of_a_scenario_stand_beside_it(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab" / "mine.yaml").write_text("controller: {recorded: {angles: t.mot, mapping: ../map.yaml}}\n")
    monkeypatch.chdir(tmp_path)
    recorded = load_scenario("lab/mine.yaml").controller
    assert (recorded.angles, recorded.mapping) == ("lab/t.mot", "lab/../map.yaml")  # type: ignore[attr-defined]
    # What is set on the command line is said from where one stands; a full path stays.
    other = load_scenario("lab/mine.yaml", {"controller.recorded.angles": "other.mot"})
    assert other.controller.angles == "other.mot"  # type: ignore[attr-defined]
    (tmp_path / "lab" / "mine.yaml").write_text(f"controller: {{recorded: {{angles: {tmp_path}/t.mot}}}}\n")
    assert load_scenario("lab/mine.yaml").controller.angles == f"{tmp_path}/t.mot"  # type: ignore[attr-defined]


def test_recording_that_is_moved_while_it_is_walked_loses_no_run(tmp_path: Path) -> None:
    recording = write_mot(tmp_path / "t.mot", bend())
    outcome = simulate(load_scenario("thesis", following(recording) | {"duration": "0.01"}))
    recording.rename(tmp_path / "moved.mot")
    run = outcome.save(tmp_path / "run")
    assert run.scenario.controller.angles == str(run.path / "controller.recorded.angles.mot")  # type: ignore[attr-defined]
    assert run.summary["provenance"]["files_sha256"]["controller.recorded.angles"] is None
    with pytest.raises(ParameterError, match=r"angles\.mot is gone"):
        reproduce(run)


# Without physics.


@pytest.fixture(scope="module")
def kinematic(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, str]:
    """The run of a recording that is shown without physics, and what was printed."""
    folder = tmp_path_factory.mktemp("kinematic")
    recording = write_mot(folder / "t.mot", bend())
    result = CliRunner().invoke(app, ["walk", "--follow", str(recording), "--kinematic", "-o", str(folder / "run")])
    assert result.exit_code == 0, result.output
    return Run.open(folder / "run"), result.stderr


def test_kinematic_run_is_announced_and_has_a_replay_and_no_plots(kinematic: tuple[Run, str]) -> None:
    run, printed = kinematic
    assert "no physics" in printed
    assert {entry.name for entry in run.path.iterdir()} == {
        "scenario.yaml",
        "signals.parquet",
        "summary.json",
        "controller.recorded.angles.mot",
        "replay.html",
    }
    assert run.summary["physics"] is False
    assert run.summary["scenario"] == "t"
    assert run.summary["end"] == "completed"


def test_kinematic_run_moves_exactly_as_recorded(kinematic: tuple[Run, str], joints: JointMap) -> None:
    run, _ = kinematic
    motion = run.scenario.controller.motion(run.scenario.subject, run.scenario.terrain)  # type: ignore[attr-defined]
    for row in (0, 20, -1):
        angles, rates = motion.joints(run.time[row])
        for i, name in enumerate(joints.names):
            assert run[f"{name}.angle"][row] == angles[i]
            assert run[f"{name}.velocity"][row] == rates[i]
        pelvis = motion.pelvis(run.time[row])
        place = [run[f"pelvis.{axis}"][row] for axis in "xyz"]
        np.testing.assert_allclose(place, pelvis.X_WP.translation(), atol=1e-15)
    assert np.rad2deg(run["RightLegTibiaMotion.angle"][-1]) > 5.0


def test_kinematic_run_claims_no_force_torque_or_effort(kinematic: tuple[Run, str]) -> None:
    run, _ = kinematic
    assert [name for name in run.signals.column_names if name.endswith(("_N", "_N_m", "saturated", "loaded"))] == []
    summary = run.summary
    assert summary["peak_torque_N_m"] == summary["saturated_share"] == {}
    assert summary["external_support"] is False
    for key in ("cost_of_transport", "steps", "gait"):
        assert summary[key] is None
    assert summary["foot_lift_m"] == {"right": None, "left": None}


@pytest.mark.parametrize(
    "command", [("plot",), ("report",), ("export", "--to", "opensim"), ("export", "--to", "c3d")], ids=str
)
def test_what_needs_forces_refuses_a_kinematic_run_in_a_line(
    kinematic: tuple[Run, str], command: tuple[str, ...]
) -> None:
    run, _ = kinematic
    with pytest.raises(ParameterError, match="a kinematic run has no forces and no torques; allowed"):
        CliRunner().invoke(app, [command[0], str(run.path), *command[1:]], catch_exceptions=False)


def test_kinematic_run_is_exported_and_repeated(kinematic: tuple[Run, str], tmp_path: Path) -> None:
    run, _ = kinematic
    result = CliRunner().invoke(app, ["export", str(run.path), "--to", "csv", "-o", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert reproduce(run).bits_agree


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        ({"controller": "recorded"}, "controller.recorded.angles: no recording"),
        ({"controller.recorded.angles": "t.mot"}, "controller is 'thesis'"),
    ],
)
def test_invalid_recorded_controller_is_refused(overrides: dict[str, str], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        load_scenario("thesis", overrides)


def test_kinematic_without_a_recording_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="--kinematic: no recording"):
        CliRunner().invoke(app, ["walk", "--kinematic", "-o", str(tmp_path / "run")], catch_exceptions=False)
    assert not (tmp_path / "run").exists()


# Angles beyond a joint's range.


def test_angle_beyond_its_range_is_clamped_with_a_one_line_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, joints: JointMap
) -> None:
    columns = bend() | {"knee_angle_r": np.full_like(TIME, -3.0), "Head_Motion": np.full_like(TIME, 1.0)}
    scenario = load_scenario("thesis", following(write_mot(tmp_path / "t.mot", columns)))
    with caplog.at_level(logging.WARNING):
        motion = scenario.controller.motion(scenario.subject, scenario.terrain)  # type: ignore[attr-defined]
    (record,) = caplog.records
    said = record.getMessage()
    knee = joints.names.index("RightLegTibiaMotion")
    moved = np.rad2deg(joints.lower[knee] - np.deg2rad(-3.0))
    assert said == (
        f"{tmp_path}/t.mot: angles clipped to the range of their joints: RightLegTibiaMotion by up to {moved:.2g} deg"
    )
    np.testing.assert_array_equal(motion.angles[:, knee], joints.lower[knee])


def test_command_tells_it_in_one_line_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    recording = write_mot(tmp_path / "t.mot", bend() | {"knee_angle_r": np.full_like(TIME, -3.0)})
    arguments = ["walk", "--follow", str(recording), "--kinematic", "-o", str(tmp_path / "run"), "--no-replay"]
    monkeypatch.setattr(sys, "argv", ["humanwalk", *arguments])
    with pytest.raises(SystemExit) as end:
        run_command()
    assert not end.value.code
    (line,) = (line for line in capfd.readouterr().err.splitlines() if "range" in line)
    assert line.startswith(f"humanwalk: {recording}: angles clipped")
    assert logging.getLogger("humanwalk").propagate


def test_angles_within_their_ranges_are_not_spoken_of(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        motion_of(load_scenario("thesis", following(write_mot(tmp_path / "t.mot", bend()))))
    assert caplog.records == []
