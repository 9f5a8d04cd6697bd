"""LeafSystem: where the feet and the centre of mass are."""

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem, ValueProducer

from humanwalk.body import SIDES
from humanwalk.numerics import Array


class BodyObserver(LeafSystem):
    """Kinematics of the body from the plant's state.

    Inputs:
        state: plant state [q; v].

    Outputs:
        soles: (6) position of the right, then the left sole frame in W [m].
        com: (6) position [m], then velocity [m/s] of the centre of mass in W.
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the observer of a finalised plant, which it uses for kinematics in a context of its own."""
        super().__init__()
        self._plant = plant
        self._plant_context = plant.CreateDefaultContext()
        self._sole_frames = [plant.GetFrameByName(f"{side}Leg_Sole") for side in SIDES]
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        # Both outputs are asked for together: the body is put into its state once.
        self._motion = self.DeclareCacheEntry(
            "motion",
            ValueProducer(allocate=lambda: Value(object()), calc=self._calc_motion),
            prerequisites_of_calc={self.input_port_ticket(self._state.get_index())},
        )
        needs = {self._motion.ticket()}
        self._soles_output = self.DeclareVectorOutputPort("soles", 6, self._calc_soles, prerequisites_of_calc=needs)
        self._com_output = self.DeclareVectorOutputPort("com", 6, self._calc_com, prerequisites_of_calc=needs)

    def _motion_at(self, state: Array) -> tuple[Array, Array]:
        plant, body = self._plant, self._plant_context
        plant.SetPositionsAndVelocities(body, state)
        soles = [frame.CalcPoseInWorld(body).translation() for frame in self._sole_frames]
        com = (
            plant.CalcCenterOfMassPositionInWorld(body),
            plant.CalcCenterOfMassTranslationalVelocityInWorld(body),
        )
        return np.concatenate(soles), np.concatenate(com)

    def _calc_motion(self, context: Context, motion: Value) -> None:
        motion.set_value(self._motion_at(self._state.Eval(context)))

    def _calc_soles(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._motion.Eval(context)[0])

    def _calc_com(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._motion.Eval(context)[1])
