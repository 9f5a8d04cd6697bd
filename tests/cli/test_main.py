"""The command line: files, output and errors."""

import errno
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from humanwalk.bench import measure
from humanwalk.bench.result import read_result
from humanwalk.choices.contact import HydroelasticContact
from humanwalk.cli.common import INSPECT, SHOW, SIMULATE
from humanwalk.cli.main import app
from humanwalk.cli.walk import program, summary_table
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.scenario import load_scenario, parse_scenario, shipped_scenarios

COMMANDS = {name.name or name.callback.__name__ for name in app.registered_commands}


@pytest.fixture
def refusal(humanwalk: Any, tmp_path: Path) -> Any:
    """Runs a command that is refused; gives the one line."""

    def run(*arguments: object) -> Any:
        before = sorted(tmp_path.rglob("*"))
        code, out, err = humanwalk(*arguments)
        assert code == 2
        assert out == ""
        (line,) = err.splitlines()
        assert line.startswith("humanwalk: ")
        assert sorted(tmp_path.rglob("*")) == before
        return line

    return run


# Help and lists.


def test_help_lists_every_command(humanwalk: Any) -> None:
    code, out, _ = humanwalk("--help")
    assert code == 0
    assert {"walk", "replay", "scenarios", "model", "diagram"} <= COMMANDS
    assert [name for name in COMMANDS if name not in out] == []


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_help_of_every_command_has_an_example(humanwalk: Any, command: Any) -> None:
    code, out, _ = humanwalk(command, "--help")
    assert code == 0
    assert f"humanwalk {command}" in out
    assert "Example" in out


def test_commands_are_grouped_by_subject(humanwalk: Any) -> None:
    _, out, _ = humanwalk("--help")
    groups = {line.strip("╭─╮ ") for line in out.splitlines() if line.startswith("╭")}
    assert {"Options", INSPECT, SHOW, SIMULATE} < groups


@pytest.mark.parametrize(
    ("command", "units"),
    [("model", ["[kg]", "[m]"]), ("walk", ["[s]"]), ("video", ["time of the run [s]"]), ("bench", ["[s]"])],
)
def test_help_shows_units(humanwalk: Any, command: Any, units: Any) -> None:
    """Rich takes text in brackets for markup."""
    _, out, _ = humanwalk(command, "--help")
    assert [unit for unit in units if unit not in out] == []


def test_scenarios_are_listed_with_their_descriptions(humanwalk: Any) -> None:
    code, out, _ = humanwalk("scenarios")
    assert code == 0
    assert "duration [s]" in out
    assert "speed [m/s]" in out
    for name in shipped_scenarios():
        (line,) = (line for line in out.splitlines() if line.startswith(f"│ {name} "))
        assert f"{load_scenario(name).controller.commanded_speed or 0.0:g}" in line


def test_a_shipped_scenario_is_printed_with_all_fields(humanwalk: Any) -> None:
    code, out, _ = humanwalk("scenarios", "--show", "walk")
    assert code == 0
    assert parse_scenario(out) == load_scenario("walk")


def test_versions_are_printed(humanwalk: Any) -> None:
    assert humanwalk("--version") == (0, f"humanwalk {version('humanwalk')}, Drake {version('drake')}\n", "")


def test_short_help_is_the_long_one(humanwalk: Any) -> None:
    assert humanwalk("walk", "-h") == humanwalk("walk", "--help")


def test_a_schema_is_printed_or_written(humanwalk: Any, tmp_path: Path) -> None:
    code, out, _ = humanwalk("schema", "scenario")
    assert code == 0
    assert "seed" in json.loads(out)["$defs"]["scenario.Scenario"]["properties"]
    assert humanwalk("schema", "scenario", "-o", "s.json")[0] == 0
    assert json.loads((tmp_path / "s.json").read_text()) == json.loads(out)


