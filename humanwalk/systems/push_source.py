"""LeafSystem: pushes against the body."""

import numpy as np
import numpy.typing as npt
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem, OutputPort

from humanwalk.control.push import Push, PushParameters, pushes_of

Array = npt.NDArray[np.float64]


class PushSource(LeafSystem):
    """Forces at the centres of mass of bodies, each constant for its duration.

    Outputs:
        spatial_forces: list of ExternallyAppliedSpatialForce, for the plant's applied_spatial_force port.
        force: (3) sum of all pushes in W [N].
    """

    def __init__(self, plant: MultibodyPlant, parameters: PushParameters, seed: int) -> None:
        """Make the source.

        Args:
            plant: finalised plant whose bodies are pushed.
            parameters: the pushes.
            seed: of those that are random.
        """
        super().__init__()
        context = plant.CreateDefaultContext()
        self._pushes: list[tuple[Push, ExternallyAppliedSpatialForce]] = []
        for push in pushes_of(parameters, seed):
            if not plant.HasBodyNamed(push.body):
                raise ValueError(f"pushes.body: {push.body}: no such body; allowed: a body of the human, like Ribs")
            body = plant.GetBodyByName(push.body)
            force = ExternallyAppliedSpatialForce()
            force.body_index = body.index()
            force.p_BoBq_B = body.CalcCenterOfMassInBodyFrame(context)
            force.F_Bq_W = SpatialForce(np.zeros(3), np.array(push.force))
            self._pushes.append((push, force))
        now = {self.time_ticket()}
        self._forces_output = self.DeclareAbstractOutputPort(
            "spatial_forces",
            lambda: Value([ExternallyAppliedSpatialForce()]),
            self._calc_forces,
            prerequisites_of_calc=now,
        )
        self._force_output = self.DeclareVectorOutputPort("force", 3, self._calc_force, prerequisites_of_calc=now)

    def _calc_forces(self, context: Context, output: Value) -> None:
        time = context.get_time()
        output.set_value([force for push, force in self._pushes if push.acts_at(time)])

    def _calc_force(self, context: Context, output: BasicVector) -> None:
        time = context.get_time()
        output.SetFromVector(sum((np.array(push.force) for push, _ in self._pushes if push.acts_at(time)), np.zeros(3)))

    def get_spatial_forces_output_port(self) -> OutputPort:
        """Output spatial_forces."""
        return self._forces_output

    def get_force_output_port(self) -> OutputPort:
        """Output force."""
        return self._force_output
