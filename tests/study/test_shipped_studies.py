"""The studies that come with humanwalk can be simulated, and are what descriptions and docs/robustness.md state."""

import math
from dataclasses import replace
from itertools import batched
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from humanwalk.body.subject import Subject
from humanwalk.cli.main import app
from humanwalk.scenario import load_scenario
from humanwalk.study.design import Rows
from humanwalk.study.page import PAGE
from humanwalk.study.row import Job, simulate_row
from humanwalk.study.study import Study, load_study, shipped_studies
from humanwalk.study.table import open_journal


@pytest.mark.parametrize("name", shipped_studies())
def test_every_point_of_a_shipped_study_is_valid(name: str) -> None:
    study = load_study(name)
    study.require_valid()
    assert study.description
    assert len(study.points) > 1


@pytest.mark.parametrize(
    ("name", "number"),
    [
        ("balance_speeds", 5),
        ("balance_fast", 12),
        ("balance_fast_pushes", 48),
        ("balance_seeds", 40),
        ("balance_paths", 6),
        ("balance_turns", 64),
        ("balance_commands", 40),
        ("balance_bodies", 8),
        ("balance_pushes", 40),
        ("balance_pushes_60", 10),
        ("balance_pushes_sideways", 40),
        ("balance_standing", 40),
        ("balance_weight_shift", 72),
        ("balance_invariance", 4),
        ("push_random", 100),
        ("thesis_step_height", 9),
        ("actuations", 3),
        ("likeness", 12),
        ("likeness_bodies", 27),
        ("likeness_speeds", 12),
        ("normative_seeds", 20),
        ("subjects_adults", 100),
        ("subjects_children", 40),
        ("subjects_loads", 80),
        ("subjects_pushes", 40),
        ("terrain", 400),
        ("terrain_rough", 40),
        ("terrain_rough_blind", 40),
        ("terrain_stones", 40),
        ("terrain_course", 40),
        ("terrain_edges", 150),
        ("terrain_blind", 55),
        ("terrain_treads", 40),
        ("terrain_stops", 60),
        ("terrain_pushes", 80),
        ("terrain_bodies", 80),
        ("terrain_mixed", 90),
        ("terrain_impairments", 160),
        ("terrain_turns", 36),
        ("terrain_commands", 40),
        ("terrain_stairs_pushes", 128),
    ],
)
def test_tables_of_the_book_have_their_number_of_rows(name: str, number: int) -> None:
    assert len(load_study(name).points) == number


def test_paths_are_those_of_the_shipped_scenarios() -> None:
    study = load_study("balance_paths")
    for point in study.points:
        shipped = load_scenario(point["path"])
        assert study.scenario_at(point) == replace(shipped, description=study.scenario.description)


def test_pushes_of_subjects_are_in_proportion_to_their_masses() -> None:
    study = load_study("subjects_pushes")
    scenarios = [study.scenario_at(point) for point in study.points]
    for scenario in scenarios:
        (push,) = scenario.pushes.given
        assert push.impulse == pytest.approx(0.4 * scenario.subject.mass)
    assert len({scenario.subject for scenario in scenarios}) == 5


def test_the_style_that_is_compared_with_people_is_that_of_the_scenario() -> None:
    study, shipped = load_study("likeness"), load_scenario("normative").controller
    walks = [study.scenario_at(point).controller for point in study.points if point["gait"] == "normative"]
    assert len(walks) == 6
    for controller in walks:
        assert replace(controller, command=shipped.command) == shipped


@pytest.mark.parametrize(("name", "number"), [("impairments", 10), ("terrain_impairments", 32)])
def test_the_prosthesis_is_that_of_the_scenario(name: str, number: int) -> None:
    study, shipped = load_study(name), load_scenario("ankle_prosthesis")
    walks = [study.scenario_at(point) for point in study.points if point["subject"] == "right ankle prosthesis"]
    assert len(walks) == number
    for walk in walks:
        assert walk.subject == shipped.subject
        assert replace(walk.controller, command=shipped.controller.command) == shipped.controller


@pytest.mark.parametrize("name", ["subjects_adults", "subjects_children"])
def test_subjects_walk_at_one_dimensionless_speed(name: str) -> None:
    study = load_study(name)
    scenarios = [study.scenario_at(point) for point in study.points]
    for scenario in scenarios:
        leg, speed = scenario.subject.body.hip_height, scenario.controller.commanded_speed
        assert speed == pytest.approx(1.2 * math.sqrt(leg / 0.93), abs=6e-4)
    assert {scenario.subject.sex for scenario in scenarios} == {"female", "male"}


