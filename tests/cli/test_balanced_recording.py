"""A recording walked on its own feet: its speed and steps are commanded, its angles are a style."""

import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from humanwalk.body.subject import Subject
from humanwalk.cli.walk import balanced_overrides
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.scenario import load_scenario

SPEED, STEP = 0.8, 0.6
SLOW_TRIAL = Path(__file__).parents[2] / "tools" / "slow_trial.py"
QUICK = ("--no-plots", "--no-replay")


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Four seconds of people's curves with the path of the pelvis, as a table."""
    path = tmp_path / "trial.csv"
    runpy.run_path(str(SLOW_TRIAL))["write"](path, SPEED, STEP, 4.0)
    return path


def test_its_speed_and_steps_are_commanded_and_nothing_supports_it(
    humanwalk: Any, tmp_path: Path, recording: Path
) -> None:
    code, _, errors = humanwalk(
        "walk", "--follow", str(recording), "--balanced", "--duration", "0.05", "-o", "walked", *QUICK
    )
    assert code == 0, errors
    run = Run.open(tmp_path / "walked")
    controller: Any = run.scenario.controller
    assert run.summary["style"] == "recorded"
    assert run.summary["external_support"] is False
    assert controller.command.points[0].forward == pytest.approx(SPEED, abs=0.01)
    timing = controller.planner.timing
    assert timing.step == pytest.approx(STEP, abs=0.01)
    default: Any = load_scenario("walk").controller
    assert controller.planner == replace(default.planner, timing=timing)
    assert controller.whole_body == default.whole_body
    recording.unlink()
    assert humanwalk("reproduce", "walked")[0] == 0


def test_a_smaller_subject_takes_the_recorded_time_for_a_step(humanwalk: Any, tmp_path: Path, recording: Path) -> None:
    options = ("--sex", "female", "--set", "subject.stature=1.55", "--mass", "52")
    code, _, errors = humanwalk(
        "walk", "--follow", str(recording), "--balanced", *options, "--duration", "0.05", "-o", "walked", *QUICK
    )
    assert code == 0, errors
    scenario: Any = Run.open(tmp_path / "walked").scenario
    step, scale = scenario.controller.planner.timing.step, scenario.subject.scale
    assert scale.time < 0.97
    assert step * scale.time == pytest.approx(STEP, abs=0.01)


def test_a_recording_with_times_in_milliseconds_is_refused_by_its_time(tmp_path: Path) -> None:
    path = tmp_path / "trial.csv"
    runpy.run_path(str(SLOW_TRIAL))["write"](path, SPEED, STEP, 3.0)
    header, *rows = path.read_text().splitlines()
    times, others = zip(*(row.split(",", 1) for row in rows), strict=True)
    path.write_text("\n".join((header, *(f"{1000.0 * float(t)!r},{o}" for t, o in zip(times, others, strict=True)))))
    with pytest.raises(
        ParameterError, match=r"trial\.csv: a step takes 6\d\d s; allowed: 0\.3 to 1\.2 s .* time, "
    ) as error:
        balanced_overrides(path, None, Subject(sex="unspecified"))
    assert "\n" not in str(error.value)


def test_a_recording_is_shown_without_physics(humanwalk: Any, tmp_path: Path, recording: Path) -> None:
    """Its whole length, so that there are steps to measure."""
    code, _, errors = humanwalk("walk", "--follow", str(recording), "--kinematic", "-o", "shown", *QUICK)
    assert code == 0, errors
    summary = Run.open(tmp_path / "shown").summary
    assert (summary["end"], summary["physics"], summary["cost_of_transport"]) == ("completed", False, None)


@pytest.mark.parametrize("more", [(), ("--balanced",), ("--kinematic",)])
def test_a_controller_that_replaces_the_recording_is_refused(
    humanwalk: Any, tmp_path: Path, recording: Path, more: tuple[str, ...]
) -> None:
    code, _, errors = humanwalk("walk", "--follow", str(recording), *more, "--set", "controller=balanced", *QUICK)
    assert code == 2
    assert "--set controller replaces what follows the recording" in " ".join(errors.split())
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("options", [("--balanced",), ("--follow", "trial.csv", "--kinematic", "--balanced")])
def test_without_a_recording_or_without_physics_nothing_can_be_balanced(
    humanwalk: Any, recording: Path, options: tuple[str, ...]
) -> None:
    code, _, errors = humanwalk("walk", *options, *QUICK)
    assert code != 0
    assert "--balanced" in errors
