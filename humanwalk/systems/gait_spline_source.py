"""Diagram: where both soles and the pelvis should be, from the gait's splines."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numpy.polynomial import Chebyshev
from numpy.polynomial import Polynomial as Power
from pydrake.polynomial import Polynomial
from pydrake.systems.framework import BasicVector, Context, Diagram, DiagramBuilder, LeafSystem
from pydrake.systems.primitives import TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from humanwalk.body import SIDES, Skeleton
from humanwalk.gait.walking_gait import PELVIS_DEGREE, FootTarget, PelvisTarget, WalkingGait
from humanwalk.numerics import Array

FOREVER = 1e6
"""Time at which the pelvis stops [s]; no simulation lasts that long."""


class GaitSplineSource(Diagram):
    """The walking reference as a function of time; it has no input.

    The plant asks for the pelvis in every step, so it is one of Drake's own sources of polynomials; the soles are
    asked for by the inverse kinematics only.

    The soles' targets are those of the time `preview` from now, everything else is of now.

    Outputs:
        sole_targets: (26) where the right, then where the left sole frame should be in the pelvis P, each as Drake's
            floating base has it: quaternion wxyz, position [m], angular velocity [rad/s], velocity [m/s]. Soles are
            level in stance (thesis 4.2.3: foot orientation constant); in swing the toes drop by the path's toe_drop.
        pelvis_reference: (13) where the pelvis should be in W, upright and walking along +x, as Drake's floating base
            has it: quaternion wxyz, position [m], angular velocity [rad/s], velocity [m/s].
        phase: (2) phase of the right and of the left foot in [0, 1), 0 at touchdown.
        contact_schedule: (2) right, left: 1 in stance, 0 in swing.
    """

    def __init__(self, gait: WalkingGait, skeleton: Skeleton, preview: float = 0.0) -> None:
        """Make the source of a gait for a body whose pelvis frame is at hip height, `preview` [s] ahead."""
        super().__init__()
        self._gait = gait
        builder = DiagramBuilder()
        pelvis = builder.AddNamedSystem("pelvis", TrajectorySource(_pelvis_reference(gait, skeleton.hip_height)))
        feet = builder.AddNamedSystem("feet", GaitFeetSource(gait, skeleton, preview))
        builder.ExportOutput(pelvis.get_output_port(), "pelvis_reference")
        for i in range(feet.num_output_ports()):
            builder.ExportOutput(feet.get_output_port(i), feet.get_output_port(i).get_name())
        builder.BuildInto(self)

    def phases(self, time: float) -> list[float]:
        """The output phase at a time [s]."""
        return _phases(self._gait, time)

    def schedule(self, time: float) -> list[float]:
        """The output contact_schedule at a time [s]."""
        return _schedule(self._gait, time)


class GaitFeetSource(LeafSystem):
    """All outputs of a GaitSplineSource but the pelvis'."""

    def __init__(self, gait: WalkingGait, skeleton: Skeleton, preview: float = 0.0) -> None:
        super().__init__()
        self._gait = gait
        self._preview = preview
        self._below_hips = skeleton.hip_height - gait.parameters.offset
        self.DeclareVectorOutputPort(
            "sole_targets", 26, self._calc_sole_targets, prerequisites_of_calc={self.time_ticket()}
        )
        self.DeclareVectorOutputPort("phase", 2, self._calc_phase, prerequisites_of_calc={self.time_ticket()})
        self.DeclareVectorOutputPort(
            "contact_schedule",
            2,
            self._calc_contact_schedule,
            prerequisites_of_calc={self.time_ticket()},
        )

    def _calc_sole_targets(self, context: Context, output: BasicVector) -> None:
        target = self._gait.target(context.get_time() + self._preview)
        output.SetFromVector(np.array((*self._sole_target(target.right), *self._sole_target(target.left))))

    def _sole_target(self, foot: FootTarget) -> tuple[float, ...]:
        x, y, z = foot.position
        half = 0.5 * foot.pitch
        turned = math.cos(half), 0.0, math.sin(half), 0.0
        return *turned, x, y, z - self._below_hips, 0.0, foot.pitch_rate, 0.0, *foot.velocity

    def _calc_phase(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(_phases(self._gait, context.get_time()))

    def _calc_contact_schedule(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(_schedule(self._gait, context.get_time()))


def _phases(gait: WalkingGait, time: float) -> list[float]:
    return [gait.phase(side, time) for side in SIDES]


def _schedule(gait: WalkingGait, time: float) -> list[float]:
    return [float(gait.in_stance(side, time)) for side in SIDES]


def _pelvis_reference(gait: WalkingGait, hip_height: float) -> PiecewisePolynomial:
    """The output pelvis_reference as polynomials of time."""
    breaks = [0.0, *gait.pelvis_breaks, FOREVER]

    def polynomials(begin: float, end: float) -> npt.NDArray[np.object_]:
        degree, end = (1, begin + 1.0) if end == FOREVER else (PELVIS_DEGREE, end)

        def fitted(value: Callable[[PelvisTarget], float]) -> Power:
            def values(since: Array) -> Array:
                return np.array([value(gait.pelvis(begin + s)) for s in since])

            power: Power = Chebyshev.interpolate(values, degree, (0.0, end - begin)).convert(kind=Power)
            return power

        x, z = fitted(lambda pelvis: pelvis.distance), fitted(lambda pelvis: hip_height - pelvis.drop)
        zero, one = Power([0.0]), Power([1.0])
        rows = (one, zero, zero, zero, x, zero, z, zero, zero, zero, x.deriv(), zero, z.deriv())
        return np.array([[Polynomial(row.coef.astype(np.float64))] for row in rows])

    return PiecewisePolynomial([polynomials(*piece) for piece in pairwise(breaks)], breaks)
