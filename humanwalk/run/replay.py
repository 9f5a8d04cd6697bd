"""The walk in a browser: Meshcat recorded while it is simulated, saved as one page that needs no network."""

from pydrake.geometry import Meshcat, MeshcatParams, MeshcatVisualizer, MeshcatVisualizerParams
from pydrake.systems.framework import DiagramBuilder, OutputPort

from humanwalk.quantity import ParameterError


def make_meshcat() -> Meshcat:
    """A Meshcat that listens on this machine only.

    Raises:
        ParameterError: no server can be started, with the reason.
    """
    try:
        meshcat = Meshcat(MeshcatParams(host="localhost", show_stats_plot=False))
    except RuntimeError as error:
        raise ParameterError(f"replay: Meshcat does not start: {error}; run with --no-replay") from None
    meshcat.SetProperty("/Grid", "visible", False)
    meshcat.SetProperty("/Axes", "visible", False)
    meshcat.SetProperty("/Background", "top_color", [0.75, 0.85, 0.95])
    meshcat.SetProperty("/Background", "bottom_color", [0.95, 0.96, 0.97])
    # Meshcat's spot and point light stay at the origin: a walker would walk into the dark.
    for light in ("SpotLight", "PointLightNegativeX"):
        meshcat.SetProperty(f"/Lights/{light}", "visible", False)
    meshcat.SetProperty("/Lights/AmbientLight/<object>", "intensity", 1.6)
    meshcat.SetProperty("/Lights/FillLight/<object>", "intensity", 1.2)
    return meshcat


def add_visualizer(builder: DiagramBuilder, query_object: OutputPort, meshcat: Meshcat, frame_rate: float) -> None:
    """Show a scene in Meshcat, published at `frame_rate` frames per second, and start recording."""
    MeshcatVisualizer.AddToBuilder(
        builder, query_object, meshcat, MeshcatVisualizerParams(publish_period=1.0 / frame_rate)
    )
    # A recording at another rate than the visualiser's stutters.
    meshcat.StartRecording(frames_per_second=frame_rate)


def static_page(meshcat: Meshcat) -> str:
    """The recording as one HTML page that needs no network."""
    meshcat.PublishRecording()
    return meshcat.StaticHtml()
