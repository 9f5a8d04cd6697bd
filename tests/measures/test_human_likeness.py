"""Comparison with human gait of constructed walks that move as humans do, or differ from them in a known way."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.measures.events import FootEvents, events_of
from humanwalk.measures.human_likeness import (
    ANGLES,
    CYCLE,
    Likeness,
    com_excursions,
    compare,
    force_peaks,
    late_stance_knee,
    over_strides,
    peak_counts,
    people,
    people_com_excursion,
    vertical_force,
)
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY, ParameterError
from humanwalk.scenario import Scenario, load_scenario

MASS = 70.0
WEIGHT = MASS * GRAVITY
DUTY, STRIDE, LENGTH, WIDTH = 0.6, 1.0, 1.3, 0.12
"""Of the made-up walk, see conftest.py: share of stance, time [s] and length of a stride [m], width of a step [m]."""


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("thesis", {"subject.mass": str(MASS)})


def test_people_are_those_of_the_source() -> None:
    for angle in ANGLES.values():
        cycle, mean, sd = people(angle.people)
        np.testing.assert_array_equal(cycle, np.arange(0, 101, 2))
        assert sd.min() > 0.0
        # Heel strike ends the cycle that it begins.
        assert mean[0] == pytest.approx(mean[-1], abs=1.5)
    _, knee, _ = people("knee_flexion_deg")
    assert 65 <= np.arange(0, 101, 2)[knee.argmax()] <= 80
    assert 50.0 < knee.max() < 70.0


def test_walk_of_human_angles_agrees_with_human_gait(walk: Callable[..., Any], scenario: Scenario) -> None:
    comparison = compare(walk(), scenario)
    assert comparison.strides == {"Right": 7, "Left": 7}
    for name, sides in comparison.curves.items():
        for side, likeness in sides.items():
            # People's pelvis as the left leg sees it is only nearly that of the right one half a stride before.
            near = side == "Left" and name.startswith("pelvis")
            assert likeness.rms.max() < (1.0 if near else 0.5), name
            assert likeness.inside.min() == 1.0, name
            if not (near and name == "pelvis tilt"):
                assert likeness.correlation.min() > (0.9 if near else 0.95), name


@given(shift=st.floats(-30, 30), scale=st.floats(0.2, 3.0))
def test_correlation_is_independent_of_offset_and_scale_and_the_difference_is_the_offset(
    shift: float, scale: float
) -> None:
    cycle, mean, _ = people("knee_flexion_deg")
    curve = np.interp(CYCLE, cycle, mean)
    moved = shift + curve.mean() + scale * (curve - curve.mean())
    likeness = Likeness.of(moved[None], "knee_flexion_deg")
    assert likeness.correlation[0] == pytest.approx(1.0)
    assert likeness.difference[0] == pytest.approx(shift, abs=1e-9)
    assert likeness.rms[0] == pytest.approx(np.hypot(shift, (scale - 1) * curve.std()), abs=1e-6)


def test_constant_angle_has_no_correlation() -> None:
    assert np.isnan(Likeness.of(np.full((1, CYCLE.size), 5.0), "knee_flexion_deg").correlation).all()


@pytest.mark.parametrize(("share", "inside"), [(0.0, 1.0), (0.99, 1.0), (1.01, 0.0)])
def test_inside_is_within_one_standard_deviation(share: float, inside: float) -> None:
    cycle, mean, sd = people("hip_flexion_deg")
    curve = np.interp(CYCLE, cycle, mean + share * sd)
    assert Likeness.of(curve[None], "hip_flexion_deg").inside[0] == inside


def test_strides_are_counted_one_by_one(walk: Callable[..., Any]) -> None:
    """One stride of seven with a stiff knee is one bad number of seven."""
    signals = walk()
    time = signals[TIME].to_numpy()
    knee = np.where((time > 3.0) & (time < 4.0), 0.0, signals["RightLegTibiaMotion.angle_rad"].to_numpy())
    strides = over_strides(events_of(signals, "Right"), np.degrees(knee))
    bad = Likeness.of(strides, "knee_flexion_deg").rms > 10.0
    assert np.flatnonzero(bad).tolist() == [2]


def test_late_stance_knee_is_the_least_of_terminal_stance() -> None:
    curve = np.full(CYCLE.size, 40.0)
    curve[[20, 40, 60]] = 1.0, 12.0, 2.0
    assert late_stance_knee(curve[None]) == pytest.approx([12.0])


def with_force(signals: pa.Table, change: Callable[..., Any]) -> pa.Table:
    """The record with a change of the right foot's vertical force [body weights], a function of force and time."""
    name = "right_foot.force_z_N"
    force = change(signals[name].to_numpy() / WEIGHT, signals[TIME].to_numpy())
    return signals.set_column(signals.column_names.index(name), name, [WEIGHT * force])


def right_force(signals: pa.Table) -> tuple[Array, FootEvents]:
    return vertical_force(signals, "Right", WEIGHT), events_of(signals, "Right")


@pytest.mark.parametrize(("valley", "count"), [(0.8, 2), (1.0, 2), (1.08, 1)])
def test_peaks_of_the_vertical_force_are_measured_and_counted(
    walk: Callable[..., Any], valley: float, count: int
) -> None:
    force, foot = right_force(walk(humps=(1.15, valley, 1.1)))
    assert force_peaks(force, foot).mean(axis=0) == pytest.approx([1.15, valley, 1.1], abs=0.01)
    assert set(peak_counts(force, foot).tolist()) == {count}


