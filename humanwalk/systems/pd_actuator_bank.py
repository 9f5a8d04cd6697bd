"""LeafSystem: the PD controllers of all 42 joint actuators."""

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex, PdControllerGains
from pydrake.systems.framework import BasicVector, Context, LeafSystem, ValueProducer

from humanwalk.body.joint_map import JointMap, base_first_mass_matrix
from humanwalk.control.hermite import HermitePiece
from humanwalk.control.pd_control import PdLaw, largest_explicit_step, largest_semi_implicit_step, pd_torque
from humanwalk.numerics import Array
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError


def install_gains(plant: MultibodyPlant, kp: Array, kd: Array, law: PdLaw = "implicit") -> None:
    """Give a plant what a law leaves to its solver, for every actuator in order; before Finalize.

    The implicit law leaves it both gains; the semi-implicit law kd, which is added to the joint's damping, and the
    effort limits, which the bank keeps since the plant would clip the torque without its damping.
    """
    for i, (p, d) in enumerate(zip(kp, kd, strict=True)):
        actuator = plant.get_mutable_joint_actuator(JointActuatorIndex(i))
        if law == "implicit":
            actuator.set_controller_gains(PdControllerGains(p=float(p), d=float(d)))
        elif law == "semi_implicit":
            joint = plant.get_mutable_joint(actuator.joint().index())
            joint.set_default_damping_vector(joint.default_damping_vector() + d)
            actuator.set_effort_limit(np.inf)


