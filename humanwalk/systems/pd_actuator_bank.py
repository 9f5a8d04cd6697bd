"""LeafSystem: the PD controllers of all 42 joint actuators."""

from collections.abc import Iterable

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, DependencyTicket, InputPort, LeafSystem

from humanwalk.body.joint_map import JointMap
from humanwalk.control.hermite import hermite
from humanwalk.control.pd_control import PD_LAWS, PdLaw, pd_torque, require_stable
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal


class PdActuatorBank(LeafSystem):
    """tau = kp (q_d - q) + kd (v_d - v) + feedforward + correction for each joint, in actuator order.

    Desired states arrive as samples. The desired state follows the cubic from the previous sample to the present one;
    after the present sample it is held to first order.

    The plant computes a part of the law, see `PdDiscretization`; the bank gives it the rest. A continuous plant
    (time_step 0, integrated by CENIC) uses the desired rates of the implicit law with the wrong sign (Drake 1.58);
    there kd v_d is a torque and the plant's desired rates are zero.

    Inputs:
        desired_state: (2n) desired angles [rad], then rates [rad/s].
        sample_time: (1) time of desired_state [s]. Optional; default: now.
        previous_state, previous_time: the sample before. Optional; default: the first-order hold.
        state: plant state [q; v].
        net_actuation: (n) torque that the plant's actuators deliver [N m].
        feedforward: (n) torque that the controller adds to the law [N m]. Optional; default: zero.
        correction: (n) torque that integral action or adaptation adds to the law [N m]. Optional; default: zero.

    Outputs:
        held_desired_state: (2n) the desired state now.
        plant_desired_state: (2n) the desired state at the end of the plant's step, for its desired_state port; only
            with the implicit law.
        actuation: (n) torque for the plant's actuation port [N m]. Implicit law: feedforward and correction, and
            kd v_d for a continuous plant. Else: the law clipped to the effort limits, plus kd v with the semi-implicit
            law, whose damping the plant subtracts.
        torque: (n) torque of the law on the joints [N m].
        saturated: (n) 1 where the law reaches the effort limit, else 0.
    """

    def __init__(
        self, plant: MultibodyPlant, kp: Array, kd: Array, law: PdLaw = "implicit", effort_limits: Array | None = None
    ) -> None:
        """Make the bank.

        Args:
            plant: the finalized plant that it drives, on which `install_gains` was called.
            kp, kd: gains [N m/rad], [N m s/rad], shape (n,), in actuator order.
            law: discretization of the law.
            effort_limits: [N m], shape (n,), infinite for none; default: the plant's.

        Raises:
            ParameterError: the law is unstable at the plant's time step.
            ValueError: no effort limits are given, and `install_gains` has replaced the plant's.
        """
        super().__init__()
        joints = JointMap.of(plant)
        self._q, self._v = joints.q, joints.num_positions + joints.v
        self._kp, self._kd = kp, kd
        self._joint_damping = PD_LAWS[law].joint_damping(kd)
        if effort_limits is None and not PD_LAWS[law].keeps_effort_limits:
            raise ValueError(f"effort_limits: None; allowed: (n,), as the law {law} replaced the plant's; give them")
        self._effort_limits = joints.effort_limits if effort_limits is None else effort_limits
        self._time_step = plant.time_step()
        if plant.time_step() > 0:
            require_stable(plant, kp, kd, law)

        n = kp.size
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * n)
        self._sample_time = self.DeclareVectorInputPort("sample_time", 1)
        self._previous = self.DeclareVectorInputPort("previous_state", 2 * n)
        self._previous_time = self.DeclareVectorInputPort("previous_time", 1)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._net_actuation = self.DeclareVectorInputPort("net_actuation", n)
        self._added = [self.DeclareVectorInputPort(name, n) for name in ("feedforward", "correction")]

        held = {self.time_ticket()} | self._tickets(
            (self._desired, self._sample_time, self._previous, self._previous_time)
        )
        added, state = self._tickets(self._added), self._tickets([self._state])
        self._held = self.DeclareVectorOutputPort("held_desired_state", 2 * n, self._calc_held, held)
        if PD_LAWS[law].takes_desired_state:
            self.DeclareVectorOutputPort("plant_desired_state", 2 * n, self._calc_plant_desired, held)
            self.DeclareVectorOutputPort("actuation", n, self._calc_added, held | added)
        else:
            self.DeclareVectorOutputPort("actuation", n, self._calc_actuation, held | added | state)
        torque = self.DeclareVectorOutputPort(
            "torque", n, self._calc_torque, state | self._tickets([self._net_actuation])
        )
        saturated = self.DeclareVectorOutputPort("saturated", n, self._calc_saturated, held | added | state)

        angles = tuple(f"{name}.desired_angle_rad" for name in joints.names)
        rates = tuple(f"{name}.desired_velocity_rad_s" for name in joints.names)
        self.signals = (
            Signal("desired_state", self._held, angles + rates),
            Signal("torque", torque, tuple(f"{name}.torque_N_m" for name in joints.names)),
            Signal("saturated", saturated, tuple(f"{name}.saturated" for name in joints.names)),
        )

    def _tickets(self, ports: Iterable[InputPort]) -> set[DependencyTicket]:
        return {self.input_port_ticket(port.get_index()) for port in ports}

    def _calc_held(self, context: Context, output: BasicVector) -> None:
        t = context.get_time()
        x1 = self._desired.Eval(context)
        t1 = self._sample_time.Eval(context)[0] if self._sample_time.HasValue(context) else t
        x0, t0 = x1, t1
        if self._previous.HasValue(context):
            x0, t0 = self._previous.Eval(context), self._previous_time.Eval(context)[0]
        output.SetFromVector(hermite(t, t0, x0, t1, x1))

    def _desired_now(self, context: Context) -> tuple[Array, Array]:
        """Desired angles and rates, shape (n,) each."""
        held = self._held.Eval(context)
        return held[: self._kp.size], held[self._kp.size :]

    def _added_now(self, context: Context) -> Array | float:
        """Torque added to the law by the inputs that are connected, shape (n,) or zero."""
        torque: Array | float = sum(port.Eval(context) for port in self._added if port.HasValue(context))
        return torque

    def _law(self, context: Context) -> tuple[Array, Array]:
        """The law without limits and the torque that the damping of the plant's joints takes from it, shape (n,)."""
        state = self._state.Eval(context)
        q, v = state[self._q], state[self._v]
        tau = pd_torque(q, v, *self._desired_now(context), self._kp, self._kd) + self._added_now(context)
        return tau, self._joint_damping * v

    def _calc_actuation(self, context: Context, output: BasicVector) -> None:
        tau, damping_in_plant = self._law(context)
        output.SetFromVector(tau.clip(-self._effort_limits, self._effort_limits) + damping_in_plant)

    def _calc_plant_desired(self, context: Context, output: BasicVector) -> None:
        q_d, v_d = self._desired_now(context)
        output.SetFromVector(np.concatenate((q_d + self._time_step * v_d, v_d if self._time_step > 0 else 0 * v_d)))

    def _calc_added(self, context: Context, output: BasicVector) -> None:
        _, v_d = self._desired_now(context)
        rate_torque = 0 * v_d if self._time_step > 0 else self._kd * v_d
        output.SetFromVector(self._added_now(context) + rate_torque)

    def _calc_torque(self, context: Context, output: BasicVector) -> None:
        damping_in_plant = self._joint_damping * self._state.Eval(context)[self._v]
        output.SetFromVector(self._net_actuation.Eval(context) - damping_in_plant)

    def _calc_saturated(self, context: Context, output: BasicVector) -> None:
        tau, _ = self._law(context)
        output.SetFromVector((np.abs(tau) >= self._effort_limits).astype(float))
