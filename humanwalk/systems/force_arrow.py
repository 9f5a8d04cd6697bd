"""Arrows of forces in Meshcat."""

import numpy as np
from pydrake.geometry import Cylinder, Meshcat, MeshcatCone, Rgba
from pydrake.math import RigidTransform, RotationMatrix

from humanwalk.numerics import Array

LENGTH_PER_FORCE = 1.0 / 1500.0
"""Length of an arrow [m/N]: body weight is about half a meter."""
MIN_LENGTH = 1e-3
"""Length of the arrow of no force [m]: a scale of zero has no inverse."""
HEAD_LENGTH = 0.07
"""By which the head extends beyond the shaft [m]."""


class ForceArrow:
    """An arrow whose length is proportional to a force.

    It is drawn over the body, because the line of action of a ground force runs inside the leg.
    """

    def __init__(self, meshcat: Meshcat, path: str, color: Rgba) -> None:
        """Add an arrow along z whose shaft is scaled to its length; it is invisible at first."""
        self._meshcat, self._path = meshcat, path
        # Last pose: an unloaded foot has no center of pressure.
        self._X_WA = RigidTransform()
        meshcat.SetProperty(path, "visible", False)
        meshcat.SetObject(f"{path}/shaft/cylinder", Cylinder(0.011, 1.0), color)
        meshcat.SetTransform(f"{path}/shaft/cylinder", RigidTransform(np.array([0.0, 0.0, 0.5])))
        meshcat.SetObject(f"{path}/head/cone", MeshcatCone(0.08, 0.032, 0.032), color)
        meshcat.SetTransform(
            f"{path}/head/cone", RigidTransform(RotationMatrix.MakeXRotation(np.pi), np.array([0.0, 0.0, HEAD_LENGTH]))
        )
        for part in ("shaft/cylinder", "head/cone"):
            drawn = f"{path}/{part}/<object>"
            meshcat.SetProperty(drawn, "material.depthTest", False)
            # Transparent objects are drawn after the opaque ones, in this order.
            meshcat.SetProperty(drawn, "material.transparent", True)
            meshcat.SetProperty(drawn, "renderOrder", 1.0)
            for shadow in ("castShadow", "receiveShadow"):
                meshcat.SetProperty(drawn, shadow, False)

    def show(self, force: Array, tail: Array | None, time: float, *, head: bool = False) -> None:
        """Draw a force.

        Args:
            force: In W [N], shape (3,).
            tail: Where the arrow begins in W [m], shape (3,); None makes it invisible.
            time: Simulated time [s].
            head: Whether `tail` is where it ends instead.
        """
        size = float(np.linalg.norm(force))
        length = max(LENGTH_PER_FORCE * size, MIN_LENGTH)
        if tail is not None and size > 0.0:
            start = tail - head * (length + HEAD_LENGTH) * force / size
            self._X_WA = RigidTransform(RotationMatrix.MakeFromOneVector(force, 2), start)
        # Every property at every frame: a track that ends before the others would repeat out of step with them.
        show, path = self._meshcat, self._path
        show.SetProperty(path, "visible", tail is not None, time)
        show.SetTransform(path, self._X_WA, time)
        show.SetTransform(f"{path}/head", RigidTransform(np.array([0.0, 0.0, length])), time)
        show.SetProperty(f"{path}/shaft", "scale", [1.0, 1.0, length], time)
