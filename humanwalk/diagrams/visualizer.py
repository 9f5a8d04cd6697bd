"""Adds Meshcat to a diagram: the scene, the view that follows its walker, and the recording."""

from pydrake.geometry import Meshcat, MeshcatVisualizer, MeshcatVisualizerParams
from pydrake.systems.framework import Diagram, DiagramBuilder

from humanwalk.systems.following_view import FollowingView
from humanwalk.terrain import Terrain


def add_visualizer(
    builder: DiagramBuilder,
    walker: Diagram,
    meshcat: Meshcat,
    frame_rate: float,
    terrain: Terrain,
    record: bool = True,
) -> FollowingView:
    """Show a walker in Meshcat, with the forces on it.

    Args:
        builder: Builder of the diagram that contains the walker.
        walker: Exports query_object and, where it has them, the forces that `FollowingView` draws.
        meshcat: Where the scene is shown.
        frame_rate: Frames per simulated second.
        terrain: The ground.
        record: Whether a recording starts; one that has started continues.
    """
    query_object = walker.GetOutputPort("query_object")
    parameters = MeshcatVisualizerParams(publish_period=1.0 / frame_rate, delete_on_initialization_event=False)
    MeshcatVisualizer.AddToBuilder(builder, query_object, meshcat, parameters)
    view = builder.AddSystem(FollowingView(meshcat, frame_rate, terrain))
    for name in ("query_object", "foot_forces", "push", "support_wrench"):
        if walker.HasOutputPort(name):
            builder.Connect(walker.GetOutputPort(name), view.GetInputPort(name))
    if record:
        # A recording at another rate than the visualizer's would stutter.
        meshcat.StartRecording(frames_per_second=frame_rate)
    return view
