import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.parameter_file import build
from humanwalk.study.objectives import FALLEN_COST, Bound, Measured, Objective, measured, score
from humanwalk.study.row import Row

POINTS = [{"push": "none"}, {"push": "left"}, {"push": "right"}]
values = st.floats(-1e3, 1e3)


def run(**measures: float | None) -> Row:
    return {"survived": True, "upright_share": 1.0} | measures


def fallen(upright: float) -> Row:
    return {"survived": False, "upright_share": upright, "cost_of_transport": None}


def test_a_measure_is_aggregated_over_the_runs_of_a_trial() -> None:
    rows = [run(cost_of_transport=0.5), run(cost_of_transport=0.6), run(cost_of_transport=0.7)]
    for over, value in (("mean", 0.6), ("max", 0.7), ("min", 0.5)):
        what = build(Measured, {"over": over})
        assert measured("cost_of_transport", what, POINTS, rows) == pytest.approx(value)


def test_only_the_named_runs_count() -> None:
    rows = [run(cost=1.0), run(cost=2.0), run(cost=3.0)]
    assert measured("x", Measured("cost", runs={"push": "left"}), POINTS, rows) == 2.0


def test_runs_that_were_not_simulated_count_as_fallen_at_once() -> None:
    rows = [run(), fallen(0.5), None]
    assert measured("survived", Measured(), POINTS, rows) == pytest.approx(1 / 3)
    assert measured("upright_share", Measured(), POINTS, rows) == pytest.approx(0.5)


def test_other_measures_count_over_the_runs_that_survived() -> None:
    rows = [run(cost_of_transport=0.5), fallen(0.5), None]
    assert measured("cost_of_transport", Measured(), POINTS, rows) == 0.5
    assert measured("cost_of_transport", Measured(), POINTS, [fallen(0.5), None, None]) is None


@given(values, values, st.floats(0.1, 10.0))
def test_the_cost_is_the_weighted_sum_of_what_is_minimized(a: float, b: float, weight: float) -> None:
    objectives = {"a": Objective(weight=weight), "b": Objective(goal="maximize")}
    result = score(objectives, {}, {"a": a, "b": b}, upright=1.0)
    assert result.losses == (a, -b)
    assert result.cost == pytest.approx(weight * a - b)
    assert result.feasible


@given(values, st.floats(-1e3, 0.0), st.floats(0.0, 1e3), st.floats(0.1, 100.0))
def test_a_bound_costs_its_penalty_per_distance_beyond_it(x: float, low: float, high: float, penalty: float) -> None:
    bounds = {"x": Bound(low=low, high=high, penalty=penalty)}
    result = score({"a": Objective()}, bounds, {"a": 1.0, "x": x}, upright=1.0)
    beyond = max(low - x, 0.0, x - high)
    assert result.violations["x"] == beyond
    assert result.cost == pytest.approx(1.0 + penalty * beyond)
    assert result.feasible == (low <= x <= high)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 10.0))
def test_a_trial_without_values_costs_more_the_earlier_it_fell_and_more_than_any_that_walks(
    early: float, late: float, cost: float
) -> None:
    early, late = sorted((early, late))
    earlier, later = (score({"a": Objective()}, {}, {"a": None}, upright) for upright in (early, late))
    assert earlier.cost >= later.cost >= FALLEN_COST > score({"a": Objective()}, {}, {"a": cost}, 1.0).cost
    assert earlier.violations["unfinished"] >= later.violations["unfinished"] >= 1.0
    assert not later.feasible
