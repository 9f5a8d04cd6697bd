"""Diagram: the balance that the thesis assumes, made visible as a force on the pelvis."""

import numpy as np
from pydrake.common import RandomDistribution
from pydrake.multibody.plant import MultibodyPlant
from pydrake.symbolic import MakeVectorContinuousVariable
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import (
    Demultiplexer,
    LinearTransformDensity,
    Multiplexer,
    SparseMatrixGain,
    SymbolicVectorSystem,
)
from scipy.linalg import block_diag
from scipy.sparse import csc_matrix

from humanwalk.control.balance_support import (
    BalanceSupportParameters,
    linear_gain,
    relative_quaternion,
    turning_stiffness,
)


class BalanceSupport(Diagram):
    """A spatial spring-damper that holds the pelvis on the walking reference.

    It stands for the balance controller that the thesis assumes; a walk that needs it does not balance. Its wrench
    is an output so that nobody takes it for balance. The plant asks for it in every step, so the law is made of
    Drake's own blocks, with expressions for what is not linear, and no Python is run.

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
        n, of_velocities = plant.num_positions(), slice(first_v, first_v + 6)
        selected = block_diag(
            np.eye(13), np.eye(n)[first_q : first_q + 7], np.eye(plant.num_velocities())[of_velocities]
        )
        linear = linear_gain(parameters)
        # From reference and motion of the pelvis: the matrix, by columns, that makes a relative quaternion of one, then
        # the pelvis' quaternion, then what is linear.
        relative = np.array([[relative_quaternion(one, reference) for reference in np.eye(4)] for one in np.eye(4)])
        gains = np.zeros((16 + 4 + 6, 26))
        gains[:16, :4] = relative.swapaxes(1, 2).reshape(16, 4)
        gains[16:20, 13:17] = np.eye(4)
        gains[20:, 4:13], gains[20:, 17:] = -linear, linear
        builder = DiagramBuilder()
        inputs = builder.AddSystem(Multiplexer([13, plant.num_multibody_states()]))
        parts = builder.AddSystem(SparseMatrixGain(csc_matrix(gains @ selected)))
        split = builder.AddSystem(Demultiplexer([16, 4, 6]))
        # It is made for random inputs, but does what is wanted: A w + b, with A and b from ports.
        rotation = builder.AddSystem(LinearTransformDensity(RandomDistribution.kUniform, 4, 4))
        turn = MakeVectorContinuousVariable(4, "turn")
        # Drake's expressions raise the processor's flag for numbers that are none, which NumPy would report.
        with np.errstate(invalid="ignore"):
            scale = turning_stiffness(turn, parameters)
        # Products are cheap in matrices and dear in expressions.
        stiffness = builder.AddSystem(SymbolicVectorSystem(input=turn, output=[scale]))
        axis = builder.AddSystem(SparseMatrixGain(csc_matrix(np.eye(6, 4, 1))))
        wrench = builder.AddSystem(LinearTransformDensity(RandomDistribution.kUniform, 1, 6))
        force = builder.AddSystem(SparseMatrixGain(csc_matrix(np.eye(plant.num_velocities())[:, of_velocities])))
        builder.Connect(inputs.get_output_port(), parts.get_input_port())
        builder.Connect(parts.get_output_port(), split.get_input_port())
        builder.Connect(split.get_output_port(0), rotation.get_input_port_A())
        builder.Connect(split.get_output_port(1), rotation.get_input_port_w_in())
        builder.Connect(rotation.get_output_port_w_out(), stiffness.get_input_port())
        builder.Connect(rotation.get_output_port_w_out(), axis.get_input_port())
        builder.Connect(axis.get_output_port(), wrench.get_input_port_A())
        builder.Connect(stiffness.get_output_port(), wrench.get_input_port_w_in())
        builder.Connect(split.get_output_port(2), wrench.get_input_port_b())
        builder.Connect(wrench.get_output_port_w_out(), force.get_input_port())
        builder.ExportInput(inputs.get_input_port(0), "pelvis_reference")
        builder.ExportInput(inputs.get_input_port(1), "state")
        builder.ExportOutput(wrench.get_output_port_w_out(), "wrench")
        builder.ExportOutput(force.get_output_port(), "generalized_force")
        builder.BuildInto(self)
