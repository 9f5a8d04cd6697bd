"""The walk in a browser: Meshcat recorded while it is simulated, saved as one page that needs no network."""

import html
import threading
import webbrowser
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import (
    Cylinder,
    Meshcat,
    MeshcatAnimation,
    MeshcatCone,
    MeshcatParams,
    MeshcatVisualizer,
    MeshcatVisualizerParams,
    QueryObject,
    Rgba,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, DiagramBuilder, InputPort, LeafSystem, OutputPort
from rich.console import Console

from humanwalk.body import SIDES
from humanwalk.quantity import ParameterError

LOCALHOST = "127.0.0.1"

SCENE = "/drake"
"""Meshcat's path of all that is published: it is moved backwards as the walker moves forwards."""

CAMERA_POSITION = (2.6, -3.9, 1.4)
CAMERA_TARGET = (0.0, 0.0, 0.79)
CAMERA_FIELD_OF_VIEW_DEG = 27.0
"""The first look, from the right and ahead; the pelvis stays above the origin."""

ARROW_LENGTH_PER_FORCE = 1.0 / 1500.0
"""Length of a foot's force arrow [m/N]: a man's weight is half a metre."""
ARROW_COLOR = Rgba(0.85, 0.25, 0.10, 1.0)

LOOPS = 1_000_000

CONTENT_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; connect-src data:"
)
"""Forbids the page, whatever Meshcat's script may try, to talk to any host."""


def make_meshcat() -> Meshcat:
    """A Meshcat that listens on this machine only, lit and with the camera set for a walker.

    Raises:
        ParameterError: no server can be started, with the reason.
    """
    try:
        meshcat = Meshcat(MeshcatParams(host="localhost", show_stats_plot=False))
    except RuntimeError as error:
        raise ParameterError(f"replay: Meshcat does not start: {error}; run with --no-replay") from None
    for path in ("/Grid", "/Axes", "/Lights/SpotLight", "/Lights/PointLightNegativeX", "/Lights/PointLightPositiveX"):
        meshcat.SetProperty(path, "visible", False)
    meshcat.SetProperty("/Background/<object>", "top_color", [0.62, 0.76, 0.90])
    meshcat.SetProperty("/Background/<object>", "bottom_color", [0.95, 0.96, 0.97])
    meshcat.SetProperty("/Lights/AmbientLight/<object>", "intensity", 1.4)
    sun = "/Lights/FillLight/<object>"
    meshcat.SetProperty(sun, "position", [3.0, -2.5, 6.0])
    meshcat.SetProperty(sun, "intensity", 2.2)
    meshcat.SetProperty(sun, "castShadow", True)
    for side in ("width", "height"):
        meshcat.SetProperty(sun, f"shadow.mapSize.{side}", 2048.0)
    # Without it the floor shades itself in rings.
    meshcat.SetProperty(sun, "shadow.normalBias", 0.02)
    meshcat.SetCamera(Meshcat.PerspectiveCamera(fov=CAMERA_FIELD_OF_VIEW_DEG, aspect=16 / 9, near=0.1, far=200.0))
    meshcat.SetCameraPose(np.array(CAMERA_POSITION), np.array(CAMERA_TARGET))
    return meshcat


class FollowingView(LeafSystem):
    """Keeps the pelvis above Meshcat's origin along x, and draws the force on each foot at its centre of pressure.

    The scene is moved rather than the camera: the light stays on the walker, the viewer may turn and zoom as they
    like, and a recording holds it.

    Inputs:
        query_object: the scene's.
        foot_forces: (16) see `FootForceObserver`; optional.
    """

    def __init__(self, meshcat: Meshcat, frame_rate: float) -> None:
        """Make the view of `frame_rate` frames per second."""
        super().__init__()
        self._meshcat = meshcat
        self._scene = self.DeclareAbstractInputPort("query_object", Value(QueryObject()))
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self.DeclarePeriodicPublishEvent(1.0 / frame_rate, 0.0, self._publish)
        for side in SIDES:
            _add_arrow(meshcat, _arrow(side))
        # Where each arrow was last: an unloaded foot has no centre of pressure to glide to.
        self._X_WA = dict.fromkeys(SIDES, RigidTransform())

    def get_query_object_input_port(self) -> InputPort:
        """Input query_object."""
        return self._scene

    def get_foot_forces_input_port(self) -> InputPort:
        """Input foot_forces."""
        return self._foot_forces

    def _publish(self, context: Context) -> None:
        time = context.get_time()
        p_WP = _pelvis_position(self._scene.Eval(context))
        self._meshcat.SetTransform(SCENE, RigidTransform(np.array([-p_WP[0], 0.0, 0.0])), time)
        if not self._foot_forces.HasValue(context):
            return
        for side, foot in zip(SIDES, self._foot_forces.Eval(context).reshape(2, 8), strict=True):
            f_W, p_WCop, loaded = foot[0:3], foot[3:6], bool(foot[7])
            if loaded:
                self._X_WA[side] = RigidTransform(RotationMatrix.MakeFromOneVector(f_W, 2), p_WCop)
            length = max(ARROW_LENGTH_PER_FORCE * float(np.linalg.norm(f_W)), 1e-3)
            # All of it at every frame: a track that ends before the others would repeat out of step with them.
            arrow = _arrow(side)
            self._meshcat.SetProperty(arrow, "visible", loaded, time)
            self._meshcat.SetTransform(arrow, self._X_WA[side], time)
            self._meshcat.SetTransform(f"{arrow}/head", RigidTransform(np.array([0.0, 0.0, length])), time)
            self._meshcat.SetProperty(f"{arrow}/shaft", "scale", [1.0, 1.0, length], time)


