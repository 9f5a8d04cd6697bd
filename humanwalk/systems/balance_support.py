"""Diagram: the balance that the thesis assumes, made visible as a force on the pelvis."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.symbolic import MakeVectorContinuousVariable
from pydrake.systems.framework import Diagram, DiagramBuilder, InputPort, OutputPort
from pydrake.systems.primitives import Multiplexer, SparseMatrixGain, SymbolicVectorSystem
from scipy.linalg import block_diag
from scipy.sparse import csc_matrix

from humanwalk.control.balance_support import BalanceSupportParameters, error_of_reference, wrench_of_error


class BalanceSupport(Diagram):
    """A spatial spring-damper that holds the pelvis on the walking reference.

    It stands for the balance controller that the thesis assumes; a walk that needs it does not balance. Its wrench
    is an output so that nobody takes it for balance. The plant asks for it in every step, so the law is handed to
    Drake as an expression and no Python is run.

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
        pelvis = plant.GetBodyByName("Pelvis")
        first_q, first_v = pelvis.floating_positions_start(), pelvis.floating_velocities_start_in_v()
        of_velocities = np.eye(plant.num_velocities())[first_v : first_v + 6]
        of_state = block_diag(np.eye(plant.num_positions())[first_q : first_q + 7], of_velocities)
        builder = DiagramBuilder()
        pelvis_motion = builder.AddSystem(SparseMatrixGain(csc_matrix(of_state)))
        motions = builder.AddSystem(Multiplexer([13, 13]))
        x, e = MakeVectorContinuousVariable(26, "x"), MakeVectorContinuousVariable(13, "e")
        # Drake's expressions raise the processor's flag for numbers that are none, which NumPy would report.
        with np.errstate(invalid="ignore"):
            off = error_of_reference(x[13:20], x[20:], x[:13])
            law = wrench_of_error(e, parameters)
        # In one expression the rotation's quaternion would be worked out anew wherever it stands.
        error = builder.AddSystem(SymbolicVectorSystem(input=x, output=off))
        wrench = builder.AddSystem(SymbolicVectorSystem(input=e, output=law))
        force = builder.AddSystem(SparseMatrixGain(csc_matrix(of_velocities.T)))
        builder.Connect(pelvis_motion.get_output_port(), motions.get_input_port(1))
        builder.Connect(motions.get_output_port(), error.get_input_port())
        builder.Connect(error.get_output_port(), wrench.get_input_port())
        builder.Connect(wrench.get_output_port(), force.get_input_port())
        builder.ExportInput(motions.get_input_port(0), "pelvis_reference")
        builder.ExportInput(pelvis_motion.get_input_port(), "state")
        builder.ExportOutput(wrench.get_output_port(), "wrench")
        builder.ExportOutput(force.get_output_port(), "generalized_force")
        builder.BuildInto(self)

    def get_pelvis_reference_input_port(self) -> InputPort:
        """Input pelvis_reference."""
        return self.GetInputPort("pelvis_reference")

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self.GetInputPort("state")

    def get_wrench_output_port(self) -> OutputPort:
        """Output wrench."""
        return self.GetOutputPort("wrench")

    def get_generalized_force_output_port(self) -> OutputPort:
        """Output generalized_force."""
        return self.GetOutputPort("generalized_force")
