"""Statistics of rows whose answer is known."""

import math
from dataclasses import astuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.numerics import Array
from humanwalk.study.statistics import (
    MAX_LEVELS,
    Level,
    Spread,
    Survival,
    factor_array,
    is_numeric,
    levels_of,
    ranked_effects,
)


def test_wilson_interval_is_that_of_the_textbook() -> None:
    # Newcombe (1998), Stat. Med. 17, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
    for count, runs, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ):
        survival = Survival.of(np.arange(runs) < count)
        assert (survival.low, survival.high) == pytest.approx((low, high), abs=5e-5)
        assert (survival.survived, survival.runs) == (count, runs)


@given(count=st.integers(0, 40), runs=st.integers(1, 40))
def test_the_interval_contains_the_share_and_mirrors_with_it(count: int, runs: int) -> None:
    survived = np.arange(runs) < min(count, runs)
    survival, fallen = Survival.of(survived), Survival.of(~survived)
    assert 0.0 <= survival.low <= survival.share <= survival.high <= 1.0
    assert (survival.low, survival.high) == pytest.approx((1.0 - fallen.high, 1.0 - fallen.low))


def test_spread_leaves_out_what_is_not_finite() -> None:
    spread = Spread.of(np.array([1.0, np.nan, 3.0, np.inf]))
    assert spread is not None
    assert astuple(spread) == pytest.approx((2, 2.0, np.sqrt(2.0), 1.1, 2.0, 2.9))
    one = Spread.of(np.array([4.0]))
    assert one is not None
    assert astuple(one) == pytest.approx((1, 4.0, np.nan, 4.0, 4.0, 4.0), nan_ok=True)
    assert Spread.of(np.array([np.nan])) is None


def test_numbers_are_levels_in_order_and_texts_by_first_row() -> None:
    assert [(level.label, level.rows.tolist()) for level in levels_of(factor_array([1.4, 0.7, 1.4]))] == [
        ("0.7", [1]),
        ("1.4", [0, 2]),
    ]
    texts = levels_of(factor_array(["turn", "corner", "turn"]))
    assert [(level.label, level.position, level.rows.tolist()) for level in texts] == [
        ("turn", 0.0, [0, 2]),
        ("corner", 1.0, [1]),
    ]
    assert not is_numeric(factor_array([True, False]))
    assert not is_numeric(factor_array([1.0, "thesis"]))


@given(
    values=st.lists(st.floats(-1e6, 1e6) | st.sampled_from([0.0, 1.0]), min_size=1, max_size=200),
    most=st.integers(1, 30),
)
def test_every_row_is_in_one_level(values: list[float], most: int) -> None:
    levels = levels_of(factor_array(values), most)
    assert len(levels) <= max(most, MAX_LEVELS)
    assert sorted(row for level in levels for row in level.rows) == list(range(len(values)))
    assert [level.position for level in levels] == sorted(level.position for level in levels)


def test_repeated_numbers_are_levels_and_samples_are_classes() -> None:
    grid = [0.1 * place for place in range(8)]
    assert [level.label for level in levels_of(factor_array(2 * grid))] == [
        "0",
        "0.1",
        "0.2",
        "0.3",
        "0.4",
        "0.5",
        "0.6",
        "0.7",
    ]
    assert [level.label for level in levels_of(factor_array(grid), 2)] == ["0 to 0.3", "0.4 to 0.7"]
    assert len(levels_of(factor_array(grid), MAX_LEVELS)) == 8
    assert len(levels_of(factor_array(4 * list(range(MAX_LEVELS + 1))), 5)) == 5


def test_classes_have_about_equal_size() -> None:
    levels = levels_of(np.random.default_rng(1).normal(size=1000), 8)
    assert [level.rows.size for level in levels] == [125] * 8
    assert isinstance(levels[0], Level)
    assert levels[0].label.count(" to ") == 1


def ishigami(x: Array) -> Array:
    """Ishigami and Homma (1990), a = 7, b = 0.1: neither straight nor monotonic."""
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_shares_of_the_ishigami_function_are_its_sobol_indices() -> None:
    x = np.random.default_rng(2).uniform(-np.pi, np.pi, (20_000, 3))
    effects = ranked_effects({f"x{i}": x[:, i] for i in range(3)}, ishigami(x))
    assert [effect.factor for effect in effects] == ["x1", "x0", "x2"]
    assert [effect.share for effect in effects] == pytest.approx([0.4424, 0.3139, 0.0], abs=0.02)
    assert effects[0].significant and effects[1].significant
    assert abs(effects[0].rank_correlation) < 0.02
    assert effects[1].rank_correlation > 0.4


def test_without_an_effect_one_factor_in_twenty_is_significant_and_the_mean_share_is_small() -> None:
    random = np.random.default_rng(3)
    factors = {str(i): random.uniform(size=60) for i in range(400)}
    effects = ranked_effects(factors, random.normal(size=60))
    assert np.mean([effect.significant for effect in effects]) == pytest.approx(0.05, abs=0.03)
    assert np.mean([effect.share for effect in effects]) < 0.06


def test_a_factorial_splits_the_variance_exactly() -> None:
    grid = [(a, b) for a in (0.0, 1.0, 2.0) for b in ("low", "high") for _ in range(2)]
    measure = np.array([3.0 * a + (b == "high") for a, b in grid])
    effects = ranked_effects(
        {"a": factor_array([a for a, _ in grid]), "b": factor_array([b for _, b in grid])}, measure
    )
    assert [effect.factor for effect in effects] == ["a", "b"]
    # Sums of squares: 72 between a, 3 between b, of 75; N = 12, M = 3 and 2.
    assert effects[0].share == pytest.approx(1.0 - 3.0 / 75.0 * 11 / 9)
    assert effects[1].share == 0.0
    assert effects[0].rank_correlation > 0.9
    assert math.isnan(effects[1].rank_correlation)


def test_there_is_no_effect_on_a_constant_of_a_constant_or_without_repeats() -> None:
    assert ranked_effects({"a": factor_array([1.0, 2.0, 3.0, 4.0])}, np.full(4, 0.1 + 0.2)) == []
    assert ranked_effects({"a": factor_array([1.0, 1.0, 1.0, 1.0])}, np.arange(4.0)) == []
    assert ranked_effects({"a": factor_array(["p", "q", "r", "s"])}, np.arange(4.0)) == []
    assert ranked_effects({"a": factor_array([1.0, 2.0])}, np.arange(2.0)) == []


def test_rows_without_the_measure_do_not_count() -> None:
    values, measure = factor_array([0.0, 0.0, 1.0, 1.0, 1.0]), np.array([1.0, 1.1, 2.0, 2.1, np.nan])
    assert ranked_effects({"a": values}, measure) == ranked_effects({"a": values[:4]}, measure[:4])
