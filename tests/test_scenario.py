"""Scenario files: read strictly, answered in one line, written back without loss."""

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.choices import BalancedController, PointContact
from humanwalk.choices.contact import HydroelasticContact
from humanwalk.choices.start import StartParameters
from humanwalk.parameter_file import fields_of
from humanwalk.quantity import ParameterError
from humanwalk.scenario import (
    Scenario,
    dump_scenario,
    load_scenario,
    parse_scenario,
    shipped_scenarios,
)
from humanwalk.terrain import PIECES
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.steps import Curb


def refusal(text: str = "", overrides: dict[str, str] | None = None) -> str:
    """The one line with which a scenario is refused."""
    with pytest.raises(ParameterError) as raised:
        parse_scenario(text, overrides)
    message = str(raised.value)
    assert len(message.splitlines()) == 1
    return message


# What is shipped, and what comes back.


def test_thesis_is_shipped() -> None:
    assert "thesis" in shipped_scenarios()


@pytest.mark.parametrize("name", shipped_scenarios())
def test_shipped_scenario_is_described_and_round_trips(name: str) -> None:
    scenario = load_scenario(name)
    assert scenario.description
    assert len(scenario.description.splitlines()) == 1
    assert parse_scenario(dump_scenario(scenario)) == scenario


@pytest.mark.parametrize("name", shipped_scenarios())
def test_shipped_scenario_is_the_same_by_name_and_by_path(name: str) -> None:
    assert load_scenario(shipped_scenarios()[name]) == load_scenario(name)


@pytest.mark.parametrize("text", ["", "  \n", "# only a comment\n", "---\n", "_anchors: &a {b: 1}\n"])
def test_empty_file_is_the_defaults(text: str) -> None:
    assert parse_scenario(text) == Scenario()


def test_dump_writes_every_field() -> None:
    def names(kind: Any) -> Iterator[str]:
        for field in dataclasses.fields(kind):
            yield field.name
            if dataclasses.is_dataclass(field.type):
                yield from names(field.type)

    text = dump_scenario(Scenario())
    assert [name for name in names(Scenario) if f"{name}:" not in text] == []


def test_anchors_of_underscored_keys_are_usable() -> None:
    scenario = parse_scenario("_slow: &slow 0.7\ncontroller: {thesis: {gait: {ramp: {speed: *slow}}}}")
    assert scenario.controller.gait.ramp.speed == 0.7  # type: ignore[attr-defined]


# Overrides are typed as in YAML.


@pytest.mark.parametrize(
    ("key", "text", "value"),
    [
        ("duration", "3", 3.0),
        ("duration", "1e-1", 0.1),
        ("seed", "7", 7),
        ("contact", "hydroelastic", HydroelasticContact()),
        ("contact", "{hydroelastic: {leg_contact: false}}", HydroelasticContact(leg_contact=False)),
        ("contact.hydroelastic.leg_contact", "false", HydroelasticContact(leg_contact=False)),
        ("description", "a walk", "a walk"),
        ("start.joint_angles", "{RightLegTibiaMotion: 0.3}", {"RightLegTibiaMotion": 0.3}),
        ("start.joint_angles.RightLegTibiaMotion", "0.3", {"RightLegTibiaMotion": 0.3}),
    ],
)
def test_override_is_typed_like_yaml(key: str, text: str, value: Any) -> None:
    found = parse_scenario("", {key: text})
    for name in key.split(".")[: 1 if key.startswith("contact") else 2]:
        found = getattr(found, name)
    assert found == value
    assert type(found) is type(value)


def test_override_replaces_one_field_and_keeps_its_neighbours() -> None:
    text = "controller: {thesis: {gait: {path: {step_length: 0.4, step_height: 0.1}}}}"
    path = parse_scenario(text, {"controller.thesis.gait.path.step_height": "0.15"}).controller.gait.path  # type: ignore[attr-defined]
    assert (path.step_length, path.step_height) == (0.4, 0.15)


