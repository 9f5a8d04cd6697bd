"""Measures of constructed signals whose values are known."""

import json
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from humanwalk.body.joint_map import JointMap
from humanwalk.measures.effort import cost_of_transport
from humanwalk.measures.events import events_of
from humanwalk.measures.path import SPACING
from humanwalk.measures.signals import TIME
from humanwalk.measures.summary import foot_lift, foot_line_error, summarize, tracking_errors
from humanwalk.numerics import Mask
from humanwalk.quantity import GRAVITY
from humanwalk.scenario import Scenario, load_scenario

PERIOD = 0.01
SPEED = 1.3
STRIDE = 0.6
DUTY = 0.6
LIFT = 0.12


def steady_from(scenario: Scenario) -> float:
    return scenario.controller.steady_from(scenario.subject)


MASS = 70.0


def down(time: Any, lag: float) -> Mask:
    return (time / STRIDE + lag) % 1.0 < DUTY - 1e-9


def walk_of(columns: tuple[str, ...], duration: Any = 5.0, **changes: Any) -> pa.Table:
    """Zeros everywhere but for feet that come down and a center of mass that advances."""
    time = PERIOD * np.arange(round(duration / PERIOD) + 1)
    data = {name: np.zeros_like(time) for name in columns}
    data["com.x_m"] = SPEED * time
    for side, lag in (("right", 0.0), ("left", 0.5)):
        phase = (time / STRIDE + lag) % 1.0
        swing = np.clip((phase - DUTY) / (1 - DUTY), 0.0, 1.0)
        data[f"{side}_foot.force_z_N"] = np.where(down(time, lag), MASS * GRAVITY, 0.0)
        data[f"{side}_sole.z_m"] = 0.01 + np.where(down(time, lag), 0.0, LIFT * np.sin(np.pi * swing))
    for name, value in changes.items():
        data[name] = np.broadcast_to(value(time) if callable(value) else value, time.shape).astype(float)
    return pa.table({TIME: time, **data})


def summary_of(signals: pa.Table, end: str = "completed", overrides: dict[str, str] | None = None) -> Any:
    return summarize(load_scenario("thesis", overrides), signals, end, 2.0, "made up")


# The whole.


def test_summary_has_the_documented_keys(columns: tuple[str, ...], joints: JointMap) -> None:
    summary = summary_of(walk_of(columns))
    assert {
        "scenario",
        "survived",
        "duration_s",
        "fall",
        "mean_speed_m_s",
        "lateral_drift_m",
        "foot_lift_m",
        "steps",
        "support_force_rms_N",
        "external_support",
        "style",
        "peak_torque_N_m",
        "tracking_error_rad",
        "cost_of_transport",
        "realtime_factor",
        "versions",
        "seed",
    } <= summary.keys()
    assert set(summary["foot_lift_m"]) == {"left", "right"}
    assert tuple(summary["peak_torque_N_m"]) == joints.names
    assert tuple(summary["tracking_error_rad"]) == joints.names


def test_summary_is_strict_json(columns: tuple[str, ...]) -> None:
    for signals in (walk_of(columns), walk_of(columns, 0.1), walk_of(columns, 0.0)):
        summary = summary_of(signals)
        assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_summary_of_a_walk_of_known_measures(columns: tuple[str, ...], joints: JointMap) -> None:
    summary = summary_of(
        walk_of(
            columns,
            **{
                "com.y_m": lambda t: -0.01 * t,
                "support.force_x_N": 3.0,
                "support.force_z_N": 4.0,
                "support.torque_y_N_m": 2.0,
                "pelvis.reference_x_m": 0.03,
                "pelvis.reference_z_m": -0.04,
            },
        )
    )
    assert summary["mean_speed_m_s"] == pytest.approx(SPEED)
    assert summary["distance_m"] == pytest.approx(5 * SPEED)
    assert summary["lateral_drift_m"] == pytest.approx(-0.05)
    assert summary["support_force_rms_N"] == pytest.approx(5.0)
    assert summary["support_torque_rms_N_m"] == pytest.approx(2.0)
    assert summary["pelvis_tracking_rms_m"] == pytest.approx(0.05)
    assert summary["realtime_factor"] == pytest.approx(2.5)
    assert summary["survived"] is True
    assert summary["fall"] is None
    assert summary["external_support"] is True


def test_speed_leaves_out_the_ramp(columns: tuple[str, ...]) -> None:
    begin = steady_from(load_scenario("thesis"))
    signals = walk_of(columns, **{"com.x_m": lambda t: np.where(t < begin, 0.0, SPEED * (t - begin))})
    assert summary_of(signals)["mean_speed_m_s"] == pytest.approx(SPEED, rel=1e-2)


def test_steady_walk_begins_with_the_later_of_ramp_and_first_landing() -> None:
    assert steady_from(load_scenario("thesis", {"controller.thesis.gait.ramp.duration": "3"})) == 3.0
    quick = load_scenario("thesis", {"controller.thesis.gait.ramp.duration": "0"})
    # The first landing is L (1 / (2 duty) - 1/2) on.
    assert quick.controller.steady_from(quick.subject) == pytest.approx(0.5 * (1 / 1.2 - 0.5) / 1.4)


