"""Where each actuated joint stands in a plant's state.

Drake orders positions by a depth-first walk of the tree, actuators by their order in the model file: for this
body the two differ from the shoulder girdle on.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex
from pydrake.systems.framework import Context

from humanwalk.numerics import Array, Indices


@dataclass(frozen=True)
class JointMap:
    """Actuated joints of a plant, in actuator order.

    Attributes:
        names: joint names, n of them.
        q, v: places of the joints in the positions and in the velocities, shape (n,).
        num_positions: nq of the plant; a state is [q; v].
        lower, upper: joint ranges [rad], shape (n,).
        effort_limits: [N m], shape (n,).
    """

    names: tuple[str, ...]
    q: Indices
    v: Indices
    num_positions: int
    lower: Array
    upper: Array
    effort_limits: Array

    @staticmethod
    def of(plant: MultibodyPlant) -> "JointMap":
        """The map of a finalised plant with one-degree-of-freedom actuated joints."""
        actuators = [plant.get_joint_actuator(JointActuatorIndex(i)) for i in range(plant.num_actuators())]
        joints = [actuator.joint() for actuator in actuators]
        return JointMap(
            names=tuple(joint.name() for joint in joints),
            q=np.array([joint.position_start() for joint in joints]),
            v=np.array([joint.velocity_start() for joint in joints]),
            num_positions=plant.num_positions(),
            lower=np.array([joint.position_lower_limits()[0] for joint in joints]),
            upper=np.array([joint.position_upper_limits()[0] for joint in joints]),
            effort_limits=np.array([actuator.effort_limit() for actuator in actuators]),
        )

    @cached_property
    def _places_of_v(self) -> Indices:
        return self.num_positions + self.v

    def positions(self, state: Array) -> Array:
        """Joint angles [rad] out of a plant state [q; v] or out of q alone, shape (n,), or of many, (..., n)."""
        # A quarter of the time of an index with an ellipsis; the actuators ask in every step.
        angles: Array = state.take(self.q, axis=-1)
        return angles

    def velocities(self, state: Array) -> Array:
        """Joint velocities [rad/s] out of a plant state [q; v], shape (n,), or of many, (..., n)."""
        rates: Array = state.take(self._places_of_v, axis=-1)
        return rates


def base_first_mass_matrix(plant: MultibodyPlant, context: Context) -> Array:
    """Mass matrix with the floating base's rows first, then the joints in actuator order; shape (6 + n, 6 + n)."""
    M = plant.CalcMassMatrix(context)
    joints = JointMap.of(plant)
    order = np.concatenate((np.setdiff1d(np.arange(M.shape[0]), joints.v), joints.v))
    return np.asarray(M[np.ix_(order, order)])
