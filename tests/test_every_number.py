"""Every number of a scenario, alone, at both ends of its range: it walks, or is refused in one line."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body.devices import DEVICES
from humanwalk.body.impairments import IMPAIRMENTS
from humanwalk.body.loads import LOADS
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.contact.asperity import Knot
from humanwalk.motion.followed import REQUIRED_JOINTS
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.motion.recorded_motion import MotionColumn
from humanwalk.parameter_file import fields_of
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, parse_scenario
from humanwalk.terrain import PIECES
from humanwalk.walking.command import CommandPoint
from humanwalk.walking.push import Push

pytestmark = pytest.mark.slow

STEPS = 2
"""Simulated, of the default time step; what a walk needs is built before."""


def ends(kind: type[Any], path: str = "") -> list[tuple[str, str]]:
    """Dotted names of all numbers of a dataclass, each with both ends of its range as YAML."""
    numbers = [(name, field) for name, field in fields_of(kind, path) if "low" in field.metadata]
    return [
        (name, repr(int(field.metadata[end]) if isinstance(field.default, int) else float(field.metadata[end])))
        for name, field in numbers
        for end in ("low", "high")
    ]


NEEDED = {
    "controller.thesis.balance.foot_force.": {"controller.thesis.balance.foot_force.enabled": "true"},
    "controller.thesis.balance.upper_body.": {"controller.thesis.balance.upper_body.enabled": "true"},
    "controller.recorded.": {"controller.recorded.angles": "still.mot"},
    "contact.asperity.": {"simulation.time_step": "0.001"},
    "subject.age": {"subject.sex": "female"},
    "simulation.accuracy": {"simulation.integrator": "cenic", "simulation.time_step": "0"},
}
"""What is set with a number whose name begins so, for it to have an effect."""


def ends_of_choices(kinds: Mapping[str, type[Any]]) -> list[tuple[str, str]]:
    """As `ends`, of several kinds by tag; the names begin with the tag."""
    return [(f"{tag}.{name}", value) for tag, kind in kinds.items() for name, value in ends(kind)]


ENTRIES = {
    "subject.loads": ends_of_choices(LOADS),
    "subject.impairments": ends_of_choices(IMPAIRMENTS),
    "subject.devices": ends_of_choices(DEVICES),
    "pushes.given": ends(Push),
    "controller.balanced.command.points": ends(CommandPoint),
    "contact.asperity.pressure_multiplier": ends(Knot),
    "contact.asperity.time_multiplier": ends(Knot),
    "terrain.course.pieces": ends_of_choices(PIECES),
}
"""Numbers of the entries of lists; those of one out of several kinds follow its tag."""


def entry_text(name: str, value: str) -> str:
    """A list of one entry as YAML, with one number."""
    *tags, leaf = name.split(".")
    fields = f"{leaf}: {value}" + (", file: map.csv" if tags == ["height_map"] else "")
    return f"[{{{tags[0]}: {{{fields}}}}}]" if tags else f"[{{{fields}}}]"


LONGEST = ("duration", "3600.0")
"""The one number that is read but not simulated."""

CASES = [(name, name, value) for name, value in ends(Scenario) if (name, value) != LONGEST]
CASES += [
    (f"{name}.0.{entry}", name, entry_text(entry, value)) for name, found in ENTRIES.items() for entry, value in found
]


@pytest.fixture(autouse=True)
def working_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with a recording of standing still and a map of heights."""
    columns = [COORDINATES[name][0] for name in REQUIRED_JOINTS]
    still = MotionTable(tuple(columns), np.array([0.0, 1.0]), np.zeros((2, len(columns))), in_degrees=True)
    (tmp_path / "still.mot").write_text(storage_text("still", still))
    (tmp_path / "map.csv").write_text("0,0.02\n0.01,0\n")
    monkeypatch.chdir(tmp_path)


def test_longest_duration_is_read() -> None:
    name, value = LONGEST
    assert parse_scenario("", {name: value}).duration == float(value)


def test_all_lists_are_covered() -> None:
    lists = {name for name, field in fields_of(Scenario) if str(field.type).startswith("tuple[")}
    assert lists == ENTRIES.keys()


@pytest.mark.parametrize(("name", "field", "value"), CASES, ids=[f"{name}={value}" for name, _, value in CASES])
def test_number_at_an_end_of_its_range_walks_or_is_refused(name: str, field: str, value: str) -> None:
    overrides = {"duration": repr(STEPS * Scenario().simulation.time_step)}
    for prefix, needed in NEEDED.items():
        overrides |= needed if name.startswith(prefix) else {}
    overrides[field] = value
    try:
        outcome = simulate(parse_scenario("", overrides))
    except ParameterError as error:
        assert str(error).isprintable()
        assert len(str(error)) < 1000
        # It names the number, or another with which it does not go.
        assert "allowed" in str(error)
    else:
        assert outcome.signals.num_rows > 0


@pytest.mark.parametrize(("name", "value"), ends(MotionColumn))
def test_number_of_a_mapping_at_an_end_of_its_range_is_followed_or_refused(
    tmp_path: Path, name: str, value: str
) -> None:
    joint = REQUIRED_JOINTS[0]
    entry = f"{{column: {COORDINATES[joint][0]}, {name}: {value}}}"
    (tmp_path / "mapping.yaml").write_text(f"columns: {{{joint}: {entry}}}\n")
    recorded = {"duration": "0.004", "controller.recorded.angles": "still.mot"}
    try:
        simulate(parse_scenario("", recorded | {"controller.recorded.mapping": "mapping.yaml"}))
    except ParameterError as error:
        assert str(error).isprintable()