class PdActuatorBank(LeafSystem):
    """tau = kp (q_d - q) + kd (v_d - v) + feedforward for each joint, in actuator order.

    Desired states arrive as samples. From the sample before to the one after the present goes a cubic with their angles
    and rates; after the last sample the angles move on with their rates (a first-order hold). The bank does that
    itself since the plant asks in every step, and every system that is asked costs.

    `PdLaw` says how the plant is given the law. The implicit law hands over the desired state; the others compute
    torques from the measured state, of which the semi-implicit one gives back kd v, the plant's damping taking it.

    A continuous plant (time_step 0, integrated by CENIC) takes the desired rates of its implicit law with the wrong
    sign, so there they go to it as torque, kd v_d, and as zero rates.

    Inputs:
        desired_state: (2n) desired angles [rad], then rates [rad/s].
        sample_time: (1) time of the desired state [s]. Optional: without it desired_state is taken as current.
        previous_state, previous_time: the sample before. Optional: without it the desired state is held.
        state: plant state [q; v].
        net_actuation: (n) what the plant's actuators deliver [N m].
        feedforward: (n) torque added to the law [N m]. Optional: zero.

    Outputs:
        held_desired_state: (2n) the desired state of now, for records.
        plant_desired_state: (2n) the desired state at the end of the plant's step, where its solver applies the
            gains; for the plant's desired_state port (implicit law only). Rates are 0 for a continuous plant.
        actuation: (n) torque for the plant's actuation port [N m]: the feed-forward (implicit), with kd v_d for a
            continuous plant; the whole law clipped to the effort limits (explicit), plus kd v (semi-implicit).
        torque: (n) what the joints feel of the law [N m]: net_actuation, less kd v (semi-implicit).
        saturated: (n) 1 where a joint feels its effort limit, else 0.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        kp: Array,
        kd: Array,
        law: PdLaw = "implicit",
        effort_limits: Array | None = None,
    ) -> None:
        """Make the bank.

        Args:
            plant: the finalised plant that it drives, on which `install_gains` was called.
            kp, kd: gains [N m/rad], [N m s/rad], shape (n,), in actuator order.
            law: how the plant is given the law.
            effort_limits: [N m], shape (n,); the plant's own unless given.

        Raises:
            ParameterError: the law is not stable at the plant's time step.
        """
        super().__init__()
        self._joints = JointMap.of(plant)
        self._kp, self._kd = kp, kd
        self._law = law
        self._time_step = plant.time_step()
        self._rates_as_torque = law == "implicit" and plant.time_step() == 0
        self._effort_limits = self._joints.effort_limits if effort_limits is None else effort_limits
        self._limited = bool(np.isfinite(self._effort_limits).any())
        if plant.time_step() > 0:
            require_stable(plant, kp, kd, law)
        n = len(self._joints.names)

        self._desired = self.DeclareVectorInputPort("desired_state", 2 * n)
        self._sample_time = self.DeclareVectorInputPort("sample_time", 1)
        self._previous = self.DeclareVectorInputPort("previous_state", 2 * n)
        self._previous_time = self.DeclareVectorInputPort("previous_time", 1)
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._net_actuation = self.DeclareVectorInputPort("net_actuation", n)
        self._feedforward = self.DeclareVectorInputPort("feedforward", n)

        # Samples come more seldom than the plant asks.
        samples = (self._desired, self._sample_time, self._previous, self._previous_time)
        self._piece = self.DeclareCacheEntry(
            "piece",
            ValueProducer(allocate=lambda: Value(object()), calc=self._calc_piece),
            prerequisites_of_calc={self.input_port_ticket(port.get_index()) for port in samples},
        )
        self._driving_piece = self.DeclareCacheEntry(
            "driving_piece",
            ValueProducer(allocate=lambda: Value(object()), calc=self._calc_driving_piece),
            prerequisites_of_calc={self._piece.ticket(), self.input_port_ticket(self._feedforward.get_index())},
        )
        hold = {self.time_ticket(), self._piece.ticket()}
        self._held_output = self.DeclareVectorOutputPort(
            "held_desired_state", 2 * n, self._calc_held, prerequisites_of_calc=hold
        )
        if law == "implicit":
            self._plant_desired_output = self.DeclareVectorOutputPort(
                "plant_desired_state", 2 * n, self._calc_plant_desired, prerequisites_of_calc=hold
            )
        needs = {self.input_port_ticket(self._feedforward.get_index())}
        if law != "implicit":
            needs |= hold | {self.input_port_ticket(self._state.get_index())}
        elif self._rates_as_torque:
            needs |= hold
        self._actuation_output = self.DeclareVectorOutputPort(
            "actuation", n, self._calc_actuation, prerequisites_of_calc=needs
        )
        felt = {
            self.input_port_ticket(self._net_actuation.get_index()),
            self.input_port_ticket(self._state.get_index()),
        }
        self._torque_output = self.DeclareVectorOutputPort("torque", n, self._calc_torque, prerequisites_of_calc=felt)
        self._saturated_output = self.DeclareVectorOutputPort(
            "saturated", n, self._calc_saturated, prerequisites_of_calc=felt | needs
        )

    def _calc_piece(self, context: Context, piece: Value) -> None:
        samples = [self._desired.Eval(context), self._sample_time.Eval(context)]
        if self._previous.HasValue(context):
            samples += [self._previous.Eval(context), self._previous_time.Eval(context)]
        piece.set_value(_piece_of(*samples))

    def _calc_driving_piece(self, context: Context, piece: Value) -> None:
        piece.set_value(self._piece.Eval(context).mapped(self._driving, self._fed_forward(context)))

    def _driving(self, desired: Array) -> Array:
        """kp q_d + kd v_d of desired states (..., 2n), shape (..., n)."""
        n = self._kp.size
        tau: Array = self._kp * desired[..., :n] + self._kd * desired[..., n:]
        return tau

    def _driving_torque(self, context: Context) -> Array:
        """kp q_d + kd v_d + feedforward, all of the law that is not of the measured state."""
        if self._sample_time.HasValue(context):
            piece: HermitePiece = self._driving_piece.Eval(context)
            return piece.at(context.get_time())
        tau, feedforward = self._driving(self._desired.Eval(context)), self._fed_forward(context)
        return tau if feedforward is None else tau + feedforward

    def _held(self, context: Context) -> Array:
        """Desired state of now."""
        if self._sample_time.HasValue(context):
            piece: HermitePiece = self._piece.Eval(context)
            return piece.at(context.get_time())
        desired: Array = self._desired.Eval(context)
        return desired

    def _calc_held(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._held(context))

    def _calc_plant_desired(self, context: Context, output: BasicVector) -> None:
        desired = self._held(context)
        n = self._kp.size
        desired[:n] += self._time_step * desired[n:]
        if self._rates_as_torque:
            desired[n:] = 0.0
        output.SetFromVector(desired)

    def _damping(self, state: Array) -> Array:
        """kd v."""
        damping: Array = self._kd * self._joints.velocities(state)
        return damping

    def _fed_forward(self, context: Context) -> Array | None:
        return self._feedforward.Eval(context) if self._feedforward.HasValue(context) else None

    def _calc_actuation(self, context: Context, output: BasicVector) -> None:
        if self._law == "implicit":
            feedforward = self._fed_forward(context)
            tau = np.zeros(output.size()) if feedforward is None else feedforward
            if self._rates_as_torque:
                tau += self._kd * self._held(context)[self._kp.size :]
        else:
            state = self._state.Eval(context)
            tau = self._driving_torque(context) - self._kp * self._joints.positions(state)
            if self._limited or self._law == "explicit":
                damping, limits = self._damping(state), self._effort_limits
                tau = np.minimum(np.maximum(tau - damping, -limits), limits)
                if self._law == "semi_implicit":
                    tau += damping
        output.SetFromVector(tau)

    def held_states(self, times: Array, *samples: Array) -> Array:
        """The output held_desired_state at many times (k,); samples: desired_state to previous_time, in rows."""
        return np.array([_piece_of(*sample).at(t) for t, *sample in zip(times, *samples, strict=True)])

    def felt_torque(self, net_actuation: Array, state: Array | None) -> Array:
        """The output torque, of one time or of many, shape (..., n); only a semi-implicit one needs the state."""
        if self._law != "semi_implicit":
            return net_actuation
        assert state is not None
        return net_actuation - self._damping(state)

    def at_limit(self, tau: Array) -> Array:
        """1 where a torque is at its limit, else 0, shape (..., n)."""
        return (np.abs(tau) >= (1 - 1e-9) * self._effort_limits).astype(float)

    def law_torque(self, state: Array, desired: Array, feedforward: Array | None) -> Array:
        """The law, not clipped, from the desired state of now; of one time or of many, shape (..., n)."""
        q, v, n = self._joints.positions(state), self._joints.velocities(state), self._kp.size
        tau = pd_torque(q, v, desired[..., :n], desired[..., n:], self._kp, self._kd)
        return tau if feedforward is None else tau + feedforward

    def _calc_torque(self, context: Context, output: BasicVector) -> None:
        state = self._state.Eval(context) if self._law == "semi_implicit" else None
        output.SetFromVector(self.felt_torque(self._net_actuation.Eval(context), state))

    def _calc_saturated(self, context: Context, output: BasicVector) -> None:
        # What a semi-implicit joint feels stays a little off the limit: its damping is of the end of the step.
        if self._law == "semi_implicit":
            tau = self.law_torque(self._state.Eval(context), self._held(context), self._fed_forward(context))
        else:
            tau = self._net_actuation.Eval(context)
        output.SetFromVector(self.at_limit(tau))

    @property
    def law(self) -> PdLaw:
        """How the plant is given the law."""
        return self._law

    @property
    def is_linear(self) -> bool:
        """Whether the actuation is linear in state and desired state: semi-implicit and without limits."""
        return self._law == "semi_implicit" and not self._limited

    @property
    def limited(self) -> bool:
        """Whether any joint has an effort limit."""
        return self._limited


def _piece_of(
    desired: Array, time: Array, previous: Array | None = None, previous_time: Array | None = None
) -> HermitePiece:
    """What leads from the sample before to a sample; without one before, what goes on from it."""
    if previous is None or previous_time is None:
        previous, previous_time = desired, time
    return HermitePiece.between(previous_time[0], previous, time[0], desired)


def require_stable(plant: MultibodyPlant, kp: Array, kd: Array, law: PdLaw) -> None:
    """Raise ParameterError if a law would diverge at the plant's time step (in neutral standing)."""
    if law == "implicit":
        return
    largest_step = largest_explicit_step if law == "explicit" else largest_semi_implicit_step
    stable = largest_step(base_first_mass_matrix(plant, plant.CreateDefaultContext()), kp, kd)
    if plant.time_step() > stable:
        raise ParameterError(
            f"actuators.law: {law} is unstable at time_step {plant.time_step():g} s; allowed: steps up to "
            f"{round_down(stable):g} s with these gains; use law: implicit, softer gains, or that step"
        )
