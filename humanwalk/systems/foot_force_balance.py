"""LeafSystem: balance level 1 of the thesis, foot targets that follow desired ground forces."""

import numpy as np
import numpy.typing as npt
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, InputPort, LeafSystem, OutputPort

from humanwalk.body import SIDES, Side
from humanwalk.control.balance_levels import (
    FootForceBalanceParameters,
    desired_foot_forces,
    foot_shift_rate,
)

Array = npt.NDArray[np.float64]


class FootForceBalance(LeafSystem):
    """Shifts the targets of both soles towards desired ground contact forces (thesis Fig 4.10, level 1).

    The pelvis is taken as upright and heading along x, so that ground forces in W shift targets in P.

    Inputs:
        X_PRs, X_PLs: RigidTransform, planned poses of the soles in the pelvis P.
        V_PRs, V_PLs: SpatialVelocity of the same, in P.
        contact_schedule: (2) right, left: 1 in stance, 0 in swing.
        foot_forces: (16) of FootForceObserver.

    Outputs:
        X_PRs_shifted, X_PLs_shifted, V_PRs_shifted, V_PLs_shifted: the same, with the shift and its rate.
        shift: (12) right x y z, left x y z [m], then their rates [m/s].
    """

    def __init__(self, weight: float, parameters: FootForceBalanceParameters, period: float) -> None:
        """Make level 1 for a body of the given weight m g [N], updated every `period` seconds."""
        super().__init__()
        self._weight = weight
        self._parameters = parameters
        self._period = period
        self._X = {side: self.DeclareAbstractInputPort(f"X_P{side[0]}s", Value(RigidTransform())) for side in SIDES}
        self._V = {side: self.DeclareAbstractInputPort(f"V_P{side[0]}s", Value(SpatialVelocity())) for side in SIDES}
        self._schedule = self.DeclareVectorInputPort("contact_schedule", 2)
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._state = self.DeclareDiscreteState(12)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
        self._shift_output = self.DeclareStateOutputPort("shift", self._state)
        self._X_outputs, self._V_outputs = {}, {}
        for place, side in enumerate(SIDES):
            self._X_outputs[side] = self.DeclareAbstractOutputPort(
                f"X_P{side[0]}s_shifted",
                lambda: Value(RigidTransform()),
                lambda context, output, side=side, place=place: output.set_value(
                    self._shifted_pose(context, side, place)
                ),
            )
            self._V_outputs[side] = self.DeclareAbstractOutputPort(
                f"V_P{side[0]}s_shifted",
                lambda: Value(SpatialVelocity()),
                lambda context, output, side=side, place=place: output.set_value(
                    self._shifted_velocity(context, side, place)
                ),
            )

    def _shift_and_rate(self, context: Context) -> Array:
        """Shape (2, 2, 3): shift and rate, foot, axis."""
        values: Array = context.get_discrete_state(self._state).value().reshape(2, 2, 3)
        return values

    def _update(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        shift, rate = self._shift_and_rate(context)
        shift = shift + self._period * rate
        measured = self._foot_forces.Eval(context).reshape(2, 8)[:, :3]
        desired = desired_foot_forces(self._schedule.Eval(context), self._weight)
        rate = foot_shift_rate(shift, desired - measured, self._parameters)
        discrete.set_value(self._state, np.concatenate((shift.ravel(), rate.ravel())))
        return EventStatus.Succeeded()

    def _shifted_pose(self, context: Context, side: Side, place: int) -> RigidTransform:
        X = self._X[side].Eval(context)
        return RigidTransform(X.rotation(), X.translation() + self._shift_and_rate(context)[0, place])

    def _shifted_velocity(self, context: Context, side: Side, place: int) -> SpatialVelocity:
        V = self._V[side].Eval(context)
        return SpatialVelocity(V.rotational(), V.translational() + self._shift_and_rate(context)[1, place])

    def get_sole_pose_input_port(self, side: Side) -> InputPort:
        """Input X_PRs or X_PLs."""
        return self._X[side]

    def get_sole_velocity_input_port(self, side: Side) -> InputPort:
        """Input V_PRs or V_PLs."""
        return self._V[side]

    def get_contact_schedule_input_port(self) -> InputPort:
        """Input contact_schedule."""
        return self._schedule

    def get_foot_forces_input_port(self) -> InputPort:
        """Input foot_forces."""
        return self._foot_forces

    def get_sole_pose_output_port(self, side: Side) -> OutputPort:
        """Output X_PRs_shifted or X_PLs_shifted."""
        return self._X_outputs[side]

    def get_sole_velocity_output_port(self, side: Side) -> OutputPort:
        """Output V_PRs_shifted or V_PLs_shifted."""
        return self._V_outputs[side]

    def get_shift_output_port(self) -> OutputPort:
        """Output shift."""
        return self._shift_output
