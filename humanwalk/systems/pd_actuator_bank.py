"""LeafSystem: the PD controllers of all 42 joint actuators."""

from typing import Literal

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex, PdControllerGains
from pydrake.systems.framework import BasicVector, Context, InputPort, LeafSystem, OutputPort

from humanwalk.control.joint_map import JointMap, base_first_mass_matrix
from humanwalk.control.pd_control import largest_explicit_step, pd_torque
from humanwalk.control.stability import round_down
from humanwalk.quantity import ParameterError

Array = npt.NDArray[np.float64]


def install_gains(plant: MultibodyPlant, kp: Array, kd: Array) -> None:
    """Give every actuator of a plant its implicit PD gains, in actuator order; before Finalize."""
    for i, (p, d) in enumerate(zip(kp, kd, strict=True)):
        plant.get_mutable_joint_actuator(JointActuatorIndex(i)).set_controller_gains(
            PdControllerGains(p=float(p), d=float(d))
        )


class PdActuatorBank(LeafSystem):
    """tau = kp (q_d - q) + kd (v_d - v) + feedforward for each joint, in actuator order.

    Desired angles arrive at the control rate; between samples they move on with their rate (a first-order hold).
    The `implicit` law hands them to the plant, whose solver applies the gains at the end of its step: stable at
    any step. The `explicit` law computes the torque from the measured state.

    A continuous plant (time_step 0, integrated by CENIC) takes the desired rates of its implicit law with the wrong
    sign, so there they go to it as torque, kd v_d, and as zero rates.

    Inputs:
        desired_state: (2n) desired angles [rad], then rates [rad/s].
        sample_time: (1) time of the desired state [s]. Optional: without it desired_state is taken as current.
        state: plant state [q; v]. Only the explicit law reads it.
        net_actuation: (n) what the plant's actuators deliver [N m], for `saturated`.
        feedforward: (n) torque added to the law [N m]. Optional: zero.

    Outputs:
        held_desired_state: (2n) the desired state of now, for records.
        plant_desired_state: (2n) the desired state at the end of the plant's step, where its solver applies the
            gains; for the plant's desired_state port (implicit law only). Rates are 0 for a continuous plant.
        actuation: (n) torque for the plant's actuation port [N m]: the feed-forward (implicit), with kd v_d for a
            continuous plant; the whole law clipped to the effort limits (explicit).
        saturated: (n) 1 where an actuator delivers its effort limit, else 0.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        kp: Array,
        kd: Array,
        law: Literal["implicit", "explicit"] = "implicit",
    ) -> None:
        """Make the bank.

        Args:
            plant: the finalised plant that it drives; for the implicit law its gains are installed already.
            kp, kd: gains [N m/rad], [N m s/rad], shape (n,), in actuator order.
            law: see the class.

        Raises:
            ParameterError: the explicit law is not stable at the plant's time step.
        """
        super().__init__()
        self._joints = JointMap.of(plant)
        self._kp, self._kd = kp, kd
        self._law = law
        self._time_step = plant.time_step()
        self._rates_as_torque = law == "implicit" and plant.time_step() == 0
        if law == "explicit" and plant.time_step() > 0:
            require_stable(plant, kp, kd)
        n = len(self._joints.names)

        self._desired = self.DeclareVectorInputPort("desired_state", 2 * n)
        self._sample_time = self.DeclareVectorInputPort("sample_time", 1)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._net_actuation = self.DeclareVectorInputPort("net_actuation", n)
        self._feedforward = self.DeclareVectorInputPort("feedforward", n)

        hold = {
            self.time_ticket(),
            self.input_port_ticket(self._desired.get_index()),
            self.input_port_ticket(self._sample_time.get_index()),
        }
        self._held_output = self.DeclareVectorOutputPort(
            "held_desired_state", 2 * n, self._calc_held, prerequisites_of_calc=hold
        )
        if law == "implicit":
            self._plant_desired_output = self.DeclareVectorOutputPort(
                "plant_desired_state", 2 * n, self._calc_plant_desired, prerequisites_of_calc=hold
            )
        needs = {self.input_port_ticket(self._feedforward.get_index())}
        if law == "explicit":
            needs |= hold | {self.input_port_ticket(self._state.get_index())}
        elif self._rates_as_torque:
            needs |= hold
        self._actuation_output = self.DeclareVectorOutputPort(
            "actuation", n, self._calc_actuation, prerequisites_of_calc=needs
        )
        self._saturated_output = self.DeclareVectorOutputPort(
            "saturated",
            n,
            self._calc_saturated,
            prerequisites_of_calc={self.input_port_ticket(self._net_actuation.get_index())},
        )

    def _held(self, context: Context, lead: float = 0.0) -> Array:
        """Desired state `lead` seconds from now."""
        desired: Array = self._desired.Eval(context)
        if self._sample_time.HasValue(context):
            lead += context.get_time() - self._sample_time.Eval(context)[0]
        n = desired.size // 2
        desired[:n] += lead * desired[n:]
        return desired

    def _calc_held(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._held(context))

    def _calc_plant_desired(self, context: Context, output: BasicVector) -> None:
        desired = self._held(context, self._time_step)
        if self._rates_as_torque:
            desired[desired.size // 2 :] = 0.0
        output.SetFromVector(desired)

    def _calc_actuation(self, context: Context, output: BasicVector) -> None:
        n = output.size()
        tau = np.zeros(n)
        if self._feedforward.HasValue(context):
            tau += self._feedforward.Eval(context)
        if self._rates_as_torque:
            tau += self._kd * self._held(context)[n:]
        if self._law == "explicit":
            desired, state = self._held(context), self._state.Eval(context)
            q, v = self._joints.positions(state), self._joints.velocities(state)
            tau += pd_torque(q, v, desired[:n], desired[n:], self._kp, self._kd)
            tau = np.clip(tau, -self._joints.effort_limits, self._joints.effort_limits)
        output.SetFromVector(tau)

    def _calc_saturated(self, context: Context, output: BasicVector) -> None:
        tau = np.abs(self._net_actuation.Eval(context))
        output.SetFromVector((tau >= (1 - 1e-9) * self._joints.effort_limits).astype(float))

    def get_desired_state_input_port(self) -> InputPort:
        """Input desired_state."""
        return self._desired

    def get_sample_time_input_port(self) -> InputPort:
        """Input sample_time."""
        return self._sample_time

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self._state

    def get_net_actuation_input_port(self) -> InputPort:
        """Input net_actuation."""
        return self._net_actuation

    def get_feedforward_input_port(self) -> InputPort:
        """Input feedforward."""
        return self._feedforward

    def get_held_desired_state_output_port(self) -> OutputPort:
        """Output held_desired_state."""
        return self._held_output

    def get_plant_desired_state_output_port(self) -> OutputPort:
        """Output plant_desired_state (implicit law only)."""
        return self._plant_desired_output

    def get_actuation_output_port(self) -> OutputPort:
        """Output actuation."""
        return self._actuation_output

    def get_saturated_output_port(self) -> OutputPort:
        """Output saturated."""
        return self._saturated_output


def require_stable(plant: MultibodyPlant, kp: Array, kd: Array) -> None:
    """Raise ParameterError if the explicit law would diverge at the plant's time step (in neutral standing)."""
    context = plant.CreateDefaultContext()
    stable = largest_explicit_step(base_first_mass_matrix(plant, context), kp, kd)
    if plant.time_step() > stable:
        raise ParameterError(
            f"actuators.law: explicit is unstable at time_step {plant.time_step():g} s; allowed: steps up to "
            f"{round_down(stable):g} s with these gains; use law: implicit, softer gains, or that step"
        )
