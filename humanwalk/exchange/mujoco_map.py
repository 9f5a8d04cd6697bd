"""Conversion between the human's coordinates in MuJoCo and in Drake."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RotationMatrix

from humanwalk.body.joint_map import JointMap
from humanwalk.numerics import Array, Indices


@dataclass(frozen=True)
class MujocoMap:
    """Indices of the joints, in actuator order, in the coordinates of both programs.

    A floating pelvis has in Drake the coordinates [quaternion, position] and [angular velocity in W, velocity], the
    last about its origin; in MuJoCo [position, quaternion] and [velocity, angular velocity in the pelvis' frame].

    Attributes:
        joints: Indices in Drake.
        qpos, qvel: Indices in MuJoCo, shape (n,).
    """

    joints: JointMap
    qpos: Indices
    qvel: Indices

    @staticmethod
    def of(joints: JointMap, model: Any) -> "MujocoMap":
        """The map to a compiled model (mujoco.MjModel) of the text of `to_mjcf`."""
        found = [model.joint(name) for name in joints.names]
        qpos, qvel = (np.concatenate([getattr(joint, place) for joint in found]) for place in ("qposadr", "dofadr"))
        return MujocoMap(joints, qpos, qvel)

    def to_qpos(self, q: Array) -> Array:
        """MuJoCo's positions from Drake's q, shape (7 + n,) each."""
        qpos = np.empty_like(q)
        qpos[:3], qpos[3:7] = q[4:7], q[:4]
        qpos[self.qpos] = q[self.joints.q]
        return qpos

    def to_q(self, qpos: Array) -> Array:
        """Drake's positions from MuJoCo's, shape (7 + n,) each."""
        q = np.empty_like(qpos)
        q[:4], q[4:7] = qpos[3:7], qpos[:3]
        q[self.joints.q] = qpos[self.qpos]
        return q

    def velocity_matrix(self, q: Array) -> Array:
        """T in v = T qvel, from MuJoCo's velocities to Drake's, shape (6 + n, 6 + n).

        It is orthogonal. Generalized forces transform by its transpose, from Drake to MuJoCo.
        """
        T = np.zeros((6 + self.qvel.size, 6 + self.qvel.size))
        T[:3, 3:6] = RotationMatrix(Quaternion(q[:4] / np.linalg.norm(q[:4]))).matrix()
        T[3:6, :3] = np.eye(3)
        T[self.joints.v, self.qvel] = 1.0
        return T
