"""The posture of walking people in a body, and the height of the center of mass that follows from it."""

from functools import cache

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from humanwalk.body import SIDES, contact_spheres
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import skeleton_plant, sole_points
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.gait.normative import SPEED_GROUPS
from humanwalk.motion.gait_curves import normative_curves

PHASES = np.arange(0.0, 0.5, 0.025)
"""Of the right leg in half a gait cycle, after which the legs have changed places."""

DECIMALS = 4
"""Of the ratio of heights: a tenth of a millimeter per meter. Bodies of equal proportions have equal ratios."""


def height_ratio(subject: Subject) -> float:
    """Height of the center of mass in walking, relative to that with straight legs, over the same of the default man.

    It is 0.997 for women: their feet are shorter relative to their legs than men's, so that a step of as many leg
    lengths lowers the body more. Impairments, devices and loads do not count.
    """
    return round(_mean_height(subject.body) / _mean_height(Subject().body), DECIMALS)


@cache
def _mean_height(body: Skeleton) -> float:
    """Mean height of the center of mass above the lower foot with people's joint angles, relative to straight legs."""
    plant = skeleton_plant(body)
    context = plant.CreateDefaultContext()
    straight = _height(body, plant, context)
    curves = normative_curves(body.hip_height)
    speed = curves.speeds[list(SPEED_GROUPS).index("free")]
    heights = []
    for phase in PHASES:
        for side, of_leg in zip(SIDES, (phase, phase + 0.5), strict=True):
            angles = curves.at(side, of_leg, speed).value
            for joint, angle in zip(LEGS[side].sagittal, angles, strict=True):
                plant.GetJointByName(joint).set_angle(context, angle)
        heights.append(_height(body, plant, context))
    return float(np.mean(heights)) / straight


def _height(body: Skeleton, plant: MultibodyPlant, context: Context) -> float:
    """Height of the center of mass above the lowest point of both soles [m]."""
    lowest = sole_points(plant, context, contact_spheres(body))[:, 2].min()
    return float(plant.CalcCenterOfMassPositionInWorld(context)[2] - lowest)
