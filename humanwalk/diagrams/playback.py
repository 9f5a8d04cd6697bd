"""Kinematic playback as a Diagram: reference and picture, no physics."""

import numpy as np
from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.rendering import MultibodyPositionToGeometryPose

from humanwalk.body.plant import add_human
from humanwalk.choices.world import World
from humanwalk.diagrams.world import built
from humanwalk.scenario import Scenario, require_scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.playback_state import PlaybackState


def make_playback(scenario: Scenario) -> Diagram:
    """Wire a scenario's reference straight to the picture: the motion that the controller commands.

    Subsystems by name: scene_graph, playback_state, body_observer, to_pose, and those of the reference: gait, arms,
    inverse_kinematics, interpolator (thesis), or recording (recorded).

    Exported outputs: state (97), desired_state (84), query_object, and every `Signal` of a subsystem under its name.

    Raises:
        ParameterError: the controller has no reference, or the body cannot follow it.
    """
    require_scenario(scenario, "make_playback")
    builder = DiagramBuilder()
    scene_graph = builder.AddNamedSystem("scene_graph", SceneGraph())
    # The plant only places the geometry; it is not part of the diagram.
    plant = MultibodyPlant(time_step=0.0)
    source = plant.RegisterAsSourceForSceneGraph(scene_graph)
    instance = add_human(plant, scenario.subject)
    scenario.terrain.add_to(plant, scenario.contact.ground_properties)
    plant.Finalize()
    none = np.zeros(plant.num_actuators())
    world = World(
        builder=builder,
        plant=plant,
        instance=instance,
        scene_graph=scene_graph,
        subject=scenario.subject,
        terrain=scenario.terrain,
        start=scenario.start,
        seed=scenario.seed,
        kp=none,
        kd=none,
        step_impedance=lambda step: (none, none),
    )
    pelvis_reference, desired_state = scenario.controller.add_reference(world)
    playback = world.add(
        "playback_state", PlaybackState(plant), pelvis_reference=pelvis_reference, desired_state=desired_state
    )
    state = playback.GetOutputPort("state")
    world.add("body_observer", BodyObserver(plant), state=state)
    to_pose = builder.AddNamedSystem("to_pose", MultibodyPositionToGeometryPose(plant, input_multibody_state=True))
    builder.Connect(state, to_pose.get_input_port())
    builder.Connect(to_pose.get_output_port(), scene_graph.get_source_pose_port(source))
    return built(world, "playback", state=state, query_object=scene_graph.get_query_output_port())
