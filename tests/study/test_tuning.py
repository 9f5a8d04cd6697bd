from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.choices import BalancedController
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.study.tuning import Range, dump_tuning, load_tuning, parse_tuning, shipped_tunings, start_values

GAIN = "controller.balanced.planner.dcm_gain"
VALID = {
    "runs": "{scenario: walk, factors: {case: {variants: {walk: {}, push: {pushes.given: [{impulse: 30.0}]}}}}}",
    "parameters": f"{{{GAIN}: {{low: 0.5, high: 2.0}}}}",
    "objectives": "{cost_of_transport: {runs: {case: walk}}}",
}


def gain_of(scenario: Scenario) -> float:
    assert isinstance(scenario.controller, BalancedController)
    return scenario.controller.planner.dcm_gain


def text(**replaced: str) -> str:
    return "\n".join(f"{name}: {value}" for name, value in (VALID | replaced).items())


@given(st.floats(-1.0, 1.0), st.floats(0.01, 0.99), st.booleans())
def test_coordinates_lead_from_low_over_the_start_to_high(at: float, share: float, log: bool) -> None:
    limits = Range(0.1, 10.0, log)
    start = limits.low + share * (limits.high - limits.low)
    assert limits.value(-1.0, start) == limits.low
    assert limits.value(0.0, start) == pytest.approx(start, rel=1e-5)
    assert limits.value(1.0, start) == limits.high
    assert limits.low <= limits.value(at, start) <= limits.high
    assert (limits.value(at, start) - start) * at >= -1e-5


def test_the_logarithm_is_searched_on_request() -> None:
    assert Range(1.0, 100.0, log=True).value(0.5, start=1.0001) == pytest.approx(10.0, rel=1e-3)
    assert Range(1.0, 100.0).value(0.5, start=1.0001) == pytest.approx(50.5, rel=1e-3)


def test_the_start_is_the_scenario_with_what_is_set() -> None:
    assert start_values(parse_tuning(text())) == {GAIN: gain_of(load_scenario("walk"))}
    runs = f"{{scenario: walk, set: {{{GAIN}: 1.7}}}}"
    assert start_values(parse_tuning(text(runs=runs, objectives="{survived: {}}"))) == {GAIN: 1.7}


def test_a_trial_differs_from_the_scenario_in_its_parameters_only() -> None:
    tuning = parse_tuning(text())
    trial = tuning.with_values({GAIN: 1.3})
    for point in tuning.runs.points:
        before, after = tuning.runs.scenario_at(point), trial.scenario_at(point)
        assert before != after
        assert gain_of(after) == 1.3
        assert after.pushes == before.pushes


@pytest.mark.parametrize("name", shipped_tunings())
def test_shipped_tunings_are_valid_and_survive_writing(name: str, tmp_path: Path) -> None:
    tuning = load_tuning(name)
    path = tmp_path / "tuning.yaml"
    path.write_text(dump_tuning(tuning), encoding="utf-8")
    assert load_tuning(path) == tuning
    assert len(tuning.parameters) >= 8


@pytest.mark.parametrize(
    ("replaced", "message"),
    [
        ({"parameters": "{}"}, "parameters: empty; allowed: from one field on"),
        ({"objectives": "{}"}, "objectives: empty; allowed: from one measure on"),
        ({"parameters": f"{{{GAIN}: {{low: 2.0, high: 0.5}}}}"}, "high: 0.5 is not above low; allowed: above 2"),
        (
            {"parameters": f"{{{GAIN}: {{low: 0.0, high: 2.0, log: true}}}}"},
            "low: 0 has no logarithm; allowed: above 0",
        ),
        ({"parameters": f"{{{GAIN}: {{low: 1.5, high: 2.0}}}}"}, "the scenario's 1 is not within 1.5 to 2; allowed: "),
        ({"parameters": f"{{{GAIN}: {{low: 0.5, high: 50.0}}}}"}, rf"^{GAIN}: 50 is out of range; allowed: 0 to 5"),
        (
            {"parameters": f"{{{GAIN}s: {{low: 0.5, high: 2.0}}}}"},
            "has no dcm_gains there; allowed: .*; did you mean dcm_gain",
        ),
        ({"parameters": f"{{{GAIN}: {{}}}}"}, rf"^tuning, line 2: parameters\.{GAIN}: low and high missing; allowed: "),
        ({"parameters": f"{{{GAIN}: {{low: 0.5}}}}"}, r"high missing; allowed: a group with low and high; write high$"),
        (
            {"parameters": "{seed: {low: -1.0, high: 9.0}}"},
            "parameters.seed: 0 is not a number with decimals; allowed: ",
        ),
        ({"objectives": "{cost_of_transprot: {}}"}, "allowed: .*; did you mean cost_of_transport"),
        ({"objectives": "{wall_time_s: {}}"}, "wall_time_s is not a measure of a run that repeats; allowed: "),
        ({"objectives": "{end: {}}"}, "end is not a measure of a run that repeats; allowed: "),
        (
            {"objectives": "{survived: {over: median}}"},
            "objectives.survived.over: 'median' is unknown; allowed: mean, ",
        ),
        ({"objectives": "{survived: {runs: {case: wlak}}}"}, "objectives.survived.runs: no run of a trial has .*wlak"),
        ({"bounds": "{cost_of_transport: {high: 1.0}}"}, "bounds.cost_of_transport: is an objective too; allowed: "),
        ({"bounds": "{survived: {low: 1.0, high: 0.5}}"}, "bounds.survived.low: 1 is above high; allowed: up to 0.5"),
        (
            {"bounds": "{survived: {}}"},
            "bounds.survived.low: no limit, and no high; allowed: low, high or both; write one",
        ),
        ({"bounds": "{survived: {low: -1.0e+9, penalty: 2.0}}"}, "bounds.survived.low: no limit, and no high"),
        ({"bounds": "{survived: {low: -.inf, high: .inf}}"}, "bounds.survived.low: no limit, and no high"),
        ({"runs": "{scenario: walk, keep: runs}", "objectives": "{survived: {}}"}, "runs.keep: .*; allowed: summary"),
        (
            {
                "parameters": "{duration: {low: 1.0, high: 30.0}}",
                "runs": "{factors: {duration: [5, 9]}}",
                "objectives": "{survived: {}}",
            },
            "parameters.duration: a factor of the runs replaces duration; allowed: ",
        ),
        ({"sampler": "tpe"}, "sampler: 'tpe' is unknown; allowed: cma_es, nsga2"),
        ({"population": "3"}, "population: 3 is out of range; allowed: 4 to 1000"),
        ({"runs": "walk"}, "runs: 'walk' is not a group of fields; allowed: "),
        ({"runs": "{design: {rows: {file: /etc/passwd}}}"}, "runs.design: rows .*; allowed: "),
    ],
)
def test_a_malformed_tuning_is_refused_in_a_line(replaced: dict[str, str], message: str) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        parse_tuning(text(**replaced))
    assert "\n" not in str(caught.value)


def test_an_unknown_tuning_is_refused_with_the_shipped_ones() -> None:
    with pytest.raises(ParameterError, match=r"no such tuning or file; allowed: .*; did you mean pushes_60\?"):
        load_tuning("pushes_6O")
