"""LeafSystem: the plant state of a walking reference, without physics."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.joint_map import JointMap, pelvis_pose, pelvis_velocity


class PlaybackState(LeafSystem):
    """The plant state in which pelvis and joints have their desired positions and velocities.

    Inputs:
        pelvis_reference: (13) desired motion of the pelvis in W, in the order of Drake's floating base: quaternion
            wxyz, position [m], angular velocity [rad/s], velocity [m/s].
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.

    Outputs:
        state: (nq + nv) plant state [q; v].
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the system for a finalized plant with a floating pelvis."""
        super().__init__()
        joints, nq = JointMap.of(plant), plant.num_positions()
        self._base = np.concatenate((np.r_[pelvis_pose(plant)], nq + np.r_[pelvis_velocity(plant)]))
        self._joints = np.concatenate((joints.q, nq + joints.v))
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._desired = self.DeclareVectorInputPort("desired_state", self._joints.size)
        self.DeclareVectorOutputPort("state", plant.num_multibody_states(), self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        state = np.zeros(output.size())
        state[self._base] = self._reference.Eval(context)
        state[self._joints] = self._desired.Eval(context)
        output.SetFromVector(state)
