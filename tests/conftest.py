"""What many tests look at: the reference human, as data and as a plant for kinematics."""

import base64
import socket
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pytest
from pydrake.geometry import Meshcat
from pydrake.multibody.plant import MultibodyPlant
from scipy.spatial.transform import Rotation

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.body.pelvic_plane import PELVIC_TILT
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.control.inverse_kinematics import LegKinematics
from humanwalk.diagrams.walker import make_walker
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.normative import CYCLE
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.measures.curves import CURVES
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.run.live_view import is_lost
from humanwalk.run.recorder import recorded_signals
from humanwalk.scenario import load_scenario
from humanwalk.sides import SIDES, Side, other_side

PERIOD = 0.005
WEIGHT = 70.0 * GRAVITY
DUTY, STRIDE, LENGTH, WIDTH = 0.6, 1.0, 1.3, 0.12


def of_people(name: str, phase: Any) -> Array:
    """People's mean of a curve at a free speed, at shares of the gait cycle."""
    mean = CURVES[name].people("free").mean
    # The end of the cycle meets its beginning.
    return np.interp(100.0 * (phase % 1.0), CYCLE, mean + CYCLE / 100.0 * (mean[0] - mean[-1]))


def hump_force(share: Array, first: float, dip: float, second: float) -> Array:
    """Vertical force over the share of a stance [body weights]: up, down, up and down, by half cosines.

    It lands and lifts at once, so that the stance is as long as it was made.
    """
    places, values = [0.0, 0.25, 0.5, 0.75, 1.0], [0.2, first, dip, second, 0.2]
    piece = np.clip(np.searchsorted(places, share, side="right") - 1, 0, 3)
    low, high = np.take(values, piece), np.take(values, piece + 1)
    return low + (high - low) * (1 - np.cos(np.pi * (4 * share - piece))) / 2


def make_walk(
    duration: float = 8.0,
    heading: float = 0.0,
    standing: bool = False,
    humps: tuple[float, float, float] = (1.1, 0.8, 1.1),
    **more: Any,
) -> pa.Table:
    """A walk of people's mean angles; the left leg is half a stride late; the pelvis is the right's."""
    time = PERIOD * np.arange(round(duration / PERIOD) + 1)
    data = {TIME: time}
    for side, lag, y in zip(SIDES, (0.0, 0.5), (-WIDTH / 2, WIDTH / 2), strict=True):
        cycle = time / STRIDE - lag
        phase = cycle % 1.0
        down = (phase < DUTY - 1e-9) | standing
        name = side.lower()
        ahead = LENGTH * (np.floor(cycle) + np.clip((phase - DUTY) / (1 - DUTY), 0.0, 1.0) + lag)
        data[f"{name}_sole.x_m"] = np.cos(heading) * ahead
        data[f"{name}_sole.y_m"] = y + np.sin(heading) * ahead
        data[f"{name}_foot.force_z_N"] = np.where(down, WEIGHT * hump_force(np.minimum(phase / DUTY, 1.0), *humps), 0.0)
        if standing:
            data[f"{name}_foot.force_z_N"] = np.full_like(time, WEIGHT / 2)
        data[f"{name}_sole.z_m"] = np.zeros_like(time)
        # From the heel to the toes.
        for axis, way in zip("xyz", (np.cos(heading), np.sin(heading), 0.0), strict=True):
            data[f"{name}_foot.cop_{axis}_m"] = data[f"{name}_sole.{axis}_m"] + way * (0.2 * phase / DUTY - 0.04)
        leg = LEGS[side]
        for joint, angle in (
            (leg.hip_flexion, np.radians(of_people("hip", phase)) - PELVIC_TILT),
            (leg.hip_abduction, np.radians(-of_people("hip adduction", phase))),
            (leg.hip_rotation, np.radians(of_people("hip rotation", phase))),
            (leg.knee, np.radians(of_people("knee", phase))),
            (leg.ankle, np.radians(of_people("ankle", phase))),
            (leg.ankle_inversion, np.zeros_like(time)),
            (leg.ankle_rotation, np.zeros_like(time)),
        ):
            data[f"{joint}.angle_rad"] = angle
        for joint in leg.sagittal:
            data[f"{joint}.velocity_rad_s"] = np.full_like(time, 1.0)
            data[f"{joint}.torque_N_m"] = 35.0 * np.sin(2 * np.pi * phase)
    phase = time / STRIDE
    rotation, obliquity, tilt = (of_people(f"pelvis {name}", phase) for name in ("rotation", "obliquity", "tilt"))
    # Right side forward turns left, right side up rolls the left one down, forward tilt pitches about the y axis.
    tilt = tilt - np.degrees(PELVIC_TILT)
    turn = Rotation.from_euler("ZXY", np.column_stack([rotation, -obliquity, tilt]), degrees=True)
    data |= zip((f"pelvis.quaternion_{axis}" for axis in "xyzw"), turn.as_quat().T, strict=True)
    data["com.x_m"] = LENGTH * time / STRIDE
    data["com.y_m"] = 0.02 * np.sin(2 * np.pi * phase)
    data["com.z_m"] = 0.9 + 0.018 * np.sin(4 * np.pi * phase)
    return pa.table(data | more)


