"""Indices of the pelvis and of the actuated joints in a plant's state.

Drake orders positions by a depth-first traversal of the tree and actuators by their order in the model file; in this
body the two orders differ from the shoulder girdle on.
"""

from dataclasses import dataclass

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex

from humanwalk.body.limbs import PELVIS
from humanwalk.numerics import Array, Indices, Mask

MAX_PLAY = 0.02
"""Largest range of a locked joint [rad]: about one degree."""

ROUNDING = 1e-9
"""Error of a joint's range [rad] that comes from the ten digits of a model file."""


@dataclass(frozen=True)
class JointMap:
    """Actuated joints of a plant, in actuator order.

    Attributes:
        names: Joint names, n of them.
        q: Indices of the joints in the positions, shape (n,).
        v: Indices of the joints in the velocities, shape (n,).
        num_positions: nq of the plant; a state is [q; v].
        lower: Lower joint limits [rad], shape (n,).
        upper: Upper joint limits [rad], shape (n,).
        effort_limits: Effort limits of the actuators [N m], shape (n,).
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
        """Return the map of a finalized plant with actuated joints of one degree of freedom."""
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

    @property
    def locked(self) -> Mask:
        """Whether each joint has no more than play, so that its structure carries the torque, shape (n,)."""
        return self.upper - self.lower <= MAX_PLAY + ROUNDING

    def positions(self, state: Array) -> Array:
        """Return the joint angles [rad] of plant states [q; v] or positions q, shape (..., n)."""
        return state[..., self.q]

    def velocities(self, state: Array) -> Array:
        """Return the joint velocities [rad/s] of plant states [q; v], shape (..., n)."""
        return state[..., self.num_positions + self.v]


def pelvis_pose(plant: MultibodyPlant) -> slice:
    """Return the place of the floating pelvis in the positions q: quaternion wxyz, then position in W [m]; length 7."""
    start = plant.GetBodyByName(PELVIS).floating_positions_start()
    return slice(start, start + 7)


def pelvis_velocity(plant: MultibodyPlant) -> slice:
    """Return the place of the floating pelvis in the velocities v: angular, then linear, in W; length 6."""
    start = plant.GetBodyByName(PELVIS).floating_velocities_start_in_v()
    return slice(start, start + 6)


def base_first_mass_matrix(plant: MultibodyPlant) -> Array:
    """Return the mass matrix at the default positions, shape (6 + n, 6 + n).

    The floating base comes first, then the joints in actuator order.
    """
    M = plant.CalcMassMatrix(plant.CreateDefaultContext())
    joints = JointMap.of(plant)
    order = np.concatenate((np.setdiff1d(np.arange(M.shape[0]), joints.v), joints.v))
    return np.asarray(M[np.ix_(order, order)])
