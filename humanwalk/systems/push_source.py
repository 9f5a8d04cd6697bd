"""LeafSystem: pushes against the body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.systems.framework import AbstractParameterIndex, BasicVector, Context, LeafSystem

from humanwalk.walking.push import Push, PushParameters, pushes_of


@dataclass(frozen=True)
class Pushes:
    """What a context of a `PushSource` holds."""

    pushes: tuple[Push, ...] = ()


class PushSource(LeafSystem):
    """Forces at the centres of mass of bodies, each constant for its duration.

    The pushes are a parameter of the context: one walker can be pushed in many ways from one moment on.

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
        self._plant = plant
        pushes = Value(self._checked(pushes_of(parameters, seed)))
        self._pushes = AbstractParameterIndex(self.DeclareAbstractParameter(pushes))
        needs = {self.time_ticket(), self.abstract_parameter_ticket(self._pushes)}
        self._forces_output = self.DeclareAbstractOutputPort(
            "spatial_forces",
            lambda: Value([ExternallyAppliedSpatialForce()]),
            self._calc_forces,
            prerequisites_of_calc=needs,
        )
        self._force_output = self.DeclareVectorOutputPort("force", 3, self._calc_force, prerequisites_of_calc=needs)

    def set_pushes(self, context: Context, pushes: Sequence[Push]) -> None:
        """Put other pushes in the place of those in this system's context."""
        context.get_mutable_abstract_parameter(self._pushes).set_value(self._checked(pushes))

    def _checked(self, pushes: Sequence[Push]) -> Pushes:
        for push in pushes:
            if not self._plant.HasBodyNamed(push.body):
                raise ValueError(f"pushes.body: {push.body}: no such body; allowed: a body of the human, like Ribs")
        return Pushes(tuple(pushes))

    def _acting(self, context: Context) -> list[Push]:
        pushes: Pushes = context.get_abstract_parameter(self._pushes).get_value()
        return [push for push in pushes.pushes if push.acts_at(context.get_time())]

    def _calc_forces(self, context: Context, output: Value) -> None:
        forces = []
        for push in self._acting(context):
            body = self._plant.GetBodyByName(push.body)
            force = ExternallyAppliedSpatialForce()
            force.body_index = body.index()
            force.p_BoBq_B = body.default_com()
            force.F_Bq_W = SpatialForce(np.zeros(3), np.array(push.force))
            forces.append(force)
        output.set_value(forces)

    def _calc_force(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(sum((np.array(push.force) for push in self._acting(context)), np.zeros(3)))