@pytest.fixture(scope="session")
def plant() -> MultibodyPlant:
    """The finalized default human; it holds no state, tests make contexts of their own."""
    return kinematics_plant(Subject())


@pytest.fixture(scope="session")
def skeleton() -> Skeleton:
    return Subject().skeleton


@pytest.fixture(scope="session")
def joints(plant: MultibodyPlant) -> JointMap:
    return JointMap.of(plant)


@pytest.fixture(scope="session")
def legs(plant: MultibodyPlant) -> dict[Side, LegKinematics]:
    """The chain from pelvis to sole of each leg."""
    return {side: LegKinematics(plant, PELVIS, leg.sole, leg.chain) for side, leg in LEGS.items()}


@pytest.fixture(scope="session")
def gait(skeleton: Skeleton) -> WalkingGait:
    """The thesis' walk: L 0.5 m, H 0.2 m, offset 5 cm, 1.4 m/s."""
    return WalkingGait(FootPathParameters(), skeleton.hip_half_width, SpeedRamp(1.4, 0.365))


class Footstep(NamedTuple):
    """One stance of one foot: position over ground (3,) [m] and times [s]; lift_off is inf if it never happens."""

    side: str
    position: np.ndarray
    touchdown: float
    lift_off: float


def footsteps_of(gait: WalkingGait, until: float) -> list[Footstep]:
    """The stances of a `WalkingGait` that begin before a time [s], those of standing first: an independent oracle."""
    p, time = gait.parameters, gait.ramp.time_at
    swing, stand = gait.first_swing, other_side(gait.first_swing)

    def at(x: float, side: Side) -> Array:
        return np.array([x, gait.hip_half_width if side == "Left" else -gait.hip_half_width, 0.0])

    steps = [
        Footstep(swing, at(0.0, swing), 0.0, 0.0),
        Footstep(stand, at(0.0, stand), 0.0, time(p.step_length / 2)),
    ]
    walked, side = gait.start_distance, swing
    while time(walked) < until:
        place = at((len(steps) - 1) * p.walked_step, side)
        steps.append(Footstep(side, place, time(walked), time(walked + p.step_length)))
        walked, side = walked + p.walked_step, other_side(side)
    return steps


@pytest.fixture(scope="session")
def footsteps() -> Callable[..., Any]:
    """The stances of a gait, see `footsteps_of`."""
    return footsteps_of


@pytest.fixture(scope="session")
def walk() -> Callable[..., Any]:
    """Makes the signals of a walk that moves as people do, see `make_walk`."""
    return make_walk


@pytest.fixture(scope="session")
def columns(joints: JointMap) -> tuple[str, ...]:
    """Every column that the walkers of the scenarios thesis and stand record, once."""
    walkers = [make_walker(load_scenario(name)) for name in ("thesis", "stand")]
    names = (column for walker in walkers for signal in recorded_signals(walker, joints) for column in signal.columns)
    return tuple(dict.fromkeys(names))


def send_malformed(meshcat: Meshcat) -> None:
    """Send what is no msgpack as a web page can, and return when Meshcat's thread has ended."""
    port = meshcat.port()
    request = ["GET / HTTP/1.1", f"Host: localhost:{port}", "Origin: http://evil.example", "Upgrade: websocket"]
    request += ["Connection: Upgrade", f"Sec-WebSocket-Key: {base64.b64encode(bytes(16)).decode()}"]
    request += ["Sec-WebSocket-Version: 13", "", ""]
    with socket.create_connection(("localhost", port)) as connection:
        connection.sendall("\r\n".join(request).encode())
        assert b"101" in connection.recv(1000)
        # A final binary frame of two bytes with an empty mask; 0xc1 is never used in msgpack.
        connection.sendall(b"\x82\x82" + bytes(4) + b"\xc1\xff")
        while not is_lost(meshcat):
            time.sleep(0.01)


@pytest.fixture(scope="session")
def lose() -> Callable[[Meshcat], None]:
    """Ends a live view, see `send_malformed`."""
    return send_malformed
