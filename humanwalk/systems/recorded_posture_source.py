"""LeafSystem: joint angles and pelvis path out of a recording."""

import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.framework import LeafSystem, OutputPort

from humanwalk.gait.recorded_motion import RecordedMotion


class RecordedPostureSource(LeafSystem):
    """A recorded motion as a function of time; it has no input.

    Outputs:
        desired_state: (2n) desired joint angles [rad], then rates [rad/s], in actuator order.
        X_WP: RigidTransform, reference pose of the pelvis in the world.
        V_WP: SpatialVelocity, its time derivative, in W.
        p_WP: (3) the translation of X_WP [m], for records.
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
        self._X_WP = self.DeclareAbstractOutputPort(
            "X_WP",
            lambda: Value(RigidTransform()),
            lambda context, output: output.set_value(motion.pelvis(context.get_time()).X_WP),
            prerequisites_of_calc=when,
        )
        self._V_WP = self.DeclareAbstractOutputPort(
            "V_WP",
            lambda: Value(SpatialVelocity()),
            lambda context, output: output.set_value(motion.pelvis(context.get_time()).V_WP),
            prerequisites_of_calc=when,
        )
        self._p_WP = self.DeclareVectorOutputPort(
            "p_WP",
            3,
            lambda context, output: output.SetFromVector(motion.pelvis(context.get_time()).X_WP.translation()),
            prerequisites_of_calc=when,
        )

    def get_desired_state_output_port(self) -> OutputPort:
        """Output desired_state."""
        return self._desired_state

    def get_pelvis_pose_output_port(self) -> OutputPort:
        """Output X_WP."""
        return self._X_WP

    def get_pelvis_velocity_output_port(self) -> OutputPort:
        """Output V_WP."""
        return self._V_WP

    def get_pelvis_position_output_port(self) -> OutputPort:
        """Output p_WP."""
        return self._p_WP
