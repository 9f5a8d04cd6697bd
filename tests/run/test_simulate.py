"""A simulated walk: up for the whole time, on its path, carried by its feet; and runs that end before are kept."""

import os
import signal
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from pydrake.systems.framework import Context
from rich.console import Console

from humanwalk.body.contact import FRICTION, SOLE_PARTS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.choices.start import start_velocities
from humanwalk.cli.walk import summary_table
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.measures.events import events_of
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.outcome import Outcome
from humanwalk.run.simulate import prepare, simulate
from humanwalk.scenario import load_scenario
from humanwalk.sides import Side
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver

GRAVITY = 9.81
SPEED = 1.4
STRIDE_TIME = FootPathParameters().walked_stride / SPEED
SIDES = ("right", "left")


def thesis(duration: float, **overrides: str) -> Any:
    fields = {key.replace("__", "."): value for key, value in overrides.items()}
    return load_scenario("thesis", {"duration": str(duration)} | fields)


@pytest.fixture(scope="module")
def walk() -> Any:
    """The thesis' walk: the ramp, and two whole strides from 0.6 s on."""
    times = []
    outcome = simulate(thesis(0.6 + 2 * STRIDE_TIME), on_progress=times.append)
    return outcome, times


@pytest.fixture(scope="module")
def strides(walk: Any) -> Any:
    """Rows of whole strides: means over them are those of the steady walk."""
    time = walk[0].signals[TIME].to_numpy()
    return (time >= 0.6 - 1e-9) & (time < 0.6 + 2 * STRIDE_TIME)


# The walk.


def test_walk_lasts_for_its_duration(walk: Any) -> None:
    outcome, times = walk
    time = outcome.signals[TIME].to_numpy()
    assert outcome.end == "completed"
    assert outcome.survived
    assert outcome.wall_time > 0
    np.testing.assert_allclose(np.diff(time), outcome.scenario.recording.signal_period, rtol=1e-6)
    assert time[-1] == pytest.approx(outcome.scenario.duration, abs=0.005)
    assert times == sorted(times)
    assert times[-1] == pytest.approx(outcome.scenario.duration, abs=0.02)


def test_every_number_is_finite(walk: Any) -> None:
    for name in walk[0].signals.column_names:
        assert np.isfinite(walk[0].signals[name].to_numpy()).all(), name


def test_speed_is_the_one_that_is_asked_for(walk: Any, strides: Any) -> None:
    signals = walk[0].signals
    time, x = signals[TIME].to_numpy()[strides], signals["com.x_m"].to_numpy()[strides]
    assert (x[-1] - x[0]) / (time[-1] - time[0]) == pytest.approx(SPEED, rel=0.05)
    assert walk[0].summary("thesis")["mean_speed_m_s"] == pytest.approx(SPEED, rel=0.05)


def test_pelvis_keeps_to_its_reference(walk: Any) -> None:
    signals = walk[0].signals
    actual = matrix(signals, [f"pelvis.{axis}_m" for axis in "xyz"])
    wanted = matrix(signals, [f"pelvis.reference_{axis}_m" for axis in "xyz"])
    distance = np.linalg.norm(actual - wanted, axis=1)
    assert np.sqrt((distance**2).mean()) < 0.015
    assert distance.max() < 0.03


def test_quaternion_of_the_pelvis_stays_a_rotation(walk: Any) -> None:
    wxyz = matrix(walk[0].signals, [f"pelvis.quaternion_{part}" for part in "wxyz"])
    np.testing.assert_allclose(np.linalg.norm(wxyz, axis=1), 1.0, atol=1e-2)
    assert (wxyz[:, 0] > 0.98).all()


def test_weight_is_carried_by_ground_and_support(walk: Any, strides: Any) -> None:
    signals = walk[0].signals
    ground = matrix(signals, [f"{side}_foot.force_z_N" for side in SIDES])[strides].sum(axis=1)
    support = signals["support.force_z_N"].to_numpy()[strides]
    # Newton: over whole strides of a steady walk the mean force is the weight.
    assert ground.mean() + support.mean() == pytest.approx(70.0 * GRAVITY, rel=0.03)
    assert ground.mean() > 0.8 * 70.0 * GRAVITY


def test_forces_along_the_walk_cancel_over_whole_strides(walk: Any, strides: Any) -> None:
    signals = walk[0].signals
    for axis in "xy":
        ground = matrix(signals, [f"{side}_foot.force_{axis}_N" for side in SIDES])[strides].sum(axis=1)
        support = signals[f"support.force_{axis}_N"].to_numpy()[strides]
        assert abs(ground.mean() + support.mean()) < 0.05 * 70.0 * GRAVITY


