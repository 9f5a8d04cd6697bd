"""LeafSystem: the balance that the thesis assumes, as a force on the pelvis."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.joint_map import pelvis_pose, pelvis_velocity
from humanwalk.control.balance_support import BalanceSupportParameters, support_wrench
from humanwalk.systems.signal import Signal, xyz

WRENCH_COLUMNS = (*xyz("support.torque_", "N_m"), *xyz("support.force_", "N"))


class BalanceSupport(LeafSystem):
    """A spatial spring-damper that holds the pelvis on the walking reference, see `support_wrench`.

    It replaces the balance controller that the thesis assumes: a walk with this support does not balance. The wrench is
    an output so that a run records it.

    Inputs:
        pelvis_reference: (13) desired state of the pelvis in W, in the order of Drake's floating base: quaternion wxyz,
            position [m], angular velocity [rad/s], velocity [m/s].
        state: plant state [q; v].

    Outputs:
        wrench: (6) torque [N m], force [N] on the pelvis at its origin Po, in W.
        generalized_force: (nv) the wrench as generalized force, for the plant's applied_generalized_force port.
    """

    def __init__(self, plant: MultibodyPlant, parameters: BalanceSupportParameters) -> None:
        """Make the support of a finalized plant with a floating pelvis."""
        super().__init__()
        self._parameters = parameters
        self._num_positions = plant.num_positions()
        self._pose, self._velocity = pelvis_pose(plant), pelvis_velocity(plant)
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._wrench = self.DeclareVectorOutputPort("wrench", 6, self._calc_wrench)
        self.DeclareVectorOutputPort("generalized_force", plant.num_velocities(), self._calc_generalized_force)
        self.signals = (Signal("support_wrench", self._wrench, WRENCH_COLUMNS),)

    def _calc_wrench(self, context: Context, output: BasicVector) -> None:
        state, reference = self._state.Eval(context), self._reference.Eval(context)
        q, v = state[: self._num_positions], state[self._num_positions :]
        output.SetFromVector(support_wrench(q[self._pose], v[self._velocity], reference, self._parameters))

    def _calc_generalized_force(self, context: Context, output: BasicVector) -> None:
        # The velocities of the floating base are the spatial velocity of the pelvis in W.
        force = np.zeros(output.size())
        force[self._velocity] = self._wrench.Eval(context)
        output.SetFromVector(force)