def add_visualizer(
    builder: DiagramBuilder,
    query_object: OutputPort,
    meshcat: Meshcat,
    frame_rate: float,
    foot_forces: OutputPort | None = None,
) -> None:
    """Show a scene in Meshcat, following its walker, and start recording.

    Args:
        builder: of the diagram that `query_object` and `foot_forces` belong to.
        query_object: of the scene, which holds a body named Pelvis.
        meshcat: where to show it.
        frame_rate: frames per simulated second.
        foot_forces: see `FootForceObserver`; drawn as arrows.
    """
    MeshcatVisualizer.AddToBuilder(
        builder, query_object, meshcat, MeshcatVisualizerParams(publish_period=1.0 / frame_rate)
    )
    view = builder.AddNamedSystem("following_view", FollowingView(meshcat, frame_rate))
    builder.Connect(query_object, view.get_query_object_input_port())
    if foot_forces is not None:
        builder.Connect(foot_forces, view.GetInputPort("foot_forces"))
    # A recording at another rate than the visualiser's stutters.
    meshcat.StartRecording(frames_per_second=frame_rate)


def static_page(meshcat: Meshcat, title: str = "humanwalk") -> str:
    """The recording as one HTML page that needs no network: it plays at true speed, over and over.

    Args:
        meshcat: holds the recording; it is published.
        title: of the page.
    """
    recording = meshcat.get_mutable_recording()
    recording.set_loop_mode(MeshcatAnimation.LoopMode.kLoopRepeat)
    recording.set_repetitions(LOOPS)
    meshcat.PublishRecording()
    head = (
        f'<title>{html.escape(title)}</title>\n  <meta http-equiv="Content-Security-Policy" content="{CONTENT_POLICY}">'
    )
    player = files("humanwalk.view").joinpath("replay_player.html").read_text(encoding="utf-8")
    page = meshcat.StaticHtml()
    page = page.replace("<title>Drake MeshCat</title>", head, 1)
    before, body_end, after = page.rpartition("</body>")
    return before + player + body_end + after


def serve_replay(run: Path, *, open_browser: bool, console: Console) -> None:
    """Serve the replay page of a run on this machine only, until Ctrl-C.

    Args:
        run: folder of the run.
        open_browser: whether to open the page.
        console: where its address goes.

    Raises:
        ParameterError: the folder holds no run, or a run without replay.
    """
    # A run folder holds what a simulation returns, and a simulation shows itself with this module.
    from humanwalk.run.folder import Run

    page = Run.open(run).replay
    with replay_server(page.read_bytes()) as server:
        url = f"http://{LOCALHOST}:{server.server_port}/"
        console.print(f"replay of {run} at {url} (Ctrl-C ends it)", soft_wrap=True)
        if open_browser:
            # A browser inside the terminal does not return before it is closed.
            threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            console.print("ended")


def replay_server(page: bytes) -> ThreadingHTTPServer:
    """A server of one page, bound to 127.0.0.1 at a port that the system chooses; it knows no other path than /."""
    return ThreadingHTTPServer((LOCALHOST, 0), partial(_OnePage, page))


class _OnePage(BaseHTTPRequestHandler):
    def __init__(self, page: bytes, *args: object) -> None:
        self._page = page
        super().__init__(*args)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        if self.path != "/":
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self._page)))
        # The next run is served at a port that may have been this one's.
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(self._page)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing: the terminal shows where to look, not who looked."""


def _pelvis_position(scene: QueryObject) -> np.ndarray:
    inspector = scene.inspector()
    for frame in inspector.GetAllFrameIds():
        if inspector.GetName(frame).endswith("::Pelvis"):
            return scene.GetPoseInWorld(frame).translation()
    raise ParameterError("replay: the scene has no body Pelvis to follow; show a scene with a human in it")


def _arrow(side: str) -> str:
    return f"{SCENE}/foot_force/{side}"


def _add_arrow(meshcat: Meshcat, path: str) -> None:
    """Add an arrow along z whose shaft is scaled by its length; it is not seen before it has one.

    It is drawn over the body: the force runs up inside the leg.
    """
    meshcat.SetProperty(path, "visible", False)
    meshcat.SetObject(f"{path}/shaft/cylinder", Cylinder(0.011, 1.0), ARROW_COLOR)
    meshcat.SetTransform(f"{path}/shaft/cylinder", RigidTransform(np.array([0.0, 0.0, 0.5])))
    meshcat.SetObject(f"{path}/head/cone", MeshcatCone(0.08, 0.032, 0.032), ARROW_COLOR)
    meshcat.SetTransform(
        f"{path}/head/cone", RigidTransform(RotationMatrix.MakeXRotation(np.pi), np.array([0.0, 0.0, 0.07]))
    )
    for part in ("shaft/cylinder", "head/cone"):
        drawn = f"{path}/{part}/<object>"
        meshcat.SetProperty(drawn, "material.depthTest", False)
        # What is see-through is drawn after the rest, and then by this order.
        meshcat.SetProperty(drawn, "material.transparent", True)
        meshcat.SetProperty(drawn, "renderOrder", 1.0)
        for shadow in ("castShadow", "receiveShadow"):
            meshcat.SetProperty(drawn, shadow, False)