def test_installed_command_answers() -> None:
    executable = shutil.which("humanwalk", path=os.path.dirname(sys.executable))
    assert executable
    done = subprocess.run([executable, "walk", "thesiss"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1


# walk.


def test_table_of_a_run_omits_what_it_does_not_have() -> None:
    figures = dict.fromkeys(("mean_speed_m_s", "steps", "pelvis_tracking_rms_m", "cost_of_transport", "qp_failures"))
    summary = figures | {
        "scenario": "a\x1b[31m",
        "end": "completed",
        "duration_s": 1.0,
        "commanded_speed_m_s": None,
        "distance_m": 1.5,
        "foot_lift_m": {"right": 0.1, "left": None},
        "foot_line_error_m": {"right": 0.1, "left": 0.1},
        "lateral_drift_m": 0.0,
        "path_deviation_m": None,
        "external_support": False,
        "style": None,
        "physics": False,
        "realtime_factor": 1.0,
    }
    table = summary_table(summary)
    first, second, _ = (list(column.cells) for column in table.columns)
    assert first == [
        "distance",
        "right foot lift",
        "right foot lateral deviation",
        "left foot lateral deviation",
        "lateral drift",
        "real-time factor",
    ]
    assert second[0] == "1.50"
    assert table.title == r"a\x1b[31m: completed at 1.00 s"


def test_messages_are_printed_without_control_characters(refusal: Any) -> None:
    line = refusal("walk", "no\nsuch\x1b]0;title\x07scenario")
    assert line.isprintable()
    assert len(refusal("walk", 5000 * "x")) < 2100


def test_walk_writes_its_files(humanwalk: Any, tmp_path: Path) -> None:
    code, out, err = humanwalk("walk", "--duration", "0.2", "--no-plots", "--no-replay", "-o", "walked")
    assert code == 0
    assert out == ""
    assert {path.name for path in (tmp_path / "walked").iterdir()} == {
        "scenario.yaml",
        "signals.parquet",
        "summary.json",
    }
    assert "EXTERNAL SUPPORT" in err
    assert "walked" in err
    run = Run.open(tmp_path / "walked")
    assert run.scenario == load_scenario("thesis", {"duration": "0.2"})
    assert run.time[-1] == pytest.approx(0.2)
    assert {
        "scenario",
        "survived",
        "duration_s",
        "fall",
        "mean_speed_m_s",
        "lateral_drift_m",
        "foot_lift_m",
        "steps",
        "support_force_rms_N",
        "external_support",
        "style",
        "peak_torque_N_m",
        "tracking_error_rad",
        "cost_of_transport",
        "realtime_factor",
        "versions",
        "seed",
    } <= run.summary.keys()


def test_run_is_repeated_from_its_own_scenario(humanwalk: Any, tmp_path: Path) -> None:
    quick = ("--no-plots", "--no-replay")
    humanwalk("walk", "--duration", "0.1", "--set", "start.joint_noise=0.01", "-o", "first", *quick)
    code, _, _ = humanwalk("walk", "first/scenario.yaml", "-o", "again", *quick)
    assert code == 0
    first, again = Run.open(tmp_path / "first"), Run.open(tmp_path / "again")
    for name in first.signals.column_names:
        assert first.signals[name].equals(again.signals[name]), name
    assert again.summary["scenario"] == "scenario"


def test_walks_without_an_output_go_to_numbered_folders(humanwalk: Any, tmp_path: Path) -> None:
    for _ in range(2):
        assert humanwalk("walk", "--duration", "0.01", "--no-plots", "--no-replay")[0] == 0
    assert sorted(path.name for path in (tmp_path / "runs").iterdir()) == ["thesis", "thesis-2"]


def test_overrides_reach_the_run(humanwalk: Any, tmp_path: Path) -> None:
    humanwalk(
        *("walk", "--duration", "0.01", "--no-plots", "--no-replay", "-o", "walked"),
        *("--set", "controller.thesis.gait.path.step_height=0.12", "--set", "contact=hydroelastic"),
    )
    scenario = Run.open(tmp_path / "walked").scenario
    assert (scenario.controller.gait.path.step_height, scenario.contact) == (0.12, HydroelasticContact())  # type: ignore[attr-defined]


def test_fall_has_an_exit_code_and_a_run(humanwalk: Any, tmp_path: Path) -> None:
    code, _, err = humanwalk(
        *("walk", "--duration", "4", "--no-plots", "--no-replay", "-o", "fallen"),
        *("--set", "controller.thesis.balance.support.enabled=false"),
    )
    assert code == 1
    assert "fell" in err
    summary = json.loads((tmp_path / "fallen" / "summary.json").read_text())
    assert summary["survived"] is False
    assert summary["fall"]["time_s"] == summary["duration_s"]
    assert summary["fall"]["description"] in err


def test_interrupted_walk_keeps_its_run(tmp_path: Any) -> None:
    executable = shutil.which("humanwalk", path=os.path.dirname(sys.executable))
    command = [executable, "walk", "--duration", "600", "--no-plots", "--no-replay", "-o", "walked"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)  # type: ignore[arg-type]
    try:
        assert process.stderr.readline() == "thesis: walking 600 s\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130
    assert "interrupted" in err
    assert Run.open(tmp_path / "walked").summary["end"] == "interrupted"


@pytest.mark.parametrize(
    ("called", "on_path", "shown"),
    [
        ("/usr/bin/humanwalk", True, "humanwalk"),
        (".venv/bin/humanwalk", False, os.path.join(".venv", "bin", "humanwalk")),
        ("/x/humanwalk/__main__.py", False, "python -m humanwalk"),
    ],
)
def test_shown_commands_call_the_program_as_it_was_called(
    monkeypatch: pytest.MonkeyPatch, called: str, on_path: bool, shown: str
) -> None:
    monkeypatch.setattr(sys, "argv", [called])
    monkeypatch.setattr(shutil, "which", lambda name: called if on_path else None)
    assert program() == shown


# Bad input: one line, exit code 2, nothing left behind.


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("thesiss",), "thesis"),
        (("none.yaml",), "no such scenario or file"),
        (("--set", "controller.thesis.gait.path.step_hight=0.1"), "did you mean step_height?"),
        (("--set", "controller.thesis.gait.path.step_length=50"), "write 0.5 (m)"),
        (("--set", "subject.mass=-3"), "allowed: 12 to 200 kg"),
        (("--set", "controller.thesis.gait.path.step_height"), "FIELD=VALUE"),
        (("--set", "=3"), "FIELD=VALUE"),
        (("--set", "duration=[1"), "not YAML"),
        (("--duration", "-1"), "duration"),
        (("--duration", "1", "--set", "duration=2"), "--set duration: another option replaces duration; allowed: one"),
        (("--look", "bones", "--set", "subject.look=person"), "--set subject.look: another option replaces"),
        (("--set", "duration=1", "--set", "duration=2"), "--set duration: replaces the earlier --set duration"),
        (
            ("--set", "subject.mass=60", "--set", "subject={mass: 70}"),
            "--set subject: replaces the earlier --set subject.mass",
        ),
        (("--duration", "nan"), "write a number"),
        (("--set", "controller.thesis.gait.path.offset=0.03"), "shorten the step"),
        (("--set", "controller.thesis.gait.path.toe_drop=0"), "Ankle"),
        (("--set", "actuation.pd.law=explicit"), "unstable"),
        (("--set", "start.joint_angles.RightLegTibiaMotion=-0.3"), "RightLegTibiaMotion"),
    ],
    ids=str,
)
@pytest.mark.parametrize("output", [(), ("-o", "new/folder")], ids=["default", "output"])
def test_invalid_walk_produces_one_line_and_leaves_no_file(
    refusal: Any, arguments: Any, said: Any, output: Any
) -> None:
    assert said in refusal("walk", *arguments, *output, "--no-replay", "--no-plots")


