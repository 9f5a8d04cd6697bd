"""The schemas of parameter files describe what humanwalk reads, and the shipped ones are up to date."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from humanwalk.cli.schema_commands import FileKind
from humanwalk.parameter_file import build, plain
from humanwalk.parameter_schema import field_documents
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios
from humanwalk.study.schemas import FORMATS, schema_of
from humanwalk.study.study import shipped_studies
from humanwalk.study.tuning import shipped_tunings
from humanwalk.walking.push import Push
from humanwalk.yaml_text import read_yaml

SHIPPED: dict[str, dict[str, Path]] = {
    "scenario": shipped_scenarios(),
    "study": shipped_studies(),
    "tuning": shipped_tunings(),
}
FILES = [(kind, path) for kind, paths in SHIPPED.items() for path in paths.values()]


def errors(kind: str, data: Any) -> list[str]:
    validator = jsonschema.Draft202012Validator(schema_of(kind))
    return [error.message for error in validator.iter_errors(data)]


@pytest.mark.parametrize("kind", FORMATS)
def test_a_schema_is_valid_and_the_shipped_one_is_up_to_date(kind: str) -> None:
    schema = schema_of(kind)
    jsonschema.Draft202012Validator.check_schema(schema)
    folder = next(iter(SHIPPED[kind].values())).parent.parent / "schemas"
    shipped = json.loads((folder / f"{kind}.json").read_text())
    json.dumps(schema, allow_nan=False)
    assert shipped == schema, f"run: humanwalk schema {kind} -o humanwalk/models/schemas/{kind}.json"


def test_every_kind_of_file_has_a_schema_and_a_name_on_the_command_line() -> None:
    assert set(FORMATS) == {kind.value for kind in FileKind} == set(SHIPPED)


@pytest.mark.parametrize(("kind", "path"), FILES, ids=lambda value: getattr(value, "stem", value))
def test_every_shipped_file_names_its_schema_and_is_valid(kind: str, path: Path) -> None:
    text = path.read_text()
    marker = "# yaml-language-server: $schema="
    (named,) = [line.removeprefix(marker) for line in text.splitlines() if line.startswith(marker)]
    assert (path.parent / named).resolve() == (path.parent.parent / "schemas" / f"{kind}.json").resolve()
    assert errors(kind, read_yaml(text, path.name)) == []


def test_a_field_without_default_is_required() -> None:
    tuning = {"parameters": {"seed": {"low": 0.0}}}
    assert errors("tuning", tuning) == ["'high' is a required property"]
    with pytest.raises(ParameterError, match=r"^parameters\.seed: high missing; allowed: a group with low and high"):
        build(FORMATS["tuning"], tuning)


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_complete_scenario_is_valid(name: str) -> None:
    assert errors("scenario", plain(load_scenario(name))) == []


@pytest.mark.parametrize(
    "data",
    [
        {"speed": 1.2},
        {"duration": "long"},
        {"duration": -1.0},
        {"subject": {"mass": 500.0}},
        {"subject": {"look": "ghost"}},
        {"terrain": "plain"},
        {"terrain": {"plane": {"slope": 3.0}}},
        {"controller": {"balanced": {"command": {"points": [{"time": 0.0, "forward": 9.0}]}}}},
        {"pushes": {"given": {"time": 1.0}}},
        {"seed": 1.5},
        {"start": {"joint_angles": {"RightLegTibiaMotion": "bent"}}},
    ],
    ids=str,
)
def test_what_humanwalk_refuses_the_schema_refuses_too(data: Any) -> None:
    with pytest.raises(ParameterError):
        build(Scenario, data)
    assert errors("scenario", data)


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"terrain": "plane", "contact": {"point": None}, "controller": "balanced"},
        {"_anchor": {"x": 1}, "duration": 5},
        {"start": {"joint_angles": {"RightLegTibiaMotion": 0.3}}},
    ],
    ids=str,
)
def test_what_humanwalk_reads_the_schema_allows(data: Any) -> None:
    build(Scenario, {key: value for key, value in data.items() if not key.startswith("_")})
    assert errors("scenario", data) == []


def test_fields_have_their_documents_units_and_ranges() -> None:
    impulse = schema_of("scenario")["$defs"]["walking.push.Push"]["properties"]["impulse"]
    assert impulse == {
        "type": "number",
        "minimum": 0.0,
        "maximum": 1000.0,
        "description": "Force times duration. [N s]",
        "default": 30.0,
    }
    assert field_documents(Push)["body"] == "Name of the body."
