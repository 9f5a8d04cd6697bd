"""Diagram: torques of a linear law between samples, without Python."""

import numpy as np
from pydrake.common import RandomDistribution
from pydrake.multibody.plant import MultibodyPlant
from pydrake.symbolic import MakeVectorContinuousVariable, Variable
from pydrake.symbolic import max as max_
from pydrake.symbolic import min as min_
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import (
    LinearTransformDensity,
    Multiplexer,
    PassThrough,
    SparseMatrixGain,
    SymbolicVectorSystem,
)
from scipy.sparse import csc_matrix

from humanwalk.body.joint_map import JointMap
from humanwalk.control.hermite import ROWS, basis, weights
from humanwalk.numerics import Array


class LinearLaw(Diagram):
    """tau = kp (q_d - q) + kd v_d + feedforward for each joint, in actuator order.

    What a PdActuatorBank whose law is linear gives the plant, of samples that are a fixed time apart. The cubic between
    two of them is worked out when they change, its value in every step, both by Drake's own blocks.

    Inputs:
        previous_state, desired_state: (2n) samples before and after the present, q_d [rad], then v_d [rad/s].
        previous_time: (1) time of the one before [s].
        state: plant state [q; v].
        feedforward: (n) torque added to the law [N m]. Optional: zero.

    Output:
        actuation: (n) torque for the plant's actuation port [N m].
    """

    def __init__(self, plant: MultibodyPlant, kp: Array, kd: Array, period: float) -> None:
        """Make the law of a finalised plant.

        Args:
            plant: whose joints are driven.
            kp, kd: gains [N m/rad], [N m s/rad], shape (n,), in actuator order.
            period: between two samples [s].
        """
        super().__init__()
        n = kp.size
        builder = DiagramBuilder()
        t, t0 = Variable("t"), MakeVectorContinuousVariable(1, "t0")
        of_time = np.array(weights(t, t0[0], t0[0] + period, min_, max_))
        now = builder.AddSystem(SymbolicVectorSystem(time=t, input=t0, output=of_time))
        fed = builder.AddSystem(PassThrough(n))
        inputs = builder.AddSystem(Multiplexer([2 * n, 2 * n, n]))
        of_q, of_v = basis(period)[::2], basis(period)[1::2]
        of_samples = np.kron(of_q, np.diag(kp)) + np.kron(of_v, np.diag(kd))
        constant = np.eye(ROWS * n, n)
        driving = builder.AddSystem(SparseMatrixGain(csc_matrix(np.hstack((of_samples, constant)))))
        of_state = csc_matrix((-kp, (np.arange(n), JointMap.of(plant).q)), shape=(n, plant.num_multibody_states()))
        stiffness = builder.AddSystem(SparseMatrixGain(of_state))
        # It is made for random inputs, but does what is wanted: A w + b, with A and b from ports.
        torque = builder.AddSystem(LinearTransformDensity(RandomDistribution.kUniform, ROWS, n))
        builder.Connect(fed.get_output_port(), inputs.get_input_port(2))
        builder.Connect(inputs.get_output_port(), driving.get_input_port())
        builder.Connect(driving.get_output_port(), torque.get_input_port_A())
        builder.Connect(now.get_output_port(), torque.get_input_port_w_in())
        builder.Connect(stiffness.get_output_port(), torque.get_input_port_b())
        builder.ExportInput(inputs.get_input_port(0), "previous_state")
        builder.ExportInput(inputs.get_input_port(1), "desired_state")
        builder.ExportInput(now.get_input_port(), "previous_time")
        builder.ExportInput(stiffness.get_input_port(), "state")
        builder.ExportInput(fed.get_input_port(), "feedforward")
        builder.ExportOutput(torque.get_output_port_w_out(), "actuation")
        builder.BuildInto(self)