@pytest.mark.parametrize("task", ["heel_off", "pelvis", "stance"])
def test_fields_beside_the_one_of_a_file_keep_the_defaults_of_the_group_that_they_belong_to(task: str) -> None:
    """`heel_off` has other gains than a `TaskGains` by itself."""
    key = f"controller.balanced.whole_body.{task}"
    default = getattr(BalancedController().whole_body, task)
    expected = dataclasses.replace(default, weight=7.0)
    for scenario in (load_scenario("walk", {f"{key}.weight": "7"}), load_scenario("walk", {key: "{weight: 7}"})):
        assert isinstance(scenario.controller, BalancedController)
        assert getattr(scenario.controller.whole_body, task) == expected


def test_override_reaches_into_a_choice_that_stands_as_its_tag() -> None:
    walk = parse_scenario("controller: balanced", {"controller.balanced.control_period": "0.006"})
    assert walk.controller == BalancedController(control_period=0.006)


def test_override_of_a_choice_replaces_it_with_its_fields() -> None:
    text = "contact: {asperity: {friction: 0.3}}"
    assert parse_scenario(text, {"contact": "point"}).contact == PointContact()


@pytest.mark.parametrize("key", ["", ".", "gait.", "gait..path", "duration.x", "_x", "_tag", "duration\n"])
def test_override_of_no_field_is_refused(key: str) -> None:
    refusal("", {key: "1"})


@pytest.mark.parametrize("value", ["", "[1", "}", "'", "&a [*a]", "1\n---\n2", "[" * 10_000])
def test_override_that_is_no_number_is_refused(value: str) -> None:
    assert "duration" in refusal("", {"duration": value})


# What is refused, and how to mend it.


@pytest.mark.parametrize(
    "key",
    [
        "controller.thesis.gait.path.step_hight",
        "controller.thesis.gait.path.stepheight",
        "controller.thesis.gait.path.step_heigth",
    ],
)
def test_misspelt_field_is_answered_with_the_right_one(key: str) -> None:
    message = refusal("", {key: "0.1"})
    assert message.startswith(f"{key}:")
    assert "did you mean step_height?" in message


@pytest.mark.parametrize(
    ("key", "value", "mend"),
    [
        ("controller.thesis.gait.path.step_length", "50", ("centimeters", "0.5")),
        ("controller.thesis.gait.path.step_height", "200", ("millimeters", "0.2")),
        ("controller.thesis.gait.path.toe_drop", "25", ("degrees", "0.4363")),
        ("controller.thesis.gait.ramp.speed", "5", ("km/h", "1.389")),
        ("simulation.time_step", "1", ("milliseconds", "0.001")),
        ("start.joint_angles.RightLegTibiaMotion", "30", ("degrees", "0.5236")),
    ],
)
def test_slip_of_the_unit_is_named_and_mended(key: str, value: str, mend: tuple[str, str]) -> None:
    message = refusal("", {key: value})
    assert message.startswith(f"{key}:")
    assert all(part in message for part in mend)


@pytest.mark.parametrize(
    "key",
    ["duration", "controller.thesis.gait.ramp.speed", "start.joint_angles.a", "controller.thesis.gains.joints.a.kp"],
)
@pytest.mark.parametrize("value", [".nan", ".inf", "-.inf", "1e400"])
def test_number_that_is_not_finite_is_refused(key: str, value: str) -> None:
    message = refusal("", {key: value})
    assert message.startswith(f"{key}:")
    assert "finite" in message


@pytest.mark.parametrize(
    "key", ["duration", "seed", "controller.thesis.inverse_kinematics.max_iterations", "contact", "gait"]
)
@pytest.mark.parametrize("value", ["1" + "0" * 400, "-1" + "0" * 400, "1" + "0" * 5000, "0x" + "f" * 9000])
def test_huge_whole_number_is_refused(key: str, value: str) -> None:
    assert key in refusal("", {key: value})


