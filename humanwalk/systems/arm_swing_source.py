"""LeafSystem: the desired posture of everything but the legs, with arms that swing against the legs."""

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.walking.arm_swing import ArmSwingParameters, arm_joints, arm_swing


class ArmSwingSource(LeafSystem):
    """Desired angles of all joints while walking, before the legs are solved for; no input.

    Outputs:
        posture: (2n) desired angles [rad], then rates [rad/s], in actuator order, at `preview` from now: the arms swing
            about their middle, every other joint is at zero.
    """

    def __init__(
        self, joint_names: Sequence[str], gait: WalkingGait, parameters: ArmSwingParameters, preview: float = 0.0
    ) -> None:
        """Make the source for joints in actuator order; the arms follow the phases of a gait, `preview` [s] ahead."""
        super().__init__()
        self._gait, self._preview = gait, preview
        self._middle, self._amplitude = np.zeros((2, len(joint_names)))
        for name, joint in arm_joints(parameters).items():
            place = joint_names.index(name)
            self._middle[place], self._amplitude[place] = joint.middle, joint.amplitude
        self.DeclareVectorOutputPort("posture", 2 * len(joint_names), self._calc_posture)

    def _calc_posture(self, context: Context, output: BasicVector) -> None:
        t = context.get_time() + self._preview
        gait, ramp = self._gait, self._gait.ramp
        full, speed = ramp.speed if ramp.speed > 0 else 1.0, ramp.speed_at(t)
        swing, rate = arm_swing(
            gait.phase("Right", t), speed / gait.parameters.walked_stride, speed / full, ramp.acceleration(t) / full
        )
        output.SetFromVector(np.concatenate((self._middle + swing * self._amplitude, rate * self._amplitude)))
