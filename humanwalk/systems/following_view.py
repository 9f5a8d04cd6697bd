"""LeafSystem: keeps the walker in Meshcat's view, and draws the force on each foot."""

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Cylinder, Meshcat, MeshcatCone, QueryObject, Rgba
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, LeafSystem

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import PELVIS
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.terrain import Terrain

SCENE = "/drake"
"""Meshcat's path of everything that is published; it moves backward as the walker moves forward."""

ARROW_LENGTH_PER_FORCE = 1.0 / 1500.0
"""Length of a force arrow [m/N]: body weight is about half a meter."""
ARROW_COLOR = Rgba(0.85, 0.25, 0.10, 1.0)
MIN_ARROW_LENGTH = 1e-3
"""Length of the arrow of no force [m]: a scale of zero has no inverse."""

LATERAL_SLACK = 0.1
"""Distance from the line of a straight walk over which the view stays [m]: sway is seen as such."""
NO_FORCES = np.zeros(16)


class FollowingView(LeafSystem):
    """Keeps the pelvis near Meshcat's origin, and draws the force on each foot at its center of pressure.

    The scene moves rather than the camera: the light stays on the walker, the viewer can turn and zoom freely, and a
    recording contains the motion. It moves along x, along y beyond LATERAL_SLACK, and vertically with the ground below
    the pelvis.

    Inputs:
        query_object: SceneGraph's.
        foot_forces: (16) see `FootForceObserver`; optional.
    """

    def __init__(self, meshcat: Meshcat, frame_rate: float, terrain: Terrain) -> None:
        """Make the view of `frame_rate` frames per second."""
        super().__init__()
        self._meshcat, self._terrain = meshcat, terrain
        self._query_object = self.DeclareAbstractInputPort("query_object", Value(QueryObject()))
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self.DeclarePeriodicPublishEvent(1.0 / frame_rate, 0.0, self._publish)
        for side in SIDES:
            _add_arrow(meshcat, _arrow(side))
        # Last pose of each arrow: an unloaded foot has no center of pressure.
        self._X_WA = dict.fromkeys(SIDES, RigidTransform())

    def _publish(self, context: Context) -> None:
        time = context.get_time()
        p_WP = _pelvis_position(self._query_object.Eval(context))
        ground = float(self._terrain.height(p_WP[:2]))
        lateral = p_WP[1] - np.clip(p_WP[1], -LATERAL_SLACK, LATERAL_SLACK)
        self._meshcat.SetTransform(SCENE, RigidTransform(-np.array([p_WP[0], lateral, ground])), time)
        forces = self._foot_forces.Eval(context) if self._foot_forces.HasValue(context) else NO_FORCES
        for side, foot in zip(SIDES, forces.reshape(2, 8), strict=True):
            f_W, p_WCop, loaded = foot[0:3], foot[3:6], bool(foot[7])
            if loaded:
                self._X_WA[side] = RigidTransform(RotationMatrix.MakeFromOneVector(f_W, 2), p_WCop)
            length = max(ARROW_LENGTH_PER_FORCE * float(np.linalg.norm(f_W)), MIN_ARROW_LENGTH)
            # Every property at every frame: a track that ends before the others would repeat out of step with them.
            arrow = _arrow(side)
            self._meshcat.SetProperty(arrow, "visible", loaded, time)
            self._meshcat.SetTransform(arrow, self._X_WA[side], time)
            self._meshcat.SetTransform(f"{arrow}/head", RigidTransform(np.array([0.0, 0.0, length])), time)
            self._meshcat.SetProperty(f"{arrow}/shaft", "scale", [1.0, 1.0, length], time)


def _pelvis_position(scene: QueryObject) -> Array:
    inspector = scene.inspector()
    for frame in inspector.GetAllFrameIds():
        if inspector.GetName(frame).endswith(f"::{PELVIS}"):
            return np.asarray(scene.GetPoseInWorld(frame).translation())
    raise ParameterError(f"replay: no body {PELVIS} in the scene; allowed: a scene with a human; add one")


def _arrow(side: Side) -> str:
    return f"{SCENE}/foot_force/{side}"


def _add_arrow(meshcat: Meshcat, path: str) -> None:
    """Add an arrow along z whose shaft is scaled to its length; it is invisible at first.

    It is drawn over the body, because the line of action runs inside the leg.
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
        # Transparent objects are drawn after the opaque ones, in this order.
        meshcat.SetProperty(drawn, "material.transparent", True)
        meshcat.SetProperty(drawn, "renderOrder", 1.0)
        for shadow in ("castShadow", "receiveShadow"):
            meshcat.SetProperty(drawn, shadow, False)