NOT_A_DURATION = "is not a number; allowed: 0.001 to 3600 s; write a number"


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("duration", "true", NOT_A_DURATION),
        ("duration", "fast", NOT_A_DURATION),
        ("duration", "15 s", NOT_A_DURATION),
        ("duration", "2017-01-01", NOT_A_DURATION),
        ("duration", "null", NOT_A_DURATION),
        ("duration", "[1]", NOT_A_DURATION),
        ("duration", "{a: 1}", NOT_A_DURATION),
        ("seed", "1.5", "is not a whole number; allowed: 0 to "),
        ("seed", "true", "is not a whole number; allowed: 0 to "),
        ("seed", "-1", "allowed: 0 to"),
        ("controller.thesis.balance.support.enabled", "1", "true or false"),
        ("controller.thesis.balance.support.enabled", "'true'", "true or false"),
        ("description", "3", "text"),
        ("controller.thesis.gait", "[1]", "allowed: ramp, path, first_swing, footholds, clearance, arms"),
        ("duration", "1:30", NOT_A_DURATION),
        ("controller.thesis.balance.support.enabled", "no", "true or false"),
        ("controller.thesis.gait.path", "0.3", "allowed: step_length"),
        ("controller.thesis.gait.path", "null", "allowed: step_length"),
        ("start.joint_angles", "[1]", "name: value pairs"),
        ("start.joint_angles", "{1: 0.2}", "name: value pairs"),
        ("controller.thesis.gains.joints", "{a: 3}", "allowed: kp, kd"),
        ("subject.mass", "-3", "allowed: 12 to 200 kg"),
        ("contact", "pont", "did you mean point?"),
        ("contact", "[point]", "allowed: point, hydroelastic, asperity"),
        ("contact", "null", "allowed: point, hydroelastic, asperity"),
        ("controller.thesis.gait.first_swing", "right", "did you mean Right?"),
        ("controller.thesis.gait.path.swing", "3", "allowed: thesis, smooth"),
    ],
)
def test_value_of_the_wrong_kind_is_refused(key: str, value: str, said: str) -> None:
    message = refusal("", {key: value})
    assert message.startswith(key)
    assert said in message


def test_discrete_plant_needs_a_time_step() -> None:
    assert "integrator: cenic" in refusal("simulation: {time_step: 0}")


def test_cenic_takes_no_time_step() -> None:
    message = refusal("simulation: {integrator: cenic, time_step: 0.001}")
    assert "simulation.time_step" in message
    assert "set time_step: 0" in message


def test_cenic_with_time_step_zero_is_accepted() -> None:
    simulation = parse_scenario("simulation: {integrator: cenic, time_step: 0}").simulation
    assert (simulation.integrator, simulation.time_step) == ("cenic", 0.0)


@pytest.mark.parametrize(
    ("text", "line"),
    [("duration: 1\ngait: [1", 2), ("a: b: c", 1), ("gait:\n\tpath: 1", 2), ("seed: 1\nduration: *nope", 2)],
)
def test_syntax_error_names_its_line(text: str, line: int) -> None:
    assert f"at line {line}," in refusal(text)


@pytest.mark.parametrize(
    "text",
    [
        "- 1",
        "3",
        "text",
        "&a [*a]",
        "&a {duration: *a}",
        "start: &a {joint_angles: *a}",
        "x: &a 1\ny: &a 2\n",
        "[" * 10_000,
        "{a: " * 10_000,
        "- " * 10_000,
        "gait: " + "[" * 10_000,
        "contact: " + "[" * 100 + "]" * 100,
        "duration: !!timestamp 3",
        "duration: !!int x",
        "duration: !!binary aaa",
        "duration: !unknown 3",
        "!Scenario {duration: 1}",
        "? [a]\n: 1",
        "null: 1",
        "1: 2",
        '"a\\nb": 1',
        'contact: "a\\nb"',
        'start: {joint_angles: {"a\\nb": 0.1}}',
        "duration: 1\n---\nduration: 2",
        "\x00",
        "<<: 3",
    ],
)
def test_what_is_no_scenario_is_refused_in_one_line(text: str) -> None:
    refusal(text)


