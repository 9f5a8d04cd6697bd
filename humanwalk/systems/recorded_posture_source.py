"""LeafSystem: joint angles and pelvis path out of a recording."""

import numpy as np
import numpy.typing as npt
from pydrake.systems.framework import LeafSystem, OutputPort

from humanwalk.gait.recorded_motion import PelvisMotion, RecordedMotion


def _floating_base(pelvis: PelvisMotion) -> npt.NDArray[np.float64]:
    X_WP, V_WP = pelvis
    return np.concatenate((X_WP.rotation().ToQuaternion().wxyz(), X_WP.translation(), V_WP.get_coeffs()))


class RecordedPostureSource(LeafSystem):
    """A recorded motion as a function of time; it has no input.

    Outputs:
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.
        pelvis_reference: (13) where the pelvis was in W, as Drake's floating base has it: quaternion wxyz, position
            [m], angular velocity [rad/s], velocity [m/s].
    """

    def __init__(self, motion: RecordedMotion) -> None:
        """Make the source of a motion whose joints are in actuator order."""
        super().__init__()
        when = {self.time_ticket()}
        self._desired_state = self.DeclareVectorOutputPort(
            "desired_state",
            2 * motion.angles.shape[1],
            lambda context, output: output.SetFromVector(np.concatenate(motion.joints(context.get_time()))),
            prerequisites_of_calc=when,
        )
        self._pelvis_reference = self.DeclareVectorOutputPort(
            "pelvis_reference",
            13,
            lambda context, output: output.SetFromVector(_floating_base(motion.pelvis(context.get_time()))),
            prerequisites_of_calc=when,
        )

    def get_desired_state_output_port(self) -> OutputPort:
        """Output desired_state."""
        return self._desired_state

    def get_pelvis_reference_output_port(self) -> OutputPort:
        """Output pelvis_reference."""
        return self._pelvis_reference
