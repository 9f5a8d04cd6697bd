"""LeafSystem: the desired posture of everything but the legs, with arms that swing against the legs."""

from collections.abc import Mapping, Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.gait.arm_swing import ArmSwingParameters, arm_joints, arm_swing
from humanwalk.gait.walking_gait import WalkingGait


class ArmSwingSource(LeafSystem):
    """Desired angles of all joints while walking, before the legs are solved for; a function of time.

    Outputs:
        posture: (2n) desired angles [rad], then rates [rad/s], in actuator order: swinging arms, every other joint at
            the start posture.
    """

    def __init__(
        self,
        joint_names: Sequence[str],
        gait: WalkingGait,
        parameters: ArmSwingParameters,
        start_posture: Mapping[str, float] | None = None,
        preview: float = 0.0,
    ) -> None:
        """Make the source for n joints in actuator order, in step with a gait.

        Args:
            joint_names: the n joints.
            gait: whose phases the arms follow.
            parameters: size of the swing.
            start_posture: angles [rad] by joint name that are held throughout (arms: the middle of their swing).
            preview: how far ahead of the present the posture is [s].
        """
        super().__init__()
        self._gait = gait
        self._preview = preview
        n, place = len(joint_names), {name: i for i, name in enumerate(joint_names)}
        # The posture is a sum of three, weighted by 1, swing and its rate.
        self._parts = np.zeros((3, 2 * n))
        for name, angle in (start_posture or {}).items():
            self._parts[0, place[name]] = angle
        for name, joint in arm_joints(parameters).items():
            self._parts[0, place[name]] += joint.middle
            self._parts[1, place[name]] = self._parts[2, n + place[name]] = joint.amplitude
        self._posture = self.DeclareVectorOutputPort(
            "posture", 2 * n, self._calc_posture, prerequisites_of_calc={self.time_ticket()}
        )

    def _calc_posture(self, context: Context, output: BasicVector) -> None:
        t = context.get_time() + self._preview
        gait, ramp = self._gait, self._gait.ramp
        full, speed = ramp.speed if ramp.speed > 0 else 1.0, ramp.speed_at(t)
        swing, rate = arm_swing(
            gait.phase("Right", t), speed / gait.parameters.walked_stride, speed / full, ramp.acceleration(t) / full
        )
        output.SetFromVector(np.array((1.0, swing, rate)).dot(self._parts))
