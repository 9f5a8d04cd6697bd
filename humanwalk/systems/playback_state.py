"""LeafSystem: the plant's state that a walking reference asks for, without physics."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.joint_map import JointMap


class PlaybackState(LeafSystem):
    """Puts the pelvis and the joints exactly where they are desired to be, as fast as they are desired to move.

    Inputs:
        pelvis_reference: (13) state of the pelvis in W as Drake's floating base has it: quaternion wxyz, position [m],
            angular velocity [rad/s], velocity [m/s].
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.

    Outputs:
        state: (nq + nv) plant state [q; v].
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the system for a finalised plant whose floating base is the body `Pelvis`."""
        super().__init__()
        self._joints = JointMap.of(plant)
        pelvis = plant.GetBodyByName("Pelvis")
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
