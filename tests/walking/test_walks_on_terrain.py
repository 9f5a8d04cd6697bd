"""The balanced walker on ground that it knows, and on a slope that it does not; the thesis' walker on stairs."""

from dataclasses import replace

import numpy as np
import pytest

from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.study.study import load_study

pytestmark = pytest.mark.slow

TEN_DEGREES, SIX_DEGREES, FOUR_DEGREES = np.deg2rad((10.0, 6.0, 4.0)).tolist()


SLOW_WALK = {"controller.balanced.command.points": "[{time: 0.0, forward: 0.8}]"}


@pytest.mark.parametrize(
    "slope, cross_slope", [(TEN_DEGREES, 0.0), (-TEN_DEGREES, 0.0), (0.0, SIX_DEGREES)], ids=["up", "down", "across"]
)
def test_it_walks_on_slopes_at_the_height_of_level_walking(slope: float, cross_slope: float) -> None:
    terrain = f"{{plane: {{slope: {slope}, cross_slope: {cross_slope}}}}}"
    outcome = simulate(load_scenario("walk", {"duration": "5", "terrain": terrain, **SLOW_WALK}))
    assert outcome.end == "completed"
    x, y, z = (outcome.signals[f"com.{axis}_m"].to_numpy() for axis in "xyz")
    assert x[-1] > 2.0
    ground = x * np.tan(slope) + y * np.tan(cross_slope)
    np.testing.assert_allclose(z - ground, 0.94, atol=0.07)


@pytest.mark.parametrize("slope", [FOUR_DEGREES, -FOUR_DEGREES])
def test_it_finds_a_slope_by_touch(slope: float) -> None:
    terrain = f"{{course: {{run_up: 1.0, pieces: [{{slope: {{slope: {slope}, length: 20}}}}]}}}}"
    knowledge = {"controller.balanced.knowledge": "blind"}
    outcome = simulate(load_scenario("walk", {"duration": "7", "terrain": terrain, **SLOW_WALK, **knowledge}))
    assert outcome.end == "completed"
    assert outcome.signals["com.x_m"].to_numpy()[-1] > 3.0


@pytest.mark.parametrize("direction, sign, duration", [("up", 1.0, "7"), ("down", -1.0, "7.5")])
def test_stairs_raise_and_lower_the_body_by_their_height(direction: str, sign: float, duration: str) -> None:
    flight = f"{{direction: {direction}, rise: 0.185, tread: 0.28, number: 4}}"
    stairs = f"{{course: {{run_up: 0.5, pieces: [{{stairs: {flight}}}, flat]}}}}"
    points = "[{time: 0.0, forward: 0.5}]"
    outcome = simulate(
        load_scenario("walk", {"duration": duration, "terrain": stairs, "controller.balanced.command.points": points})
    )
    assert outcome.end == "completed"
    x, z = (outcome.signals[f"com.{axis}_m"].to_numpy() for axis in "xz")
    assert x[-1] > 0.5 + 4 * 0.28
    assert z[-1] - z[0] == pytest.approx(sign * 4 * 0.185, abs=0.06)
    soles = [outcome.signals[f"{side}_sole.z_m"].to_numpy()[-1] for side in ("right", "left")]
    assert min(abs(sole - sign * 4 * 0.185) for sole in soles) < 0.05


@pytest.mark.parametrize("run_up", [0.5, 0.7])
def test_it_steps_over_a_beam_that_begins_in_any_phase_of_a_step(run_up: float) -> None:
    """The trailing foot, which rises behind the hip, leaves the ground steeply: the ankle bends by 35 degrees only."""
    beam = f"{{course: {{run_up: {run_up}, pieces: [{{obstacle: {{height: 0.2, length: 0.6}}}}]}}}}"
    forward = {"controller.balanced.command.points.0.forward": "0.5"}
    outcome = simulate(load_scenario("walk", {"duration": "7", "terrain": beam, **forward}))
    assert outcome.end == "completed"
    heels = [outcome.signals[f"{side}_sole.x_m"].to_numpy()[-1] for side in ("right", "left")]
    assert min(heels) > run_up + 0.35


@pytest.mark.parametrize("speed, seed", [(0.55, 1), (0.45, 2)])
def test_it_walks_down_stairs_that_begin_right_at_the_start(speed: float, seed: int) -> None:
    """The plan knows that the step over the edge takes longer than the one before it."""
    stairs = "{course: {run_up: 0.5, pieces: [{stairs: {direction: down, rise: 0.185, tread: 0.28, number: 4}}, flat]}}"
    start = {"start.joint_noise": "0.01", "start.rate_noise": "0.1", "seed": str(seed)}
    forward = {"controller.balanced.command.points.0.forward": str(speed)}
    outcome = simulate(load_scenario("walk", {"duration": "7.5", "terrain": stairs, **start, **forward}))
    assert outcome.end == "completed"
    ahead = outcome.signals["com.x_m"].to_numpy()[-1]
    assert ahead > 0.5 + 4 * 0.28


TREAD = 0.28
"""0.9 cm shorter than the soles of a man of 110 kg and 1.95 m."""


