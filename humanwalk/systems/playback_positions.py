"""LeafSystem: the plant's positions that a walking reference asks for, without physics."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, InputPort, LeafSystem, OutputPort

from humanwalk.control.joint_map import JointMap


class PlaybackPositions(LeafSystem):
    """Puts the pelvis and the joints exactly where they are desired to be.

    Inputs:
        pelvis_reference: (13) state of the pelvis as Drake's floating base has it; the pose is its first 7 elements.
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.

    Outputs:
        positions: (nq) plant positions q, for MultibodyPositionToGeometryPose.
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the system for a finalised plant whose floating base is the body `Pelvis`."""
        super().__init__()
        self._joints = JointMap.of(plant)
        start = plant.GetBodyByName("Pelvis").floating_positions_start()
        self._pelvis = slice(start, start + 7)
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * len(self._joints.names))
        self._output = self.DeclareVectorOutputPort("positions", plant.num_positions(), self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        q = np.zeros(output.size())
        q[self._pelvis] = self._reference.Eval(context)[:7]
        q[self._joints.q] = self._desired.Eval(context)[: self._joints.q.size]
        output.SetFromVector(q)

    def get_pelvis_reference_input_port(self) -> InputPort:
        """Input pelvis_reference."""
        return self._reference

    def get_desired_state_input_port(self) -> InputPort:
        """Input desired_state."""
        return self._desired

    def get_positions_output_port(self) -> OutputPort:
        """Output positions."""
        return self._output
