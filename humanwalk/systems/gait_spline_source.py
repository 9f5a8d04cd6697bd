"""LeafSystem: desired motion of both soles and the pelvis, from the gait's splines."""

from math import cos, sin

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body import SIDES, Skeleton
from humanwalk.gait.walking_gait import FootTarget, WalkingGait
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal, floating_base


class GaitSplineSource(LeafSystem):
    """The walking reference as a function of time; no input.

    Poses and velocities are in the order of Drake's floating base: quaternion wxyz, position [m], angular velocity
    [rad/s], velocity [m/s].

    Outputs:
        sole_targets: (26) desired motion of the right, then of the left sole frame in the pelvis frame P, at `preview`
            from now. Soles lie on the ground in stance (thesis 4.2.3: foot orientation constant); in swing the toes
            drop by the path's toe_drop.
        pelvis_reference: (13) desired motion of the pelvis in W, upright and walking along +x.
        phase: (2) phase of the right and of the left foot in [0, 1), 0 at touchdown.
        contact_schedule: (2) right, left: 1 in stance, 0 in swing.
    """

    def __init__(self, gait: WalkingGait, skeleton: Skeleton, preview: float = 0.0) -> None:
        """Make the source of a gait for a body whose pelvis frame is at hip height, `preview` [s] ahead."""
        super().__init__()
        self._gait, self._preview = gait, preview
        self._hip_height = skeleton.hip_height
        self.DeclareVectorOutputPort("sole_targets", 26, self._calc_sole_targets)
        pelvis = self.DeclareVectorOutputPort("pelvis_reference", 13, self._calc_pelvis_reference)
        phase = self.DeclareVectorOutputPort("phase", 2, self._calc_phase)
        schedule = self.DeclareVectorOutputPort("contact_schedule", 2, self._calc_contact_schedule)
        self.signals = (
            Signal("phase", phase, tuple(f"{side.lower()}_foot.phase" for side in SIDES)),
            Signal("contact_schedule", schedule, tuple(f"{side.lower()}_foot.scheduled" for side in SIDES)),
            Signal("pelvis_reference", pelvis, floating_base("pelvis.reference_")),
        )

    def _calc_sole_targets(self, context: Context, output: BasicVector) -> None:
        target = self._gait.target(context.get_time() + self._preview)
        output.SetFromVector(np.concatenate((self._sole_target(target.right), self._sole_target(target.left))))

    def _sole_target(self, foot: FootTarget) -> Array:
        x, y, z = foot.position
        (c_pitch, s_pitch), (c_roll, s_roll) = ((cos(angle / 2), sin(angle / 2)) for angle in (foot.pitch, foot.roll))
        quaternion = (c_pitch * c_roll, c_pitch * s_roll, s_pitch * c_roll, -s_pitch * s_roll)
        rates = (foot.roll_rate * cos(foot.pitch), foot.pitch_rate, -foot.roll_rate * sin(foot.pitch))
        # The gait's z is from the ground while walking, where the hips are lower than in standing by the offset.
        position = (x, y, z - (self._hip_height - self._gait.parameters.offset))
        return np.array((*quaternion, *position, *rates, *foot.velocity))

    def _calc_pelvis_reference(self, context: Context, output: BasicVector) -> None:
        pelvis = self._gait.pelvis(context.get_time())
        quaternion, angular_velocity = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        position = (pelvis.distance, 0.0, self._hip_height - pelvis.drop)
        velocity = (pelvis.speed, 0.0, -pelvis.drop_rate)
        output.SetFromVector(np.array((*quaternion, *position, *angular_velocity, *velocity)))

    def _calc_phase(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(np.array([self._gait.phase(side, context.get_time()) for side in SIDES]))

    def _calc_contact_schedule(self, context: Context, output: BasicVector) -> None:
        stance = [self._gait.in_stance(side, context.get_time()) for side in SIDES]
        output.SetFromVector(np.array(stance, dtype=float))