@pytest.mark.parametrize("direction, sign", [("up", 1.0), ("down", -1.0)])
def test_a_tall_man_walks_on_treads_that_are_a_little_shorter_than_his_soles(direction: str, sign: float) -> None:
    flight = f"{{direction: {direction}, rise: 0.185, tread: {TREAD}, number: 3}}"
    man = {"subject.mass": "110", "subject.stature": "1.95", "duration": "7.5"}
    course = {"terrain": f"{{course: {{run_up: 0.5, pieces: [{{stairs: {flight}}}, flat]}}}}"}
    forward = {"controller.balanced.command.points.0.forward": "0.5"}
    outcome = simulate(load_scenario("walk", {**man, **course, **forward}))
    assert outcome.end == "completed"
    x, z = (outcome.signals[f"com.{axis}_m"].to_numpy() for axis in "xz")
    assert x[-1] > 0.5 + 3 * TREAD
    assert z[-1] - z[0] == pytest.approx(sign * 3 * 0.185, abs=0.06)


def test_steps_that_lift_the_foot_over_a_riser_have_no_long_double_support() -> None:
    """On treads of 25 cm a step takes 0.9 s: with 0.23 s of double support the body was behind, and fell."""
    study = load_study("terrain_treads")
    point = next(p for p in study.points if p["body"] == "default man, treads of 25 cm")
    outcome = simulate(replace(study.scenario_at(point), duration=8.0))
    assert outcome.end == "completed"
    z = outcome.signals["com.z_m"].to_numpy()
    assert z[-1] - z[0] > 3 * 0.18


@pytest.mark.parametrize("direction", ["up", "down"])
def test_it_stands_before_treads_that_are_much_shorter_than_its_soles(direction: str) -> None:
    flight = f"{{direction: {direction}, rise: 0.18, tread: 0.24, number: 3}}"
    course = {"terrain": f"{{course: {{run_up: 0.5, pieces: [{{stairs: {flight}}}, flat]}}}}"}
    forward = {"controller.balanced.command.points.0.forward": "0.5"}
    outcome = simulate(load_scenario("walk", {"duration": "6", **course, **forward}))
    assert outcome.end == "completed"
    assert outcome.signals["com.x_m"].to_numpy()[-1] < 0.5


@pytest.mark.parametrize("direction", ["up", "down"])
def test_on_stairs_it_stops_with_both_feet_on_one_tread(direction: str) -> None:
    flight = f"{{direction: {direction}, rise: 0.17, tread: 0.28, number: 8}}"
    stairs = f"{{course: {{run_up: 0.6, pieces: [{{stairs: {flight}}}, flat]}}}}"
    points = "[{time: 0.0, forward: 0.5}, {time: 4.0, forward: 0.0}]"
    outcome = simulate(
        load_scenario("walk", {"duration": "9.5", "terrain": stairs, "controller.balanced.command.points": points})
    )
    assert outcome.end == "completed"
    signals = {name: outcome.signals[name].to_numpy() for name in outcome.signals.column_names}
    assert abs(signals["com.velocity_x_m_s"][-1]) < 0.05
    assert 0.6 < signals["com.x_m"][-1] < 0.6 + 8 * 0.28
    right, left = (signals[f"{side}_sole.z_m"][-1] for side in ("right", "left"))
    assert right == pytest.approx(left, abs=0.03)


@pytest.mark.parametrize("ground", ["up", "down"])
def test_pushed_backward_on_stairs_it_keeps_its_balance_and_walks_on(ground: str) -> None:
    study = load_study("terrain_stairs_pushes")
    pushed = {"ground": ground, "pushes.given.0.impulse": 10.0, "pushes.given.0.time": 6.0}
    scenario = next(
        scenario
        for scenario in map(study.scenario_at, (point for point in study.points if pushed.items() <= point.items()))
        if scenario.pushes.given[0].direction == pytest.approx(np.pi)
    )
    outcome = simulate(replace(scenario, duration=9.5))
    assert outcome.end == "completed"
    x, t = (outcome.signals[name].to_numpy() for name in ("com.x_m", "time_s"))
    at_the_push = np.searchsorted(t, 6.0)
    assert x[-1] > x[at_the_push] + 0.29


def test_the_held_walk_of_the_thesis_climbs_stairs_with_its_feet_on_the_treads() -> None:
    course = "{course: {run_up: 0.528, pieces: [{stairs: {rise: 0.15, tread: 0.3, number: 2}}, flat]}}"
    scenario = load_scenario("thesis_stairs", {"duration": "3.2", "terrain": course})
    outcome = simulate(scenario)
    assert outcome.end == "completed"
    signals = {name: outcome.signals[name].to_numpy() for name in outcome.signals.column_names}
    for side in ("right", "left"):
        phase, force = signals[f"{side}_foot.phase"], signals[f"{side}_foot.force_z_N"]
        stands = (phase > 0.1) & (phase < 0.3) & (force > 50.0)
        x, y, z = (signals[f"{side}_sole.{axis}_m"][stands] for axis in "xyz")
        np.testing.assert_allclose(z, scenario.terrain.height(np.column_stack((x, y))), atol=0.005)
    # The pelvis is 3 cm lower in walking than in standing, and the energy is m g times the rise.
    rise = signals["com.z_m"][-1] - signals["com.z_m"][0]
    assert rise == pytest.approx(2 * 0.15 - 0.03, abs=0.03)
