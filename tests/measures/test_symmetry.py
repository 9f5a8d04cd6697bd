"""Symmetry of a walk: the index, and the measures of both legs."""

from collections.abc import Callable

import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.limbs import LEGS
from humanwalk.measures.symmetry import asymmetries, symmetry_index
from humanwalk.measures.walk_measures import Walk
from humanwalk.scenario import load_scenario

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


def test_a_measure_that_changes_on_the_right_changes_there_only(walk: Callable[..., pa.Table]) -> None:
    leg, change, signals = LEGS["Right"], 1.2, walk()
    made = {name: signals[name].to_numpy() for name in signals.column_names}
    made["right_foot.force_z_N"] = change * made["right_foot.force_z_N"]
    for joint in leg.sagittal:
        made[f"{joint}.torque_N_m"] = change * made[f"{joint}.torque_N_m"]
        # An offset is no range.
        made[f"{joint}.angle_rad"] = 0.3 + change * made[f"{joint}.angle_rad"]
    found, before = (asymmetries(Walk.of(table, load_scenario("thesis"))) for table in (pa.table(made), signals))
    for name, both in found.items():
        factor = change if "peak" in name or "range" in name else 1.0
        assert both.right == pytest.approx(factor * before[name].right, rel=1e-6), name
        assert both.left == pytest.approx(before[name].left, rel=1e-6), name
    assert before["peak vertical force"].right == pytest.approx(1.1, abs=0.01)


def test_peaks_compare_the_same_phenomenon_of_both_legs(walk: Callable[..., pa.Table]) -> None:
    """Of opposite powers, one leg delivers the peak that the other one absorbs."""
    signals, legs = walk(), [LEGS[side].ankle for side in ("Right", "Left")]
    made = {name: signals[name].to_numpy() for name in signals.column_names}
    for ankle, rate in zip(legs, (1.0, -1.0), strict=True):
        torque = made[f"{ankle}.torque_N_m"]
        made[f"{ankle}.velocity_rad_s"] = rate * (torque < torque.mean()) + 0.1 * rate * (torque > torque.mean())
    found = asymmetries(Walk.of(pa.table(made), load_scenario("thesis")))
    delivered, absorbed = found["ankle peak power"], found["ankle peak absorbed power"]
    assert delivered.right == pytest.approx(absorbed.left, rel=0.05)
    assert delivered.left == pytest.approx(absorbed.right, rel=0.05)
