"""A recorded walk as a Diagram: its picture at every time, no physics."""

from collections.abc import Mapping

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from humanwalk.diagrams.picture import add_picture
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
    picture = add_picture(builder, scenario)
    motion = builder.AddNamedSystem(
        "state", TrajectorySource(PiecewisePolynomial.FirstOrderHold(time.tolist(), _vectors(state)))
    )
    builder.Connect(motion.get_output_port(), picture.state)
    builder.ExportOutput(picture.scene_graph.get_query_output_port(), "query_object")
    for name, values in forces.items():
        held = PiecewisePolynomial.ZeroOrderHold(time.tolist(), _vectors(values))
        builder.ExportOutput(builder.AddNamedSystem(name, TrajectorySource(held)).get_output_port(), name)
    diagram = builder.Build()
    diagram.set_name("replay")
    return diagram


def _vectors(rows: Array) -> list[Array]:
    return list(rows[:, :, np.newaxis])
