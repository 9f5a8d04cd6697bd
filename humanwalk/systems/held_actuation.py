"""Diagram: the torques of actuators that hold samples, out of Drake's own systems."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.symbolic import MakeVectorContinuousVariable, Variable
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import Adder, Multiplexer, Saturation, SparseMatrixGain, SymbolicVectorSystem
from scipy.sparse import csc_matrix

from humanwalk.body.joint_map import JointMap
from humanwalk.numerics import Array, Indices


class HeldActuation(Diagram):
    """The output `actuation` of a semi-implicit `PdActuatorBank` to which no samples before the present ones are given.

    The plant asks in every step; to ask Python took a twelfth of a balanced walk. With gains and limits of the bank,

        tau = clip(kp (q_d + v_d (t - t_d) - q) + kd (v_d - v) + feedforward) + kd v

    Inputs:
        desired_state: (2n) q_d [rad], then v_d [rad/s], in actuator order.
        sample_time: (1) t_d [s].
        feedforward: (n) [N m].
        state: plant state [q; v].

    Outputs:
        actuation: (n) torque for the plant's actuation port [N m].
    """

    def __init__(self, plant: MultibodyPlant, kp: Array, kd: Array, effort_limits: Array) -> None:
        """Make the law of a finalised plant.

        Args:
            plant: whose joints are driven.
            kp, kd: gains [N m/rad], [N m s/rad], shape (n,), in actuator order.
            effort_limits: [N m], shape (n,).
        """
        super().__init__()
        n, stiff = kp.size, np.flatnonzero(kp)
        builder = DiagramBuilder()

        def gain(rows: int, columns: int, *entries: tuple[Indices, Indices, Array]) -> SparseMatrixGain:
            """Multiplication by a matrix, told by rows, columns and values of its entries."""
            i, j, values = (np.concatenate(parts) for parts in zip(*entries, strict=True))
            return builder.AddSystem(SparseMatrixGain(csc_matrix((values, (i, j)), shape=(rows, columns))))

        joints, nx = JointMap.of(plant), plant.num_multibody_states()
        joint, q, v = np.arange(n), joints.q, joints.num_positions + joints.v
        of_desired = gain(n, 2 * n, (joint, joint, kp), (joint, n + joint, kd))
        of_state = gain(n, nx, (joint, q, -kp), (joint, v, -kd))
        damping = gain(n, nx, (joint, v, kd))
        # What the angles go on after the sample: of few joints, since most are only damped.
        rates = gain(stiff.size, 2 * n, (np.arange(stiff.size), n + stiff, kp[stiff]))
        rates_and_time = builder.AddSystem(Multiplexer([stiff.size, 1]))
        t, x = Variable("t"), MakeVectorContinuousVariable(stiff.size + 1, "x")
        # Drake's expressions raise the processor's flag for numbers that are none, which NumPy would report.
        with np.errstate(invalid="ignore"):
            moved_on = builder.AddSystem(SymbolicVectorSystem(time=t, input=x, output=x[:-1] * (t - x[-1])))
        of_moving = gain(n, stiff.size, (stiff, np.arange(stiff.size), np.ones(stiff.size)))

        law, torque = builder.AddSystem(Adder(4, n)), builder.AddSystem(Adder(2, n))
        limited = builder.AddSystem(Saturation(-effort_limits, effort_limits))
        for source, sink in (
            (rates, rates_and_time.get_input_port(0)),
            (rates_and_time, moved_on.get_input_port()),
            (moved_on, of_moving.get_input_port()),
            (of_desired, law.get_input_port(0)),
            (of_state, law.get_input_port(1)),
            (of_moving, law.get_input_port(2)),
            (law, limited.get_input_port()),
            (limited, torque.get_input_port(0)),
            (damping, torque.get_input_port(1)),
        ):
            builder.Connect(source.get_output_port(), sink)
        builder.ExportInput(of_desired.get_input_port(), "desired_state")
        builder.ConnectInput("desired_state", rates.get_input_port())
        builder.ExportInput(rates_and_time.get_input_port(1), "sample_time")
        builder.ExportInput(law.get_input_port(3), "feedforward")
        builder.ExportInput(of_state.get_input_port(), "state")
        builder.ConnectInput("state", damping.get_input_port())
        builder.ExportOutput(torque.get_output_port(), "actuation")
        builder.BuildInto(self)