def share_out_of_the_friction_cone(signals: pa.Table, side: Any) -> float:
    force = matrix(signals, [f"{side}_foot.force_{axis}_N" for axis in "xyz"])
    assert (force[:, 2] >= -1e-9).all()
    return float((np.hypot(force[:, 0], force[:, 1]) > FRICTION * force[:, 2] + 1.0).mean())


def test_friction_stays_in_its_cone() -> None:
    # Drake's lagged approximation bounds friction by the normal force of the step before: wrong where feet land.
    # The share grows with the step: 4 % is the bound at 1 ms.
    fine = thesis(0.6 + 2 * STRIDE_TIME, simulation__time_step="0.001", recording__signal_period="0.005")
    signals = simulate(fine).signals
    assert max(share_out_of_the_friction_cone(signals, side) for side in SIDES) <= 0.04


def test_friction_stays_in_its_cone_at_every_step_of_the_similar_approximation() -> None:
    signals = simulate(thesis(0.7, simulation__contact_approximation="similar")).signals
    assert [share_out_of_the_friction_cone(signals, side) for side in SIDES] == [0.0, 0.0]


@pytest.mark.parametrize("side", SIDES)
def test_center_of_pressure_is_under_the_loaded_foot(walk: Any, side: Side) -> None:
    signals = walk[0].signals
    loaded = signals[f"{side}_foot.loaded"].to_numpy() > 0
    x, y = (
        (signals[f"{side}_foot.cop_{axis}_m"].to_numpy() - signals[f"{side}_sole.{axis}_m"].to_numpy())[loaded]
        for axis in "xy"
    )
    turned = 0.01
    assert loaded.mean() > 0.3
    assert x.min() > SOLE_PARTS[0].x[0] - turned
    assert x.max() < SOLE_PARTS[-1].x[1] + turned
    assert np.abs(y).max() < 0.5 * max(part.width for part in SOLE_PARTS) + turned


@pytest.mark.parametrize("side", SIDES)
def test_inverse_kinematics_reach_every_sole(walk: Any, side: Any) -> None:
    assert walk[0].signals[f"{side}_leg.ik_residual"].to_numpy().max() < 1e-4


def test_feet_alternate_and_are_on_the_ground_about_when_they_should(walk: Any) -> None:
    signals = walk[0].signals
    landings = sorted((time, side) for side in ("Right", "Left") for time in events_of(signals, side).touchdown_times)
    assert [side for _, side in landings[:5]] == ["Right", "Left", "Right", "Left", "Right"]
    assert np.diff([time for time, _ in landings]) == pytest.approx(STRIDE_TIME / 2, abs=0.05)
    for side in SIDES:
        scheduled = signals[f"{side}_foot.scheduled"].to_numpy() > 0
        loaded = signals[f"{side}_foot.force_z_N"].to_numpy() > 50.0
        assert (scheduled == loaded).mean() > 0.7


def test_feet_lift_about_as_high_as_commanded(walk: Any) -> None:
    lift = walk[0].summary("thesis")["foot_lift_m"]
    assert lift["right"] == pytest.approx(0.2, abs=0.02)
    assert lift["left"] == pytest.approx(0.2, abs=0.02)


def test_joints_follow_their_desired_angles(walk: Any) -> None:
    errors = walk[0].summary("thesis")["tracking_error_rad"]
    assert max(errors.values()) < 0.06


def test_support_is_reported(walk: Any) -> None:
    summary = walk[0].summary("thesis")
    assert summary["external_support"] is True
    assert summary["support_force_rms_N"] > 10.0


def test_the_support_is_a_spring_damper_on_the_pelvis(walk: Any) -> None:
    signals = walk[0].signals
    support = walk[0].scenario.controller.balance.support
    columns = [f"pelvis.{{}}{kind}{axis}_{unit}" for kind, unit in (("", "m"), ("velocity_", "m_s")) for axis in "xyz"]
    error = matrix(signals, [column.format("reference_") for column in columns])
    error -= matrix(signals, [column.format("") for column in columns])
    force = support.stiffness * error[:, :3] + support.damping * error[:, 3:]
    np.testing.assert_allclose(matrix(signals, [f"support.force_{axis}_N" for axis in "xyz"]), force, atol=1e-6)


def test_summary_is_printed_with_the_support(walk: Any, capsys: pytest.CaptureFixture[str]) -> None:
    Console(width=120).print(summary_table(walk[0].summary("thesis")))
    shown = capsys.readouterr().out
    assert "EXTERNAL SUPPORT" in shown
    assert "cost of transport" in shown


# Runs that end before.


