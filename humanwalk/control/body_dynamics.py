"""Inertia, Jacobians and bias accelerations of the body at one state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ForceElementIndex, JacobianWrtVariable, MultibodyForces, RevoluteSpring

from humanwalk.body.carried_load import NO_LOAD, CarriedLoad
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import CHEST, LEGS, PELVIS
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix

BY_V = JacobianWrtVariable.kV
ORIGIN = np.zeros(3)


class PointMotion(NamedTuple):
    """A point in W: position (3,) [m], velocity (3,) [m/s], and acceleration = J v' + bias [m/s2]; J is (3, nv)."""

    position: Array
    J: Array
    velocity: Array
    bias: Array


class FrameMotion(NamedTuple):
    """A body frame B: pose, velocity, and acceleration = J v' + bias, all [angular; translational] in W.

    R_WB: (3, 3). p_WB: (3,) [m]. J: (6, nv). V_WB: (6,) [rad/s, m/s]. bias: (6,) [rad/s2, m/s2].
    """

    R_WB: Array
    p_WB: Array
    J: Array
    V_WB: Array
    bias: Array

    def point(self, p_BP: Array) -> PointMotion:
        """A point P fixed to B, from its position in B [m]."""
        r = self.R_WB @ p_BP
        w = cross_matrix(self.V_WB[:3])
        # The velocity of P is v + w x r, and its acceleration in addition has w x (w x r).
        to_P = np.hstack((-cross_matrix(r), np.eye(3)))
        return PointMotion(self.p_WB + r, to_P @ self.J, to_P @ self.V_WB, to_P @ self.bias + w @ (w @ r))


class Dynamics(NamedTuple):
    """The body at one state; M v' + h = tau + J' f, with gravity and damping in h.

    Attributes:
        q, v: positions and velocities of the plant.
        M: mass matrix, (nv, nv).
        h: (nv,) [N m, N]; with the passive springs of the joints.
        com: center of mass.
        bodies: names of pelvis, chest and the bodies of the feet, n of them.
        X_WB: rotation matrix and position of each body frame, (n, 3, 4) [m].
        V_WB: spatial velocity of each in W, (n, 6) [rad/s, m/s]; its derivative is J v' + bias.
        J: (n, 6, nv).
        bias: (n, 6).
    """

    q: Array
    v: Array
    M: Array
    h: Array
    com: PointMotion
    bodies: tuple[str, ...]
    X_WB: Array
    V_WB: Array
    J: Array
    bias: Array

    @property
    def mass(self) -> float:
        """Of the body [kg]: the inertia of its base against a translation."""
        return float(self.M[3, 3])

    def frame(self, body: str) -> FrameMotion:
        """The frame of one body."""
        i = self.bodies.index(body)
        return FrameMotion(self.X_WB[i, :, :3], self.X_WB[i, :, 3], self.J[i], self.V_WB[i], self.bias[i])


class BodyDynamics:
    """Computes `Dynamics` with a plant and a context of its own.

    Args:
        plant: finalized model of the body; its floating base is the pelvis, whose velocities come first.
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        self.plant = plant
        self.joints = JointMap.of(plant)
        self.mass = plant.CalcTotalMass(plant.CreateDefaultContext())
        self._context = plant.CreateDefaultContext()
        self._carried = CarriedLoad(plant, self._context)
        self.bodies = (PELVIS, CHEST, *(body for leg in LEGS.values() for body in leg.foot_bodies))
        bodies = [plant.GetBodyByName(name) for name in self.bodies]
        self._frames = [(body.body_frame().index(), int(body.index())) for body in bodies]
        self._damping = np.zeros(plant.num_velocities())
        for name, place in zip(self.joints.names, self.joints.v, strict=True):
            self._damping[place] = plant.GetJointByName(name).default_damping_vector()[0]
        elements = (plant.get_force_element(ForceElementIndex(i)) for i in range(plant.num_force_elements()))
        springs = [element for element in elements if isinstance(element, RevoluteSpring)]
        self._spring_v = np.array([spring.joint().velocity_start() for spring in springs], dtype=int)
        self._spring_q = np.array([spring.joint().position_start() for spring in springs], dtype=int)
        self._stiffness = np.array([spring.default_stiffness() for spring in springs])
        self._rest_angle = np.array([spring.default_nominal_angle() for spring in springs])
        self._no_acceleration = np.zeros(plant.num_velocities())
        self._upward = self._no_acceleration.copy()
        self._upward[3:6] = -plant.gravity_field().gravity_vector()
        self._no_forces = MultibodyForces(plant)

    def at(self, state: Array, load: Array = NO_LOAD) -> Dynamics:
        """The body at a plant state [q; v], with a load on its chest (see `CarriedLoad`)."""
        self._carried.set(load)
        mass = self.mass + self._carried.mass
        plant, context, world = self.plant, self._context, self.plant.world_frame()
        plant.SetPositionsAndVelocities(context, state)
        q, v = state[: plant.num_positions()], state[plant.num_positions() :]
        n = len(self._frames)
        X_WB, J, bias = np.empty((n, 3, 4)), np.empty((n, 6, v.size)), np.empty((n, 6))
        accelerations = plant.CalcSpatialAccelerationsFromVdot(context, self._no_acceleration)
        for i, (index, body) in enumerate(self._frames):
            frame = plant.get_frame(index)
            X_WB[i] = frame.CalcPoseInWorld(context).GetAsMatrix34()
            J[i] = plant.CalcJacobianSpatialVelocity(context, BY_V, frame, ORIGIN, world, world)
            bias[i] = accelerations[body].get_coeffs()
        M = plant.CalcMassMatrix(context)
        # Inverse dynamics with the base accelerated upward at g: the effect of gravity.
        h = plant.CalcInverseDynamics(context, self._upward, self._no_forces)
        # The translational rows of the floating base are momentum and its rate (the pelvis' velocities are given in W).
        com = PointMotion(
            position=plant.CalcCenterOfMassPositionInWorld(context),
            J=M[3:6] / mass,
            velocity=M[3:6] @ v / mass,
            bias=h[3:6] / mass - self._upward[3:6],
        )
        h = h + self._damping * v
        h[self._spring_v] += self._stiffness * (q[self._spring_q] - self._rest_angle)
        return Dynamics(q, v, M, h, com, self.bodies, X_WB, J @ v, J, bias)
