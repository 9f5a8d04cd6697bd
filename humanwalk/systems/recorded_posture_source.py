"""LeafSystem: joint angles and pelvis motion of a recording."""

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.systems.signal import Signal, floating_base


class RecordedPostureSource(LeafSystem):
    """A recorded motion as a function of time; no input.

    Outputs:
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.
        pelvis_reference: (13) recorded motion of the pelvis in W, in the order of Drake's floating base: quaternion
            wxyz, position [m], angular velocity [rad/s], velocity [m/s].
    """

    def __init__(self, motion: RecordedMotion) -> None:
        """Make the source of a motion with joints in actuator order."""
        super().__init__()
        self._motion = motion
        self.DeclareVectorOutputPort("desired_state", 2 * motion.angles.shape[1], self._calc_desired_state)
        pelvis = self.DeclareVectorOutputPort("pelvis_reference", 13, self._calc_pelvis_reference)
        self.signals = (Signal("pelvis_reference", pelvis, floating_base("pelvis.reference_")),)

    def _calc_desired_state(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(np.concatenate(self._motion.joints(context.get_time())))

    def _calc_pelvis_reference(self, context: Context, output: BasicVector) -> None:
        X_WP, V_WP = self._motion.pelvis(context.get_time())
        quaternion = X_WP.rotation().ToQuaternion().wxyz()
        output.SetFromVector(np.concatenate((quaternion, X_WP.translation(), V_WP.get_coeffs())))
