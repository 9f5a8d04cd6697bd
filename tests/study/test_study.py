"""The study as a file format."""

from pathlib import Path

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario
from humanwalk.study.study import Study, dump_study, load_study, parse_study, shipped_studies

EVERYTHING = """
description: Every kind of factor
scenario: push
set: {duration: 10, actuation: {pd: {law: implicit}}}
factors:
  controller.balanced.command.points.0.forward: [0.8, 1.0]
  subject.mass: {range: {low: 60, high: 80, number: 3}}
  start.joint_noise: {log_range: {low: 0.001, high: 0.01}}
  start.rate_noise: {uniform: {low: 0, high: 0.1}}
  subject.stature: {normal: {mean: 1.75, standard_deviation: 0.07, low: 1.5, high: 2.0}}
  seed: {seeds: {first: 3, count: 4}}
  push: {variants: {none: {pushes.given: []}, hard: {pushes.given.0.impulse: 60, pushes.given.0.time: 4}}}
design: {sobol: {number: 16, seed: 2}}
keep: runs
"""


def test_complete_study_is_read_back_to_an_equal_one() -> None:
    study = parse_study(EVERYTHING)
    assert parse_study(dump_study(study)) == study
    assert parse_study(dump_study(study)).points == study.points


def test_scenario_at_a_point_is_the_one_with_the_same_overrides() -> None:
    study = parse_study(EVERYTHING)
    assert len(study.points) == 16
    for point in study.points:
        variant = {"pushes.given": "[]"}
        if point["push"] == "hard":
            variant = {"pushes.given.0.impulse": "60", "pushes.given.0.time": "4"}
        others = {name: repr(value) for name, value in point.items() if name != "push"}
        overrides = {"duration": "10", "actuation": "{pd: {law: implicit}}"} | others | variant
        assert study.scenario_at(point) == load_scenario("push", overrides)


def test_points_do_not_change_each_other() -> None:
    study = parse_study(EVERYTHING)
    first = [study.scenario_at(point) for point in study.points]
    assert list(reversed([study.scenario_at(point) for point in reversed(study.points)])) == first
    assert study.scenario == load_scenario("push")


def test_empty_study_is_one_run() -> None:
    assert [Study().scenario_at(point) for point in Study().points] == [Study().scenario]


def test_base_scenario_is_a_name_a_file_or_fields(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("duration: 3")
    for scenario in ("mine.yaml", "{duration: 3}"):
        (tmp_path / "study.yaml").write_text(f"scenario: {scenario}")
        assert load_study(tmp_path / "study.yaml").scenario.duration == 3.0


def test_paths_of_a_study_count_from_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "points.csv").write_text("duration\n1\n2\n")
    (tmp_path / "study.yaml").write_text("design: {rows: {file: points.csv}}")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    study = load_study(tmp_path / "study.yaml")
    assert [study.scenario_at(point).duration for point in study.points] == [1.0, 2.0]
    assert load_study("../study.yaml") == study


