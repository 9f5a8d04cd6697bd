"""A recorded walk as a Diagram: its picture at every time, no physics."""

from collections.abc import Mapping

import numpy as np
from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import TrajectorySource
from pydrake.systems.rendering import MultibodyPositionToGeometryPose
from pydrake.trajectories import PiecewisePolynomial

from humanwalk.body.plant import add_human
from humanwalk.numerics import Array
from humanwalk.scenario import Scenario


def make_replay(scenario: Scenario, time: Array, state: Array, forces: Mapping[str, Array]) -> Diagram:
    """Wire recorded signals to the picture.

    Args:
        scenario: What was simulated; body and terrain are taken from it.
        time: Of the samples [s], increasing, shape (rows,), at least two.
        state: Of the plant [q; v], shape (rows, 97); linear between samples.
        forces: Values of output ports by name, shape (rows, size) each; constant between samples.

    Exported outputs: query_object, and every name in `forces`.
    """
    builder = DiagramBuilder()
    scene_graph = builder.AddNamedSystem("scene_graph", SceneGraph())
    # The plant only places the geometry; it is not part of the diagram.
    plant = MultibodyPlant(time_step=0.0)
    source = plant.RegisterAsSourceForSceneGraph(scene_graph)
    add_human(plant, scenario.subject)
    scenario.terrain.add_to(plant, scenario.contact.ground_properties)
    plant.Finalize()
    motion = builder.AddNamedSystem(
        "state", TrajectorySource(PiecewisePolynomial.FirstOrderHold(time.tolist(), _vectors(state)))
    )
    to_pose = builder.AddNamedSystem("to_pose", MultibodyPositionToGeometryPose(plant, input_multibody_state=True))
    builder.Connect(motion.get_output_port(), to_pose.get_input_port())
    builder.Connect(to_pose.get_output_port(), scene_graph.get_source_pose_port(source))
    builder.ExportOutput(scene_graph.get_query_output_port(), "query_object")
    for name, values in forces.items():
        held = PiecewisePolynomial.ZeroOrderHold(time.tolist(), _vectors(values))
        builder.ExportOutput(builder.AddNamedSystem(name, TrajectorySource(held)).get_output_port(), name)
    diagram = builder.Build()
    diagram.set_name("replay")
    return diagram


def _vectors(rows: Array) -> list[Array]:
    return list(rows[:, :, np.newaxis])