def test_third_peak_is_counted(walk: Callable[..., Any]) -> None:
    """A bump of 0.3 body weights in the valley of mid-stance."""
    bump = with_force(walk(), lambda force, time: force + 0.3 * np.exp(-(((time % STRIDE - 0.3) / 0.02) ** 2)))
    assert set(peak_counts(*right_force(bump)).tolist()) == {3}


def test_impact_of_the_heel_is_no_peak(walk: Callable[..., Any]) -> None:
    impact = with_force(walk(), lambda force, time: force + np.where(np.isclose(time % 1.0, 0.02), 2.0, 0.0))
    assert force_peaks(*right_force(impact))[:, 0] == pytest.approx(1.1, abs=0.02)


def test_measures_of_a_walk_are_as_it_was_made(walk: Callable[..., Any], scenario: Scenario) -> None:
    measures = {measure.name: measure for measure in compare(walk(), scenario).measures}
    made = {
        "speed": LENGTH / STRIDE,
        "step length": LENGTH / 2,
        "cadence": 120 / STRIDE,
        "share of stance": DUTY,
        "share of double support": 2 * DUTY - 1,
        "step width": WIDTH,
        "center of mass, vertical range": 0.036,
        "center of mass, lateral range": 0.04,
        "vertical GRF, first peak": 1.1,
        "vertical GRF, valley": 0.8,
        "share of stances with two peaks": 1.0,
        "moment, hip flexion": 0.5,
        "moment, ankle plantarflexion": 0.5,
        "cost of transport": 6 * 35 * (2 / np.pi) / (WEIGHT * LENGTH),
    }
    for name, value in made.items():
        assert measures[name].values.mean() == pytest.approx(value, rel=0.02), name


def test_walk_of_human_angles_is_within_the_human_ranges(walk: Callable[..., Any], scenario: Scenario) -> None:
    """The walk made of people's angles and of textbook steps lies within people's values, where there are any."""
    measures = {measure.name: measure for measure in compare(walk(), scenario).measures}
    for name in ("speed", "step length", "least knee flexion, terminal stance", "center of mass, lateral range"):
        people = measures[name].people
        assert people.source
        assert people.low <= measures[name].values.mean() <= people.high, name
    assert [measure.name for measure in measures.values() if measure.people and not measure.people.source] == []


def test_drift_is_no_excursion(walk: Callable[..., Any]) -> None:
    signals = walk()
    drifting = signals["com.y_m"].to_numpy() + 0.3 * signals[TIME].to_numpy()
    drifted = signals.drop_columns("com.y_m").append_column("com.y_m", [drifting])
    for record in (signals, drifted):
        assert com_excursions(record, events_of(record, "Right"), "y") == pytest.approx(0.04, rel=0.01)


@pytest.mark.parametrize("direction", ["vertical", "lateral"])
def test_human_excursion_is_given_between_the_speeds_of_the_source(direction: str) -> None:
    assert people_com_excursion(direction, 0.6) is None
    assert people_com_excursion(direction, 1.7) is None
    slow, fast = people_com_excursion(direction, 0.7), people_com_excursion(direction, 1.6)
    middle = people_com_excursion(direction, 1.15)
    assert middle.low == pytest.approx((slow.low + fast.low) / 2)
    # A faster walk rises more and sways less.
    assert (fast.high > slow.high) == (direction == "vertical")


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (dict(duration=2.4), "strides: 1 of the right leg"),
        (dict(standing=True), "strides: 0 of the right leg and 0 of the left"),
        (dict(heading=np.radians(30)), "30 deg from straight ahead"),
        (dict(heading=np.pi), "180 deg from straight ahead"),
    ],
    ids=["short", "standing", "aslant", "backward"],
)
def test_walk_that_is_short_or_not_straight_is_refused(
    walk: Callable[..., Any], scenario: Scenario, made: dict[str, bool | float], said: str
) -> None:
    with pytest.raises(ParameterError, match=said):
        compare(walk(**made), scenario)


def test_only_steady_strides_count(walk: Callable[..., Any]) -> None:
    scenario = load_scenario("thesis", {"controller.thesis.gait.ramp.duration": "3.5"})
    assert scenario.controller.steady_from(scenario.subject) == 3.5
    # Landings at 4, 5, 6, 7, 8 s.
    assert compare(walk(), scenario).strides["Right"] == 4


def test_moments_of_flexion_and_extension_are_separate(walk: Callable[..., Any], scenario: Scenario) -> None:
    time = walk()[TIME].to_numpy()
    torque = {f"{side}LegTibiaMotion.torque_N_m": 7.0 + 35.0 * np.sin(2 * np.pi * time) for side in ("Right", "Left")}
    measures = {measure.name: measure.values for measure in compare(walk(**torque), scenario).measures}
    assert measures["moment, knee flexion"] == pytest.approx(0.6, rel=0.01)
    assert measures["moment, knee extension"] == pytest.approx(0.4, rel=0.01)


def test_record_that_is_sampled_slowly_is_compared_too(walk: Callable[..., Any], scenario: Scenario) -> None:
    """The longest signal period of a scenario is below the rate of the force filter."""
    rows = np.arange(0, walk().num_rows, 10)
    measures = {measure.name: measure.values for measure in compare(walk().take(rows), scenario).measures}
    assert measures["cadence"] == pytest.approx(120 / STRIDE, rel=0.02)
    assert np.isfinite(measures["vertical GRF, valley"]).all()
