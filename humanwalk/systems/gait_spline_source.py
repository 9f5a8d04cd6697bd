"""LeafSystem: where both soles and the pelvis should be, from the gait's splines."""

from functools import lru_cache

import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.framework import BasicVector, Context, LeafSystem, OutputPort

from humanwalk.body import SIDES, Side, Skeleton
from humanwalk.gait.walking_gait import FootTarget, WalkingGait


def _sole_velocity(foot: FootTarget) -> SpatialVelocity:
    return SpatialVelocity(np.array([0.0, foot.pitch_rate, 0.0]), foot.velocity)


class GaitSplineSource(LeafSystem):
    """The walking reference as a function of time; it has no input.

    The soles' targets are those of the time `preview` from now, everything else is of now.

    Outputs:
        X_PRs, X_PLs: RigidTransform, desired pose of the right and left sole frame in the pelvis P. Soles are level
            in stance (thesis 4.2.3: foot orientation constant); in swing the toes drop by the path's toe_drop.
        V_PRs, V_PLs: SpatialVelocity, their time derivatives, in P.
        pelvis_reference: (13) where the pelvis should be in W, upright and walking along +x, as Drake's floating base
            has it: quaternion wxyz, position [m], angular velocity [rad/s], velocity [m/s].
        phase: (2) phase of the right and of the left foot in [0, 1), 0 at touchdown.
        contact_schedule: (2) right, left: 1 in stance, 0 in swing.
    """

    def __init__(self, gait: WalkingGait, skeleton: Skeleton, preview: float = 0.0) -> None:
        """Make the source of a gait for a body whose pelvis frame is at hip height, `preview` [s] ahead."""
        super().__init__()
        self._gait = gait
        self._preview = preview
        # Pose and velocity of a foot are asked for one after the other.
        self._foot_at = lru_cache(maxsize=4)(gait.foot)
        self._hip_height = skeleton.hip_height
        self._X, self._V = {}, {}
        for side in SIDES:
            self._X[side] = self.DeclareAbstractOutputPort(
                f"X_P{side[0]}s",
                lambda: Value(RigidTransform()),
                lambda context, output, side=side: output.set_value(self._sole_pose(self._foot(context, side))),
                prerequisites_of_calc={self.time_ticket()},
            )
            self._V[side] = self.DeclareAbstractOutputPort(
                f"V_P{side[0]}s",
                lambda: Value(SpatialVelocity()),
                lambda context, output, side=side: output.set_value(_sole_velocity(self._foot(context, side))),
                prerequisites_of_calc={self.time_ticket()},
            )
        self._pelvis_reference = self.DeclareVectorOutputPort(
            "pelvis_reference", 13, self._calc_pelvis_reference, prerequisites_of_calc={self.time_ticket()}
        )
        self._phase = self.DeclareVectorOutputPort(
            "phase", 2, self._calc_phase, prerequisites_of_calc={self.time_ticket()}
        )
        self._contact_schedule = self.DeclareVectorOutputPort(
            "contact_schedule",
            2,
            self._calc_contact_schedule,
            prerequisites_of_calc={self.time_ticket()},
        )

    def _foot(self, context: Context, side: Side) -> FootTarget:
        return self._foot_at(side, context.get_time() + self._preview)

    def _sole_pose(self, foot: FootTarget) -> RigidTransform:
        below_hips = self._hip_height - self._gait.parameters.offset
        return RigidTransform(
            RotationMatrix.MakeYRotation(foot.pitch),
            foot.position - np.array([0.0, 0.0, below_hips]),
        )

    def _calc_pelvis_reference(self, context: Context, output: BasicVector) -> None:
        pelvis = self._gait.pelvis(context.get_time())
        reference = np.zeros(13)
        reference[0] = 1.0
        reference[4], reference[6] = pelvis.distance, self._hip_height - pelvis.drop
        reference[10], reference[12] = pelvis.speed, -pelvis.drop_rate
        output.SetFromVector(reference)

    def _calc_phase(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.phases(context.get_time()))

    def _calc_contact_schedule(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.schedule(context.get_time()))

    def phases(self, time: float) -> list[float]:
        """The output phase at a time [s]."""
        return [self._gait.phase(side, time) for side in SIDES]

    def schedule(self, time: float) -> list[float]:
        """The output contact_schedule at a time [s]."""
        return [float(self._gait.in_stance(side, time)) for side in SIDES]

    def get_sole_pose_output_port(self, side: Side) -> OutputPort:
        """Output X_PRs or X_PLs."""
        return self._X[side]

    def get_sole_velocity_output_port(self, side: Side) -> OutputPort:
        """Output V_PRs or V_PLs."""
        return self._V[side]

    def get_pelvis_reference_output_port(self) -> OutputPort:
        """Output pelvis_reference."""
        return self._pelvis_reference

    def get_phase_output_port(self) -> OutputPort:
        """Output phase."""
        return self._phase

    def get_contact_schedule_output_port(self) -> OutputPort:
        """Output contact_schedule."""
        return self._contact_schedule
