"""Upright standing: how tall a body with unequal legs and stiff joints stands, and how it bends its knees."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.impairments import NO_TORQUE
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.numerics.scalars import clip
from humanwalk.sides import SIDES, Side

SAME_HEIGHT = 1e-9
"""Difference of the legs that is not one [m]."""


class Upright(NamedTuple):
    """Heights of a body that stands on the shorter leg, its knee as straight as its range allows.

    Attributes:
        com_height: Center of mass above the sole [m].
        ankle_height: Ankle above the sole [m].
        leg_length: Distance of hip and ankle [m].
    """

    com_height: float
    ankle_height: float
    leg_length: float


def upright(plant: MultibodyPlant) -> Upright:
    """Return the heights of a finalized model of the body, which by default is upright with straight legs."""
    context = plant.CreateDefaultContext()
    com = float(plant.CalcCenterOfMassPositionInWorld(context)[2])
    found = []
    for side in SIDES:
        leg = LEGS[side]
        hip, knee, ankle, sole = (
            float(plant.GetFrameByName(frame).CalcPoseInWorld(context).translation()[2])
            for frame in (leg.thigh, leg.shank, leg.hindfoot, leg.sole)
        )
        flexion = max(float(plant.GetJointByName(leg.knee).position_lower_limits()[0]), 0.0)
        thigh, shank = hip - knee, knee - ankle
        lost = hip - ankle - math.hypot(thigh + shank * math.cos(flexion), shank * math.sin(flexion))
        found.append(Upright(com - sole - lost, ankle - sole, hip - ankle - lost))
    right, left = found
    return left if left.com_height < right.com_height - SAME_HEIGHT else right


def passive_ankles(plant: MultibodyPlant) -> tuple[Side, ...]:
    """Return the sides of a finalized model of the body that have no muscles at the ankle."""
    joints = JointMap.of(plant)
    limits = dict(zip(joints.names, joints.effort_limits, strict=True))
    return tuple(side for side, leg in LEGS.items() if limits[leg.ankle] <= NO_TORQUE)


def knee_flexions(skeleton: Skeleton, flexion: float) -> Mapping[Side, float]:
    """Return the flexion of both knees in standing with flat feet below level hips [rad].

    Hip and ankle are flexed by half of it. The leg that is longer, or whose joints do not straighten, is bent more.

    Args:
        skeleton: Of the body.
        flexion: Flexion of the knees of a body with equal legs [rad].
    """
    lengths, lows, highs = [], [], []
    for leg in (LEGS[side] for side in SIDES):
        hip, knee, ankle = (skeleton.joint(name) for name in leg.sagittal)
        lengths.append(-knee.origin[2] - ankle.origin[2])
        half = [(2.0 * low, 2.0 * high) for low, high in (hip.range_rad, ankle.range_rad)]
        highs.append(min(high for _, high in (knee.range_rad, *half)))
        lows.append(min(max(low for low, _ in (knee.range_rad, *half)), highs[-1]))

    def heights(knees: list[float]) -> list[float]:
        return [length * math.cos(0.5 * knee) for length, knee in zip(lengths, knees, strict=True)]

    desired = [clip(flexion, low, high) for low, high in zip(lows, highs, strict=True)]
    height = clip(min(heights(desired)), max(heights(highs)), max(min(heights(lows)), max(heights(highs))))
    return {
        side: knee if abs(own - height) < SAME_HEIGHT else clip(2.0 * math.acos(min(height / length, 1.0)), low, high)
        for side, knee, own, length, low, high in zip(
            SIDES, desired, heights(desired), lengths, lows, highs, strict=True
        )
    }
