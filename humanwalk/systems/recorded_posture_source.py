"""LeafSystem: joint angles and pelvis path out of a recording."""

import numpy as np
from pydrake.systems.framework import LeafSystem

from humanwalk.motion.recorded_motion import PelvisMotion, RecordedMotion
from humanwalk.numerics import Array


def _floating_base(pelvis: PelvisMotion) -> Array:
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
