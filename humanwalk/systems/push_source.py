"""LeafSystem: pushes of the body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import BodyIndex
from pydrake.systems.framework import AbstractParameterIndex, BasicVector, Context, LeafSystem

from humanwalk.quantity import ParameterError, near_or_all
from humanwalk.systems.abstract_output import declare_abstract_output
from humanwalk.systems.signal import Signal, xyz
from humanwalk.walking.push import Push, PushParameters, all_pushes

FORCE_COLUMNS = xyz("push.force_", "N")


@dataclass(frozen=True)
class Pushes:
    """The abstract parameter of a `PushSource`."""

    pushes: tuple[Push, ...] = ()


class PushSource(LeafSystem):
    """Forces at the centers of mass of bodies, each constant for its duration.

    The pushes are a parameter of the context, so that one walker can be pushed in many ways from one state.

    Outputs:
        spatial_forces: list of ExternallyAppliedSpatialForce, for the plant's applied_spatial_force port.
        force: (3) sum of all pushes in W [N].
    """

    def __init__(self, plant: MultibodyPlant, parameters: PushParameters, seed: int) -> None:
        """Create the source.

        Args:
            plant: Finalized plant of the bodies that are pushed.
            parameters: The pushes.
            seed: Seed of the random pushes.

        Raises:
            ParameterError: A push names a body that the plant does not have.
        """
        super().__init__()
        self._plant = plant
        pushes = Value(self._checked(all_pushes(parameters, seed)))
        self._pushes = AbstractParameterIndex(self.DeclareAbstractParameter(pushes))
        needs = {self.time_ticket(), self.abstract_parameter_ticket(self._pushes)}
        forces = Value([ExternallyAppliedSpatialForce()])
        declare_abstract_output(self, "spatial_forces", forces, self._calc_spatial_forces, needs)
        force = self.DeclareVectorOutputPort("force", 3, self._calc_force, prerequisites_of_calc=needs)
        self.signals = (Signal("push", force, FORCE_COLUMNS),)

    def set_pushes(self, context: Context, pushes: Sequence[Push]) -> None:
        """Replace the pushes in this system's context.

        Raises:
            ParameterError: A push names a body that the plant does not have.
        """
        context.get_mutable_abstract_parameter(self._pushes).set_value(self._checked(pushes))

    def pushes(self, context: Context) -> tuple[Push, ...]:
        """The pushes in this system's context."""
        pushes: Pushes = context.get_abstract_parameter(self._pushes).get_value()
        return pushes.pushes

    def _checked(self, pushes: Sequence[Push]) -> Pushes:
        for push in pushes:
            if not self._plant.HasBodyNamed(push.body):
                names = [self._plant.get_body(BodyIndex(i)).name() for i in range(1, self._plant.num_bodies())]
                raise ParameterError(
                    f"pushes.body: {push.body}: no such body; allowed: the {len(names)} bodies of the model"
                    f"{near_or_all(push.body, names)}"
                )
        step = self._plant.time_step()
        return Pushes(tuple(push.in_steps(step) for push in pushes) if step > 0.0 else tuple(pushes))

    def _active(self, context: Context) -> list[Push]:
        return [push for push in self.pushes(context) if push.is_active(context.get_time())]

    def _calc_spatial_forces(self, context: Context, output: Value) -> None:
        forces = []
        for push in self._active(context):
            body = self._plant.GetBodyByName(push.body)
            force = ExternallyAppliedSpatialForce()
            force.body_index = body.index()
            force.p_BoBq_B = body.default_com()
            force.F_Bq_W = SpatialForce(np.zeros(3), np.array(push.force))
            forces.append(force)
        output.set_value(forces)

    def _calc_force(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(sum((np.array(push.force) for push in self._active(context)), np.zeros(3)))
