"""The human inside a Drake MultibodyPlant."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from pydrake.multibody.parsing import PackageMap, Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import Context

from humanwalk.body.contact import ContactSphere
from humanwalk.body.sdf import to_sdf
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.numerics import Array

PACKAGE = "humanwalk"
HUMAN_URL = "package://humanwalk/models/sdf/human.sdf"
"""Model file of the reference human, for a parser after `register_package`."""


def register_package(package_map: PackageMap) -> None:
    """Map `package://humanwalk/...` to the files of this package."""
    package_map.Add(PACKAGE, str(Path(__file__).parent.parent))


def add_human(plant: MultibodyPlant, subject: Subject) -> ModelInstanceIndex:
    """Parse the model of a subject, whole and strictly, into a plant that is not finalized; returns its instance."""
    parser = Parser(plant)
    parser.SetStrictParsing()
    register_package(parser.package_map())
    if subject == Subject(sex="unspecified"):
        (instance,) = parser.AddModelsFromUrl(HUMAN_URL)
    else:
        (instance,) = parser.AddModelsFromString(to_sdf(subject.skeleton, subject.look), "sdf")
    return instance


def kinematics_plant(subject: Subject) -> MultibodyPlant:
    """Return a finalized plant of the subject alone, without geometry, for kinematics and inertia.

    It is the walker's model of its body: it has the impairments, devices and loads that are known. Its states are those
    of every plant of the subject.
    """
    return skeleton_plant(subject.known_skeleton)


def body_plant(subject: Subject) -> MultibodyPlant:
    """Return a finalized plant of the subject alone, without geometry, with everything that its model may lack."""
    return skeleton_plant(subject.skeleton)


@cache
def skeleton_plant(skeleton: Skeleton) -> MultibodyPlant:
    """Return a finalized plant of a skeleton alone, without geometry."""
    plant = MultibodyPlant(time_step=0.0)
    parser = Parser(plant)
    parser.SetStrictParsing()
    parser.AddModelsFromString(to_sdf(skeleton), "sdf")
    plant.Finalize()
    return plant


def sole_points(plant: MultibodyPlant, context: Context, spheres: Sequence[ContactSphere]) -> Array:
    """Return the lowest points of contact spheres, p_WQ [m], shape (spheres, 3)."""
    centers = [plant.GetBodyByName(s.body).EvalPoseInWorld(context) @ np.array(s.center) for s in spheres]
    return np.array(centers) - [(0.0, 0.0, s.radius) for s in spheres]
