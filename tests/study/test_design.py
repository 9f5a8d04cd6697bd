"""Designs of experiments."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.study.design import MAX_POINTS, FullFactorial, LatinHypercube, OneAtATime, Rows, Sobol
from humanwalk.study.factors import Factor, Range, Seeds, Uniform, Values, Variants
from humanwalk.yaml_text import MAX_DEPTH

levels = st.lists(st.integers(), min_size=1, max_size=4, unique=True).map(lambda values: Values(tuple(values)))
factors = st.dictionaries(st.text("abc", min_size=1), levels, max_size=4)
seeds = st.integers(0, 2**32 - 1)


class Unmade(Range):
    """A range whose levels are counted, never made."""

    def levels(self) -> Any:
        raise AssertionError


TWO: dict[str, Factor] = {"x": Uniform(0.0, 1.0), "y": Uniform(-1.0, 0.0)}


@given(factors)
def test_full_factorial_has_every_combination_once(chosen: Any) -> None:
    points = FullFactorial().points(chosen)
    assert len(points) == int(np.prod([len(factor.levels()) for factor in chosen.values()]))
    assert len({tuple(point.items()) for point in points}) == len(points)
    for point in points:
        assert list(point) == list(chosen)
        assert all(value in chosen[name].levels() for name, value in point.items())


def test_last_factor_of_a_full_factorial_changes_fastest() -> None:
    points = FullFactorial().points({"a": Values((1, 2)), "b": Values(("x", "y"))})
    assert [tuple(point.values()) for point in points] == [(1, "x"), (1, "y"), (2, "x"), (2, "y")]


@given(factors)
def test_one_at_a_time_changes_nothing_and_then_one_factor_in_each_point(chosen: Any) -> None:
    first, *others = OneAtATime().points(chosen)
    assert first == {}
    assert others == [{name: level} for name, factor in chosen.items() for level in factor.levels()]


@given(number=st.integers(1, 40), seed=seeds)
def test_latin_hypercube_has_one_sample_in_each_share(number: int, seed: int) -> None:
    points = LatinHypercube(number, seed).points(TWO)
    for name, low in (("x", 0.0), ("y", -1.0)):
        assert sorted(int((point[name] - low) * number) for point in points) == list(range(number))


@given(power=st.integers(1, 6), seed=seeds)
def test_sobol_sequence_is_balanced_in_each_factor(power: int, seed: int) -> None:
    points = Sobol(2**power, seed).points(TWO)
    for name, low in (("x", 0.0), ("y", -1.0)):
        assert sum(point[name] - low < 0.5 for point in points) == 2 ** (power - 1)


@pytest.mark.parametrize("kind", [LatinHypercube, Sobol])
def test_samples_depend_on_the_seed_alone(kind: Any) -> None:
    assert kind(8, 1).points(TWO) == kind(8, 1).points(TWO)
    assert kind(8, 1).points(TWO) != kind(8, 2).points(TWO)


def test_sobol_number_is_a_power_of_two() -> None:
    with pytest.raises(ParameterError, match="write 64 or 128"):
        Sobol(100)


@pytest.mark.parametrize(
    ("design", "chosen"),
    [
        (FullFactorial(), {"a": Unmade(0.0, 1.0, number=1000), "b": Unmade(0.0, 1.0, number=1000)}),
        (OneAtATime(), {str(i): Unmade(0.0, 1.0, number=100_000) for i in range(200)}),
        (FullFactorial(), {str(i): Seeds(0, 100_000) for i in range(1000)}),
        (FullFactorial(), {str(i): Seeds(0, 2) for i in range(1000)}),
        (OneAtATime(), {str(i): Seeds(0, MAX_POINTS // 2) for i in range(4)}),
        (LatinHypercube(MAX_POINTS), {str(i): Uniform(0.0, 1.0) for i in range(1000)}),
    ],
)
def test_too_many_points_are_refused_before_they_are_made(design: Any, chosen: Any) -> None:
    with pytest.raises(ParameterError, match=r"^design: .*allowed: "):
        design.points(chosen)


def test_distribution_has_no_place_in_a_full_factorial() -> None:
    with pytest.raises(ParameterError, match=r"^factors\.x: .*latin_hypercube"):
        FullFactorial().points(TWO)


@pytest.mark.parametrize("design", [LatinHypercube(4), Sobol(4)])
def test_a_sample_of_nothing_is_refused(design: Any) -> None:
    with pytest.raises(ParameterError, match=r"^factors: empty; allowed with a design that samples: one or more; "):
        design.points({})


def test_rows_are_those_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text('duration,contact,push\n3,point,none\n2.5,,hard\n1e1,"{""point"": {}}",\n')
    points = Rows(str(file)).points({"push": Variants({"none": {}, "hard": {}})})
    assert points == [
        {"duration": 3, "contact": "point", "push": "none"},
        {"duration": 2.5, "push": "hard"},
        {"duration": 10.0, "contact": {"point": {}}},
    ]


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", "not CSV with a header"),
        ("a,a\n1,2\n", "a name twice"),
        ("a,b\n1\n", "row 1 has 1 values"),
        ("a\n", "0 points"),
        ("a\n\n", "points.csv: 0 points below the header; allowed: one row or more; add rows"),
        (",b\n1,2\n", "the header is empty"),
        ('a\n"1', "not CSV"),
        ("a\n" + "1\n" * (MAX_POINTS + 1) + '"not read', f"more than {MAX_POINTS} rows"),
        ("a,b\n1,2\n1,\n,\n1.0,2\n", "row 4 is row 1 again; allowed: every row once; remove one"),
        ('a,b\n"[{""x"": 1}]",\n"[{""x"":1.0}]", \n', "row 2 is row 1 again"),
        ("a,b\n" + "1,2\n" * 10 + '3\n"not read', "row 11 has 1 values"),
    ],
)
def test_files_that_are_no_rows_are_refused(tmp_path: Path, text: str, match: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text)
    with pytest.raises(ParameterError, match=match):
        Rows(str(file)).points({})


@pytest.mark.parametrize(
    ("cell", "match"),
    [
        ('"slow walk,\nbare foot"', r"'slow walk,\\nbare foot' cannot be a value"),
        (r'"""\ud800"""', "cannot be a value"),
        ("NaN", "nan cannot be a value"),
        ("[" * 900 + "]" * 900, f"at most {MAX_DEPTH} inside each other"),
        ('"{""mass"": 80, ""mass"": 60}"', "'mass' comes twice"),
    ],
)
def test_a_cell_that_cannot_be_a_value_is_refused_with_its_place(tmp_path: Path, cell: str, match: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(f"duration,subject\n3,\n2,{cell}\n")
    with pytest.raises(ParameterError, match=f"points.csv: row 2, column subject.*{match}") as raised:
        Rows(str(file)).points({})
    assert str(raised.value).isprintable()


def test_rows_have_no_other_factors(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="values of its own"):
        Rows(str(tmp_path / "points.csv")).points({"duration": Values((1,))})
