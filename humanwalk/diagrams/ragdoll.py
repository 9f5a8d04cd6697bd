"""A body that falls: the human without control, whose parts all touch the ground. For pictures only."""

from collections.abc import Callable

import numpy as np
from pydrake.geometry import (
    AddContactMaterial,
    Box,
    Capsule,
    CollisionFilterDeclaration,
    Cylinder,
    Ellipsoid,
    GeometrySet,
    ProximityProperties,
    Shape,
)
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ContactModel, CoulombFriction
from pydrake.multibody.tree import JointActuatorIndex, PdControllerGains
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import add_human
from humanwalk.body.subject import Subject
from humanwalk.body.visuals import visuals
from humanwalk.contact.ground_properties import ground_properties
from humanwalk.numerics import Array
from humanwalk.terrain import Terrain

TIME_STEP = 0.004
"""Step of the discrete plant [s]."""

STIFFNESS_SHARE, DAMPING_SHARE = 0.05, 0.02
"""Gains of every joint toward its angle at the start, per effort limit [1/rad, s/rad]: tense, but it collapses."""

FLESH_STIFFNESS = 2.0e4
"""Point-contact stiffness of a part of the body [N/m], as of the legs of the reference human on each other."""

DISSIPATION = 2.0
"""Hunt-Crossley dissipation [s/m]: the body does not bounce."""

FRICTION = 0.6
"""Coulomb coefficient of cloth and skin."""

MIN_RADIUS = 0.03
"""Least extent of a part of the look that touches the ground [m]."""

SHAPES: dict[str, Callable[..., Shape]] = {"ellipsoid": Ellipsoid, "capsule": Capsule, "cylinder": Cylinder, "box": Box}


def make_ragdoll(subject: Subject, terrain: Terrain, state: Array) -> Diagram:
    """Wire a body that starts at a state and falls to the ground.

    The larger parts of the look `person` touch the ground; they pass through each other.

    Subsystems by name: plant, scene_graph, posture. Exported output: query_object.

    Args:
        subject: The body.
        terrain: The ground.
        state: [q; v] of a plant that contains nothing but the subject.
    """
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, TIME_STEP)
    instance = add_human(plant, subject)
    terrain.add_to(plant, ground_properties)
    plant.set_contact_model(ContactModel.kPoint)
    properties = ProximityProperties()
    AddContactMaterial(DISSIPATION, FLESH_STIFFNESS, CoulombFriction(FRICTION, FRICTION), properties)
    for part in visuals(subject.skeleton):
        if min(part.size) >= MIN_RADIUS:
            X_BG = RigidTransform(RollPitchYaw(*part.rpy), np.array(part.center))
            shape = SHAPES[part.primitive](*part.size)
            plant.RegisterCollisionGeometry(plant.GetBodyByName(part.body), X_BG, shape, part.name, properties)
    for index in range(plant.num_actuators()):
        actuator = plant.get_mutable_joint_actuator(JointActuatorIndex(index))
        limit = actuator.effort_limit()
        actuator.set_controller_gains(PdControllerGains(p=STIFFNESS_SHARE * limit, d=DAMPING_SHARE * limit))
    plant.Finalize()
    bodies = [plant.GetBodyFrameIdOrThrow(body) for body in plant.GetBodyIndices(instance)]
    scene_graph.collision_filter_manager().Apply(
        CollisionFilterDeclaration().ExcludeWithin(GeometrySet(frame_ids=bodies))
    )
    angles = JointMap.of(plant).positions(state)
    posture = ConstantVectorSource(np.concatenate((angles, np.zeros_like(angles))))
    builder.Connect(
        builder.AddNamedSystem("posture", posture).get_output_port(), plant.get_desired_state_input_port(instance)
    )
    builder.ExportOutput(scene_graph.get_query_output_port(), "query_object")
    diagram = builder.Build()
    diagram.set_name("ragdoll")
    return diagram
