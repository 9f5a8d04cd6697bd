"""LeafSystem: the plant state of a walking reference, without physics."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import PELVIS


class PlaybackState(LeafSystem):
    """The plant state in which pelvis and joints have their desired positions and velocities.

    Inputs:
        pelvis_reference: (13) desired state of the pelvis in W, in the order of Drake's floating base: quaternion wxyz,
            position [m], angular velocity [rad/s], velocity [m/s].
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.

    Outputs:
        state: (nq + nv) plant state [q; v].
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the system for a finalized plant with a floating pelvis."""
        super().__init__()
        self._joints = JointMap.of(plant)
        pelvis = plant.GetBodyByName(PELVIS)
        self._pose = slice(pelvis.floating_positions_start(), pelvis.floating_positions_start() + 7)
        velocity = plant.num_positions() + pelvis.floating_velocities_start_in_v()
        self._velocity = slice(velocity, velocity + 6)
        self._rates = plant.num_positions() + self._joints.v
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * len(self._joints.names))
        self._output = self.DeclareVectorOutputPort("state", plant.num_multibody_states(), self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        pelvis = self._reference.Eval(context)
        angles, rates = np.split(self._desired.Eval(context), 2)
        state = np.zeros(output.size())
        state[self._pose], state[self._velocity] = pelvis[:7], pelvis[7:]
        state[self._joints.q] = angles
        state[self._rates] = rates
        output.SetFromVector(state)
