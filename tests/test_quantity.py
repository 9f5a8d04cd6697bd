"""Errors of one line: field, value, allowed range, fix."""

import math
import re
from dataclasses import dataclass, field

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pydrake.multibody.tree import UniformGravityFieldElement

from humanwalk.quantity import GRAVITY, UNIT_MISTAKES, ParameterError, check, printable, quantity, require_in_range


def test_gravity_is_that_of_drake() -> None:
    assert UniformGravityFieldElement.kDefaultStrength == GRAVITY


@dataclass(frozen=True)
class Leaf:
    length: float = quantity(0.5, "m", 0.1, 1.0)
    share: float = quantity(0.5, "", 0.0, 1.0)
    label: str = "no quantity"


@dataclass(frozen=True)
class Tree:
    leaf: Leaf = Leaf()
    by_name: dict[str, Leaf] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    angle: float = quantity(0.0, "rad", -1.0, 1.0)


def message_of(parameters: Leaf | Tree, path: str = "") -> str:
    with pytest.raises(ParameterError) as caught:
        check(parameters, path)
    return str(caught.value)


def test_defaults_pass() -> None:
    check(Tree())


@given(st.floats(0.1, 1.0))
def test_every_value_within_the_range_passes_both_ends_included(value: float) -> None:
    check(Leaf(length=value))


@given(st.floats(0.0, 0.1, exclude_max=True) | st.floats(1.0, exclude_min=True))
def test_every_value_beyond_the_range_is_refused(value: float) -> None:
    assert "length" in message_of(Leaf(length=value))


def test_the_message_has_field_value_range_and_fix_on_one_line() -> None:
    message = message_of(Leaf(length=2.0))
    assert message == "length: 2 is out of range; allowed: 0.1 to 1 m; the nearest allowed value is 1"


def test_an_error_does_not_contradict_itself_where_a_value_is_close_to_the_limit() -> None:
    with pytest.raises(ParameterError) as caught:
        require_in_range("duration", 3600.001, "s", 0.001, 3600.0)
    assert str(caught.value) == (
        "duration: 3600.001 is out of range; allowed: 0.001 to 3600 s; the nearest allowed value is 3600"
    )


def test_whole_numbers_are_written_whole() -> None:
    with pytest.raises(ParameterError) as caught:
        require_in_range("seed", 4294970000, "", 0, 2**32 - 1)
    assert str(caught.value) == (
        "seed: 4294970000 is out of range; allowed: 0 to 4294967295; the nearest allowed value is 4294967295"
    )


@given(st.floats(-1e9, 1e9), st.floats(0.0, 1e9), st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_in_an_error_are_on_the_side_of_the_limit_that_it_says(low: float, size: float, value: float) -> None:
    assume(low + size > low and not low <= value <= low + size)
    with pytest.raises(ParameterError) as caught:
        require_in_range("x", value, "", low, low + size)
    numbers = re.fullmatch(r"x: (\S+) is .*; allowed: (\S+) to (\S+); the nearest .* is (\S+)", str(caught.value))
    assert numbers is not None
    shown, *allowed = map(float, numbers.groups())
    assert not low <= shown <= low + size
    assert all(low <= number <= low + size for number in allowed)


def test_the_fix_for_a_value_below_the_range_is_its_lower_end() -> None:
    assert message_of(Leaf(length=0.01)).endswith("the nearest allowed value is 0.1")


def test_a_pure_number_has_no_unit_in_its_message() -> None:
    assert "allowed: 0 to 1;" in message_of(Leaf(share=3.0))


@pytest.mark.parametrize(
    ("value", "unit", "high", "other_unit", "fixed"),
    [
        (50.0, "m", 1.0, "centimeters", "0.5 (m)"),
        (500.0, "m", 1.0, "millimeters", "0.5 (m)"),
        (45.0, "rad", 1.0, "degrees", "0.7854 (rad)"),
        (250.0, "s", 1.0, "milliseconds", "0.25 (s)"),
        (5.04, "m/s", 3.0, "km/h", "1.4 (m/s)"),
        (70000.0, "kg", 200.0, "grams", "70 (kg)"),
    ],
)
def test_a_wrong_unit_is_recognized(value: float, unit: str, high: float, other_unit: str, fixed: str) -> None:
    with pytest.raises(ParameterError, match="out of range") as caught:
        require_in_range("x", value, unit, 0.0, high)
    assert str(caught.value).endswith(f"if it is in {other_unit}, write {fixed}")


@pytest.mark.parametrize("unit", UNIT_MISTAKES)
def test_no_unit_is_guessed_for_a_fraction(unit: str) -> None:
    with pytest.raises(ParameterError, match=r"nearest allowed value is 0.5$"):
        require_in_range("x", 0.8, unit, 0.0, 0.5)


@pytest.mark.parametrize("unit", UNIT_MISTAKES)
def test_no_unit_is_guessed_for_a_value_that_is_too_small(unit: str) -> None:
    with pytest.raises(ParameterError, match=r"nearest allowed value is 10$"):
        require_in_range("x", -1.0, unit, 10.0, 1e9)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_not_finite_is_refused_even_without_bounds(value: float) -> None:
    with pytest.raises(ParameterError, match=r"^x: .*; give a finite number$"):
        require_in_range("x", value, "m", -math.inf, math.inf)


def test_nested_dataclasses_and_mappings_have_dotted_names() -> None:
    assert message_of(Tree(leaf=Leaf(length=2.0))).startswith("leaf.length: 2 ")
    assert message_of(Tree(by_name={"Knee": Leaf(length=2.0)})).startswith("by_name.Knee.length: 2 ")
    assert message_of(Tree(angle=2.0), "controller.thesis.gait.path").startswith(
        "controller.thesis.gait.path.angle: 2 "
    )


def test_plain_mappings_and_texts_are_not_checked() -> None:
    check(Tree(numbers={"anything": math.nan}))


def test_a_parameter_error_is_a_value_error() -> None:
    assert issubclass(ParameterError, ValueError)


@given(st.text(alphabet=st.characters(codec=None), max_size=300), st.integers(20, 150))
def test_any_text_is_printed_on_one_line_of_limited_length_without_control_characters(text: str, limit: int) -> None:
    shown = printable(text, limit)
    assert shown.isprintable()
    assert len(shown) <= limit


@given(st.text(alphabet=st.characters(categories=["L", "N", "P", "S"]), max_size=50))
def test_text_that_fits_is_shown_unchanged(text: str) -> None:
    assert printable(text, 50) == text


@pytest.mark.parametrize(
    ("text", "shown"), [("a\x1b[2Jb", r"a\x1b[2Jb"), ("a\nb", r"a\nb"), ("\u202eb", r"\u202eb"), ("\udcff", r"\udcff")]
)
def test_what_a_terminal_would_act_on_is_escaped(text: str, shown: str) -> None:
    assert printable(text) == shown
    assert str(ParameterError(text)) == shown


def test_long_text_keeps_its_ends() -> None:
    assert printable("begin" + "x" * 10**6 + "end", 20) == "beginxxxx...xxxxxend"