def test_bodies_are_compared_at_the_dimensionless_speeds_of_the_default_man() -> None:
    study, man = load_study("likeness_bodies"), Subject().skeleton.hip_height
    speeds = load_study("likeness").factors["controller.balanced.command.points.0.forward"].levels()
    for scenarios in batched(map(study.scenario_at, study.points), 3):
        (subject,) = {scenario.subject for scenario in scenarios}
        ratio = math.sqrt(subject.skeleton.hip_height / man)
        commanded = [scenario.controller.commanded_speed for scenario in scenarios]
        assert commanded == pytest.approx([ratio * speed for speed in speeds], abs=6e-4)


def test_pushes_leave_time_to_fall() -> None:
    for name in ("balance_pushes", "balance_pushes_60", "balance_pushes_sideways", "push_random", "subjects_pushes"):
        study = load_study(name)
        for scenario in map(study.scenario_at, study.points):
            (push,) = scenario.pushes.given
            assert push.time >= scenario.controller.steady_from(scenario.subject)
            assert scenario.duration >= push.time + 4.0
            assert push.duration == 0.1


def test_random_pushes_have_every_direction_and_time() -> None:
    points = load_study("push_random").points
    for name, low, high in (("time", 8.0, 9.04), ("direction", -math.pi, math.pi)):
        values = [point[f"pushes.given.0.{name}"] for point in points]
        assert sorted(int(100 * (value - low) / (high - low)) for value in values) == list(range(100))


@pytest.fixture
def short_study(tmp_path: Path) -> Study:
    """The first points of the shipped study of step heights, 0.05 s long."""
    study = load_study("thesis_step_height")
    assert isinstance(study.design, Rows)
    lines = Path(study.design.file).read_text().splitlines()[:3]
    file = tmp_path / "two.csv"
    file.write_text("\n".join(lines))
    return replace(study, set={"duration": 0.05}, design=Rows(str(file)))


def test_a_study_is_simulated_and_shown(short_study: Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    with open_journal(folder, short_study) as journal:
        for index, scenario in enumerate(map(short_study.scenario_at, short_study.points)):
            journal.append(index, simulate_row(Job(index, scenario)))
    result: Any = CliRunner().invoke(app, ["study", "show", str(folder), "--measure", "duration"])
    assert result.exit_code == 0, result.output
    assert "1 of 1     100 %   20.7 to 100.0 %" in result.stdout
    assert "step height [m] with" in result.stdout
    assert "duration [s]" in result.stdout
    assert (folder / PAGE).is_file()
    assert str(folder / PAGE) in result.stderr


def test_a_page_that_cannot_be_written_is_refused_before_the_tables(short_study: Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    with open_journal(folder, short_study) as journal:
        journal.append(0, simulate_row(Job(0, short_study.scenario_at(short_study.points[0]))))
    (folder / PAGE).mkdir()
    result: Any = CliRunner().invoke(app, ["study", "show", str(folder)])
    assert str(result.exception) == f"{folder / PAGE}: a folder or device; allowed: a file; move it away"
    assert result.stdout == ""


@pytest.mark.parametrize("form", ["eps", ""])
def test_an_unknown_format_is_refused_before_the_tables(short_study: Study, tmp_path: Path, form: str) -> None:
    result: Any = CliRunner().invoke(app, ["study", "show", str(tmp_path), "--figures", form])
    assert str(result.exception) == f"--figures {form}: unknown; allowed: png, svg, pdf; choose one of them"


def test_a_study_without_a_finished_run_is_not_shown(short_study: Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    with open_journal(folder, short_study):
        pass
    result: Any = CliRunner().invoke(app, ["study", "show", str(folder)])
    assert "no run has finished; allowed: one or more; run the study first" in str(result.exception)


@pytest.mark.parametrize("name", ["terrain_rough", "terrain_rough_blind", "terrain_stones", "terrain_course"])
def test_every_walk_on_random_ground_has_its_own_ground_and_its_own_noise(name: str) -> None:
    points = load_study(name).points
    for factor in points[0]:
        assert sorted(point[factor] for point in points) == list(range(1, 41))
