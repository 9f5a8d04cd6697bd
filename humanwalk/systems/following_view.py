"""LeafSystem: keeps the walker in Meshcat's view, and draws the forces on it."""

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Meshcat, QueryObject, Rgba
from pydrake.math import RigidTransform
from pydrake.systems.framework import AbstractParameterIndex, Context, InputPort, LeafSystem

from humanwalk.body import SIDES
from humanwalk.body.limbs import CHEST, PELVIS
from humanwalk.contact.ground_force import FootForces
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.systems.force_arrow import ForceArrow
from humanwalk.terrain import Terrain

SCENE = "/drake"
"""Meshcat's path of everything that is published; it moves backward as the walker moves forward."""

GROUND_FORCE_COLOR = Rgba(0.85, 0.25, 0.10, 1.0)
PUSH_COLOR = Rgba(0.55, 0.15, 0.75, 1.0)
SUPPORT_COLOR = Rgba(0.10, 0.35, 0.85, 1.0)


LATERAL_SLACK = 0.1
"""Distance from the line of a straight walk over which the view stays [m]: sway is seen as such."""

AROUND = np.column_stack((np.linspace(-0.6, 0.6, 25), np.zeros(25)))
"""Points around the pelvis, along x, whose mean height the view follows [m]: about two steps of a walk or stairs."""


_KEPT: set[Meshcat] = set()
"""See `keep_meshcat`."""


def keep_meshcat(meshcat: Meshcat) -> None:
    """Keep a Meshcat until the program ends.

    Drake aborts the program if a Meshcat is destroyed in another thread than the one that made it. The garbage
    collector may run in any thread, and frees a diagram together with its Meshcat.
    """
    _KEPT.add(meshcat)


class FollowingView(LeafSystem):
    """Keeps the pelvis near Meshcat's origin, and draws forces as arrows.

    The scene moves rather than the camera: the light stays on the walker, the viewer can turn and zoom freely, and a
    recording contains the motion. It moves along x, along y beyond LATERAL_SLACK, and vertically with the mean height
    of the ground around the pelvis, which changes gradually on stairs. Whether it moves is a parameter of the context.

    Inputs:
        query_object: SceneGraph's.
        foot_forces: (16) see `FootForceObserver`; optional. Arrows from the centers of pressure.
        push: (3) sum of all pushes in W [N]; optional. An arrow that ends at the chest.
        support_wrench: (6) see `BalanceSupport`; optional. The force as an arrow from the pelvis.
    """

    def __init__(self, meshcat: Meshcat, frame_rate: float, terrain: Terrain) -> None:
        """Make the view of `frame_rate` frames per second."""
        super().__init__()
        keep_meshcat(meshcat)
        self._meshcat, self._terrain = meshcat, terrain
        self._following = AbstractParameterIndex(self.DeclareAbstractParameter(Value[bool](True)))
        self._query_object = self.DeclareAbstractInputPort("query_object", Value(QueryObject()))
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._push = self.DeclareVectorInputPort("push", 3)
        self._support = self.DeclareVectorInputPort("support_wrench", 6)
        self.DeclarePeriodicPublishEvent(1.0 / frame_rate, 0.0, self._publish)
        self._foot_arrows = [ForceArrow(meshcat, f"{SCENE}/foot_force/{side}", GROUND_FORCE_COLOR) for side in SIDES]
        self._push_arrow = ForceArrow(meshcat, f"{SCENE}/push", PUSH_COLOR)
        self._support_arrow = ForceArrow(meshcat, f"{SCENE}/external_support", SUPPORT_COLOR)

    def follow(self, context: Context, following: bool) -> None:
        """Let the scene move with the walker, or stay where it is."""
        context.get_mutable_abstract_parameter(self._following).set_value(following)

    def _publish(self, context: Context) -> None:
        time, scene = context.get_time(), self._query_object.Eval(context)
        p_WP = _position(scene, PELVIS)
        if context.get_abstract_parameter(self._following).get_value():
            ground = float(self._terrain.height(p_WP[:2] + AROUND).mean())
            lateral = p_WP[1] - np.clip(p_WP[1], -LATERAL_SLACK, LATERAL_SLACK)
            self._meshcat.SetTransform(SCENE, RigidTransform(-np.array([p_WP[0], lateral, ground])), time)
        feet = FootForces.of(self._value(self._foot_forces, context))
        for arrow, f_W, p_WCop, loaded in zip(self._foot_arrows, feet.f_W, feet.p_WCop, feet.loaded, strict=True):
            arrow.show(f_W, p_WCop if loaded else None, time)
        push = self._value(self._push, context)
        self._push_arrow.show(push, _position(scene, CHEST) if push.any() else None, time, head=True)
        support = self._value(self._support, context)[3:6]
        self._support_arrow.show(support, p_WP if support.any() else None, time)

    def _value(self, port: InputPort, context: Context) -> Array:
        return np.asarray(port.Eval(context)) if port.HasValue(context) else np.zeros(port.size())


def _position(scene: QueryObject, body: str) -> Array:
    inspector = scene.inspector()
    for frame in inspector.GetAllFrameIds():
        if inspector.GetName(frame).endswith(f"::{body}"):
            return np.asarray(scene.GetPoseInWorld(frame).translation())
    raise ParameterError(f"replay: no body {body} in the scene; allowed: a scene with a human; add one")
