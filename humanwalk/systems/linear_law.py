"""Diagram: torques of a linear law between samples, without Python in any step."""

import numpy as np
import numpy.typing as npt
from pydrake.common import RandomDistribution
from pydrake.multibody.plant import MultibodyPlant
from pydrake.symbolic import MakeVectorContinuousVariable, Variable
from pydrake.symbolic import max as max_
from pydrake.symbolic import min as min_
from pydrake.systems.framework import Diagram, DiagramBuilder, InputPort, OutputPort
from pydrake.systems.primitives import LinearTransformDensity, SparseMatrixGain, SymbolicVectorSystem
from scipy.sparse import csc_matrix

from humanwalk.control.hermite import ROWS, weights
from humanwalk.control.joint_map import JointMap

Array = npt.NDArray[np.float64]


class LinearLaw(Diagram):
    """tau = driving torque of now - kp q for each joint, in actuator order.

    What a PdActuatorBank whose law is linear gives the plant. The plant asks in every step; the bank is asked only
    when samples change, and Drake's own blocks do what is left.

    Inputs:
        driving (6n), driving_times (2): see PdActuatorBank.
        state: plant state [q; v].

    Output:
        actuation: (n) torque for the plant's actuation port [N m].
    """

    def __init__(self, plant: MultibodyPlant, kp: Array) -> None:
        """Make the law of a finalised plant with gains kp [N m/rad], shape (n,), in actuator order."""
        super().__init__()
        n = kp.size
        builder = DiagramBuilder()
        t, times = Variable("t"), MakeVectorContinuousVariable(2, "t")
        now = builder.AddSystem(
            SymbolicVectorSystem(time=t, input=times, output=np.array(weights(t, times[0], times[1], min_, max_)))
        )
        of_state = csc_matrix((-kp, (np.arange(n), JointMap.of(plant).q)), shape=(n, plant.num_multibody_states()))
        stiffness = builder.AddSystem(SparseMatrixGain(of_state))
        # It is made for random inputs, but does what is wanted: A w + b, with A and b from ports.
        torque = builder.AddSystem(LinearTransformDensity(RandomDistribution.kUniform, ROWS, n))
        builder.Connect(now.get_output_port(), torque.get_input_port_w_in())
        builder.Connect(stiffness.get_output_port(), torque.get_input_port_b())
        builder.ExportInput(torque.get_input_port_A(), "driving")
        builder.ExportInput(now.get_input_port(), "driving_times")
        builder.ExportInput(stiffness.get_input_port(), "state")
        builder.ExportOutput(torque.get_output_port_w_out(), "actuation")
        builder.BuildInto(self)

    def get_driving_input_port(self) -> InputPort:
        """Input driving."""
        return self.GetInputPort("driving")

    def get_driving_times_input_port(self) -> InputPort:
        """Input driving_times."""
        return self.GetInputPort("driving_times")

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self.GetInputPort("state")

    def get_actuation_output_port(self) -> OutputPort:
        """Output actuation."""
        return self.GetOutputPort("actuation")
