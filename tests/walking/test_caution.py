"""Which steps are careful, and how high the foot is lifted in them."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.walking.caution import Caution

CAUTION = Caution()
shares = st.floats(0.0, 1.0)
errors = st.floats(0.0, 2.0)


@given(shares, errors)
def test_caution_is_a_share(previous: float, error: float) -> None:
    assert 0.0 <= CAUTION.after(previous, error) <= 1.0


@given(st.floats(0.0, CAUTION.free_error))
def test_small_errors_leave_a_step_ordinary(error: float) -> None:
    assert CAUTION.after(0.0, error) == 0.0


@given(shares, st.floats(CAUTION.full_error, 2.0))
def test_large_errors_make_a_step_careful(previous: float, error: float) -> None:
    assert CAUTION.after(previous, error) == pytest.approx(1.0)


@given(shares, errors, errors)
def test_caution_increases_with_the_error(previous: float, a: float, b: float) -> None:
    assert CAUTION.after(previous, min(a, b)) <= CAUTION.after(previous, max(a, b))


@given(shares)
def test_caution_fades_from_step_to_step(previous: float) -> None:
    assert CAUTION.after(previous, 0.0) == CAUTION.memory * previous


def test_equal_errors_switch_from_ordinary_to_careful_steps() -> None:
    switch = replace(CAUTION, free_error=0.2, full_error=0.2)
    assert switch.after(0.0, 0.199) == 0.0
    assert switch.after(0.0, 0.201) == 1.0


def test_errors_in_descending_order_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"full_error: 0\.1 is too small; allowed: free_error, 0\.2 m, or more"):
        Caution(full_error=0.1)


@given(st.lists(st.floats(-0.5, 0.5), max_size=5))
def test_the_greatest_height_of_the_ground_decides(heights: list[float]) -> None:
    caution = CAUTION.on_ground(heights)
    greatest = max(map(abs, heights), default=0.0)
    assert caution == pytest.approx(min(greatest / CAUTION.full_height, 1.0))


@given(st.floats(0.0, 0.1), shares)
def test_a_careful_foot_is_never_lower(ordinary: float, caution: float) -> None:
    lift = CAUTION.lift_above(ordinary, caution)
    assert ordinary <= lift <= max(ordinary, CAUTION.lift) + 1e-12
    assert CAUTION.lift_above(ordinary, 0.0) == ordinary
