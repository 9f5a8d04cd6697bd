"""LeafSystem: the balance that the thesis assumes, made visible as a force on the pelvis."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, InputPort, LeafSystem, OutputPort

from humanwalk.control.balance_support import BalanceSupportParameters, support_wrench


class BalanceSupport(LeafSystem):
    """A spatial spring-damper that holds the pelvis on the walking reference.

    It stands for the balance controller that the thesis assumes; a walk that needs it does not balance. Its wrench
    is an output so that nobody takes it for balance.

    Inputs:
        pelvis_reference: (13) where the pelvis should be in W, as Drake's floating base has it: quaternion wxyz,
            position [m], angular velocity [rad/s], velocity [m/s].
        state: plant state [q; v].

    Outputs:
        wrench: (6) torque [N m], force [N] on the pelvis at its origin Po, in W.
        generalized_force: (nv) the same, for the plant's applied_generalized_force port: a floating base's own
            generalized forces are the wrench.
    """

    def __init__(self, plant: MultibodyPlant, parameters: BalanceSupportParameters) -> None:
        """Make the support of a finalised plant whose floating base is the body `Pelvis`."""
        super().__init__()
        self._parameters = parameters
        pelvis = plant.GetBodyByName("Pelvis")
        self._q = slice(pelvis.floating_positions_start(), pelvis.floating_positions_start() + 7)
        first_v = plant.num_positions() + pelvis.floating_velocities_start_in_v()
        self._v = slice(first_v, first_v + 6)
        self._base = slice(pelvis.floating_velocities_start_in_v(), pelvis.floating_velocities_start_in_v() + 6)
        self._reference = self.DeclareVectorInputPort("pelvis_reference", 13)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        inputs = {self.all_input_ports_ticket()}
        self._wrench_output = self.DeclareVectorOutputPort("wrench", 6, self._calc_wrench, prerequisites_of_calc=inputs)
        self._force_output = self.DeclareVectorOutputPort(
            "generalized_force", plant.num_velocities(), self._calc_force, prerequisites_of_calc=inputs
        )

    def _calc_wrench(self, context: Context, output: BasicVector) -> None:
        state = self._state.Eval(context)
        output.SetFromVector(
            support_wrench(state[self._q], state[self._v], self._reference.Eval(context), self._parameters)
        )

    def _calc_force(self, context: Context, output: BasicVector) -> None:
        force = np.zeros(output.size())
        force[self._base] = self._wrench_output.Eval(context)
        output.SetFromVector(force)

    def get_pelvis_reference_input_port(self) -> InputPort:
        """Input pelvis_reference."""
        return self._reference

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self._state

    def get_wrench_output_port(self) -> OutputPort:
        """Output wrench."""
        return self._wrench_output

    def get_generalized_force_output_port(self) -> OutputPort:
        """Output generalized_force."""
        return self._force_output
