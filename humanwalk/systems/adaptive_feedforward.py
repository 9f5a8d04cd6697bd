"""LeafSystem: adaptive feedforward of all joints."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, EventStatus, LeafSystem, State

from humanwalk.body.joint_map import JointMap
from humanwalk.control.adaptive_feedforward import (
    AdaptationParameters,
    adaptation_gains,
    adapted,
    feedforward_torque,
    regressor,
)
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal


class AdaptiveFeedforward(LeafSystem):
    """Estimates inertia and load of each joint and feeds them forward to a `PdActuatorBank`.

    Updates at every step of the plant, in an unrestricted update as the plant does, so that all errors belong to one
    instant. The desired acceleration is that of the last step, from the desired rates at its ends; it begins at zero.

    Inputs:
        desired_state: (2n) desired angles [rad], then rates [rad/s], at the present time.
        state: plant state [q; v].
        saturated: (n) 1 where the law reaches the effort limit; there the estimates do not change.

    Outputs:
        torque: (n) feedforward [N m], for the input `correction` of the bank.
        estimates: (2n) estimated inertia [kg m2], then estimated load [N m].
    """

    def __init__(
        self, plant: MultibodyPlant, kp: Array, inertia: Array, max_load: Array, parameters: AdaptationParameters
    ) -> None:
        """Make the feedforward on a finalized discrete plant.

        Args:
            plant: of the joints.
            kp: stiffness of the PD law [N m/rad], shape (n,), in actuator order; joints without it do not adapt.
            inertia: of the joints in neutral standing [kg m2], shape (n,).
            max_load: bounds of the estimated loads [N m], shape (n,).
            parameters: rates and bounds of the adaptation.
        """
        super().__init__()
        self._joints, self._parameters, self._step = JointMap.of(plant), parameters, plant.time_step()
        # Joints without stiffness do not adapt, whatever their bound.
        self._max_acceleration = np.where(kp > 0, parameters.reference_error * kp / inertia, 1.0)
        self._gains = adaptation_gains(kp, self._max_acceleration, parameters)
        self._bounds = (
            np.stack((np.zeros_like(inertia), -max_load)),
            np.stack((parameters.max_inertia_ratio * inertia, max_load)),
        )
        n = kp.size
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * n)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._saturated = self.DeclareVectorInputPort("saturated", n)
        self._theta, self._rate, self._torque = (self.DeclareDiscreteState(size) for size in (2 * n, n, n))
        self.DeclarePeriodicUnrestrictedUpdateEvent(self._step, 0.0, self._update)
        self.DeclareStateOutputPort("torque", self._torque)
        estimates = self.DeclareStateOutputPort("estimates", self._theta)
        what = ("estimated_inertia_kg_m2", "estimated_load_N_m")
        self.signals = (
            Signal("estimates", estimates, tuple(f"{name}.{each}" for each in what for name in self._joints.names)),
        )

    def _update(self, context: Context, state: State) -> EventStatus:
        p, h = self._parameters, self._step
        x = self._state.Eval(context)
        angle, rate = np.split(self._desired.Eval(context), 2)
        error, rate_error = angle - self._joints.positions(x), rate - self._joints.velocities(x)
        Y = regressor((rate - context.get_discrete_state(self._rate).value()) / h, self._max_acceleration)
        theta = adapted(
            context.get_discrete_state(self._theta).value().reshape(2, -1),
            Y,
            rate_error + p.error_rate * error,
            self._gains,
            self._bounds,
            p.leakage,
            self._saturated.Eval(context) > 0,
            h,
        )
        state.get_mutable_discrete_state(self._theta).set_value(theta.ravel())
        state.get_mutable_discrete_state(self._rate).set_value(rate)
        state.get_mutable_discrete_state(self._torque).set_value(feedforward_torque(theta, Y))
        return EventStatus.Succeeded()
