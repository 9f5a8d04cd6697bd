"""LeafSystem: the soles and the center of mass."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body import SIDES
from humanwalk.body.carried_load import NO_LOAD, CarriedLoad
from humanwalk.body.limbs import LEGS
from humanwalk.numerics import Array
from humanwalk.systems.load_observer import load_at
from humanwalk.systems.signal import Signal, xyz

SOLE_COLUMNS = tuple(column for side in SIDES for column in xyz(f"{side.lower()}_sole.", "m"))
COM_COLUMNS = (*xyz("com.", "m"), *xyz("com.velocity_", "m_s"))


class BodyObserver(LeafSystem):
    """Kinematics of the body from the plant's state.

    Inputs:
        state: plant state [q; v].
        load: (4) load on the chest that the plant lacks, see LoadObserver. Optional; default: none.

    Outputs:
        soles: (6) position of the right, then the left sole frame in W [m].
        com: (6) position [m], then velocity [m/s] of the center of mass in W, of the bodies in the plant and the
            load.
        ankles: (30) of the right, then the left ankle in W: position [m], velocity [m/s], x and z axis of the hindfoot
            and its angular velocity [rad/s].
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Make the observer.

        Args:
            plant: finalized; in a walker its model of its own body, which may lack a load.
        """
        super().__init__()
        self._plant = plant
        self._plant_context = plant.CreateDefaultContext()
        self._carried = CarriedLoad(plant, self._plant_context)
        self._soles = [plant.GetFrameByName(LEGS[side].sole).index() for side in SIDES]
        self._ankles = [plant.GetFrameByName(LEGS[side].hindfoot).index() for side in SIDES]
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._load = self.DeclareVectorInputPort("load", NO_LOAD.size)
        soles = self.DeclareVectorOutputPort("soles", 6, self._calc_soles)
        com = self.DeclareVectorOutputPort("com", 6, self._calc_com)
        self.DeclareVectorOutputPort("ankles", 30, self._calc_ankles)
        self.signals = (Signal("soles", soles, SOLE_COLUMNS), Signal("com", com, COM_COLUMNS))

    def _body_at(self, context: Context) -> Context:
        """The plant's context in the state of the input; its cache serves all outputs of one state."""
        state = self._state.Eval(context)
        if not np.array_equal(state, self._plant.GetPositionsAndVelocities(self._plant_context)):
            self._plant.SetPositionsAndVelocities(self._plant_context, state)
        self._carried.set(load_at(self._load, context))
        return self._plant_context

    def _calc_soles(self, context: Context, output: BasicVector) -> None:
        body = self._body_at(context)
        soles = map(self._plant.get_frame, self._soles)
        output.SetFromVector(np.concatenate([sole.CalcPoseInWorld(body).translation() for sole in soles]))

    def _calc_com(self, context: Context, output: BasicVector) -> None:
        body = self._body_at(context)
        position = self._plant.CalcCenterOfMassPositionInWorld(body)
        velocity = self._plant.CalcCenterOfMassTranslationalVelocityInWorld(body)
        output.SetFromVector(np.concatenate((position, velocity)))

    def _calc_ankles(self, context: Context, output: BasicVector) -> None:
        body = self._body_at(context)
        parts: list[Array] = []
        for ankle in map(self._plant.get_frame, self._ankles):
            X_WF, V_WF = ankle.CalcPoseInWorld(body), ankle.CalcSpatialVelocityInWorld(body)
            parts += (
                X_WF.translation(),
                V_WF.translational(),
                X_WF.rotation().col(0),
                X_WF.rotation().col(2),
                V_WF.rotational(),
            )
        output.SetFromVector(np.concatenate(parts))
