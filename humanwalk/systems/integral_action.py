"""LeafSystem: integral action on all joints."""

from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, EventStatus, LeafSystem, State

from humanwalk.body.joint_map import JointMap
from humanwalk.control.integral_action import integrated
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal


class IntegralAction(LeafSystem):
    """Integral of the angle error of each joint, which makes the law of a `PdActuatorBank` PID.

    Updates at every step of the plant, in an unrestricted update as the plant does, so that the error belongs to one
    instant.

    Inputs:
        desired_state: (2n) desired angles [rad], then rates [rad/s], at the present time.
        state: plant state [q; v].
        saturated: (n) 1 where the law reaches the effort limit; there the integral does not change.

    Outputs:
        torque: (n) integral torque [N m], for the input `correction` of the bank.
    """

    def __init__(self, plant: MultibodyPlant, ki: Array) -> None:
        """Make the action on a finalized discrete plant for gains ki [N m/(rad s)], shape (n,), in actuator order."""
        super().__init__()
        self._joints, self._ki, self._step = JointMap.of(plant), ki, plant.time_step()
        n = ki.size
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * n)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._saturated = self.DeclareVectorInputPort("saturated", n)
        self._integral = self.DeclareDiscreteState(n)
        self.DeclarePeriodicUnrestrictedUpdateEvent(self._step, 0.0, self._update)
        torque = self.DeclareStateOutputPort("torque", self._integral)
        columns = tuple(f"{name}.integral_torque_N_m" for name in self._joints.names)
        self.signals = (Signal("integral_torque", torque, columns),)

    def _update(self, context: Context, state: State) -> EventStatus:
        error = self._desired.Eval(context)[: self._ki.size] - self._joints.positions(self._state.Eval(context))
        z = context.get_discrete_state(self._integral).value()
        saturated = self._saturated.Eval(context) > 0
        z = integrated(z, error, self._ki, saturated, self._step)
        state.get_mutable_discrete_state(self._integral).set_value(z)
        return EventStatus.Succeeded()
