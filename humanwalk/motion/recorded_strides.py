"""The mean stride of a recorded walk: its touchdowns, step duration, speed and joint angles over the gait cycle."""

from __future__ import annotations

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
        ParameterError: it is too long, has no two touchdowns of each leg, or does not go forward.
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
    strides, cycles, distances = [], [], []
    for side in SIDES:
        hip, knee, _ = columns = [joints.names.index(joint) for joint in LEGS[side].sagittal]
        touchdowns = _touchdowns(_forward_reach(angles[:, hip], angles[:, knee], subject))
        if touchdowns.size < 2:
            raise ParameterError(
                f"{printable(name)}: {touchdowns.size} touchdowns of the {side.lower()} foot; allowed: at least 2, of "
                f"strides of {MIN_STRIDE:g} s or longer; record a longer walk"
            )
        phase = np.interp(np.arange(time.size), touchdowns, np.arange(touchdowns.size), left=-1.0, right=-1.0)
        wanted = np.arange(POINTS * (touchdowns.size - 1)) / POINTS
        inside = phase >= 0.0
        values = np.column_stack([np.interp(wanted, phase[inside], angles[inside, column]) for column in columns])
        cycles.append(values.reshape(-1, POINTS, len(columns)).mean(axis=0))
        strides.append(np.diff(time[touchdowns]))
        first, last = (motion.pelvis(time[row]).X_WP.translation()[0] for row in touchdowns[[0, -1]])
        distances.append(last - first)
    durations = np.concatenate(strides)
    stride, speed = float(durations.mean()), float(sum(distances) / durations.sum())
    if not speed > 0.0:
        raise ParameterError(
            f"{printable(name)}: the pelvis moves at {speed:.2g} m/s; allowed: forward, along x; turn the recording"
        )
    curves = GaitCurves.through(np.array([speed]), np.stack(cycles, axis=1)[None])
    return RecordedGait(curves, speed, 0.5 * stride)


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
    rows: Indices = find_peaks(reach, height=middle, distance=round(MIN_STRIDE * RATE))[0]
    return rows
