"""LeafSystem: desired joint angles of both legs from the desired poses of both soles."""

from collections.abc import Mapping

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import LEG_JOINTS, SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.control.inverse_kinematics import (
    InverseKinematicsParameters,
    LegKinematics,
    joint_velocity,
    solve_inverse_kinematics,
)
from humanwalk.control.revolute_chain import pose_of
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal

FIRST_KNEE_BEND = 0.3
"""Bend of the knees from which the first solution starts [rad]."""


class InverseKinematicsSolver(LeafSystem):
    """Newton inverse kinematics of both legs, warm-started, in a periodic discrete update.

    With a preview its inputs are targets for the time `preview` from now. Made with a preview of one period, it keeps
    the sample before and the sample after the present, for a PostureInterpolator.

    Inputs:
        sole_targets: (26) of the right, then of the left sole in the pelvis P, as Drake's floating base has it: desired
            quaternion wxyz, position [m], angular velocity [rad/s], velocity [m/s].
        posture: (84) desired angles [rad] and rates [rad/s] of all 42 joints, in actuator order; the legs'
            entries are replaced. Optional: zero when not connected.

    Outputs (all show state, so reading them solves nothing):
        desired_state: (84) desired joint angles [rad], then rates [rad/s], in actuator order.
        sample_time: (1) the time for which they were solved [s].
        previous_state, previous_time: the same of the solution before; at first the start posture at rest.
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
            plant: finalised model of the body, for kinematics only.
            parameters: settings of the Newton iteration.
            period: time between solutions [s].
            preview: how far ahead of the present the inputs are [s].
            start_posture: joint angles [rad] by name of the posture before the first solution, zero unless named. It
                is solved from there, but with knees bent by 0.3 rad: a straight knee is singular.
        """
        super().__init__()
        self._parameters = parameters
        self._legs = {side: LegKinematics(plant, "Pelvis", f"{side}Leg_Sole", LEG_JOINTS[side]) for side in SIDES}
        names = JointMap.of(plant).names
        self._n = len(names)
        self._places = {side: np.array([names.index(name) for name in LEG_JOINTS[side]]) for side in SIDES}
        start = np.zeros(2 * self._n)
        for name, angle in (start_posture or {}).items():
            start[names.index(name)] = angle
        self._bent_knees = np.zeros(self._n)
        self._bent_knees[[names.index(f"{side}LegTibiaMotion") for side in SIDES]] = FIRST_KNEE_BEND
        self._preview = preview

        self._sole_targets = self.DeclareVectorInputPort("sole_targets", 26)
        self._posture = self.DeclareVectorInputPort("posture", 2 * self._n)

        desired = self.DeclareDiscreteState(start)
        sample_time = self.DeclareDiscreteState(1)
        status = self.DeclareDiscreteState(6)
        previous = self.DeclareDiscreteState(start)
        previous_time = self.DeclareDiscreteState(1)
        self._desired_state_output = self.DeclareStateOutputPort("desired_state", desired)
        self._sample_time_output = self.DeclareStateOutputPort("sample_time", sample_time)
        self._status_output = self.DeclareStateOutputPort("status", status)
        self._previous_state_output = self.DeclareStateOutputPort("previous_state", previous)
        self._previous_time_output = self.DeclareStateOutputPort("previous_time", previous_time)
        self._groups = (desired, sample_time, status, previous, previous_time)
        self.DeclareInitializationDiscreteUpdateEvent(self._initialize)
        # The first solution is the initialisation's.
        self.DeclarePeriodicDiscreteUpdateEvent(period, period, self._solve)
        self.signals = (
            Signal(
                "ik_status",
                self.GetOutputPort("status"),
                tuple(
                    f"{side.lower()}_leg.{column}"
                    for column in ("ik_residual", "ik_iterations", "ik_converged")
                    for side in SIDES
                ),
            ),
        )

    def _initialize(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        desired, *_, previous_time = self._groups
        start = context.get_discrete_state(desired).value()
        discrete.set_value(previous_time, np.array([context.get_time()]))
        return self._solve_from(start[: self._n] + self._bent_knees, context, discrete)

    def _solve(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        desired, sample_time, _, previous, previous_time = self._groups
        last, last_time = (context.get_discrete_state(group).value() for group in (desired, sample_time))
        discrete.set_value(previous, last)
        discrete.set_value(previous_time, last_time)
        # Start from where the last solution would be by the time of this one.
        elapsed = context.get_time() + self._preview - last_time[0]
        return self._solve_from(last[: self._n] + elapsed * last[self._n :], context, discrete)

    def _solve_from(self, warm: Array, context: Context, discrete: DiscreteValues) -> EventStatus:
        desired, sample_time, status, *_ = self._groups
        found = self._posture.Eval(context) if self._posture.HasValue(context) else np.zeros(2 * self._n)
        q, v = found[: self._n], found[self._n :]
        report = np.empty(6)
        for i, (side, target) in enumerate(zip(SIDES, self._sole_targets.Eval(context).reshape(2, 13), strict=True)):
            leg, places = self._legs[side], self._places[side]
            w, x, y, z, *origin = target[:7].tolist()
            solution = solve_inverse_kinematics(leg, pose_of((w, x, y, z), origin), warm[places], self._parameters)
            q[places] = solution.theta
            v[places] = joint_velocity(leg, solution.theta, target[7:], self._parameters)
            report[i::2] = solution.residual, solution.iterations, solution.converged
        discrete.set_value(desired, found)
        discrete.set_value(sample_time, np.array([context.get_time() + self._preview]))
        discrete.set_value(status, report)
        return EventStatus.Succeeded()
