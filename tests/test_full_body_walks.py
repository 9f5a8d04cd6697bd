"""Whole walks of the balanced walker obey the command and Newton's law: turn, backward, push, stop, stand."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform

from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.limbs import ARMS, LEGS, PELVIS, Leg
from humanwalk.body.loads import Backpack
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.measures.events import FootEvents, events_of
from humanwalk.measures.path import path_deviation
from humanwalk.measures.signals import matrix
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario, parse_scenario
from humanwalk.sides import SIDES, Side
from humanwalk.walking.commanded_path import PathFollowing

pytestmark = pytest.mark.slow

COMMANDS = {
    "turn": "[{time: 0.5, forward: 0.8, turn: 0.4}, {time: 4.5, forward: 0.8}]",
    "backward": "[{time: 0.5, forward: -0.5}]",
    "push": "[{time: 0.5, forward: 1.0}]",
    "stop": "[{time: 0.5, forward: 0.8}, {time: 3.5, forward: 0.0}]",
}
PUSH_TIME, PUSH_DURATION, IMPULSE = 4.7, 0.1, 30.0
"""Push at the chest, to the left [s, s, N s]."""
STEADY_FROM = 4.0
"""Beginning of steady walking: 0.5 s of standing, 2.5 s of acceleration, one stride [s]."""
STANDING_FROM = 6.5
"""End of the walk `stop`: 2 s of deceleration and two steps after the command [s]."""
MASS = Subject().mass

WALKS = pytest.mark.parametrize("name", COMMANDS)


class Walk:
    """Signals of 8 s of walking at the default time step."""

    def __init__(self, name: str) -> None:
        push = f"{{time: {PUSH_TIME}, duration: {PUSH_DURATION}, impulse: {IMPULSE}, direction: {np.pi / 2}}}"
        text = f"""
            duration: 8.0
            recording: {{signal_period: 0.004}}
            controller: {{balanced: {{command: {{points: {COMMANDS[name]}}}}}}}
            pushes: {{given: [{push if name == "push" else ""}]}}
        """
        self.outcome = simulate(parse_scenario(text))
        self.time = self["time_s"]

    def __getitem__(self, column: str) -> Array:
        return np.asarray(self.outcome.signals[column].to_numpy())

    def vector(self, prefix: str, unit: str) -> Array:
        """Columns x, y, z of a vector, shape (rows, 3)."""
        return matrix(self.outcome.signals, [f"{prefix}{axis}_{unit}" for axis in "xyz"])

    @property
    def orientation(self) -> Array:
        """Unit quaternion w, x, y, z of the pelvis, shape (rows, 4)."""
        wxyz = matrix(self.outcome.signals, [f"pelvis.quaternion_{part}" for part in "wxyz"])
        return np.asarray(wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True))

    @property
    def heading(self) -> Array:
        """Yaw of the pelvis [rad], shape (rows,)."""
        w, x, y, z = self.orientation.T
        return np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2)))

    @property
    def commanded_heading(self) -> Array:
        """Integral of the commanded turn rate [rad], shape (rows,)."""
        return np.cumsum(self["command.turn_rad_s"] * np.diff(self.time, prepend=0.0))

    @property
    def commanded_path(self) -> Array:
        """Integral of the commanded velocity [m], shape (rows, 2)."""
        velocity = self["command.forward_m_s"] * np.exp(1j * self.commanded_heading)
        path = np.cumsum(velocity * np.diff(self.time, prepend=0.0))
        return np.column_stack((path.real, path.imag))

    @property
    def ground_force(self) -> Array:
        """Force of the ground on both feet [N], shape (rows, 3)."""
        return self.vector("right_foot.force_", "N") + self.vector("left_foot.force_", "N")

    def events(self, side: Side) -> FootEvents:
        """Touchdowns and strides of a foot."""
        return events_of(self.outcome.signals, side)


walk_of = cache(Walk)


def mean_over(walk: Walk, column: str, begin: float, end: float = np.inf) -> float:
    return float(walk[column][(walk.time >= begin) & (walk.time < end)].mean())


def center_of_pressure(walk: Walk, leg: Leg, every: int = 10) -> Array:
    """CoP of the loaded foot in the frame of its sole [m], shape (rows, 3)."""
    plant = kinematics_plant(Subject())
    context = plant.CreateDefaultContext()
    side = leg.side.lower()
    positions, cop = walk.vector("pelvis.", "m"), walk.vector(f"{side}_foot.cop_", "m")
    points = []
    for row in np.flatnonzero(walk[f"{side}_foot.loaded"] > 0.5)[::every]:
        for joint in leg.chain:
            plant.GetJointByName(joint).set_angle(context, walk[f"{joint}.angle_rad"][row])
        X_WP = RigidTransform(Quaternion(walk.orientation[row]), positions[row])
        plant.SetFloatingBaseBodyPoseInWorldFrame(context, plant.GetBodyByName(PELVIS), X_WP)
        X_WS = plant.GetFrameByName(leg.sole).CalcPoseInWorld(context)
        points.append(X_WS.inverse() @ cop[row])
    return np.array(points)


@WALKS
def test_the_walker_stays_up_and_every_program_is_solved(name: str) -> None:
    walk = walk_of(name)
    assert walk.outcome.end == "completed"
    assert walk["qp.failures"].max() < 0.5
    assert walk["com.z_m"].min() > 0.9 * walk["com.z_m"][0]


@WALKS
def test_the_feet_carry_the_weight(name: str) -> None:
    walk = walk_of(name)
    strides = walk.events("Right").strides
    begin, end = strides[0][0], strides[-1][1]
    rise = walk["com.velocity_z_m_s"][end] - walk["com.velocity_z_m_s"][begin]
    carried = walk.ground_force[begin:end, 2].mean() - MASS * rise / (walk.time[end] - walk.time[begin])
    assert len(strides) >= 3
    assert carried == pytest.approx(MASS * GRAVITY, rel=0.02)


@WALKS
@pytest.mark.parametrize("leg", LEGS.values(), ids=lambda leg: leg.side)
def test_the_center_of_pressure_stays_under_the_sole(name: str, leg: Leg) -> None:
    x, y, _ = center_of_pressure(walk_of(name), leg).T
    heel, toe = SOLE_PARTS[0].x[0], SOLE_PARTS[-1].x[1]
    assert heel < x.min() < 0.0 < 0.1 < x.max() < toe
    assert np.abs(y).max() < 0.5 * max(part.width for part in SOLE_PARTS)


@pytest.mark.parametrize("name", ["turn", "backward", "stop"])
def test_the_walker_follows_the_commanded_path(name: str) -> None:
    walk = walk_of(name)
    com = walk.vector("com.", "m")[::20, :2]
    deviation = [np.linalg.norm(walk.commanded_path - point, axis=1).min() for point in com]
    # The center of mass sways by 4 cm.
    assert max(deviation) < 0.09
    nominal = walk.commanded_path[np.searchsorted(walk.time, walk.time[-1] - PathFollowing.lag)]
    # A walker that stops does not make up for what it is behind.
    assert np.linalg.norm(com[-1] - nominal) < (0.25 if name == "stop" else 0.1)


def test_turning_ends_at_the_commanded_heading() -> None:
    walk = walk_of("turn")
    last_stride = slice(*walk.events("Right").strides[-1])
    assert np.degrees(walk.commanded_heading[-1]) == pytest.approx(91.7, abs=0.1)
    assert np.degrees(walk.heading[last_stride].mean()) == pytest.approx(91.7, abs=5.0)
    assert mean_over(walk, "com.velocity_y_m_s", 6.5) == pytest.approx(0.8, abs=0.08)


def test_walking_backward_lands_each_foot_behind_the_other() -> None:
    walk = walk_of("backward")
    landings = sorted((row, side) for side in SIDES for row in walk.events(side).touchdowns)
    assert len(landings) >= 8
    assert all(side != following for (_, side), (_, following) in pairwise(landings))
    x = [walk[f"{side.lower()}_sole.x_m"][row] for row, side in landings]
    assert np.diff(x).max() < -0.1
    assert mean_over(walk, "com.velocity_x_m_s", STEADY_FROM) == pytest.approx(-0.5, abs=0.05)


def test_a_push_adds_its_impulse_to_the_momentum() -> None:
    walk = walk_of("push")
    before, after = np.searchsorted(walk.time, [PUSH_TIME - 0.0025, PUSH_TIME + PUSH_DURATION + 0.0025])
    momentum = MASS * walk["com.velocity_y_m_s"]
    # A recorded force is that of the time step that ends at the sample.
    force = walk.ground_force[before + 1 : after + 1, 1]
    of_ground = np.sum(force * np.diff(walk.time[before : after + 1]))
    assert momentum[after] - momentum[before] - of_ground == pytest.approx(IMPULSE, rel=0.02)
    assert momentum[after] - momentum[before] > 0.8 * IMPULSE


def test_after_a_push_the_walker_steps_sideways_and_walks_on() -> None:
    walk = walk_of("push")
    left_at_push = walk["com.y_m"][np.searchsorted(walk.time, PUSH_TIME)]
    assert walk["com.y_m"].max() > left_at_push + 0.2
    assert np.degrees(walk.heading[-1]) == pytest.approx(0.0, abs=5.0)
    assert mean_over(walk, "com.velocity_x_m_s", 7.0) == pytest.approx(1.0, abs=0.15)
    assert abs(mean_over(walk, "com.velocity_y_m_s", 7.0)) < 0.2


def test_stopping_ends_in_standing_on_both_feet() -> None:
    walk = walk_of("stop")
    assert mean_over(walk, "com.velocity_x_m_s", 3.0, 3.5) == pytest.approx(0.8, abs=0.1)
    standing = walk.time >= STANDING_FROM
    assert np.abs(walk.vector("com.velocity_", "m_s")[standing]).max() < 0.03
    for side in SIDES:
        assert walk.events(side).touchdown_times.max() < STANDING_FROM
        share = walk[f"{side.lower()}_foot.force_z_N"][standing] / (MASS * GRAVITY)
        assert 0.3 < share.min() < share.max() < 0.7


@pytest.mark.parametrize("fast", [1.6, 1.8])
def test_the_feet_of_a_fast_walk_do_not_cross(fast: float) -> None:
    """Decision 0050: each step was narrower than the one before, until the feet crossed and the walker fell."""
    outcome = simulate(
        parse_scenario(f"""
        duration: 14.0
        controller: {{balanced: {{command: {{points: [{{time: 0.5, forward: {fast}}}]}}}}}}
    """)
    )
    assert outcome.end == "completed"
    time, speed, right, left = (
        outcome.signals[name].to_numpy() for name in ("time_s", "com.velocity_x_m_s", "right_sole.y_m", "left_sole.y_m")
    )
    steady = time >= 8.0
    assert speed[steady].mean() == pytest.approx(fast, rel=0.08)
    landings = [row for side in SIDES for row in events_of(outcome.signals, side).touchdowns if steady[row]]
    assert len(landings) > 10
    assert min(left[row] - right[row] for row in landings) > 0.05


OUT_AND_BACK = "{time: 0.5, forward: 0.8}, {time: 3}, {time: 5, turn: 0.4}, {time: 12.854}, {time: 13.5, forward: 0.8}"
"""Half a turn on the spot."""


@pytest.mark.parametrize(
    ("duration", "points"),
    [(9.0, "{time: 1, forward: 0.5, sideways: 0.3}"), (17.0, OUT_AND_BACK)],
    ids=["to the left of the heading", "out and back"],
)
def test_the_walker_stays_on_a_path_that_is_not_straight_ahead(duration: float, points: str) -> None:
    """With steps of 0.65 s to the side it fell; on the way back it turned to the way out, and fell."""
    outcome = simulate(
        parse_scenario(f"{{duration: {duration}, controller: {{balanced: {{command: {{points: [{points}]}}}}}}}}")
    )
    assert outcome.end == "completed"
    deviation = path_deviation(
        outcome.signals, np.ones(outcome.signals.num_rows, dtype=bool), outcome.scenario.controller.command
    )
    assert deviation is not None
    assert deviation < 0.12


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0], ids=["forward", "left", "backward"])
def test_a_standing_body_that_is_pushed_steps_and_stands_again(degrees: float) -> None:
    push = f"{{time: 1.0, impulse: {2.0 * IMPULSE}, direction: {np.deg2rad(degrees)}}}"
    outcome = simulate(
        parse_scenario(f"""
        duration: 6.0
        controller: {{balanced: {{command: {{points: []}}}}}}
        pushes: {{given: [{push}]}}
    """)
    )
    assert outcome.end == "completed"
    signals = {name: outcome.signals[name].to_numpy() for name in outcome.signals.column_names}
    way = [signals[f"com.{axis}_m"][-1] - signals[f"com.{axis}_m"][0] for axis in "xy"]
    assert np.dot(way, (np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees)))) > 0.2
    assert np.hypot(signals["com.velocity_x_m_s"][-1], signals["com.velocity_y_m_s"][-1]) < 0.05
    forces = [signals[f"{side}_foot.force_z_N"][-1] for side in ("right", "left")]
    assert min(forces) > 0.2 * MASS * GRAVITY


@WALKS
def test_a_walker_that_carries_nothing_feels_no_load(name: str) -> None:
    assert not walk_of(name)["felt_load.mass_kg"].any()


def walk_with(load: str) -> dict[str, Array]:
    """Signals of 8 s of walking at 1 m/s with a load."""
    outcome = simulate(
        parse_scenario(f"""
        duration: 8.0
        subject: {{loads: [{load}]}}
        controller: {{balanced: {{command: {{points: [{{time: 0.5, forward: 1.0}}]}}}}}}
    """)
    )
    assert outcome.end == "completed"
    return {name: outcome.signals[name].to_numpy() for name in outcome.signals.column_names}


def test_a_walker_feels_the_load_that_its_model_lacks() -> None:
    """Its mass, where it is on the back, and that the walk has to carry it."""
    signals = walk_with("{backpack: {mass: 15.0, known: false}}")
    steady = signals["time_s"] >= STEADY_FROM
    assert signals["felt_load.mass_kg"][steady] == pytest.approx(15.0, rel=0.1)
    (bag,) = Backpack(15.0).parts(Subject().body)
    assert signals["felt_load.x_m"][steady].mean() == pytest.approx(bag.center[0], abs=0.03)
    assert signals["felt_load.y_m"][steady].mean() == pytest.approx(0.0, abs=0.02)
    assert signals["com.velocity_x_m_s"][steady].mean() == pytest.approx(1.0, abs=0.1)
    assert np.abs(signals["com.y_m"]).max() < 0.1


@pytest.mark.parametrize("load", ["{mass: 15.0, side: Left}", "{mass: 8.0, side: Right, known: false}"])
def test_a_heavy_hand_hangs_still_and_the_walker_is_as_fast_as_without(load: str) -> None:
    signals = walk_with(f"{{suitcase: {load}}}")
    steady = signals["time_s"] >= STEADY_FROM
    assert signals["com.velocity_x_m_s"][steady].mean() == pytest.approx(1.0, abs=0.1)
    assert np.abs(signals["com.y_m"]).max() < 0.2
    right, left = (np.ptp(signals[f"{arm.shoulder_flexion}.angle_rad"][steady]) for arm in ARMS.values())
    assert left < 0.5 * right if "Left" in load else right < 0.5 * left
    assert signals["felt_load.mass_kg"][steady].mean() == pytest.approx(8.0 if "known" in load else 0.0, rel=0.1)


def test_a_walker_with_a_passive_ankle_walks_from_a_disturbed_start() -> None:
    """The force on a foot that its spring turns is not limited; with the limit this walk ended at 7.8 s."""
    fields = {"start.joint_noise": "0.01", "seed": "6", "duration": "9.0"}
    assert simulate(load_scenario("ankle_prosthesis", fields)).end == "completed"