@pytest.mark.parametrize("command", ["walk", "drive", "bench"])
def test_the_duration_of_the_option_and_of_set_are_not_both_given(refusal: Any, command: str) -> None:
    both = ("--duration", "1", "--set", "duration=2")
    assert "--set duration: another option replaces duration" in refusal(command, "thesis", *both)


def test_nonempty_output_is_refused_and_unchanged(refusal: Any, tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years of work")
    assert "holds files already" in refusal("walk", "-o", "mine", "--no-replay")
    assert (tmp_path / "mine" / "thesis.txt").read_text() == "years of work"


def test_empty_folder_that_was_there_stays_when_the_walk_is_refused(refusal: Any, tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    refusal("walk", "-o", "mine", "--no-replay", "--set", "controller.thesis.gait.path.offset=0.03")


@pytest.mark.parametrize("output", ["file", "file/run", "/proc/humanwalk"])
def test_output_that_cannot_be_written_is_refused(refusal: Any, tmp_path: Path, output: Any) -> None:
    (tmp_path / "file").write_text("x")
    if output.startswith("/proc") and not os.path.isdir("/proc"):
        pytest.skip("no /proc on this system")
    assert output in refusal("walk", "-o", output, "--no-replay", "--duration", "0.01")


def test_invalid_yaml_is_refused(refusal: Any, tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("duration: 1\ngait: [1\n")
    assert "mine.yaml: not YAML at line" in refusal("walk", "mine.yaml")


@pytest.mark.parametrize("command", ["replay", "plot"])
def test_folder_without_run_is_refused(refusal: Any, command: Any) -> None:
    assert "no run" in refusal(command, "none")


@pytest.mark.parametrize(
    "command",
    [
        ("video", "run"),
        ("snapshot", "run", "--times", "0"),
        ("compare", "run", "run"),
        ("schema", "scenario"),
        ("model", "none.yaml"),
        ("diagram", "none.yaml"),
        ("bench", "none.yaml"),
    ],
    ids=str,
)
def test_a_file_that_is_named_is_replaced_only_with_overwrite(
    humanwalk: Any, refusal: Any, tmp_path: Path, command: Any
) -> None:
    (tmp_path / "mine.mp4").write_text("holidays")
    assert "mine.mp4: is there already" in refusal(*command, "-o", "mine.mp4")
    assert (tmp_path / "mine.mp4").read_text() == "holidays"
    _, _, errors = humanwalk(*command, "-o", "mine.mp4", "--overwrite")
    assert "is there already" not in errors


def test_an_error_of_a_file_is_not_one_of_standard_output(refusal: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: Any) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", "secret/x.mp4")

    monkeypatch.setattr("humanwalk.run.folder.Run.open", fail)
    assert "secret/x.mp4: Permission denied" in refusal("plot", "run")


@pytest.mark.parametrize("command", [("video", "run"), ("snapshot", "run", "--times", "0"), ("bench", "stand")])
def test_a_name_that_no_file_can_have_is_named_in_the_error(refusal: Any, command: Any) -> None:
    name = 300 * "x" + ".mp4"
    message = refusal(*command, "-o", name)
    assert "standard output" not in message
    assert "File name too long; allowed: a folder that you may write to" in message


def test_a_comparison_without_page_is_not_written(refusal: Any) -> None:
    line = refusal("compare", "run", "run", "--no-page", "-o", "x.html")
    assert "-o x.html: no page with --no-page; allowed: one of the two; leave one out" in line


# bench.


@pytest.mark.slow
def test_bench_prints_a_table_and_writes_what_can_be_compared(humanwalk: Any, tmp_path: Path) -> None:
    code, out, err = humanwalk("bench", "stand", "--duration", "0.02", "--repeats", "1", "-o", "new.json")
    assert code == 0
    assert "stand" in out
    assert "WholeBodyController" in out
    assert "new.json" in err
    code, out, _ = humanwalk("bench", "--compare", "new.json", "new.json")
    assert code == 0
    assert "1.00" in out


@pytest.fixture
def measured_until(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Repeats of a benchmark that cost one second each, and an error instead of the one with that place."""

    def set_(place: Any, error: Any) -> None:
        repeats = iter(range(100))

        def repeat(scenario: Any, overrides: Any) -> Any:
            if next(repeats) == place:
                raise error
            turns = {name: [(1.0, 1.0)] for name in ("full", "unrecorded", "bare")}
            return {"startup_s": 1.0, "peak_memory_MB": 1.0, "profile": {}, "turns": turns}

        monkeypatch.setattr(measure, "_repeat", repeat)

    return set_


def test_interrupted_bench_keeps_its_results(humanwalk: Any, measured_until: Any, tmp_path: Path) -> None:
    measured_until(3, KeyboardInterrupt())
    code, out, err = humanwalk("bench", "stand", "walk", "--repeats", "2", "-o", "new.json")
    assert code == 130
    assert "not complete: 3 of 4 repeats" in out
    assert "interrupted; kept 3 of 4 repeats" in err
    assert read_result(tmp_path / "new.json").done == {"stand": 2, "walk": 1}
    code, out, _ = humanwalk("bench", "--compare", "new.json", "new.json")
    assert code == 0
    assert "old has 3 of 4 repeats" in out


def test_bench_interrupted_at_once_prints_that_nothing_was_measured(
    humanwalk: Any, measured_until: Any, tmp_path: Path
) -> None:
    measured_until(0, KeyboardInterrupt())
    code, _, err = humanwalk("bench", "stand", "-o", "new.json")
    assert code == 130
    assert "nothing was measured" in err
    assert not (tmp_path / "new.json").exists()


def test_failed_bench_keeps_previous_results(humanwalk: Any, measured_until: Any, tmp_path: Path) -> None:
    measured_until(1, ParameterError("walk: fell; allowed: none"))
    code, _, err = humanwalk("bench", "stand", "walk", "-o", "new.json")
    assert code not in (0, 130)
    assert "walk: fell" in err
    assert list(read_result(tmp_path / "new.json").scenarios) == ["stand"]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none/x.json", "none/x.json: No such file or directory; allowed: a folder that you may write to"),
        ("file/x.json", "file/x.json: Not a directory; allowed: a folder that you may write to"),
        ("folder", "-o folder: a folder or device; allowed: a file; choose another name"),
        ("/dev/null", "-o /dev/null: a folder or device; allowed: a file"),
        ("/proc/x.json", "humanwalk: /proc/x.json: "),
    ],
)
@pytest.mark.parametrize(
    "command",
    [("bench", "stand", "--duration", "3600"), ("video", "run"), ("compare", "run", "run"), ("schema", "scenario")],
    ids=str,
)
def test_a_file_that_cannot_be_written_is_refused_before_the_work(
    refusal: Any, tmp_path: Path, command: tuple[str, ...], name: str, said: str
) -> None:
    if name.startswith("/proc") and not os.path.isdir("/proc"):
        pytest.skip("no /proc on this system")
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    assert said in refusal(*command, "-o", name, "--overwrite")


def test_a_comparison_that_cannot_be_written_is_refused_before_the_runs_are_read(refusal: Any, tmp_path: Path) -> None:
    (tmp_path / "comparison.html").mkdir()
    said = "humanwalk: comparison.html: a folder or device; allowed: a file; move it away"
    assert refusal("compare", "run", "run") == said


def test_a_comparison_in_another_format_is_refused(refusal: Any, tmp_path: Path) -> None:
    line = refusal("compare", "run", "run", "-o", "x.txt")
    assert line == "humanwalk: -o x.txt: unknown page format; allowed: .html, .htm; name it comparison.html"


@pytest.mark.parametrize(
    ("more", "named"),
    [
        (("stand",), "SCENARIO"),
        (("-o", "x.json"), "-o"),
        (("--set", "seed=1", "--repeats", "3"), "--set, --repeats"),
        (("--duration", "1", "--overwrite"), "--overwrite, --duration"),
    ],
)
def test_bench_does_not_measure_while_it_compares(refusal: Any, more: tuple[str, ...], named: str) -> None:
    line = refusal("bench", "--compare", "old.json", "new.json", *more)
    assert f"--compare: measures nothing, and {named} would be ignored; allowed: two files alone" in line


def test_bench_compares_only_its_own_files(refusal: Any, tmp_path: Path) -> None:
    (tmp_path / "other.json").write_text("{}")
    assert "other.json: " in refusal("bench", "--compare", "other.json", "other.json")


# model and diagram.


def test_model_is_written_for_a_subject(humanwalk: Any, tmp_path: Path) -> None:
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    assert humanwalk("model", "--mass", "55", "--stature", "1.6", "-o", "small.sdf")[0] == 0
    plant = MultibodyPlant(time_step=0.0)
    Parser(plant).AddModels(str(tmp_path / "small.sdf"))
    plant.Finalize()
    assert plant.CalcTotalMass(plant.CreateDefaultContext()) == pytest.approx(55.0, rel=1e-6)
    assert plant.num_actuators() == 42


def test_model_for_mujoco_is_written_where_the_file_is_xml(humanwalk: Any, tmp_path: Path) -> None:
    assert humanwalk("model", "-o", "human.xml")[0] == 0
    assert ElementTree.parse(tmp_path / "human.xml").getroot().tag == "mujoco"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--mass", "-3"), "mass: -3"),
        (("--stature", "175"), "centimeters"),
        (("--mass", "nan"), "is not a number"),
    ],
    ids=str,
)
def test_model_of_an_invalid_subject_is_refused(refusal: Any, arguments: Any, said: Any) -> None:
    assert said in refusal("model", *arguments, "-o", "x.sdf")


def test_model_prints_the_segments_beside_the_table(humanwalk: Any) -> None:
    code, out, err = humanwalk("model", "--sex", "female", "--age", "8", "--mass", "26", "--stature", "1.28")
    assert code == 0
    assert "26 kg, 1.28 m, beside de Leva's women of 8 years" in out
    assert re.search(r"thigh +25\.7 \(25\.7\) +3\.25 \(3\.25\) +36 \(36\) +1\.00 +1\.00 +1\.00", out)
    # Left limbs mirror the right ones and are not repeated.
    assert out.count("thigh") == 1
    assert err == ""


def test_model_prints_the_loads(humanwalk: Any, tmp_path: Path) -> None:
    loads = ("--load", "backpack 3 kg", "--load", "suitcase 2 kg in the left hand unknown")
    code, _, err = humanwalk("model", *loads, "-o", "loaded.sdf")
    assert code == 0
    assert "backpack: 3 kg, known to the walker\nsuitcase: 2 kg, unknown to the walker\n" in err
    assert "loaded.sdf: 46 bodies, 42 revolute joints, 75 kg, 1.75 m" in err


def test_model_in_a_missing_folder_is_refused(refusal: Any) -> None:
    assert "No such file or directory" in refusal("model", "-o", "none/x.sdf")


@pytest.mark.parametrize("name", ["human.txt", "human", "human.sdf.gz"])
def test_model_of_unknown_format_is_refused(refusal: Any, name: str) -> None:
    assert "unknown model format; allowed: .sdf, .urdf, .xml, .osim" in refusal("model", "-o", name)


@pytest.mark.parametrize(
    ("name", "root"), [("x.sdf", "sdf"), ("x.URDF", "robot"), ("x.xml", "mujoco"), ("x.osim", "OpenSimDocument")]
)
def test_model_has_the_format_of_its_suffix(humanwalk: Any, tmp_path: Path, name: str, root: str) -> None:
    assert humanwalk("model", "-o", name)[0] == 0
    assert ElementTree.parse(tmp_path / name).getroot().tag == root


needs_dot = pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz' dot is not installed")
# pydot calls pyparsing by names of old.
old_pydot = pytest.mark.filterwarnings("ignore:.*deprecated - use:DeprecationWarning")


@needs_dot
@old_pydot
@pytest.mark.parametrize(("name", "start"), [("d.svg", b"<?xml"), ("d.png", b"\x89PNG"), ("d.PDF", b"%PDF")])
def test_diagram_is_drawn(humanwalk: Any, tmp_path: Path, name: str, start: Any) -> None:
    assert humanwalk("diagram", "-o", name)[0] == 0
    assert (tmp_path / name).read_bytes().startswith(start)
    assert [path.name for path in tmp_path.iterdir()] == [name]


@needs_dot
@old_pydot
def test_diagram_shows_the_systems_of_its_scenario(humanwalk: Any, tmp_path: Path) -> None:
    humanwalk("diagram", "-o", "d.svg", "--set", "controller.thesis.balance.upper_body.enabled=true")
    drawn = (tmp_path / "d.svg").read_text()
    for name in ("gait", "inverse_kinematics", "actuators", "plant", "support", "upper_body_balance"):
        assert name in drawn
    assert "foot_force_balance" not in drawn


@pytest.mark.parametrize("name", ["d.jpg", "d", "d.svg.gz"])
def test_diagram_of_an_unknown_format_is_refused(refusal: Any, name: str) -> None:
    assert "svg, png, pdf" in refusal("diagram", "-o", name)


def test_diagram_of_an_unknown_scenario_is_refused(refusal: Any) -> None:
    assert "thesiss" in refusal("diagram", "thesiss", "-o", "d.svg")


# Studies and tunings.


def test_an_empty_address_of_a_scheduler_is_refused(refusal: Any, tmp_path: Path) -> None:
    """As an unset variable of the shell gives it: the study does not run on this machine instead."""
    (tmp_path / "short.yaml").write_text("set: {duration: 0.02}")
    assert refusal("study", "short.yaml", "-o", "x", "--scheduler", "").startswith("humanwalk: --scheduler : ")
    assert not (tmp_path / "x").exists()


def test_a_study_prints_the_first_warnings_of_its_points(humanwalk: Any, tmp_path: Path) -> None:
    late = "[{time: 3.0}, {time: 4.0}]"
    (tmp_path / "late.yaml").write_text(
        f"scenario: thesis\nset: {{pushes.given: {late}}}\nfactors: {{duration: [0.01, 0.02, 0.03]}}\n"
    )
    code, _, err = humanwalk("study", "late.yaml", "-o", "late", "--workers", "1")
    assert code == 0
    warnings = [line for line in err.splitlines() if line.startswith("warning: ")]
    assert warnings[0] == "warning: pushes.given: the push at 3 s comes after the end at 0.01 s (1 of 3 points)"
    assert warnings[5:] == ["warning: and 1 more"]


def test_a_point_that_only_its_simulation_refuses_is_no_fall(humanwalk: Any, tmp_path: Path) -> None:
    lift = "controller.thesis.gait.path.step_height: [0.1, 0.15]"
    (tmp_path / "lifts.yaml").write_text(f"scenario: thesis\nset: {{duration: 0.02}}\nfactors: {{{lift}}}\n")
    code, _, err = humanwalk("study", "lifts.yaml", "-o", "lifts", "--workers", "1")
    assert code == 2
    assert "1 without a result; the first, row 0: refused: controller.thesis.gait" in err
    code, out, _ = humanwalk("study", "show", "lifts")
    assert code == 0
    assert "1 of 1" in out


def test_a_tuning_that_cannot_be_used_is_refused(refusal: Any, tmp_path: Path) -> None:
    assert "no such tuning or file; allowed: cost_of_transport, likeness, pushes_60" in refusal(
        "tune", "cheap", "-o", "x"
    )
    (tmp_path / "bad.yaml").write_text("parameters: {duration: {low: 1.0, high: 30.0}}\n")
    assert "objectives: empty; allowed: " in refusal("tune", "bad.yaml", "-o", "x")
    assert "no tuning, tuning.yaml is missing" in refusal("tune", "show", ".")
