"""LeafSystem: the load that the body feels."""

import math

from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, EventStatus, InputPort, LeafSystem

from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.limbs import CHEST
from humanwalk.contact.ground_force import FootForces
from humanwalk.control.felt_load import LoadFeeling, felt_load, limited, unexplained_wrench
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import yaw_pitch
from humanwalk.systems.signal import Signal, xyz


def load_at(port: InputPort, context: Context) -> Array:
    """The load at an optional input port, shape (4,); none where it is not connected."""
    load: Array = port.Eval(context) if port.HasValue(context) else NO_LOAD
    return load


class LoadObserver(LeafSystem):
    """Feels a load that the model of the body lacks, once per control period.

    What ground and weight do not explain is averaged in axes that turn with the chest about the vertical, so that a
    load keeps its place on the body in a turn.

    Inputs:
        state: plant state [q; v].
        foot_forces: (16) see FootForceObserver.

    Outputs:
        load: (4) mass [kg] and position in the frame of the chest [m] of the load that is felt; 0 without one. State.
    """

    def __init__(self, plant: MultibodyPlant, feeling: LoadFeeling, period: float) -> None:
        """Make the observer.

        Args:
            plant: Finalized model of the body, without the load.
            feeling: How a load is felt.
            period: Control period [s].
        """
        super().__init__()
        self._plant, self._plant_context = plant, plant.CreateDefaultContext()
        self._mass = plant.CalcTotalMass(self._plant_context)
        self._gravity = -float(plant.gravity_field().gravity_vector()[2])
        self._chest = plant.GetFrameByName(CHEST).index()
        self._feeling, self._period = feeling, period
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._momentum, self._wrench, self._load = (self.DeclareDiscreteState(size) for size in (6, 6, 4))
        load = self.DeclareStateOutputPort("load", self._load)
        self.signals = (Signal("felt_load", load, ("felt_load.mass_kg", *xyz("felt_load.", "m"))),)
        self.DeclareInitializationDiscreteUpdateEvent(self._start)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)

    def _start(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        discrete_state.set_value(self._momentum, self._body(context)[1])
        return EventStatus.Succeeded()

    def _update(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        com, momentum = self._body(context)
        X_WC = self._plant.get_frame(self._chest).CalcPoseInWorld(self._plant_context)
        forward = X_WC.rotation().col(0)
        R_WH = yaw_pitch(math.atan2(forward[1], forward[0]), 0.0)

        rate = (momentum - context.get_discrete_state(self._momentum).value()) / self._period
        forces = FootForces.of(self._foot_forces.Eval(context))
        weight = self._mass * self._gravity
        now = limited(unexplained_wrench(rate, forces, com, weight), self._feeling.largest * weight)
        wrench = context.get_discrete_state(self._wrench).value()
        wrench = wrench + self._period / self._feeling.time_constant * ((now.reshape(2, 3) @ R_WH).ravel() - wrench)

        load = felt_load(wrench, self._mass, self._gravity, self._feeling)
        if load[0] > 0.0:
            load[1:] = X_WC.rotation().matrix().T @ (com + R_WH @ load[1:] - X_WC.translation())
        for group, value in ((self._momentum, momentum), (self._wrench, wrench), (self._load, load)):
            discrete_state.set_value(group, value)
        return EventStatus.Succeeded()

    def _body(self, context: Context) -> tuple[Array, Array]:
        """Center of mass in W [m], and the momentum: angular about it [N m s], then linear [N s]."""
        plant, body = self._plant, self._plant_context
        plant.SetPositionsAndVelocities(body, self._state.Eval(context))
        com = plant.CalcCenterOfMassPositionInWorld(body)
        return com, plant.CalcSpatialMomentumInWorldAboutPoint(body, com).get_coeffs()
