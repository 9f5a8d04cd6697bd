"""LeafSystem: the whole-body quadratic program, solved periodically."""

from collections.abc import Mapping

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import SIDES, Skeleton, contact_spheres
from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.limbs import ARMS, HEAD_YAW, LEGS
from humanwalk.control.body_dynamics import BodyDynamics, Dynamics
from humanwalk.control.joint_style import JointStyle
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.control.whole_body_qp import Posture, WholeBodyQp
from humanwalk.systems.load_observer import load_at
from humanwalk.systems.signal import Signal
from humanwalk.walking.walking_reference import WalkingReference

STATUS_COLUMNS = ("qp.solved", "qp.failures", "qp.failures_in_a_row")

ELBOW_PER_SHOULDER = 0.5
"""Flexion of an elbow per forward flexion of its shoulder (our choice)."""


class WholeBodyController(LeafSystem):
    """Torques and desired rates of all joints from a whole-body program, updated periodically.

    After a QP failure the last torques are held for `hold` seconds; then the joints are only damped until a program
    is solved again.

    Inputs:
        state: plant state [q; v].
        plan: WalkingReference.
        load: (4) load on the chest that the model of the body lacks, see LoadObserver. Optional; default: none.
        assistance: (n) known torque of devices on the joints, in actuator order [N m]; the actuators deliver the rest.
            Optional; default: zero.

    Outputs (all are state; evaluating them solves nothing), n joints in actuator order:
        torque: (n) feedforward torque of the actuators [N m].
        desired_state: (2n) angles [rad] and rates [rad/s] for the gains of the actuators.
        sample_time: (1) time of the last update [s].
        status: (3) 1 if the last program was solved, else 0; number of QP failures; of consecutive QP failures.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        skeleton: Skeleton,
        parameters: WholeBodyParameters,
        posture: Mapping[str, float],
        period: float,
        style: JointStyle | None = None,
    ) -> None:
        """Make the controller.

        Args:
            plant: finalized model of the body.
            skeleton: the same body, for the contact points of its soles.
            parameters: tasks and limits.
            posture: joint angles [rad] by name around which arms and spine are held; 0 if not named.
            period: time between updates [s].
            style: joint angles that the legs follow softly.
        """
        super().__init__()
        self._dynamics = BodyDynamics(plant)
        self._qp = WholeBodyQp(self._dynamics, contact_spheres(skeleton), parameters)
        self._period, self._style = period, style
        self._hold = parameters.hold
        joints, names = self._dynamics.joints, self._qp.names
        n = len(names)
        # The program has its joints in the order of the velocities, the outputs in actuator order.
        self._to_actuators = joints.v - 6
        self._q = joints.q[np.argsort(joints.v)]
        self._rest = np.array([posture.get(name, 0.0) for name in names])
        self._moving = [
            [names.index(joint) for joint in (ARMS[side].shoulder_flexion, ARMS[side].elbow, LEGS[side].toes)]
            for side in SIDES
        ]
        self._head = names.index(HEAD_YAW)
        self._is_held = np.isin(names, [joint for leg in LEGS.values() for joint in leg.foot_joints])

        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._plan = self.DeclareAbstractInputPort("plan", Value[object]())
        self._load = self.DeclareVectorInputPort("load", NO_LOAD.size)
        self._assistance = self.DeclareVectorInputPort("assistance", n)
        self._torque, self._desired, self._time, self._status = (
            self.DeclareDiscreteState(size) for size in (n, 2 * n, 1, len(STATUS_COLUMNS))
        )
        self.DeclareStateOutputPort("torque", self._torque)
        self.DeclareStateOutputPort("desired_state", self._desired)
        self.DeclareStateOutputPort("sample_time", self._time)
        status = self.DeclareStateOutputPort("status", self._status)
        self.signals = (Signal("qp_status", status, STATUS_COLUMNS),)
        self.DeclareInitializationDiscreteUpdateEvent(self._update)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)

    def _update(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        reference = self._plan.Eval(context)
        load = load_at(self._load, context)
        body = self._assisted(context, self._dynamics.at(self._state.Eval(context), load))
        q, v = body.q[self._q], body.v[6:]
        posture = self._posture(reference)
        radius = self._qp.parameters.rotation_radius
        style = self._style.tasks(body, reference, radius) if self._style is not None else ()
        solution = self._qp.solve(body, reference, posture, style)

        _, failures, in_a_row = context.get_discrete_state(self._status).value()
        if solution is not None:
            torque, in_a_row = solution.torque[self._to_actuators], 0.0
            rate = v + self._period * solution.acceleration[6:]
        else:
            failures, in_a_row = failures + 1.0, in_a_row + 1.0
            is_held = in_a_row * self._period <= self._hold
            torque = is_held * context.get_discrete_state(self._torque).value()
            rate = np.zeros_like(v)
        # The actuators hold the joints of the feet at their posture; of all others they only damp the rate.
        angle, rate = np.where(self._is_held, (posture.angle, posture.rate), (q, rate))
        discrete_state.set_value(self._torque, torque)
        discrete_state.set_value(self._desired, np.concatenate((angle[self._to_actuators], rate[self._to_actuators])))
        discrete_state.set_value(self._time, np.array([context.get_time()]))
        discrete_state.set_value(self._status, np.array([solution is not None, failures, in_a_row], dtype=float))
        return EventStatus.Succeeded()

    def _assisted(self, context: Context, body: Dynamics) -> Dynamics:
        """The body with the torque of devices in h, with the opposite sign."""
        if not self._assistance.HasValue(context):
            return body
        h = body.h.copy()
        h[6 + self._to_actuators] -= self._assistance.Eval(context)
        return body._replace(h=h)

    def _posture(self, reference: WalkingReference) -> Posture:
        """Rest posture with swinging arms, and with head and toes of the reference."""
        angle, rate = self._rest.copy(), np.zeros_like(self._rest)
        feet = (reference.foot(side) for side in SIDES)
        for (shoulder, elbow, toes), (swing, swing_rate), foot in zip(
            self._moving, reference.shoulder_flexion, feet, strict=True
        ):
            angle[shoulder] += swing
            rate[shoulder] = swing_rate
            angle[elbow] += ELBOW_PER_SHOULDER * max(swing, 0.0)
            angle[toes], rate[toes] = foot.toes
        angle[self._head], rate[self._head] = reference.head_yaw
        return Posture(angle, rate)
