"""Factors of a study."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.study.factors import FACTORS, LogRange, Normal, Range, Seeds, Uniform, Values, Variants

shares = st.floats(0.0, 1.0, exclude_max=True)
numbers = st.floats(-1e6, 1e6)

EACH: dict[str, Any] = {
    "values": Values((3, 1, 2)),
    "range": Range(-1.0, 2.0, 4),
    "log_range": LogRange(0.1, 100.0, 4),
    "uniform": Uniform(-1.0, 2.0),
    "normal": Normal(1.0, 0.5, 0.0, 3.0),
    "seeds": Seeds(5, 3),
    "variants": Variants({"none": {}, "front": {"pushes.given.0.impulse": 30}}),
}


def quantile(name: str, share: float) -> Any:
    (value,) = EACH[name].quantiles(np.array([share]))
    return value


def test_every_kind_is_tested() -> None:
    assert {name: type(factor) for name, factor in EACH.items()} == FACTORS


@pytest.mark.parametrize("name", ["values", "seeds", "variants"])
@given(u=shares)
def test_quantile_of_a_list_is_one_of_its_levels(name: str, u: float) -> None:
    assert quantile(name, u) in EACH[name].levels()


@pytest.mark.parametrize("name", ["values", "seeds", "variants"])
def test_levels_have_equal_shares(name: str) -> None:
    factor = EACH[name]
    drawn = factor.quantiles((np.arange(300) + 0.5) / 300)
    number = len(factor.levels())
    assert [drawn.count(level) for level in factor.levels()] == [300 // number] * number


@pytest.mark.parametrize("name", ["range", "log_range", "uniform", "normal"])
@given(u=shares, v=shares)
def test_quantiles_of_numbers_are_within_the_bounds_and_in_order(name: str, u: float, v: float) -> None:
    factor = EACH[name]
    of_u, of_v = factor.quantiles(np.array([u, v]))
    low, high = sorted((of_u, of_v))
    assert (u <= v) <= (of_u <= of_v)
    assert factor.low - 1e-9 <= low <= high <= factor.high + 1e-9


@given(low=numbers, width=st.floats(1e-3, 1e6), number=st.integers(2, 50))
def test_range_is_equally_spaced_from_low_to_high(low: float, width: float, number: int) -> None:
    levels = Range(low, low + width, number).levels()
    np.testing.assert_allclose(levels, np.linspace(low, low + width, number), rtol=1e-11, atol=1e-11)
    assert len(levels) == number


@pytest.mark.parametrize("name", list(EACH))
@given(some=st.lists(shares, max_size=20))
def test_a_quantile_has_the_same_bits_whatever_is_sampled_with_it(name: str, some: list[float]) -> None:
    assert EACH[name].quantiles(np.array(some)) == [quantile(name, u) for u in some]


def test_range_has_the_numbers_that_one_would_write() -> None:
    assert Range(0.05, 0.25, 5).levels() == (0.05, 0.1, 0.15, 0.2, 0.25)
    assert LogRange(0.01, 100.0, 5).levels() == (0.01, 0.1, 1.0, 10.0, 100.0)


def test_median_of_a_log_range_is_the_geometric_mean() -> None:
    assert LogRange(1.0, 100.0).quantiles(np.array([0.5])) == pytest.approx([10.0])


def test_normal_distribution_without_bounds_has_its_mean_and_deviation() -> None:
    factor = Normal(2.0, 3.0)
    drawn = np.array(factor.quantiles((np.arange(2000) + 0.5) / 2000))
    assert drawn.mean() == pytest.approx(2.0, abs=1e-6)
    assert drawn.std() == pytest.approx(3.0, rel=0.01)
    assert math.isfinite(*factor.quantiles(np.zeros(1)))


@pytest.mark.parametrize("name", ["uniform", "normal"])
def test_distributions_have_no_levels(name: str) -> None:
    with pytest.raises(ParameterError, match="latin_hypercube or sobol"):
        EACH[name].levels()


@pytest.mark.parametrize(
    "make",
    [
        lambda: Values(()),
        lambda: Values((1.0, 2.0, 1)),
        lambda: Values(({"time": 1.0}, [], [], 3)),
        lambda: Range(1.0, 1.0),
        lambda: Range(math.nan, 1.0),
        lambda: Range(-1e308, 1e308),
        lambda: LogRange(0.0, 1.0),
        lambda: Uniform(2.0, 1.0),
        lambda: Normal(0.0, 1.0, low=1.0, high=1.0),
        lambda: Normal(math.inf, 1.0),
        lambda: Normal(0.0, 1.0, low=1e200, high=2e200),
        lambda: Variants({}),
    ],
)
def test_values_that_make_no_factor_are_refused(make: Any) -> None:
    with pytest.raises(ParameterError, match=r"allowed|write"):
        make()


def test_variant_replaces_several_fields_and_an_unknown_one_is_refused() -> None:
    push = Variants({"none": {"pushes.given": []}, "hard": {"pushes.given.0.impulse": 60, "seed": 3}})
    assert push.overrides("push", "hard") == {"pushes.given.0.impulse": 60, "seed": 3}
    with pytest.raises(ParameterError, match="did you mean hard"):
        push.overrides("push", "hart")
