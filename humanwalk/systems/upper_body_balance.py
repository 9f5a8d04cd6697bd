"""LeafSystem: balance level 2 of the thesis, a spine that bends against alpha."""

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body.limbs import SPINE_PITCH_JOINTS, SPINE_ROLL_JOINTS
from humanwalk.control.balance_levels import UpperBodyBalanceParameters, lean_angles
from humanwalk.systems.signal import Signal

ALPHA_COLUMNS = (
    "balance.alpha_forward_rad",
    "balance.alpha_left_rad",
    "balance.alpha_forward_rate_rad_s",
    "balance.alpha_left_rate_rad_s",
)


class UpperBodyBalance(LeafSystem):
    """Bends the spine of the desired posture against the lean of the body (thesis Fig 4.9, level 2).

    Inputs:
        posture: (2n) desired angles [rad], then rates [rad/s], in actuator order.
        soles: (6) positions of the right and left sole in W [m].
        com: (6) position [m] and velocity [m/s] of the center of mass in W.

    Outputs:
        balanced_posture: (2n) the posture with the bend of the spine added.
        alpha: (4) filtered forward and leftward lean [rad], then their rates [rad/s].
    """

    def __init__(self, joint_names: Sequence[str], parameters: UpperBodyBalanceParameters, period: float) -> None:
        """Make level 2 for n joints in actuator order, updated every `period` seconds."""
        super().__init__()
        self._parameters, self._period = parameters, period
        n = len(joint_names)
        # Joint angles per alpha. Positive spine pitch is flexion (about y), positive roll bends to the right (about x).
        self._bend = np.zeros((n, 2))
        for column, joints, gain in (
            (0, SPINE_PITCH_JOINTS, -parameters.pitch_gain),
            (1, SPINE_ROLL_JOINTS, parameters.roll_gain),
        ):
            self._bend[[joint_names.index(joint) for joint in joints], column] = gain / len(joints)
        self._posture = self.DeclareVectorInputPort("posture", 2 * n)
        self._soles = self.DeclareVectorInputPort("soles", 6)
        self._com = self.DeclareVectorInputPort("com", 6)
        self._state = self.DeclareDiscreteState(4)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
        alpha = self.DeclareStateOutputPort("alpha", self._state)
        # The prerequisites exclude the other inputs, which in a walker depend on this posture.
        self.DeclareVectorOutputPort(
            "balanced_posture",
            2 * n,
            self._calc_posture,
            {self.discrete_state_ticket(self._state), self.input_port_ticket(self._posture.get_index())},
        )
        self.signals = (Signal("alpha", alpha, ALPHA_COLUMNS),)

    def _update(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        alpha, rate = context.get_discrete_state(self._state).value().reshape(2, 2)
        alpha = alpha + self._period * rate
        right, left = self._soles.Eval(context).reshape(2, 3)
        measured = lean_angles(0.5 * (right + left), self._com.Eval(context)[:3])
        rate = (measured - alpha) / self._parameters.time_constant
        discrete.set_value(self._state, np.concatenate((alpha, rate)))
        return EventStatus.Succeeded()

    def _calc_posture(self, context: Context, output: BasicVector) -> None:
        alpha_and_rate = context.get_discrete_state(self._state).value().reshape(2, 2)
        posture = self._posture.Eval(context).reshape(2, -1)
        output.SetFromVector((posture + alpha_and_rate @ self._bend.T).ravel())
