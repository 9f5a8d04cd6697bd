"""The mean stride of a recorded walk: its touchdowns, step duration, speed and joint angles over the gait cycle."""

from __future__ import annotations

import cmath
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.motion.gait_curves import GaitCurves
from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.numerics import Array, Indices
from humanwalk.quantity import ParameterError, printable

RATE = 200.0
"""Samples per second at which a recording is searched for touchdowns [1/s]."""

MAX_DURATION = 3600.0
"""Longest recording [s]: few numbers may stand for a time that is too long to be searched."""

MIN_STRIDE = 0.6
"""Shortest stride that is a walk [s]."""

MAX_STRIDE = 1.5
"""Longest stride that counts, over the median (our choice): people's strides differ by a few percent."""

MIN_DISPLACEMENT = 0.5
"""Least displacement of the pelvis in a stride over that of the ankle relative to the pelvis: 1.5 in a walk over the
ground, where the foot stands for 60 % of a stride, and 0 on a treadmill (our choice)."""

MAX_HEADING = np.deg2rad(20.0)
"""Largest angle between a straight walk and x [rad] (our choice); speed and angles are those along the walk."""

POINTS = 100
"""Points of the gait cycle at which strides are averaged."""


class RecordedGait(NamedTuple):
    """A recorded walk.

    Attributes:
        curves: Joint angles over the gait cycle, the mean of all strides of each leg.
        speed: Mean forward speed over the strides [m/s].
        step: Mean duration of a step [s].
    """

    curves: GaitCurves
    speed: float
    step: float


def recorded_gait(motion: RecordedMotion, subject: Subject, name: str) -> RecordedGait:
    """The mean stride of a recording.

    Touchdown is where the ankle is farthest ahead of the pelvis (Zeni, Richards, Higginson 2008, Gait Posture 27(4)
    710-714).

    Args:
        motion: A walk along x, with its pelvis path.
        subject: Whose body it moves.
        name: Of the recording, for messages.

    Raises:
        ParameterError: it is too long, has no two touchdowns of each leg, or does not go forward over the ground.
    """
    plant = kinematics_plant(subject)
    joints = JointMap.of(plant)
    end = float(motion.time[-1])
    if end > MAX_DURATION:
        raise ParameterError(
            f"{printable(name)}: {end:g} s long; allowed: up to {MAX_DURATION:g} s; shorten it, or give times in s"
        )
    time = np.arange(0.0, end, 1.0 / RATE)
    angles = motion.angles_at(time)
    cycles, durations, displacements = [], [], []
    reach = 0.0
    for side in SIDES:
        hip, knee, _ = columns = [joints.names.index(joint) for joint in LEGS[side].sagittal]
        ahead = _forward_reach(angles[:, hip], angles[:, knee], subject)
        reach = max(reach, float(np.ptp(ahead)))
        touchdowns = _touchdowns(ahead)
        if touchdowns.size < 2:
            raise ParameterError(
                f"{printable(name)}: {touchdowns.size} touchdowns of the {side.lower()} foot; allowed: at least 2, of "
                f"strides of {MIN_STRIDE:g} s or longer; record a longer walk"
            )
        strides = _strides(touchdowns)
        cycles.append(np.mean([_over_cycle(angles[begin : end + 1, columns]) for begin, end in strides], axis=0))
        ends = [(time[begin], time[end]) for begin, end in strides]
        durations += [after - before for before, after in ends]
        displacements += [_position(motion, after) - _position(motion, before) for before, after in ends]
    stride, displacement = float(np.mean(durations)), complex(np.mean(displacements))
    _require_forward(displacement, stride, reach, name)
    speed = abs(displacement) / stride
    curves = GaitCurves.through(np.array([speed]), np.stack(cycles, axis=1)[None])
    return RecordedGait(curves, speed, 0.5 * stride)


def _require_forward(displacement: complex, stride: float, reach: float, name: str) -> None:
    """Raise ParameterError unless the pelvis moves along x and over the ground.

    Args:
        displacement: Of the pelvis in a stride [m].
        stride: Duration of a stride [s].
        reach: Distance that the ankle moves relative to the pelvis [m].
        name: Of the recording.
    """
    if not displacement.real > 0.0:
        raise ParameterError(
            f"{printable(name)}: the pelvis moves at {displacement.real / stride:.2g} m/s; allowed: forward, along x; "
            "turn the recording"
        )
    if abs(displacement) < MIN_DISPLACEMENT * reach:
        raise ParameterError(
            f"{printable(name)}: in a stride the pelvis moves by {abs(displacement):.2g} m, and the ankle by "
            f"{reach:.2g} m relative to it; allowed: a walk over the ground; leave out the path of a treadmill"
        )
    heading = abs(cmath.phase(displacement))
    if heading > MAX_HEADING:
        raise ParameterError(
            f"{printable(name)}: the pelvis moves {np.degrees(heading):.0f} deg from x; allowed: up to "
            f"{np.degrees(MAX_HEADING):.0f} deg; turn the recording"
        )


def _position(motion: RecordedMotion, time: float) -> complex:
    """Position of the pelvis over the ground, x + iy [m]."""
    x, y, _ = motion.pelvis(time).X_WP.translation()
    return complex(x, y)


def _strides(touchdowns: Indices) -> list[tuple[int, int]]:
    """First and last rows of the strides; one much longer than the others has a stop in it."""
    limit = MAX_STRIDE * np.median(np.diff(touchdowns))
    return [(begin, end) for begin, end in pairwise(touchdowns.tolist()) if end - begin <= limit]


def _over_cycle(values: Array) -> Array:
    """Values of the rows of a stride at `POINTS` points of the gait cycle, shape (POINTS, columns)."""
    phase, wanted = np.linspace(0.0, 1.0, len(values)), np.arange(POINTS) / POINTS
    return np.column_stack([np.interp(wanted, phase, column) for column in values.T])


def _forward_reach(hip: Array, knee: Array, subject: Subject) -> Array:
    """Distance of the ankle ahead of the hip [m] with an upright pelvis, shape (rows,)."""
    origins, leg = subject.skeleton.origins, LEGS["Right"]
    thigh, shank = (
        float(origins[upper][2] - origins[lower][2])
        for upper, lower in ((leg.thigh, leg.shank), (leg.shank, leg.hindfoot))
    )
    reach: Array = thigh * np.sin(hip) + shank * np.sin(hip - knee)
    return reach


def _touchdowns(reach: Array) -> Indices:
    """Rows where the foot is farthest ahead, one per stride."""
    from scipy.signal import find_peaks

    middle = 0.5 * (reach.max() + reach.min())
    # In standing small movements have peaks, too.
    prominence = 0.5 * np.ptp(reach)
    rows: Indices = find_peaks(reach, height=middle, distance=round(MIN_STRIDE * RATE), prominence=prominence)[0]
    return rows
