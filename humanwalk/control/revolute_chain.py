"""Pose and Jacobian of a chain of hinges, in plain floats.

Inverse kinematics ask for both five hundred times in a simulated second. Alone, Drake's calls take as long; between the
steps of a plant, which has used the caches for its own, what is small is quicker.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from pydrake.math import RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RevoluteJoint

from humanwalk.numerics import Array

Vector = tuple[float, float, float]


def rotation_vector(axes: Sequence[Sequence[float]], goal: Sequence[Sequence[float]]) -> Vector:
    """Axis times angle [rad] of the rotation that takes a frame's axes x, y, z to those of another."""
    # The cross products of the axes add up to twice sine times axis, the dot products to the trace.
    x = y = z = trace = 0.0
    for (ax, ay, az), (gx, gy, gz) in zip(axes, goal, strict=True):
        x += ay * gz - az * gy
        y += az * gx - ax * gz
        z += ax * gy - ay * gx
        trace += ax * gx + ay * gy + az * gz
    sine2, cosine2 = math.hypot(x, y, z), trace - 1.0
    if cosine2 < 0.0:
        # Beyond a right angle the cross products lose the axis.
        turn = RotationMatrix(np.array(goal).T @ np.array(axes)).ToAngleAxis()
        x, y, z = turn.angle() * turn.axis()
        return x, y, z
    scale = math.atan2(sine2, cosine2) / sine2 if sine2 > 2e-9 else 0.5
    return scale * x, scale * y, scale * z


Pose = tuple[Vector, Vector, Vector, Vector]
"""A frame in another: its axes x, y, z, then its origin."""

NOWHERE = (0.0, 0.0, 0.0)


def pose_of(wxyz: Sequence[float], origin: Sequence[float]) -> Pose:
    """The pose with an orientation, as a quaternion that need not be normalised, and an origin [m]."""
    w, x, y, z = wxyz
    a, b, c = origin
    s = 2.0 / (w * w + x * x + y * y + z * z)
    return (
        (1.0 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)),
        (s * (x * y - w * z), 1.0 - s * (x * x + z * z), s * (y * z + w * x)),
        (s * (x * z + w * y), s * (y * z - w * x), 1.0 - s * (x * x + y * y)),
        (a, b, c),
    )


@dataclass(frozen=True)
class Hinge:
    """One joint of a chain.

    Attributes:
        axis: 0, 1, 2: it turns about x, y, z of the frame that the hinges before it carry.
        sign: 1 where its positive turn is about that axis, -1 where it is against it.
        offset: from the hinge before it, or from the base's origin, in that frame [m].
    """

    axis: int
    sign: float
    offset: Vector


class ChainState(NamedTuple):
    """Where a chain is at some joint angles, everything in its base frame P.

    Attributes:
        X_PS: the tip's frame S.
        axes: unit vectors about which the joints turn.
        points: a point on each of these axes [m].
    """

    X_PS: Pose
    axes: Sequence[Vector]
    points: Sequence[Vector]

    def jacobian(self) -> Array:
        """Jacobian of the spatial velocity (rotation first) of S in P, expressed in P, shape (6, n)."""
        x, y, z = self.X_PS[3]
        columns = []
        for (a, b, c), (px, py, pz) in zip(self.axes, self.points, strict=True):
            rx, ry, rz = x - px, y - py, z - pz
            columns.append((a, b, c, b * rz - c * ry, c * rx - a * rz, a * ry - b * rx))
        return np.array(columns).T


@dataclass(frozen=True)
class RevoluteChain:
    """Hinges one after the other from a base frame P to a tip frame S, all frames parallel at zero angles.

    Attributes:
        hinges: from the base to the tip.
        tip: S from the last hinge, in the frame that it carries [m].
    """

    hinges: Sequence[Hinge]
    tip: Vector

    @staticmethod
    def of(plant: MultibodyPlant, base_frame: str, tip_frame: str, joint_names: Sequence[str]) -> "RevoluteChain":
        """The chain through the named joints of a plant, from the base to the tip.

        Raises:
            ValueError: a joint is no hinge about x, y or z of the base, or the tip is turned, at zero angles.
        """
        context = plant.CreateDefaultContext()
        P, S = plant.GetFrameByName(base_frame), plant.GetFrameByName(tip_frame)
        hinges, last = [], np.zeros(3)
        for name in joint_names:
            joint = plant.GetJointByName(name)
            if not isinstance(joint, RevoluteJoint) or joint.get_angle(context) != 0.0:
                raise ValueError(f"{name}: no hinge, or not at zero")
            X_PJ = joint.frame_on_parent().CalcPose(context, P)
            turn = X_PJ.rotation().matrix() @ joint.revolute_axis()
            axis = int(np.argmax(np.abs(turn)))
            if not np.isclose(abs(turn[axis]), 1.0, rtol=0.0, atol=1e-12):
                raise ValueError(f"{name}: turns about {turn}, not about x, y or z of {base_frame}")
            p_PJ = X_PJ.translation()
            hinges.append(Hinge(axis, float(np.sign(turn[axis])), tuple((p_PJ - last).tolist())))
            last = p_PJ
        X_PS = S.CalcPose(context, P)
        if not X_PS.rotation().IsNearlyIdentity(1e-12):
            raise ValueError(f"{tip_frame}: turned in {base_frame}")
        return RevoluteChain(tuple(hinges), tuple((X_PS.translation() - last).tolist()))

    def at(self, theta: Sequence[float]) -> ChainState:
        """The chain at joint angles theta [rad], n of them."""
        frame: list[Vector] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
        p: Vector = NOWHERE
        axes, points = [], []
        for hinge, angle in zip(self.hinges, theta, strict=True):
            if hinge.offset != NOWHERE:
                p = _along(frame, p, hinge.offset)
            points.append(p)
            k, sign = hinge.axis, hinge.sign
            a, b, c = frame[k]
            axes.append((sign * a, sign * b, sign * c))
            # The other two axes turn in their plane.
            i, j = k - 2, k - 1
            cosine, sine = math.cos(angle), sign * math.sin(angle)
            (a, b, c), (d, e, f) = frame[i], frame[j]
            frame[i] = cosine * a + sine * d, cosine * b + sine * e, cosine * c + sine * f
            frame[j] = cosine * d - sine * a, cosine * e - sine * b, cosine * f - sine * c
        x, y, z = frame
        return ChainState((x, y, z, _along(frame, p, self.tip)), axes, points)


def _along(frame: Sequence[Vector], p: Vector, offset: Vector) -> Vector:
    """The point with an offset in a frame from p."""
    (a, b, c), (d, e, f), (g, h, i) = frame
    x, y, z = offset
    return p[0] + a * x + d * y + g * z, p[1] + b * x + e * y + h * z, p[2] + c * x + f * y + i * z
