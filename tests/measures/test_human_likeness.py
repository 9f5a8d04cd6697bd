"""Comparison with human gait of constructed walks that move as humans do, or differ from them in a known way."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES, human
from humanwalk.body.limbs import LEGS
from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import ANGLES, CURVES, JOINTS, over_strides
from humanwalk.measures.events import FootEvents, events_of
from humanwalk.measures.ground_force import contact_lost, force_peaks, peak_counts, vertical_force
from humanwalk.measures.human_likeness import SCORED, Likeness, compare, pooled
from humanwalk.measures.signals import TIME, unit_of
from humanwalk.measures.walk_measures import MEASURES, com_excursions
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY, ParameterError
from humanwalk.scenario import Scenario, load_scenario

MASS = 70.0
LEG = 0.93
WEIGHT = MASS * GRAVITY
DUTY, STRIDE, LENGTH, WIDTH = 0.6, 1.0, 1.3, 0.12
"""Of the made-up walk, see conftest.py: share of stance, time [s] and length of a stride [m], width of a step [m]."""


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("thesis", {"subject.mass": str(MASS)})


def test_walk_of_human_angles_agrees_with_human_gait(walk: Callable[..., Any], scenario: Scenario) -> None:
    comparison = compare(walk(), scenario)
    assert comparison.strides == {"Right": 7, "Left": 7}
    # The orientation of the feet follows from the other angles.
    for name in ANGLES.keys() - {"foot progression"}:
        for side, likeness in comparison.curves[name].items():
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
    band = ANGLES["knee"].people("free")
    moved = shift + band.mean.mean() + scale * (band.mean - band.mean.mean())
    likeness = Likeness.of(moved[None], band)
    assert likeness.correlation[0] == pytest.approx(1.0)
    assert likeness.difference[0] == pytest.approx(shift, abs=1e-9)
    assert likeness.rms[0] == pytest.approx(np.hypot(shift, (scale - 1) * band.mean.std()), abs=1e-6)


@given(scale=st.floats(0.2, 3.0))
def test_peak_ratio_is_the_scale_of_the_curve(scale: float) -> None:
    band = CURVES["ankle moment"].people("slow")
    assert Likeness.of(-scale * band.mean[None], band).peak_ratio == pytest.approx(scale)


def test_constant_angle_has_no_correlation() -> None:
    assert np.isnan(Likeness.of(np.full((1, CYCLE.size), 5.0), ANGLES["knee"].people("free")).correlation).all()


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize(
    ("share", "inside", "inside_2"), [(0.0, 1.0, 1.0), (0.99, 1.0, 1.0), (-1.01, 0.0, 1.0), (2.01, 0.0, 0.0)]
)
def test_inside_is_within_one_and_two_standard_deviations(
    name: str, share: float, inside: float, inside_2: float
) -> None:
    band = CURVES[name].people("fast")
    likeness = Likeness.of((band.mean + share * band.sd)[None], band)
    assert likeness.inside[0] == inside
    assert likeness.inside_2[0] == inside_2
    assert likeness.distance[0] == pytest.approx(abs(share))


LEG = human().hip_height


def kinetics_of_people(leg: float) -> dict[str, Array]:
    """Torques and rates of both legs whose moments and powers are people's at a free speed, for a leg length [m]."""
    time = 0.005 * np.arange(1601)
    columns = {}
    for side, lag in zip(SIDES, (0.0, 0.5), strict=True):
        for name, joint in JOINTS.items():
            people = (CURVES[f"{name} {what}"].people("free", leg).mean for what in ("moment", "power"))
            moment, power = (np.interp(100.0 * ((time / STRIDE - lag) % 1.0), CYCLE, mean) for mean in people)
            # A rate of 0.1 rad/s where there is no moment.
            moment = np.where(np.abs(moment) < 1e-3, 1e-3, moment)
            columns[f"{joint(LEGS[side])}.torque_N_m"] = -MASS * moment
            columns[f"{joint(LEGS[side])}.velocity_rad_s"] = -power / moment
    return columns


def test_walk_with_the_mean_curves_of_people_scores_one(walk: Callable[..., Any], scenario: Scenario) -> None:
    comparison = compare(walk(**kinetics_of_people(LEG)), scenario)
    assert comparison.group == "free"
    assert comparison.score == 1.0
    assert comparison.distance < 0.1
    for name in SCORED:
        assert comparison.mean(name, "correlation") > 0.98, name
        assert comparison.mean(name, "peak_ratio") == pytest.approx(1.0, rel=0.05), name


def test_score_is_the_mean_of_the_nine_curves(walk: Callable[..., Any], scenario: Scenario) -> None:
    """One joint of one leg without torque: its moment and power leave people's bands."""
    kinetics = kinetics_of_people(LEG)
    kinetics["LeftLegAnkleMotion.torque_N_m"] *= 0.0
    comparison = compare(walk(**kinetics), scenario)
    lost = [1.0 - pooled(comparison.curves[f"ankle {what}"], "inside").mean() for what in ("moment", "power")]
    assert min(lost) > 0.1
    assert comparison.score == pytest.approx(1.0 - sum(lost) / len(SCORED))


