"""Curves over the gait cycle as gait laboratories define them: angles, internal moments and powers of a leg.

Pelvic tilt and hip flexion are those of the anatomical pelvic plane (`humanwalk.body.pelvic_plane`), not of the model's
pelvis frame. The pelvis turns by rotation, obliquity, tilt in this order: Baker (2001), Gait Posture 13:1-6. Moments
are the torques of the sagittal joints per body mass, powers these torques times the rates of the same joints.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from humanwalk.body import Side
from humanwalk.body.limbs import LEGS, Leg
from humanwalk.body.pelvic_plane import PELVIC_TILT
from humanwalk.gait.normative import CYCLE, PEOPLE_LEG, Band, SpeedGroup, moment_scale, people, power_scale
from humanwalk.measures.events import FootEvents
from humanwalk.measures.orientation import heading_rotation, pelvis_rotation, sole_rotation
from humanwalk.numerics import Array

JOINTS: dict[str, Callable[[Leg], str]] = {
    "hip": attrgetter("hip_flexion"),
    "knee": attrgetter("knee"),
    "ankle": attrgetter("ankle"),
}
"""The sagittal joint of a leg by its name in ANGLES; positive in flexion and dorsiflexion."""

TERMINAL_STANCE = (31.0, 50.0)
"""From heel rise to touchdown of the other foot [% of the gait cycle]: Perry and Burnfield (2010), chapter 2."""


def joint_signal(signals: pa.Table, joint: str, side: Side, quantity: str) -> Array:
    """A signal of one of JOINTS, shape (rows,): its angle_rad, velocity_rad_s or torque_N_m."""
    values: Array = signals[f"{JOINTS[joint](LEGS[side])}.{quantity}"].to_numpy()
    return values


class LegRecord(NamedTuple):
    """A record of a walk, relative to one leg.

    Attributes:
        signals: the record.
        side: of the leg.
        mass: body mass [kg].
        facing: heading of the walk at every row (`Directions.facing`), or 1 for a walk along x.
    """

    signals: pa.Table
    side: Side
    mass: float
    facing: Array | complex


@dataclass(frozen=True)
class Curve:
    """A curve over the gait cycle that is compared with people's.

    Attributes:
        positive: its positive sense.
        unit: of its values.
        quantity: its name in the human data.
        values: its values in a record, shape (rows,).
        people_scale: factor from the unit of the human data to `unit`.
        leg_scale: factor from the people of the human data to dynamically similar bodies with a leg length [m].
    """

    positive: str
    unit: str
    quantity: str
    values: Callable[[LegRecord], Array]
    people_scale: float = 1.0
    leg_scale: Callable[[float], float] = lambda leg: 1.0

    def of(self, signals: pa.Table, side: Side, mass: float, facing: Array | complex) -> Array:
        """Its values in a record, shape (rows,); see `LegRecord`."""
        return self.values(LegRecord(signals, side, mass, facing))

    def people(self, group: SpeedGroup, leg: float = PEOPLE_LEG) -> Band:
        """People's curve in this unit, for a leg length [m]."""
        band, scale = people(self.quantity, group), self.people_scale * self.leg_scale(leg)
        return Band(scale * band.mean, scale * band.sd)


def _joint(joint: Callable[[Leg], str], factor: float, zero: float, walk: LegRecord) -> Array:
    angle: Array = walk.signals[f"{joint(LEGS[walk.side])}.angle_rad"].to_numpy()
    return np.degrees(factor * angle + zero)


def _pelvis(axis: int, left: int, right: int, zero: float, walk: LegRecord) -> Array:
    rotation = heading_rotation(walk.facing).inv() * pelvis_rotation(walk.signals)
    angles: Array = rotation.as_euler("ZXY")[:, axis]
    return np.degrees(angles * (left if walk.side == "Left" else right) + zero)


def _progression(walk: LegRecord) -> Array:
    forward = (heading_rotation(walk.facing).inv() * sole_rotation(walk.signals, walk.side)).apply((1.0, 0.0, 0.0))
    angle: Array = np.degrees(np.arctan2(forward[:, 1], forward[:, 0]))
    return angle if walk.side == "Right" else -angle


def _moment(joint: str, walk: LegRecord) -> Array:
    return -joint_signal(walk.signals, joint, walk.side, "torque_N_m") / walk.mass


def _power(joint: str, walk: LegRecord) -> Array:
    torque, rate = (joint_signal(walk.signals, joint, walk.side, what) for what in ("torque_N_m", "velocity_rad_s"))
    return torque * rate / walk.mass


ANGLES = {
    "hip": Curve("flexion", "deg", "hip_flexion_deg", partial(_joint, JOINTS["hip"], 1.0, PELVIC_TILT)),
    "knee": Curve("flexion", "deg", "knee_flexion_deg", partial(_joint, JOINTS["knee"], 1.0, 0.0)),
    "ankle": Curve("dorsiflexion", "deg", "ankle_dorsiflexion_deg", partial(_joint, JOINTS["ankle"], 1.0, 0.0)),
    "hip adduction": Curve(
        "adduction", "deg", "hip_adduction_deg", partial(_joint, attrgetter("hip_abduction"), -1.0, 0.0)
    ),
    "hip rotation": Curve(
        "internal", "deg", "hip_internal_rotation_deg", partial(_joint, attrgetter("hip_rotation"), 1.0, 0.0)
    ),
    "foot progression": Curve("internal", "deg", "foot_internal_progression_deg", _progression),
    "pelvis tilt": Curve("forward", "deg", "pelvis_anterior_tilt_deg", partial(_pelvis, 2, 1, 1, PELVIC_TILT)),
    "pelvis obliquity": Curve("side up", "deg", "pelvis_up_obliquity_deg", partial(_pelvis, 1, 1, -1, 0.0)),
    "pelvis rotation": Curve("side forward", "deg", "pelvis_internal_rotation_deg", partial(_pelvis, 0, -1, 1, 0.0)),
}
"""Angles by name [deg].

The thigh flexes about the lateral axis of the pelvis before its other turns, and the pelvis tilts about the same axis
after its others: both angles of the pelvic plane are those of the pelvis frame plus a constant.
"""

MOMENTS = {
    f"{joint} moment": Curve(
        sense, "N m/kg", f"{joint}_{sense}_moment_Nmm_per_kg", partial(_moment, joint), 1e-3, moment_scale
    )
    for joint, sense in (("hip", "extensor"), ("knee", "extensor"), ("ankle", "plantarflexor"))
}
"""Internal moments of the sagittal joints by name."""

POWERS = {
    f"{joint} power": Curve(
        "delivered", "W/kg", f"{joint}_power_W_per_kg", partial(_power, joint), leg_scale=power_scale
    )
    for joint in JOINTS
}
"""Powers of the sagittal joints by name."""

CURVES = ANGLES | MOMENTS | POWERS


def over_strides(foot: FootEvents, values: Array) -> Array:
    """A signal over every whole stride of a leg at the points of CYCLE, shape (strides, 101)."""
    time = foot.time
    strides = [np.interp(time[a] + CYCLE / 100.0 * (time[b] - time[a]), time, values) for a, b in foot.strides]
    return np.array(strides).reshape(-1, CYCLE.size)


def late_stance_knee(strides: Array) -> Array:
    """Least knee flexion in terminal stance [deg], from knee flexion over strides, (strides, 101) -> (strides,)."""
    begin, end = TERMINAL_STANCE
    least: Array = strides[:, (begin <= CYCLE) & (end >= CYCLE)].min(axis=1)
    return least