@pytest.mark.parametrize("form", ["{tag} ['{command}']", "duration: {tag} ['{command}']", "_a: {tag} ['{command}']"])
def test_a_file_runs_no_code(form: str, tmp_path: Path) -> None:
    trace = tmp_path / "trace"
    refusal(form.format(tag="!!python/object/apply:os.system", command=f"touch {trace}"))
    assert not trace.exists()


def test_missing_file_is_answered_with_what_is_shipped(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"no such scenario or file; allowed: .*thesis"):
        load_scenario(tmp_path / "none.yaml")


@pytest.mark.parametrize("content", [b"\xff\xfe\x00\x01\x80", bytes(range(256))])
def test_binary_file_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "picture.yaml"
    path.write_bytes(content)
    with pytest.raises(ParameterError, match="not UTF-8"):
        load_scenario(path)


def test_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"regular file|directory"):
        load_scenario(tmp_path)


# Whatever is written into a scenario: it is one, or it is refused in a line.


FIELDS = dict(fields_of(Scenario))
KEYS = sorted(FIELDS)


def _numbers(kind: Any) -> Iterator[tuple[str, Any]]:
    """Strategies of all numbers of a scenario by dotted name, with one choice of each kind."""
    for name, field in fields_of(kind):
        if "low" in field.metadata and not name.startswith(UNCHOSEN):
            low, high = field.metadata["low"], field.metadata["high"]
            whole = (isinstance(field.default, int) and name in ("seed", "number")) or name.endswith("max_iterations")
            yield name, st.integers(int(low), int(high)) if whole else st.floats(low, high)


CHOSEN = ("plane", "thesis")
UNCHOSEN = ("terrain.course", "contact.", "controller.balanced", "controller.recorded", "actuation.")
NUMBERS = dict(_numbers(Scenario))

leaves = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(10**300, 10**350),
    st.floats(),
    st.text(max_size=8),
    st.sampled_from(["point", "hydroelastic", "cenic", "smooth", "human", "Left", "numeric", "1e-3"]),
)
names = st.sampled_from(sorted({part for key in KEYS for part in key.split(".")})) | st.text(max_size=5)
values = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(names, inner, max_size=2),
    max_leaves=4,
)
changes = st.dictionaries(st.sampled_from(KEYS) | names, values, min_size=1, max_size=4)


def nested(flat: dict[str, Any]) -> dict[str, Any]:
    """The dictionary of a scenario out of values by dotted key; a group that is a value already stays one."""
    data = {}
    for key in sorted(flat):
        *parents, leaf = key.split(".")
        group = data
        for parent in parents:
            group = group.setdefault(parent, {})
            if not isinstance(group, dict):
                break
        else:
            group[leaf] = flat[key]
    return data


@settings(max_examples=300)
@given(changes)
def test_any_mapping_is_a_scenario_or_refused_in_one_line(flat: dict[str, Any]) -> None:
    text = yaml.safe_dump(nested(flat))
    try:
        scenario = parse_scenario(text)
    except ParameterError as error:
        assert len(str(error).splitlines()) == 1
    else:
        assert parse_scenario(dump_scenario(scenario)) == scenario


@settings(max_examples=300)
@given(st.text(alphabet=st.sampled_from("ab:{}[]&*!-?|>'\"#%,\n\t 0.1~<"), max_size=40))
def test_any_text_is_a_scenario_or_refused_in_one_line(text: str) -> None:
    try:
        parse_scenario(text)
    except ParameterError as error:
        assert len(str(error).splitlines()) == 1


