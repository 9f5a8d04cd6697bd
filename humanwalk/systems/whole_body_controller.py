"""LeafSystem: the whole-body quadratic program in time."""

from collections.abc import Mapping

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import SIDES, Skeleton, contact_spheres
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.control.whole_body_qp import Posture, WholeBodyParameters, WholeBodyQp, is_foot_posture
from humanwalk.walking.walking_reference import WalkingReference

STATUS = ("solved", "failures", "failures_in_a_row")


class WholeBodyController(LeafSystem):
    """Torques and desired rates of all joints, in a periodic discrete update.

    Where the program has no solution the torques of the last one are held for `hold` seconds; after that the joints
    are only damped, until there is a solution again.

    Inputs:
        state: plant state [q; v].
        plan: WalkingReference.

    Outputs (all show state, so reading them solves nothing):
        torque: (n) feed-forward for the actuators, in actuator order [N m].
        desired_state: (2n) angles [rad] and rates [rad/s] for the actuators' own gains, in actuator order.
        sample_time: (1) the time at which they were computed [s].
        status: (3) 1 where the last program was solved, else 0; failures so far; failures in a row.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        skeleton: Skeleton,
        parameters: WholeBodyParameters,
        posture: Mapping[str, float],
        period: float,
    ) -> None:
        """Make the controller.

        Args:
            plant: finalised model of the body, in a context of its own.
            skeleton: the same body, for the contact points of its soles.
            parameters: tasks and limits.
            posture: joint angles [rad] by name around which arms and back are held; 0 where not named.
            period: time between solutions [s].
        """
        super().__init__()
        self._dynamics = BodyDynamics(plant)
        self._qp = WholeBodyQp(self._dynamics, contact_spheres(skeleton), parameters)
        self._period = period
        self._hold = parameters.hold
        joints = self._dynamics.joints
        self._n = n = len(joints.names)
        self._place = joints.v - 6
        self._q = joints.q[np.argsort(self._place)]
        moved = ("ArmShoulderMotion", "ArmElbowMotion", "LegFootToesMotion")
        self._moved = [[self._qp.names.index(f"{side}{joint}") for joint in moved] for side in SIDES]
        self._rest = np.array([posture.get(name, 0.0) for name in self._qp.names])
        self._is_foot = np.array([is_foot_posture(name) for name in self._qp.names])

        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._plan = self.DeclareAbstractInputPort("plan", Value[object]())
        groups = [self.DeclareDiscreteState(size) for size in (n, 2 * n, 1, len(STATUS))]
        self._groups = groups
        self._torque_output = self.DeclareStateOutputPort("torque", groups[0])
        self._desired_output = self.DeclareStateOutputPort("desired_state", groups[1])
        self._time_output = self.DeclareStateOutputPort("sample_time", groups[2])
        self._status_output = self.DeclareStateOutputPort("status", groups[3])
        self.DeclareInitializationDiscreteUpdateEvent(self._solve)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._solve)

    def _solve(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        reference = self._plan.Eval(context)
        body = self._dynamics.at(self._state.Eval(context))
        q, v = body.q[self._q], body.v[6:]
        posture = self._posture(reference)
        solution = self._qp.solve(body, reference, posture)

        _, failures, in_a_row = context.get_discrete_state(self._groups[3]).value().tolist()
        if solution is not None:
            torque, in_a_row = solution.torque.take(self._place), 0.0
            rate = v + self._period * solution.acceleration[6:]
        else:
            failures, in_a_row = failures + 1.0, in_a_row + 1.0
            rate = np.zeros_like(v)
            held = in_a_row * self._period <= self._hold
            torque = context.get_discrete_state(self._groups[0]).value() if held else np.zeros_like(v)
        desired = np.where(self._is_foot, (posture.angle, posture.rate), (q, rate))
        values = (
            torque,
            desired.take(self._place, axis=1).ravel(),
            np.array((context.get_time(),)),
            np.array((float(solution is not None), failures, in_a_row)),
        )
        for group, value in zip(self._groups, values, strict=True):
            discrete_state.set_value(group, value)
        return EventStatus.Succeeded()

    def _posture(self, reference: WalkingReference) -> Posture:
        angle, rate = self._rest.copy(), np.zeros(self._n)
        feet = (reference.foot(side) for side in SIDES)
        moves = zip(self._moved, reference.shoulder_flexion, feet, strict=True)
        for (shoulder, elbow, toes), (swing, swing_rate), foot in moves:
            angle[shoulder] += swing
            rate[shoulder] = swing_rate
            angle[elbow] += 0.5 * max(swing, 0.0)
            angle[toes], rate[toes] = foot.toes
        return Posture(angle, rate)