def test_run_without_a_steady_part_has_null_there(columns: tuple[str, ...]) -> None:
    summary = summary_of(walk_of(columns, 0.2), end="fell")
    for key in (
        "mean_speed_m_s",
        "support_force_rms_N",
        "pelvis_tracking_rms_m",
        "cost_of_transport",
        "torque_rms_N_m",
    ):
        assert summary[key] is None
    assert set(summary["tracking_error_rad"].values()) == {None}
    assert summary["foot_lift_m"] == {"left": None, "right": None}
    assert summary["survived"] is False
    assert summary["fall"]["time_s"] == pytest.approx(0.2)


def test_walk_that_never_becomes_steady_by_its_scenario_has_null_there(columns: tuple[str, ...]) -> None:
    summary = summary_of(walk_of(columns), overrides={"controller.thesis.gait.ramp.speed": "0"})
    assert summary["mean_speed_m_s"] is None
    assert summary["steady_from_s"] is None
    json.dumps(summary, allow_nan=False)


def test_run_that_ended_in_no_number_is_still_strict_json(columns: tuple[str, ...], joints: JointMap) -> None:
    name = joints.names[0]
    ends_badly = {column: lambda t: np.where(t == t[-1], np.nan, t) for column in ("com.x_m", f"{name}.torque_N_m")}
    summary = summary_of(walk_of(columns, **ends_badly), end="not a number")
    assert summary["mean_speed_m_s"] is None
    assert summary["peak_torque_N_m"][name] is None
    json.dumps(summary, allow_nan=False)


@pytest.mark.parametrize("end", ["interrupted", "not a number", "solver failed: x"])
def test_run_that_ended_for_another_reason_did_not_fall(columns: tuple[str, ...], end: str) -> None:
    summary = summary_of(walk_of(columns), end=end)
    assert (summary["survived"], summary["fall"], summary["end"]) == (False, None, end)


def test_run_without_support_is_marked(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns)
    signals = signals.drop_columns([name for name in signals.column_names if name.startswith("support.")])
    summary = summary_of(signals, overrides={"controller.thesis.balance.support.enabled": "false"})
    assert summary["external_support"] is False
    assert summary["support_force_rms_N"] == 0.0


def test_saturated_share_and_peak_torque_are_of_their_joint(columns: tuple[str, ...], joints: JointMap) -> None:
    name = joints.names[5]
    signals = walk_of(
        columns,
        **{f"{name}.saturated": lambda t: t < 2.5, f"{name}.torque_N_m": lambda t: np.where(t == 1.0, -80.0, 30.0)},
    )
    summary = summary_of(signals)
    assert summary["saturated_share"][name] == pytest.approx(0.5, abs=0.01)
    assert summary["peak_torque_N_m"][name] == 80.0
    assert sum(summary["saturated_share"].values()) == summary["saturated_share"][name]
    assert sum(summary["peak_torque_N_m"].values()) == 80.0


# Its parts.


def test_first_rows_without_force_are_no_landing(columns: tuple[str, ...]) -> None:
    standing = {f"{side}_foot.force_z_N": lambda t: np.where(t < 0.005, 0.0, 350.0) for side in ("right", "left")}
    signals = walk_of(columns, **standing)
    assert events_of(signals, "Right").touchdowns.size == events_of(signals, "Left").touchdowns.size == 0
    assert summary_of(signals)["steps"] == 0


def test_touchdowns_are_when_the_force_comes_back(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns)
    np.testing.assert_allclose(events_of(signals, "Right").touchdown_times, STRIDE * np.arange(1, 9), atol=1.5 * PERIOD)
    np.testing.assert_allclose(
        events_of(signals, "Left").touchdown_times, STRIDE * (np.arange(8) + 0.5), atol=1.5 * PERIOD
    )
    assert summary_of(signals)["steps"] == 16


def test_foot_lift_is_the_peak_above_the_start_and_needs_a_stride(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns)
    assert foot_lift(signals, "Right") == pytest.approx(LIFT, rel=0.02)
    assert foot_lift(signals, "Left") == pytest.approx(LIFT, rel=0.02)
    assert foot_lift(walk_of(columns, 0.5), "Right") is None


def test_foot_lift_does_not_count_the_rise_of_the_ground(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns)
    name = "right_sole.z_m"
    climb = signals[name].to_numpy() + 0.1 * signals["time_s"].to_numpy()
    climbed = signals.set_column(signals.column_names.index(name), name, pa.array(climb))
    # Up to the next place the ground rises by that of a stride.
    assert foot_lift(climbed, "Right") == pytest.approx(foot_lift(signals, "Right"), abs=0.1 * STRIDE)


def test_foot_line_error_is_the_greatest_either_way(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns, **{"right_sole.y_m": lambda t: -0.1 + np.where(t == 2.0, -0.03, 0.02)})
    assert foot_line_error(signals, "Right") == pytest.approx(0.05)
    assert foot_line_error(signals, "Left") == 0.0


