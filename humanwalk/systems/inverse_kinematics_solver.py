"""LeafSystem: desired joint angles of both legs from the desired poses of both soles."""

from collections.abc import Mapping

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.control.inverse_kinematics import (
    InverseKinematicsParameters,
    LegKinematics,
    joint_velocity,
    solve_inverse_kinematics,
)
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal

FIRST_KNEE_BEND = 0.3
"""Flexion of the knees from which the first solution starts [rad]: a straight knee is singular."""

STATUS_COLUMNS = tuple(
    f"{side.lower()}_leg.{column}" for column in ("ik_residual", "ik_iterations", "ik_converged") for side in SIDES
)


class InverseKinematicsSolver(LeafSystem):
    """Newton inverse kinematics of both legs with a warm start, updated periodically.

    With a preview, the inputs are targets for the time `preview` from now. A preview of one period keeps the present
    between the previous sample and the next.

    Inputs:
        sole_targets: (26) of the right, then of the left sole in the pelvis frame P: desired quaternion wxyz, position
            [m], angular velocity [rad/s], velocity [m/s].
        posture: (2n) desired angles [rad] and rates [rad/s] of all n joints, in actuator order; the entries of the legs
            are replaced. Optional; default: zero.

    Outputs (all are state; evaluating them solves nothing):
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.
        sample_time: (1) time to which they belong [s].
        previous_state, previous_time: the solution before; at first the start posture at rest.
        status: (6) residual right, left; Newton steps right, left; converged right, left (1 or 0).
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        parameters: InverseKinematicsParameters,
        period: float,
        preview: float = 0.0,
        start_posture: Mapping[str, float] | None = None,
    ) -> None:
        """Make the solver.

        Args:
            plant: finalized model of the body, for kinematics only.
            parameters: settings of the Newton iteration.
            period: time between solutions [s].
            preview: time from now to which the inputs belong [s].
            start_posture: joint angles [rad] by name before the first solution and as its warm start; default: zero.
        """
        super().__init__()
        self._parameters = parameters
        self._preview = preview
        names = JointMap.of(plant).names
        self._n = n = len(names)
        legs = [LEGS[side] for side in SIDES]
        self._legs = [
            (LegKinematics(plant, PELVIS, leg.sole, leg.chain), np.array([names.index(name) for name in leg.chain]))
            for leg in legs
        ]
        self._start = start = np.zeros(2 * n)
        for name, angle in (start_posture or {}).items():
            start[names.index(name)] = angle
        self._first_bend = FIRST_KNEE_BEND * np.isin(names, [leg.knee for leg in legs])

        self._sole_targets = self.DeclareVectorInputPort("sole_targets", 26)
        self._posture = self.DeclareVectorInputPort("posture", 2 * n)
        self._desired, self._previous = (self.DeclareDiscreteState(start) for _ in range(2))
        self._time, self._previous_time = (self.DeclareDiscreteState(1) for _ in range(2))
        self._status = self.DeclareDiscreteState(len(STATUS_COLUMNS))
        self.DeclareStateOutputPort("desired_state", self._desired)
        self.DeclareStateOutputPort("sample_time", self._time)
        self.DeclareStateOutputPort("previous_state", self._previous)
        self.DeclareStateOutputPort("previous_time", self._previous_time)
        status = self.DeclareStateOutputPort("status", self._status)
        self.signals = (Signal("ik_status", status, STATUS_COLUMNS),)
        self.DeclareInitializationDiscreteUpdateEvent(self._initialize)
        self.DeclarePeriodicDiscreteUpdateEvent(period, period, self._update)

    def _initialize(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        discrete.set_value(self._previous, self._start)
        discrete.set_value(self._previous_time, np.array([context.get_time()]))
        return self._solve(self._start[: self._n] + self._first_bend, context, discrete)

    def _update(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        last = context.get_discrete_state(self._desired).value()
        last_time = context.get_discrete_state(self._time).value()
        discrete.set_value(self._previous, last)
        discrete.set_value(self._previous_time, last_time)
        elapsed = context.get_time() + self._preview - last_time[0]
        return self._solve(last[: self._n] + elapsed * last[self._n :], context, discrete)

    def _solve(self, guess: Array, context: Context, discrete: DiscreteValues) -> EventStatus:
        posture = self._posture.Eval(context) if self._posture.HasValue(context) else np.zeros(2 * self._n)
        q, v = posture[: self._n], posture[self._n :]
        status = np.empty((3, len(self._legs)))
        targets = self._sole_targets.Eval(context).reshape(len(self._legs), 13)
        for i, ((leg, joints), target) in enumerate(zip(self._legs, targets, strict=True)):
            wxyz, p_PS, V_PS = target[:4], target[4:7], target[7:]
            X_PS = RigidTransform(Quaternion(wxyz / np.linalg.norm(wxyz)), p_PS)
            solution = solve_inverse_kinematics(leg, X_PS, guess[joints], self._parameters)
            q[joints] = solution.theta
            v[joints] = joint_velocity(leg, solution.theta, V_PS, self._parameters)
            status[:, i] = solution.residual, solution.iterations, solution.converged
        discrete.set_value(self._desired, np.concatenate((q, v)))
        discrete.set_value(self._time, np.array([context.get_time() + self._preview]))
        discrete.set_value(self._status, status.ravel())
        return EventStatus.Succeeded()
