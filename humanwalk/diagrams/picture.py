"""The body and terrain of a scenario as a picture: geometry that follows a state, no physics."""

from typing import NamedTuple

from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import DiagramBuilder, InputPort
from pydrake.systems.rendering import MultibodyPositionToGeometryPose

from humanwalk.body.plant import add_human
from humanwalk.scenario import Scenario


class Picture(NamedTuple):
    """What `add_picture` added, and the plant that places the geometry, which is not part of the diagram.

    Attributes:
        plant: finalized, continuous.
        instance: the body's model instance.
        scene_graph: of the plant.
        state: input port of the plant's state [q; v].
    """

    plant: MultibodyPlant
    instance: ModelInstanceIndex
    scene_graph: SceneGraph
    state: InputPort


def add_picture(builder: DiagramBuilder, scenario: Scenario) -> Picture:
    """Add scene_graph and to_pose, which moves the body's geometry to where a state has it."""
    scene_graph = builder.AddNamedSystem("scene_graph", SceneGraph())
    plant = MultibodyPlant(time_step=0.0)
    source = plant.RegisterAsSourceForSceneGraph(scene_graph)
    instance = add_human(plant, scenario.subject)
    scenario.terrain.add_to(plant, scenario.contact.ground_properties)
    plant.Finalize()
    to_pose = builder.AddNamedSystem("to_pose", MultibodyPositionToGeometryPose(plant, input_multibody_state=True))
    builder.Connect(to_pose.get_output_port(), scene_graph.get_source_pose_port(source))
    return Picture(plant, instance, scene_graph, to_pose.get_input_port())
