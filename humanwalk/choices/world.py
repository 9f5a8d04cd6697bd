"""The subject on level ground: a MultibodyPlant with contact and actuators as the scenario asks."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from pydrake.geometry import (
    CollisionFilterDeclaration,
    GeometrySet,
    SceneGraph,
)
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    ContactModel,
    DiscreteContactApproximation,
    MultibodyPlant,
)
from pydrake.multibody.tree import JointActuatorIndex, ModelInstanceIndex
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body.contact import HYDRO_SET, POINT_SET
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import add_human, kinematics_plant
from humanwalk.contact.ground_properties import ground_properties
from humanwalk.contact.leg_contact import add_leg_capsules, filter_leg_capsules
from humanwalk.control.gain_noise import gain_factors
from humanwalk.control.pd_control import joint_gains
from humanwalk.control.pd_laws import install_gains
from humanwalk.numerics import Array
from humanwalk.scenario import BalancedWalkParameters, Contact, Scenario
from humanwalk.terrain import Plane

CONTACT_MODELS = {
    "point": ContactModel.kPoint,
    "hydroelastic": ContactModel.kHydroelasticWithFallback,
    "asperity": ContactModel.kPoint,
}
UNUSED_CONTACT_SETS = {"point": (HYDRO_SET,), "hydroelastic": (POINT_SET,), "asperity": (HYDRO_SET, POINT_SET)}
"""What Drake must not collide; all of it where `AsperityContact` carries the body."""
APPROXIMATIONS = {
    "sap": DiscreteContactApproximation.kSap,
    "lagged": DiscreteContactApproximation.kLagged,
    "similar": DiscreteContactApproximation.kSimilar,
}

ACTUATOR_GAINS = 2
"""What their noise is drawn from together with the scenario's seed, so that it is independent of the start's."""


@dataclass(frozen=True)
class HumanPlant:
    """A finalised plant with its scene graph and its actuators' gains and limits (in actuator order)."""

    plant: MultibodyPlant
    instance: ModelInstanceIndex
    scene_graph: SceneGraph
    joints: JointMap
    kp: Array
    kd: Array
    effort_limits: Array


def add_human_plant(builder: DiagramBuilder, scenario: Scenario, visuals: bool = True) -> HumanPlant:
    """Add the subject on level ground to a diagram, with gains installed and no contact set but the scenario's.

    Args:
        builder: of the diagram.
        scenario: what is simulated.
        visuals: whether there is anything to see of it; what nobody sees is still moved in every step.
    """
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, scenario.simulation.time_step)
    instance = add_human(plant, scenario.subject)
    Plane().add_to(plant, partial(ground_properties, hydroelastic=scenario.contact == "hydroelastic"))
    plant.set_contact_model(CONTACT_MODELS[scenario.contact])
    if plant.time_step() > 0:
        plant.set_discrete_contact_approximation(APPROXIMATIONS[scenario.simulation.contact_approximation])
    kp, kd = human_gains(scenario)
    if scenario.actuators.effort_limits == "none":
        for i in range(plant.num_actuators()):
            plant.get_mutable_joint_actuator(JointActuatorIndex(i)).set_effort_limit(np.inf)
    effort_limits = np.array(
        [plant.get_joint_actuator(JointActuatorIndex(i)).effort_limit() for i in range(plant.num_actuators())]
    )
    install_gains(plant, kp, kd, scenario.actuators.law)
    legs_touch = scenario.controller == "balanced" and scenario.balanced.leg_contact
    if legs_touch:
        add_leg_capsules(plant, scenario.subject.skeleton)
    plant.Finalize()
    exclude_unused_contact_sets(plant, scene_graph, scenario.contact)
    if legs_touch:
        filter_leg_capsules(plant, scene_graph)
    if not visuals:
        remove_visuals(plant, scene_graph)
    return HumanPlant(plant, instance, scene_graph, JointMap.of(plant), kp, kd, effort_limits)


def remove_visuals(plant: MultibodyPlant, scene_graph: SceneGraph) -> None:
    """Remove all geometry of a finalised plant that is only there to be seen."""
    source, inspector = plant.get_source_id(), scene_graph.model_inspector()
    assert source is not None
    for geometry in inspector.GetAllGeometryIds():
        if inspector.GetProximityProperties(geometry) is None:
            scene_graph.RemoveGeometry(source, geometry)


def human_gains(scenario: Scenario) -> tuple[Array, Array]:
    """kp and kd of the scenario's actuators, shape (42,) each, with the inertia of neutral standing and its noise."""
    plant = kinematics_plant(scenario.subject)
    joints = JointMap.of(plant)
    if scenario.controller == "balanced":
        kp, kd = balanced_gains(joints.names, scenario.balanced)
    else:
        inertia = plant.CalcMassMatrix(plant.CreateDefaultContext()).diagonal()[joints.v]
        kp, kd = joint_gains(joints.names, inertia, scenario.actuators)
    random = np.random.default_rng((scenario.seed, ACTUATOR_GAINS))
    noise = scenario.start.gain_noise
    return kp * gain_factors(kp.size, noise, random), kd * gain_factors(kd.size, noise, random)


def balanced_gains(joint_names: Sequence[str], walk: BalancedWalkParameters) -> tuple[Array, Array]:
    """kp and kd of the balanced walker: only the small joints of the feet are held, the rest is damped."""
    held = np.isin(joint_names, [joint for leg in LEGS.values() for joint in leg.foot_joints])
    return np.where(held, walk.foot_stiffness, 0.0), np.where(held, walk.foot_damping, walk.joint_damping)


def exclude_unused_contact_sets(plant: MultibodyPlant, scene_graph: SceneGraph, contact: Contact) -> None:
    """Filter out of all collisions the foot geometry that the contact model does not use."""
    inspector = scene_graph.model_inspector()
    unused, everything = GeometrySet(), GeometrySet()
    for index in plant.GetBodyIndices(plant.GetModelInstanceByName("human")):
        for geometry in plant.GetCollisionGeometriesForBody(plant.get_body(index)):
            everything.Add(geometry)
            if any(unused_set in inspector.GetName(geometry) for unused_set in UNUSED_CONTACT_SETS[contact]):
                unused.Add(geometry)
    for geometry in plant.GetCollisionGeometriesForBody(plant.world_body()):
        everything.Add(geometry)
    filters = scene_graph.collision_filter_manager()
    filters.Apply(CollisionFilterDeclaration().ExcludeWithin(unused).ExcludeBetween(unused, everything))
