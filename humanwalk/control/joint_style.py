"""A style: soft tasks that hips, knees and ankles follow given angles over the gait cycle."""

from __future__ import annotations

import numpy as np

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.control.body_dynamics import Dynamics
from humanwalk.control.whole_body_parameters import TaskGains
from humanwalk.control.whole_body_tasks import Task
from humanwalk.motion.gait_curves import GaitCurves
from humanwalk.walking.walking_reference import WalkingReference


class JointStyle:
    """Tasks of the whole-body program: sagittal joint angles over the gait cycle of each leg.

    The phase is that of the step planner, so that the angles follow the steps, not the steps the angles. Below the
    lowest speed of the curves the weight decreases with the measured forward speed; in standing there is no task. With
    the commanded speed, the angles of a full stride kept the body from its first step, and it walked backward.
    """

    def __init__(self, joints: JointMap, curves: GaitCurves, gains: TaskGains, ankle: float = 1.0) -> None:
        """Make the tasks.

        Args:
            joints: Places of the joints in the positions and velocities of the plant.
            curves: Angles over the gait cycle.
            gains: Of the task of each leg.
            ankle: Weight of the ankle relative to hip and knee.
        """
        self._curves, self._gains = curves, gains
        self._scale = np.sqrt((1.0, 1.0, ankle))
        places = {side: [joints.names.index(name) for name in LEGS[side].sagittal] for side in SIDES}
        self._q = {side: joints.q[place] for side, place in places.items()}
        self._v = {side: joints.v[place] for side, place in places.items()}

    def tasks(self, body: Dynamics, reference: WalkingReference, radius: float) -> list[Task]:
        """The tasks at one state; none in standing or at a speed that is not forward.

        Args:
            body: The body at this state.
            reference: Phase and speed of the step.
            radius: Length by which angular accelerations are weighed against those of points [m].
        """
        gains = self._gains
        forward = np.array((np.cos(reference.pelvis_yaw), np.sin(reference.pelvis_yaw)))
        speed = min(float(forward @ body.com.velocity[:2]), reference.speed)
        share = min(max(speed, 0.0) / self._curves.lowest_speed, 1.0)
        if not reference.is_stepping or share == 0.0:
            return []
        phase_rate = 0.5 / reference.step_duration
        tasks = []
        for side in SIDES:
            phase, places = reference.gait_phase(side), self._v[side]
            motion = self._curves.at(side, phase, reference.speed)
            q, v = body.q[self._q[side]], body.v[places]
            desired = phase_rate**2 * motion.curvature
            desired += gains.stiffness * (motion.value - q) + gains.damping * (phase_rate * motion.slope - v)
            J = self._scale[:, None] * np.eye(body.v.size)[places]
            tasks.append(Task(J, self._scale * desired, share * radius**2 * gains.weight))
        return tasks
