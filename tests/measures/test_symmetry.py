"""Symmetry of a walk: the index, and the measures of both legs."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.measures.symmetry import symmetry_index

POSITIVE = st.floats(1e-3, 1e3)


@given(POSITIVE, POSITIVE)
def test_exchanging_the_legs_reverses_the_index(right: float, left: float) -> None:
    index = symmetry_index(right, left)
    assert index is not None
    assert symmetry_index(left, right) == pytest.approx(-index, abs=1e-9)
    assert -200.0 <= index <= 200.0


@given(POSITIVE, POSITIVE)
def test_the_index_depends_on_the_ratio_alone(value: float, factor: float) -> None:
    assert symmetry_index(value, value) == 0.0
    assert symmetry_index(factor * value, value) == pytest.approx(symmetry_index(factor, 1.0), rel=1e-6, abs=1e-6)
    assert symmetry_index(-value * factor, -value) == pytest.approx(symmetry_index(factor, 1.0), rel=1e-6, abs=1e-6)


def test_ten_percent_more_than_the_mean_on_each_side() -> None:
    assert symmetry_index(1.1, 0.9) == pytest.approx(20.0)


@pytest.mark.parametrize(("right", "left"), [(None, 1.0), (1.0, None), (1.0, -1.0), (0.0, 0.0)])
def test_there_is_no_index_without_two_values_of_one_sign(right: float | None, left: float | None) -> None:
    assert symmetry_index(right, left) is None
