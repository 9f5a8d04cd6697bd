"""LeafSystem: the desired posture of everything but the legs, with arms that swing against the legs."""

from collections.abc import Mapping, Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem, OutputPort

from humanwalk.gait.arm_swing import ArmSwingParameters, arm_targets
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
        self._parameters = parameters
        self._preview = preview
        self._place = {name: i for i, name in enumerate(joint_names)}
        self._n = len(joint_names)
        self._start = np.zeros(2 * self._n)
        for name, angle in (start_posture or {}).items():
            self._start[self._place[name]] = angle
        self._posture = self.DeclareVectorOutputPort(
            "posture", 2 * self._n, self._calc_posture, prerequisites_of_calc={self.time_ticket()}
        )

    def _calc_posture(self, context: Context, output: BasicVector) -> None:
        t = context.get_time() + self._preview
        ramp, parameters = self._gait.ramp, self._gait.parameters
        full = ramp.speed if ramp.speed > 0 else 1.0
        targets = arm_targets(
            self._parameters,
            self._gait.phase("Right", t),
            ramp.speed_at(t) / parameters.walked_stride,
            ramp.speed_at(t) / full,
            ramp.acceleration(t) / full,
        )
        posture = self._start.copy()
        for name, target in targets.items():
            posture[self._place[name]] += target.angle
            posture[self._n + self._place[name]] = target.rate
        output.SetFromVector(posture)

    def get_posture_output_port(self) -> OutputPort:
        """Output posture."""
        return self._posture
