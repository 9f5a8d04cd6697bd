"""LeafSystem: the balance that the thesis assumes, made visible as a force on the pelvis."""

import math

import numpy as np
import numpy.typing as npt
from pydrake.common.eigen_geometry import Quaternion
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce, SpatialVelocity
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, InputPort, LeafSystem, OutputPort

from humanwalk.control.balance_support import BalanceSupportParameters, support_wrench

Array = npt.NDArray[np.float64]


def _pose(q: Array) -> RigidTransform:
    """Pose out of a floating base's positions [quaternion wxyz; translation]; Drake lets its norm drift."""
    wxyz = q[:4]
    return RigidTransform(Quaternion(wxyz / math.sqrt(wxyz @ wxyz)), q[4:])


class BalanceSupport(LeafSystem):
    """A spatial spring-damper that holds the pelvis on the walking reference.

    It stands for the balance controller that the thesis assumes; a walk that needs it does not balance. Its wrench
    is an output so that nobody takes it for balance.

    Inputs:
        X_WP: RigidTransform, reference pose of the pelvis in the world.
        V_WP: SpatialVelocity, its velocity in the world.
        state: plant state [q; v].

    Outputs:
        spatial_forces: list of ExternallyAppliedSpatialForce, for the plant's applied_spatial_force port.
        wrench: (6) torque [N m], force [N] on the pelvis at its origin Po, in W.
    """

    def __init__(self, plant: MultibodyPlant, parameters: BalanceSupportParameters) -> None:
        """Make the support of a finalised plant whose floating base is the body `Pelvis`."""
        super().__init__()
        self._parameters = parameters
        pelvis = plant.GetBodyByName("Pelvis")
        self._pelvis_index = pelvis.index()
        self._q = slice(pelvis.floating_positions_start(), pelvis.floating_positions_start() + 7)
        first_v = plant.num_positions() + pelvis.floating_velocities_start_in_v()
        self._v = slice(first_v, first_v + 6)
        self._X_WP = self.DeclareAbstractInputPort("X_WP", Value(RigidTransform()))
        self._V_WP = self.DeclareAbstractInputPort("V_WP", Value(SpatialVelocity()))
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        inputs = {self.all_input_ports_ticket()}
        self._wrench_output = self.DeclareVectorOutputPort("wrench", 6, self._calc_wrench, prerequisites_of_calc=inputs)
        self._forces_output = self.DeclareAbstractOutputPort(
            "spatial_forces",
            lambda: Value([ExternallyAppliedSpatialForce()]),
            self._calc_forces,
            prerequisites_of_calc=inputs,
        )

    def _calc_wrench(self, context: Context, output: BasicVector) -> None:
        state = self._state.Eval(context)
        output.SetFromVector(
            support_wrench(
                _pose(state[self._q]),
                state[self._v],
                self._X_WP.Eval(context),
                self._V_WP.Eval(context).get_coeffs(),
                self._parameters,
            )
        )

    def _calc_forces(self, context: Context, output: Value) -> None:
        wrench = self._wrench_output.Eval(context)
        force = ExternallyAppliedSpatialForce()
        force.body_index = self._pelvis_index
        force.F_Bq_W = SpatialForce(wrench)
        output.set_value([force])

    def get_reference_pose_input_port(self) -> InputPort:
        """Input X_WP."""
        return self._X_WP

    def get_reference_velocity_input_port(self) -> InputPort:
        """Input V_WP."""
        return self._V_WP

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self._state

    def get_spatial_forces_output_port(self) -> OutputPort:
        """Output spatial_forces."""
        return self._forces_output

    def get_wrench_output_port(self) -> OutputPort:
        """Output wrench."""
        return self._wrench_output