def test_column_shows_the_scenarios_value_where_a_point_has_none() -> None:
    study = parse_study(
        "scenario: push\nset: {duration: 9}\ndesign: one_at_a_time\nfactors: "
        "{duration: [3], pushes.given.1.impulse: [5], pushes.given.9.impulse: [5], v: {variants: {a: {seed: 1}}}}"
    )
    assert [study.value_at({}, name) for name in study.columns] == [9, 30.0, None, None]
    for index in ("x", "9" * 5000):
        assert study.value_at({}, f"pushes.given.{index}.impulse") is None
    assert study.value_at({"duration": 3}, "duration") == 3


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("factor: {}", "did you mean factors"),
        ("factors: {seed: 3}", "factors.seed: 3 is unknown"),
        ("factors: {seed: []}", "factors.seed.values: no values"),
        ("factors: {duration: [1, 2, 1.0]}", "factors.duration.values: 1.0 comes twice; allowed: every value once"),
        ("factors: {contact: {values: [point, point]}}", "factors.contact.values: 'point' comes twice; allowed: "),
        ("factors: {seed: {seeds: {count: 0}}}", r"factors\.seed\.count: 0 is out of range"),
        ("factors: {duration: {rnge: {}}}", "did you mean range"),
        ("factors: {duration: {range: {low: 2, high: 1}}}", r"factors\.duration\.range\.low: 2 and high: 1"),
        ("factors: {duration: [.nan]}", r"factors\.duration\.values\.0: nan cannot be a value"),
        ("factors: {push: {variants: {a: 3}}}", r"factors\.push\.variants\.a: 3 is not a mapping"),
        ("factors: {duration: {range: {mean: 3.0}}}", r"no such field; .*; it belongs to factors\.NAME\.normal$"),
        (
            "factors: {duration: {range: {number: 5}}}",
            r"^study, line 1: factors\.duration\.range: low and high mi",
        ),
        ("factors: {duration: {log_range: {high: 5}}}", r"factors\.duration\.log_range: low missing; allowed: "),
        ("factors: {duration: uniform}", r"factors\.duration\.uniform: low and high missing; allowed: "),
        (
            "factors: {duration: {normal: {mean: 5}}}",
            "normal: standard_deviation missing; allowed: a group with mean ",
        ),
        ("design: {full_factorial: 3}", r"3 is not a group of fields; allowed: none, it has no fields$"),
        (
            "design: {full_factorial: {number: 3}}",
            "no such field; allowed: none, it has no fields; it belongs to design",
        ),
        ("design: sobl", "did you mean sobol"),
        ("keep: everything", "keep: 'everything' is unknown; allowed: summary, runs"),
        ("scenario: tesis", "did you mean thesis"),
        ("scenario: {duration: -1}", r"scenario\.duration: -1 is out of range"),
        ("scenario: [1]", "scenario: .* is not a group of fields"),
    ],
)
def test_files_that_are_no_study_are_refused_in_one_line(text: str, match: str) -> None:
    with pytest.raises(ParameterError, match=match) as raised:
        parse_study(text)
    assert str(raised.value).isprintable()


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("factors: {durations: [1]}", r"point \(durations: 1\): durations: no such field.*did you mean duration"),
        ("factors: {duration: [1, -1], seed: [4]}", r"point \(duration: -1, seed: 4\): duration: -1 is out of range"),
        ("factors: {pushes.given.1.time: [1]}", "pushes.given.1: no such entry; allowed: 0 to 0"),
        ("factors: {controller.balanced.control_period: [0.006]}", "controller is 'thesis'"),
        ("set: {duration: -1}", r"^duration: -1 is out of range"),
        (
            "factors: {subject.mass: [60, 80], subject: [{sex: female}]}",
            r"point \(subject.mass: 60, .*: factors: subject replaces subject.mass, which a factor before it sets",
        ),
        (
            "factors: {subject.mass: [60, 80], v: {variants: {heavy: {subject.mass: 90}}}}",
            "factors: v replaces subject.mass, which a factor before it sets; allowed: .* remove one",
        ),
        ("set: {duration.x: -1}", r"duration is 15\.0"),
        ("factors: {seed: {uniform: {low: 0, high: 1}}}", "latin_hypercube or sobol"),
        ("factors: {seed: {range: {low: 0, high: 1}}}", "0.0 is not a whole number"),
    ],
)
def test_points_that_cannot_be_simulated_are_refused_with_their_values(text: str, match: str) -> None:
    study = parse_study(text)
    with pytest.raises(ParameterError, match=match) as raised:
        study.require_valid()
    assert str(raised.value).isprintable()


def test_a_factor_may_replace_a_field_of_a_group_that_one_before_it_sets() -> None:
    study = parse_study("factors: {subject: [{sex: female}], subject.mass: [60, 80]}")
    assert [(scenario.subject.sex, scenario.subject.mass) for scenario in study.scenarios()] == [
        ("female", 60.0),
        ("female", 80.0),
    ]


def test_warnings_of_the_scenarios_are_counted() -> None:
    push = "pushes.given: [{time: 1.0}]"
    study = parse_study(f"scenario: stand\nset: {{{push}}}\nfactors: {{duration: [0.5, 1.0, 1.5]}}\n")
    early, late = study.warnings
    assert early == "pushes.given: the push at 1 s comes after the end at 0.5 s (1 of 3 points)"
    assert late == "pushes.given: the push at 1 s comes after the end at 1 s (1 of 3 points)"
    (both,) = parse_study(f"scenario: stand\nset: {{{push}, duration: 0.5}}\nfactors: {{seed: [0, 1]}}\n").warnings
    assert both.endswith("(2 of 2 points)")
    assert parse_study("scenario: stand\n").warnings == ()
    twice = "scenario: stand\nset: {duration: 0.5, pushes.given: [{time: 1.0}, {time: 1.0}]}\n"
    assert parse_study(twice).warnings[0].endswith("(1 of 1 points)")


def test_unknown_study_is_refused() -> None:
    with pytest.raises(ParameterError, match="no such study or file"):
        load_study("nothing")


def test_shipped_studies_are_valid() -> None:
    for name in shipped_studies():
        load_study(name).require_valid()