@pytest.fixture(scope="module")
def fall() -> Any:
    return simulate(thesis(5.0, controller__thesis__balance__support__enabled="false"))


def test_walker_without_support_falls_and_its_record_is_kept(fall: Any) -> None:
    time = fall.signals[TIME].to_numpy()
    assert fall.end == "fell"
    assert not fall.survived
    assert 0.3 < time[-1] < 4.0
    height = fall.signals["pelvis.z_m"].to_numpy()
    assert height[-1] < 0.65 * height[0]
    assert (height[:-10] > 0.6 * height[0]).all()


def test_fall_is_summarised(fall: Any) -> None:
    summary = fall.summary("thesis")
    assert summary["survived"] is False
    assert summary["fall"]["time_s"] == pytest.approx(fall.signals[TIME][-1].as_py())
    assert summary["external_support"] is False
    summary_table(summary)


def test_interrupt_ends_a_run_and_keeps_its_signals() -> None:
    def interrupt(time: float) -> None:
        if time >= 0.1:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    outcome = simulate(thesis(5.0), on_progress=interrupt)
    time = outcome.signals[TIME].to_numpy()
    assert outcome.end == "interrupted"
    assert 0.1 <= time[-1] < 0.2
    assert signal.getsignal(signal.SIGINT) is before


def test_state_that_drake_gives_up_on_ends_a_run_and_keeps_its_signals(monkeypatch: pytest.MonkeyPatch) -> None:
    solve = InverseKinematicsSolver._solve
    plant = kinematics_plant(Subject())

    def run_away(self: Any, guess: Array, context: Context, discrete: Any) -> Any:
        if context.get_time() >= 0.05:
            plant.SetPositions(plant.CreateDefaultContext(), np.full(plant.num_positions(), np.nan))
        return solve(self, guess, context, discrete)

    monkeypatch.setattr(InverseKinematicsSolver, "_solve", run_away)
    outcome = simulate(thesis(1.0))
    assert outcome.end.startswith("solver failed:")
    assert len(outcome.end.splitlines()) == 1
    assert outcome.signals[TIME].to_numpy()[-1] == pytest.approx(0.05, abs=0.006)
    summary_table(outcome.summary("thesis"))


def test_run_of_one_row_has_a_summary(capsys: pytest.CaptureFixture[str]) -> None:
    outcome = simulate(thesis(0.001))
    assert outcome.signals[TIME].to_pylist() == [0.0]
    summary = outcome.summary("thesis")
    assert summary["survived"] is True
    assert summary["duration_s"] == 0.0
    assert summary["distance_m"] == 0.0
    assert summary["mean_speed_m_s"] is None
    assert summary["steps"] == 0
    Console(width=120).print(summary_table(summary))
    shown = capsys.readouterr().out
    assert "completed at 0.00 s" in shown
    assert not any(word in shown for word in ("speed", "cost of transport", "nan", "None"))


def test_scenario_that_cannot_be_simulated_is_refused() -> None:
    with pytest.raises(ParameterError):
        simulate(thesis(1.0, gait__path__offset="0.03"))


def test_cenic_is_what_integrates_when_asked_for() -> None:
    outcome = simulate(thesis(0.1, simulation__integrator="cenic", simulation__time_step="0"))
    assert outcome.survived
    reference = simulate(thesis(0.1))
    difference = matrix(outcome.signals, ["pelvis.x_m", "pelvis.z_m"]) - matrix(
        reference.signals, ["pelvis.x_m", "pelvis.z_m"]
    )
    assert np.abs(difference).max() < 0.005


def test_a_simulation_starts_with_the_velocities_of_the_scenario() -> None:
    scenario = thesis(0.1, start__rate_noise="0.1")
    prepared = prepare(scenario)
    context = prepared.plant.GetMyContextFromRoot(prepared.simulator.get_context())
    np.testing.assert_array_equal(
        prepared.plant.GetVelocities(context), start_velocities(scenario.subject, scenario.start, scenario.seed)
    )


def test_the_same_scenario_gives_the_same_record() -> None:
    first, again = (simulate(thesis(0.1, start__joint_noise="0.01")) for _ in range(2))
    assert first.signals.equals(again.signals)


def test_signal_that_arrives_while_the_run_is_saved_waits() -> None:
    received, saved = [], []
    before = signal.signal(signal.SIGTERM, lambda number, frame: received.append(number))

    def save(outcome: Outcome) -> None:
        os.kill(os.getpid(), signal.SIGTERM)
        assert received == []
        saved.append(outcome)

    try:
        outcome = simulate(load_scenario("thesis", {"duration": "0.02"}), on_end=save)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert saved == [outcome]
    assert outcome.end == "completed"
    assert received == [signal.SIGTERM]