@settings(max_examples=100)
@given(st.data())
def test_every_valid_number_survives_dump_and_parse(data: Any) -> None:
    keys = data.draw(st.lists(st.sampled_from(sorted(NUMBERS)), min_size=1, max_size=8, unique=True))
    flat = {key: data.draw(NUMBERS[key], label=key) for key in keys}
    if flat.get("simulation.time_step") == 0:
        flat["simulation.integrator"] = "cenic"
    try:
        scenario = parse_scenario("", {key: repr(value) for key, value in flat.items()})
    except ParameterError as error:
        assert str(error).startswith(
            ("simulation.time_step", "pushes.random_interval", "subject.mass", "subject.stature", "subject.sex")
        )
        return
    for key, value in flat.items():
        found = scenario
        for part in key.split("."):
            found = found if part in CHOSEN else getattr(found, part)
        assert found == value
    assert parse_scenario(dump_scenario(scenario)) == scenario


@pytest.mark.parametrize(
    ("pieces", "message"),
    [
        ("3", "terrain.course.pieces: 3 is not a list; allowed: a list of flat, slope, "),
        ("[flt]", "terrain.course.pieces.0: 'flt' is unknown; allowed: flat, slope, "),
        ("[flat, {slope: {}, flat: {}}]", "terrain.course.pieces.1: "),
        ("[{slope: {slop: 1}}]", "terrain.course.pieces.0.slope.slop: no such field; allowed: "),
        ("[flat, {slope: {slope: 10}}]", "terrain.course.pieces.1.slope.slope: 10 is out of range; allowed: -0.5 to"),
        (
            "[{stairs: {number: 2.5}}]",
            "terrain.course.pieces.0.stairs.number: 2.5 is not a whole number; allowed: 1 to ",
        ),
        ("[{stairs: {direction: left}}]", "terrain.course.pieces.0.stairs.direction: 'left' is unknown; allowed: up"),
        ("[{stairs: {rise: .nan}}]", "terrain.course.pieces.0.stairs.rise: nan is out of range"),
        ("[height_map]", "terrain.course.pieces.0.height_map.file: no file"),
    ],
)
def test_piece_of_a_course_that_is_none_is_refused_in_one_line(pieces: str, message: str) -> None:
    with pytest.raises(ParameterError) as error:
        parse_scenario(f"terrain: {{course: {{pieces: {pieces}}}}}")
    assert str(error.value).startswith(f"scenario, line 1: {message}")
    assert str(error.value).isprintable()


@pytest.mark.parametrize("field", ["controller.balanced.planer.dcm_gain", "controller.balanced.planner.dcm_gan"])
def test_an_error_of_an_override_is_not_located_in_the_file(field: str) -> None:
    text = "controller:\n  balanced:\n    planner: {}"
    with pytest.raises(ParameterError, match=r"^controller\.balanced\.plan.*: no such field; .*; did you mean "):
        parse_scenario(text, {field: "1"})


@pytest.mark.parametrize(
    ("text", "home"),
    [
        ("terrain: stairs", "terrain.course.pieces"),
        ("terrain: {stairs: {rise: 0.17}}", "terrain.course.pieces"),
        ("subject: {loads: [hip_exoskeleton]}", "subject.devices"),
        ("subject: {devices: [{stiff_knee: {}}]}", "subject.impairments"),
    ],
)
def test_a_choice_of_another_list_is_sent_there(text: str, home: str) -> None:
    with pytest.raises(ParameterError, match=rf" is unknown; allowed: .*; it belongs to the list {home}$"):
        parse_scenario(text)


def test_override_reaches_into_a_piece_of_a_course() -> None:
    text = "terrain: {course: {pieces: [flat, {slope: {length: 4}}]}}"
    name = "terrain.course.pieces"
    changed = parse_scenario(text, {f"{name}.0.flat.length": "3", f"{name}.1.slope.slope": "0.1", f"{name}.2": "curb"})
    assert changed.terrain.pieces == (Flat(length=3.0), Slope(length=4.0, slope=0.1), Curb())  # type: ignore[attr-defined]
    with pytest.raises(ParameterError, match=rf"^{name}\.0\.slope: {name}\.0 is 'flat'; allowed: fields of 'flat'"):
        parse_scenario(text, {f"{name}.0.slope.slope": "0.1"})


