"""Every example runs, shortened, and does what its first line says."""

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import humanwalk

EXAMPLES = Path(__file__).parent.parent / "examples"

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning:multiprocessing")


def example(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)  # type: ignore[arg-type]
    spec.loader.exec_module(module)
    return module


def test_every_example_is_tested() -> None:
    tested = {
        "build_a_walker",
        "compare_with_people",
        "follow_a_recording",
        "own_controller",
        "plot_joint_torques",
        "read_a_run",
        "run_a_study",
    }
    assert {path.stem for path in EXAMPLES.glob("*.py")} == tested


def test_build_a_walker_walks() -> None:
    assert example("build_a_walker").main(0.2) > 0


def test_study_has_a_row_for_each_value(tmp_path: Path) -> None:
    study = example("run_a_study")
    table = study.main(tmp_path / "study", (0.12, 0.18), 0.05, workers=1)
    assert table[study.STEP_HEIGHT].to_pylist() == [0.12, 0.18]
    assert table["end"].to_pylist() == ["completed", "completed"]


def test_plot_joint_torques_draws_both_knees(tmp_path: Path) -> None:
    figure = example("plot_joint_torques").main(0.05, tmp_path / "torques.png")
    assert (tmp_path / "torques.png").stat().st_size > 1000
    assert [line.get_label() for line in figure.axes[0].lines] == ["right knee", "left knee"]


def test_own_controller_changes_the_walk() -> None:
    own = example("own_controller")
    assert own.main(0.2, lever=0.05) != own.main(0.2, lever=0.0)


def test_recording_is_followed_with_physics_and_shown_without(tmp_path: Path) -> None:
    runs = example("follow_a_recording").main(tmp_path, duration=0.3)
    assert {name: run.summary["physics"] for name, run in runs.items()} == {"followed": True, "shown": False}
    assert all(run.summary["end"] == "completed" for run in runs.values())


def test_comparison_with_people_is_of_every_height() -> None:
    found = example("compare_with_people").main((0.12, 0.2), duration=2.5)
    assert set(found) == {0.12, 0.2}
    # Both bend and straighten the knee when people do; how far is not what a correlation tells.
    assert all(0.5 < correlation < 1.0 for correlation in found.values())


def test_read_a_run_reads_what_a_script_saved(tmp_path: Path) -> None:
    scenario = humanwalk.load_scenario("thesis", {"duration": "0.1"})
    run = humanwalk.simulate(scenario).save(tmp_path / "run")
    assert example("read_a_run").main(run.path) == pytest.approx(run["right_foot.force_z_N"].max())
    assert (run.path / "my_ground_reaction.png").is_file()
    assert (run.path / "opensim" / "angles.mot").is_file()

    # The run as a table with units.
    assert run.units["RightLegTibiaMotion.torque_N_m"] == "N m"
    assert run.units["com.velocity_x_m_s"] == "m/s"
    assert run.units["RightLegTibiaMotion.velocity_rad_s"] == "rad/s"
    assert run.units["right_foot.loaded"] == run.units["pelvis.quaternion_w"] == ""
    np.testing.assert_array_equal(run["com.x"], run["com.x_m"])
    np.testing.assert_array_equal(run.time, run.signals["time_s"].to_numpy())
    with pytest.raises(humanwalk.ParameterError, match=r"RightLegTibiaMotion\.torque_N_m"):
        run["RightLegTibaMotion.torque"]
    with pytest.raises(humanwalk.ParameterError, match="joint_torques"):
        humanwalk.plot(run, "joint_torqes")
    with pytest.raises(humanwalk.ParameterError, match="holds files already"):
        humanwalk.simulate(humanwalk.load_scenario("thesis", {"duration": "0.002"})).save(run.path)


def test_read_a_run_reads_a_fall_before_steady_walking(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    push = {"duration": "2", "pushes": "{given: [{time: 0.0, duration: 0.05, impulse: 400.0, direction: 1.57}]}"}
    run = humanwalk.simulate(humanwalk.load_scenario("walk", push)).save(tmp_path / "run")
    assert run.summary["mean_speed_m_s"] is None
    example("read_a_run").main(run.path)
    printed = capsys.readouterr().out
    assert f"script: fell after {run.time[-1]:g} s" in printed
    assert "commanded 1.00 m/s, walked -" in printed


def test_everything_promised_at_the_top_is_there() -> None:
    for name in humanwalk.__all__:
        assert getattr(humanwalk, name) is not None
    with pytest.raises(AttributeError, match="no_such"):
        _ = humanwalk.no_such  # type: ignore[attr-defined]


def test_importing_the_package_does_not_import_drake() -> None:
    import subprocess
    import sys

    code = "import sys, humanwalk; raise SystemExit('pydrake' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