@pytest.mark.parametrize("joint", JOINTS)
def test_power_is_moment_times_speed_of_extension(walk: Callable[..., Any], joint: str) -> None:
    signals = walk(**kinetics_of_people(LEG))
    rate = signals[f"{JOINTS[joint](LEGS['Left'])}.velocity_rad_s"].to_numpy()
    moment, power = (CURVES[f"{joint} {what}"].of(signals, "Left", MASS, 1.0) for what in ("moment", "power"))
    np.testing.assert_allclose(power, moment * -rate, atol=1e-12)


def test_moments_are_per_body_mass(walk: Callable[..., Any]) -> None:
    moment = CURVES["hip moment"].of
    signals = walk()
    np.testing.assert_allclose(2.0 * moment(signals, "Right", 80.0, 1.0), moment(signals, "Right", 40.0, 1.0))


def test_strides_are_counted_one_by_one(walk: Callable[..., Any]) -> None:
    """One stride of seven with a stiff knee is one bad number of seven."""
    signals = walk()
    time = signals[TIME].to_numpy()
    knee = np.where((time > 3.0) & (time < 4.0), 0.0, signals["RightLegTibiaMotion.angle_rad"].to_numpy())
    strides = over_strides(events_of(signals, "Right"), np.degrees(knee))
    bad = Likeness.of(strides, ANGLES["knee"].people("free")).rms > 10.0
    assert np.flatnonzero(bad).tolist() == [2]


def with_force(signals: pa.Table, change: Callable[..., Any]) -> pa.Table:
    """The record with a change of the right foot's vertical force [body weights], a function of force and time."""
    name = "right_foot.force_z_N"
    force = change(signals[name].to_numpy() / WEIGHT, signals[TIME].to_numpy())
    return signals.set_column(signals.column_names.index(name), name, [WEIGHT * force])


def right_force(signals: pa.Table) -> tuple[Array, FootEvents]:
    return vertical_force(signals, "Right", WEIGHT), events_of(signals, "Right")


@pytest.mark.parametrize(("dip", "count"), [(0.8, 2), (1.0, 2), (1.08, 1)])
def test_peaks_of_the_vertical_force_are_measured_and_counted(walk: Callable[..., Any], dip: float, count: int) -> None:
    force, foot = right_force(walk(humps=(1.15, dip, 1.1)))
    assert force_peaks(force, foot).mean(axis=0) == pytest.approx([1.15, dip, 1.1], abs=0.01)
    assert set(peak_counts(force, foot).tolist()) == {count}


def test_third_peak_is_counted(walk: Callable[..., Any]) -> None:
    """A bump of 0.3 body weights in the dip of mid-stance."""
    bump = with_force(walk(), lambda force, time: force + 0.3 * np.exp(-(((time % STRIDE - 0.3) / 0.02) ** 2)))
    assert set(peak_counts(*right_force(bump)).tolist()) == {3}


def test_impact_of_the_heel_is_no_peak(walk: Callable[..., Any]) -> None:
    impact = with_force(walk(), lambda force, time: force + np.where(np.isclose(time % 1.0, 0.02), 2.0, 0.0))
    assert force_peaks(*right_force(impact))[:, 0] == pytest.approx(1.1, abs=0.02)


@pytest.mark.parametrize("lost", [0.0, 0.02, 0.05])
def test_contact_that_a_bouncing_heel_loses_is_measured(walk: Callable[..., Any], lost: float) -> None:
    begin = 0.047

    def change(force: Array, time: Array) -> Array:
        return np.where((time % STRIDE > begin) & (time % STRIDE < begin + lost), 0.0, force)

    bounce = with_force(walk(), change)
    assert contact_lost(bounce, "Right", events_of(bounce, "Right")) == pytest.approx(lost, abs=1e-9)
    assert contact_lost(bounce, "Left", events_of(bounce, "Left")) == pytest.approx(0.0)


def test_contact_that_a_dragging_toe_loses_is_not_after_heel_strike(walk: Callable[..., Any]) -> None:
    drag = with_force(walk(), lambda force, time: np.where((time % 1.0 > 0.55) & (time % 1.0 < 0.57), 0, force))
    assert contact_lost(drag, "Right", events_of(drag, "Right")) == pytest.approx(0.0)


def test_columns_of_measures_are_unique_and_have_their_units() -> None:
    columns = [kind.column for kind in MEASURES]
    assert len(columns) == len(set(columns))
    for kind in MEASURES:
        assert unit_of(kind.column) == kind.unit
        assert kind.column.isascii() and kind.column.replace("_", "").isalnum()


def test_value_of_a_measure_is_its_mean_or_its_worst(walk: Callable[..., Any], scenario: Scenario) -> None:
    one_bounce = with_force(walk(), lambda force, time: np.where((time > 4.05) & (time < 4.08), 0, force))
    measures = {measure.name: measure for measure in compare(one_bounce, scenario).measures}
    assert measures["contact lost after heel strike"].value == pytest.approx(0.025, abs=0.006)
    assert measures["step length"].value == pytest.approx(measures["step length"].values.mean())


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
        "vertical GRF, dip": 0.8,
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
    for name in (
        *("speed", "share of stance", "share of double support", "step width"),
        *("least knee flexion, terminal stance", "center of mass, lateral range"),
    ):
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
    assert np.isfinite(measures["vertical GRF, dip"]).all()
