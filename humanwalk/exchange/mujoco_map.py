"""The human's coordinates in MuJoCo, and what they are in Drake."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RotationMatrix

from humanwalk.body.joint_map import JointMap
from humanwalk.numerics import Array, Indices


@dataclass(frozen=True)
class MujocoMap:
    """Places of the joints, in actuator order, in both programs' coordinates.

    A floating pelvis has in Drake the coordinates [quaternion, position] and [angular velocity in W, velocity], the
    last about its origin; in MuJoCo [position, quaternion] and [velocity, angular velocity in the pelvis' frame].

    Attributes:
        joints: places in Drake's.
        qpos, qvel: places of the joints in MuJoCo's, shape (n,).
    """

    joints: JointMap
    qpos: Indices
    qvel: Indices

    @staticmethod
    def of(joints: JointMap, model: Any) -> "MujocoMap":
        """The map to a compiled MuJoCo model (mujoco.MjModel) of what `to_mjcf` wrote."""
        found = [model.joint(name) for name in joints.names]
        qpos, qvel = (np.concatenate([getattr(joint, place) for joint in found]) for place in ("qposadr", "dofadr"))
        return MujocoMap(joints, qpos, qvel)

    def to_qpos(self, q: Array) -> Array:
        """MuJoCo's positions of Drake's q, shape (7 + n,) each."""
        qpos = np.empty_like(q)
        qpos[:3], qpos[3:7] = q[4:7], q[:4]
        qpos[self.qpos] = q[self.joints.q]
        return qpos

    def to_q(self, qpos: Array) -> Array:
        """Drake's positions of MuJoCo's."""
        q = np.empty_like(qpos)
        q[:4], q[4:7] = qpos[3:7], qpos[:3]
        q[self.joints.q] = qpos[self.qpos]
        return q

    def velocity_matrix(self, q: Array) -> Array:
        """T with v = T qvel, Drake's velocities of MuJoCo's; generalized forces go the other way, by T'.

        Orthogonal, so its transpose is its inverse; shape (6 + n, 6 + n).
        """
        T = np.zeros((6 + self.qvel.size, 6 + self.qvel.size))
        T[:3, 3:6] = RotationMatrix(Quaternion(q[:4] / np.linalg.norm(q[:4]))).matrix()
        T[3:6, :3] = np.eye(3)
        T[self.joints.v, self.qvel] = 1.0
        return T
