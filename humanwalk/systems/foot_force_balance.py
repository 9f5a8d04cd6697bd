"""LeafSystem: balance level 1 of the thesis, sole targets that respond to ground reaction forces."""

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import SIDES
from humanwalk.contact.ground_force import FootForces
from humanwalk.control.balance_levels import FootForceBalanceParameters, desired_foot_forces, foot_shift_rate
from humanwalk.systems.signal import Signal, xyz

SHIFT_COLUMNS = tuple(
    column
    for prefix, unit in (("shift_", "m"), ("shift_velocity_", "m_s"))
    for side in SIDES
    for column in xyz(f"{side.lower()}_foot.{prefix}", unit)
)


class FootForceBalance(LeafSystem):
    """Shifts the targets of both soles toward desired ground reaction forces (thesis Fig 4.10, level 1).

    The pelvis is assumed upright with heading x, so that forces in W shift targets in P.

    Inputs:
        sole_targets: (26) planned poses and velocities of the soles in the pelvis P, see InverseKinematicsSolver.
        contact_schedule: (2) right, left: 1 in stance, 0 in swing.
        foot_forces: (16) see FootForceObserver.

    Outputs:
        shifted_targets: (26) sole_targets with the shift and its rate added.
        shift: (12) right x y z, left x y z [m], then their rates [m/s].
    """

    def __init__(self, weight: float, parameters: FootForceBalanceParameters, period: float) -> None:
        """Make level 1 for a body of weight m g [N], updated every `period` seconds."""
        super().__init__()
        self._weight, self._parameters, self._period = weight, parameters, period
        self._sole_targets = self.DeclareVectorInputPort("sole_targets", 26)
        self._schedule = self.DeclareVectorInputPort("contact_schedule", 2)
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._state = self.DeclareDiscreteState(12)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
        shift = self.DeclareStateOutputPort("shift", self._state)
        # The prerequisites exclude the other inputs, which in a walker depend on these targets.
        self.DeclareVectorOutputPort(
            "shifted_targets",
            26,
            self._calc_shifted_targets,
            {self.input_port_ticket(self._sole_targets.get_index()), self.discrete_state_ticket(self._state)},
        )
        self.signals = (Signal("foot_shift", shift, SHIFT_COLUMNS),)

    def _update(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        shift, rate = context.get_discrete_state(self._state).value().reshape(2, 2, 3)
        shift = shift + self._period * rate
        measured = FootForces.of(self._foot_forces.Eval(context)).f_W
        desired = desired_foot_forces(self._schedule.Eval(context), self._weight)
        rate = foot_shift_rate(shift, desired - measured, self._parameters)
        discrete.set_value(self._state, np.concatenate((shift, rate)).ravel())
        return EventStatus.Succeeded()

    def _calc_shifted_targets(self, context: Context, output: BasicVector) -> None:
        shift, rate = context.get_discrete_state(self._state).value().reshape(2, 2, 3)
        targets = self._sole_targets.Eval(context).reshape(2, 13)
        targets[:, 4:7] += shift
        targets[:, 10:] += rate
        output.SetFromVector(targets.ravel())