PIECE = st.one_of(
    *(
        st.fixed_dictionaries(
            {tag: st.fixed_dictionaries({}, optional={name: strategy for name, strategy in _numbers(kind)})}
        )
        for tag, kind in PIECES.items()
        if tag != "height_map"
    ),
    st.sampled_from([tag for tag in PIECES if tag != "height_map"]),
)


@settings(max_examples=30)
@given(st.lists(PIECE, max_size=5))
def test_course_survives_dump_and_parse(pieces: list[Any]) -> None:
    scenario = parse_scenario(yaml.safe_dump({"terrain": {"course": {"pieces": pieces}}}))
    assert parse_scenario(dump_scenario(scenario)) == scenario
    tags = [next(iter(piece)) if isinstance(piece, dict) else piece for piece in pieces]
    assert [type(piece) for piece in scenario.terrain.pieces] == [PIECES[tag] for tag in tags]  # type: ignore[attr-defined]


@given(st.dictionaries(st.text(st.characters(categories=["L", "N"]), min_size=1), st.floats(-math.pi, math.pi)))
def test_start_angles_survive_dump_and_parse(angles: dict[str, Any]) -> None:
    scenario = Scenario(start=StartParameters(joint_angles=angles))
    assert parse_scenario(dump_scenario(scenario)) == scenario


@pytest.mark.parametrize("key", sorted(NUMBERS))
def test_every_number_is_refused_just_outside_its_range(key: str) -> None:
    field = FIELDS[key]
    span = field.metadata["high"] - field.metadata["low"]
    whole = field.metadata["unit"] == "" and field.metadata["high"] >= 1000
    for value in (field.metadata["low"] - 0.01 * span, field.metadata["high"] + 0.01 * span):
        assert refusal("", {key: repr(math.floor(value) if whole else value)}).startswith(f"{key}:")


# A setting that a choice does not have.


@pytest.mark.parametrize(
    ("text", "field", "home"),
    [
        ("gait: {path: {step_height: 0.1}}", "gait", "controller.thesis"),
        ("controller: {balanced: {gait: {}}}", "controller.balanced.gait", "controller.thesis"),
        ("controller: {thesis: {command: {}}}", "controller.thesis.command", "controller.balanced"),
        ("contact: {point: {normal_stiffness: 1e7}}", "contact.point.normal_stiffness", "contact.asperity"),
        (
            "simulation: {effort_limits: none}",
            "simulation.effort_limits",
            "actuation.pd or actuation.pid or actuation.adaptive",
        ),
        ("controller: {balanced: {seed: 3}}", "controller.balanced.seed", "the top of the file"),
        ("subject: {shortening: 0.1}", "subject.shortening", "subject.impairments.0.short_leg"),
        (
            "terrain: {course: {pieces: [{slope: {tread: 0.3}}]}}",
            "terrain.course.pieces.0.slope.tread",
            "terrain.course.pieces.0.stairs",
        ),
    ],
)
def test_setting_of_another_choice_is_refused_with_the_place_where_it_belongs(text: str, field: str, home: Any) -> None:
    message = refusal(text)
    assert f"{field}: no such field" in message
    assert message.endswith(f"it belongs to {home}")


def test_field_of_an_entry_with_a_similar_name_in_its_place_is_refused_with_both() -> None:
    assert refusal("pushes: {impulse: 60}").endswith("it belongs to pushes.given.0; did you mean random_impulse?")


@pytest.mark.parametrize(
    ("scenario", "key"),
    [("walk", "controller.thesis.gait.path.step_height"), ("thesis", "controller.balanced.planner")],
)
def test_override_of_another_controllers_setting_is_refused(scenario: Any, key: str) -> None:
    with pytest.raises(ParameterError) as error:
        load_scenario(scenario, {key: "0.1"})
    assert "--set controller=" in str(error.value)


def test_two_choices_at_once_are_refused() -> None:
    assert "allowed: point, hydroelastic, asperity" in refusal("contact: {point: {}, asperity: {}}")


# A key that comes twice.


