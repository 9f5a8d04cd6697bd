"""Adds Meshcat to a diagram: the scene, the view that follows its walker, and the recording."""

from pydrake.geometry import Meshcat, MeshcatVisualizer, MeshcatVisualizerParams
from pydrake.systems.framework import DiagramBuilder, OutputPort

from humanwalk.systems.following_view import FollowingView
from humanwalk.terrain import Terrain


def add_visualizer(
    builder: DiagramBuilder,
    query_object: OutputPort,
    meshcat: Meshcat,
    frame_rate: float,
    terrain: Terrain,
    foot_forces: OutputPort | None = None,
    new_recording: bool = True,
) -> None:
    """Show a scene in Meshcat, following its walker, and start recording.

    Args:
        builder: Builder of the diagram that `query_object` and `foot_forces` belong to.
        query_object: Of the scene, which contains a human.
        meshcat: Where the scene is shown.
        frame_rate: Frames per simulated second.
        terrain: The ground.
        foot_forces: See `FootForceObserver`; drawn as arrows.
        new_recording: Whether a recording starts; otherwise the present one continues.
    """
    parameters = MeshcatVisualizerParams(publish_period=1.0 / frame_rate, delete_on_initialization_event=False)
    MeshcatVisualizer.AddToBuilder(builder, query_object, meshcat, parameters)
    view = builder.AddNamedSystem("following_view", FollowingView(meshcat, frame_rate, terrain))
    builder.Connect(query_object, view.GetInputPort("query_object"))
    if foot_forces is not None:
        builder.Connect(foot_forces, view.GetInputPort("foot_forces"))
    # A recording at another rate than the visualizer's would stutter.
    if new_recording:
        meshcat.StartRecording(frames_per_second=frame_rate)