def test_tracking_error_is_root_mean_square(columns: tuple[str, ...], joints: JointMap) -> None:
    name = joints.names[3]
    signals = walk_of(columns, **{f"{name}.desired_angle_rad": lambda t: np.where(t < 2.5, 0.0, 0.2)})
    late = signals[TIME].to_numpy() >= 2.5
    errors = tracking_errors(signals, joints.names)
    np.testing.assert_array_equal(errors[:, 3], np.where(late, 0.2, 0.0))
    np.testing.assert_array_equal(np.delete(errors, 3, axis=1), 0.0)
    summary = summary_of(signals)
    steady = signals[TIME].to_numpy() >= summary["steady_from_s"]
    share = late.sum() / steady.sum()
    assert summary["tracking_error_rad"] == pytest.approx(dict.fromkeys(joints.names, 0.0) | {name: 0.2 * share**0.5})
    assert summary["tracking_error_rms_rad"] == pytest.approx(0.2 * (share / len(joints.names)) ** 0.5)


def test_torque_is_the_root_mean_square_of_all_joints_in_the_steady_walk(
    columns: tuple[str, ...], joints: JointMap
) -> None:
    first, second = joints.names[:2]
    signals = walk_of(
        columns, **{f"{first}.torque_N_m": lambda t: np.where(t < 0.2, 1e3, 30.0), f"{second}.torque_N_m": -40.0}
    )
    assert summary_of(signals)["torque_rms_N_m"] == pytest.approx(50.0 / len(joints.names) ** 0.5)


def test_cost_of_transport_of_a_known_power(columns: tuple[str, ...], joints: JointMap) -> None:
    first, second = joints.names[:2]
    signals = walk_of(
        columns,
        **{
            f"{first}.torque_N_m": 20.0,
            f"{first}.velocity_rad_s": 2.0,
            f"{second}.torque_N_m": 10.0,
            # Braking costs too: nothing is regained.
            f"{second}.velocity_rad_s": -3.0,
        },
    )
    every = np.ones(signals.num_rows, dtype=bool)
    expected = 70.0 / (MASS * GRAVITY * SPEED)
    assert cost_of_transport(signals, every, MASS, 5.0 * SPEED) == pytest.approx(expected)
    half = signals[TIME].to_numpy() >= 2.0
    assert cost_of_transport(signals, half, MASS, 3.0 * SPEED) == pytest.approx(expected)
    assert summary_of(signals)["cost_of_transport"] == pytest.approx(expected)


@pytest.mark.parametrize("distance", [0.0, -1.0])
def test_cost_of_transport_of_no_way_forward_is_null(columns: tuple[str, ...], distance: float) -> None:
    signals = walk_of(columns)
    assert cost_of_transport(signals, np.ones(signals.num_rows, dtype=bool), MASS, distance) is None


def test_qp_failures_are_counted_to_the_end(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns, **{"qp.failures": np.floor})
    assert summary_of(signals)["qp_failures"] == 5


def test_ik_converged_share_is_that_of_both_legs_and_all_samples(columns: tuple[str, ...]) -> None:
    signals = walk_of(columns, **{"right_leg.ik_converged": 1.0, "left_leg.ik_converged": lambda t: t < 2.5})
    assert summary_of(signals)["ik_converged_share"] == pytest.approx(0.75, abs=0.01)


def test_deviation_from_the_path_counts_in_the_steady_walk_only(columns: tuple[str, ...]) -> None:
    scenario = load_scenario("walk")
    begin = steady_from(scenario)
    aside = {"com.x_m": lambda t: 0.3 * t, "com.y_m": lambda t: np.where(t < begin, 0.2 * np.sin(t), 0.0)}
    summary = summarize(scenario, walk_of(columns, begin + 3.0, **aside), "completed", 2.0, "made up")
    assert summary["path_deviation_m"] == pytest.approx(0.0, abs=SPACING)


@pytest.mark.parametrize(
    ("scenario", "point", "velocity"), [("sideways", "com.y_m", 0.3), ("backward", "com.x_m", -0.4)]
)
def test_a_walk_to_any_side_covers_distance_at_a_cost(
    columns: tuple[str, ...], joints: JointMap, scenario: str, point: str, velocity: float
) -> None:
    work = {f"{joints.names[0]}.torque_N_m": 20.0, f"{joints.names[0]}.velocity_rad_s": 2.0}
    signals = walk_of(columns, 12.0, **{"com.x_m": 0.0, point: lambda t: velocity * t}, **work)
    summary = summarize(load_scenario(scenario), signals, "completed", 2.0, "made up")
    assert summary["distance_m"] == pytest.approx(12.0 * abs(velocity))
    assert summary["mean_speed_m_s"] == pytest.approx(velocity if point == "com.x_m" else 0.0)
    assert summary["cost_of_transport"] == pytest.approx(40.0 / (MASS * GRAVITY * abs(velocity)), rel=1e-3)
    assert (summary["lateral_drift_m"] is None) == (scenario == "sideways")