@pytest.mark.parametrize(
    ("text", "key", "lines"),
    [
        ("duration: 1\nseed: 2\nduration: 3\n", "duration", "1 and 3"),
        ("start:\n  joint_angles: {step_height: 0.1,\n    step_height: 0.2}\n", "step_height", "2 and 3"),
        ("gait: {ramp: {speed: 1}}\ngait: {}\n", "gait", "1 and 2"),
        ('"seed": 1\nseed: 1\n', "seed", "1 and 2"),
        ("_a: &a {speed: 1, speed: 2}\ngait: {ramp: *a}\n", "speed", "1 and 1"),
    ],
)
def test_key_that_comes_twice_is_refused_wherever_it_is(text: str, key: str, lines: str) -> None:
    with pytest.raises(ParameterError) as error:
        parse_scenario(text, name="mine.yaml")
    assert str(error.value).startswith(f"mine.yaml: '{key}' comes twice, at lines {lines}; allowed:")
    assert "\n" not in str(error.value)


def test_same_key_in_two_groups_is_no_doubling() -> None:
    points = "[{time: 0.5, forward: 1}, {time: 2, forward: 1}]"
    scenario = parse_scenario(
        f"_a: &a {{time: 1.0}}\n_b: *a\ncontroller: {{balanced: {{command: {{points: {points}}}}}}}\n"
    )
    assert len(scenario.controller.command.points) == 2


def test_the_text_of_an_override_holds_one_value_and_no_other_field() -> None:
    for text in ("0.02\nseed: 3", "0.02\n_seed: 3", "0.02\n...\nseed: 3"):
        with pytest.raises(ParameterError, match=r"^--set duration: not YAML at line"):
            load_scenario("thesis", {"duration": text})
    loaded = load_scenario("walk", {"pushes.given": "\n- time: 1.0\n- time: 2.0\n"})
    assert [push.time for push in loaded.pushes.given] == [1.0, 2.0]


@pytest.mark.parametrize("level", ["foot_force", "upper_body"])
def test_a_balance_level_is_no_faster_than_its_control_period(level: str) -> None:
    field, on = (f"controller.thesis.balance.{level}.{name}" for name in ("time_constant", "enabled"))
    with pytest.raises(ParameterError, match=rf"balance\.{level}\.time_constant: 0\.004 .*control_period, 0\.01 s, on"):
        load_scenario("thesis", {field: 0.004, on: True})
    load_scenario("thesis", {field: 0.004, on: True, "controller.thesis.control_period": 0.004})
    load_scenario("thesis", {field: 0.004})


def test_untested_speeds_and_pushes_after_the_end_are_warnings() -> None:
    scenario = load_scenario(
        "walk",
        {
            "duration": "5",
            "pushes.given": "[{time: 4.9}, {time: 5}, {time: 8}]",
            "controller.balanced.command.points": "[{time: 1.0, forward: 2.1}]",
        },
    )
    speed, *pushes = scenario.warnings
    assert "2.1 m/s" in speed
    assert pushes == [f"pushes.given: the push at {time} s comes after the end at 5 s" for time in (5, 8)]


@pytest.mark.parametrize(
    ("field", "value"),
    [("subject.mass", np.float32(60.0)), ("seed", np.int64(3)), ("duration", np.array(2.0))],
)
def test_numbers_of_numpy_are_numbers(field: str, value: Any) -> None:
    assert load_scenario("walk", {field: value}) == load_scenario("walk", {field: value.item()})


def test_arrays_of_numpy_are_lists() -> None:
    points = [{"time": np.float32(speed), "forward": speed} for speed in np.linspace(1.0, 1.25, 2)]
    walker = load_scenario("walk", {"controller.balanced.command.points": np.array(points)}).controller
    assert isinstance(walker, BalancedController)
    assert [point.forward for point in walker.command.points] == [1.0, 1.25]


def test_a_field_that_is_not_text_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"^3: not the name of a field; allowed: text"):
        load_scenario("walk", {3: 4})  # type: ignore[dict-item]
