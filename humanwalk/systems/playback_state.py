"""LeafSystem: the plant state of a walking reference, without physics."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import PELVIS


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
        joints, pelvis, nq = JointMap.of(plant), plant.GetBodyByName(PELVIS), plant.num_positions()
        base_q, base_v = pelvis.floating_positions_start(), nq + pelvis.floating_velocities_start_in_v()
        self._base = np.concatenate((np.arange(base_q, base_q + 7), np.arange(base_v, base_v + 6)))
        self._joints = np.concatenate((joints.q, nq + joints.v))
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._desired = self.DeclareVectorInputPort("desired_state", self._joints.size)
        self.DeclareVectorOutputPort("state", plant.num_multibody_states(), self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        state = np.zeros(output.size())
        state[self._base] = self._reference.Eval(context)
        state[self._joints] = self._desired.Eval(context)
        output.SetFromVector(state)
