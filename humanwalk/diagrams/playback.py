"""Kinematic playback as a Diagram: reference and picture, no physics."""

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder

from humanwalk.choices.world import World
from humanwalk.diagrams.picture import add_picture
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
    picture = add_picture(builder, scenario)
    plant, none = picture.plant, np.zeros(picture.plant.num_actuators())
    world = World(
        builder=builder,
        plant=plant,
        instance=picture.instance,
        scene_graph=picture.scene_graph,
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
    builder.Connect(state, picture.state)
    return built(world, "playback", state=state, query_object=picture.scene_graph.get_query_output_port())
