"""Lines of fields in YAML text, and the errors that name them."""

from pathlib import Path

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.study.study import Study, load_study
from humanwalk.study.tuning import load_tuning
from humanwalk.yaml_text import MAX_DEPTH, line_of, read_yaml

TEXT = """\
duration: 5
controller:
  balanced:
    command:
      points:
        - {time: 1.0, forward: 1.0}
        - time: 2.0
          forward: 9.0
terrain: plane
"""


@pytest.mark.parametrize(
    ("field", "line"),
    [
        ("duration", 1),
        ("controller.balanced.command.points", 5),
        ("controller.balanced.command.points.0.forward", 6),
        ("controller.balanced.command.points.1", 7),
        ("controller.balanced.command.points.1.forward", 8),
        # What a file does not write out is where its group is.
        ("controller.balanced.command.points.1.turn", 7),
        ("controller.balanced.command.points.2.turn", 5),
        (f"controller.balanced.command.points.{'1' * 5000}.turn", 5),
        ("terrain.plane.slope", 9),
        ("subject.mass", None),
        ("", None),
    ],
)
def test_a_field_is_found_at_its_line_or_that_of_its_group(field: str, line: int | None) -> None:
    assert line_of(TEXT, field) == line


def test_an_error_names_file_and_line(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(TEXT)
    with pytest.raises(
        ParameterError, match=r"^mine.yaml, line 8: controller.balanced.command.points.1.forward: 9 is out"
    ):
        load_scenario(tmp_path / "mine.yaml")
    (tmp_path / "typo.yaml").write_text("duration: 5\nspeed: 1.2\n")
    with pytest.raises(ParameterError, match=r"^typo.yaml, line 2: speed: no such field"):
        load_scenario(tmp_path / "typo.yaml")


def test_an_error_of_an_override_has_no_line_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("duration: 5\nsubject: {mass: 60}\n")
    with pytest.raises(ParameterError, match=r"^subject.mass: 500 is out of range"):
        load_scenario(tmp_path / "mine.yaml", {"subject.mass": "500"})
    with pytest.raises(ParameterError, match=r"^subject.mass: 5 is out of range"):
        load_scenario(tmp_path / "mine.yaml", {"subject": "{mass: 5}"})


NESTED = "{}[" + "[" * (MAX_DEPTH // 2) + "{}" + "]" * (MAX_DEPTH // 2) + "]"


@pytest.mark.parametrize(
    "text",
    [
        "a: " + "[" * MAX_DEPTH + "]" * MAX_DEPTH,
        "a: " + "{b: " * 400 + "}" * 400,
        f"a: {NESTED.format('&inner ', '')}\nb: {NESTED.format('', '*inner')}",
    ],
)
def test_values_too_deep_for_what_visits_them_are_refused_in_one_line(text: str) -> None:
    with pytest.raises(ParameterError, match=rf"^mine: \d+ lists and groups inside each other; .*up to {MAX_DEPTH}"):
        read_yaml(text, "mine")


def test_values_may_be_as_deep_as_is_allowed() -> None:
    assert read_yaml("a: " + "[" * (MAX_DEPTH - 1) + "1" + "]" * (MAX_DEPTH - 1), "mine")


@pytest.mark.parametrize("text", ["", " \n", "# duration: 5\n\n  # terrain: plane", "---\n", "\ufeff"])
def test_a_file_without_fields_is_refused_with_what_to_write(text: str, tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    for load in (load_scenario, load_study, load_tuning):
        with pytest.raises(ParameterError, match=r"mine.yaml: empty; allowed: .*; write `field: value`$"):
            load(tmp_path / "mine.yaml")


def test_an_empty_group_asks_for_the_defaults(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("{}  # the thesis' walk\n")
    assert load_scenario(tmp_path / "mine.yaml") == Scenario()
    assert load_study(tmp_path / "mine.yaml") == Study()


@pytest.mark.parametrize(
    ("text", "line", "character"),
    [(3 * "\0", 1, r"'\x00'"), ("a: 1\nb: \0", 2, r"'\x00'"), ("\n\na: \x07", 3, r"'\x07'")],
)
def test_a_character_that_is_no_text_is_named_with_its_line(text: str, line: int, character: str) -> None:
    with pytest.raises(ParameterError) as raised:
        read_yaml(text, "mine")
    problem = f"mine: not YAML at line {line}: the character {character}; allowed: printable text; "
    assert str(raised.value).startswith(problem)
