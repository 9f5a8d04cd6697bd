"""Everything that a whole-body controller needs to know of the body at one state: inertia, Jacobians, biases."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, MultibodyForces

from humanwalk.body import SIDES, Side
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import CHEST, LEGS, PELVIS
from humanwalk.numerics import Array, Indices
from humanwalk.numerics.scalars import clip
from humanwalk.walking.walking_reference import BodyState, FootState

BY_V = JacobianWrtVariable.kV
ORIGIN = np.zeros(3)


@dataclass(frozen=True)
class Directions:
    """Directions d in W, shape (k, 3), and the linear map from an arm r to all moments r x d, shape (3, 3 k)."""

    d_W: Array
    moments: Array

    @staticmethod
    def of(d_W: Array) -> Directions:
        """The directions of the rows of an array."""
        return Directions(d_W, np.hstack([_cross_matrix(d) for d in d_W]))


class FrameMotion(NamedTuple):
    """A body frame B: pose, velocity, and acceleration = J v' + bias, all [angular; translational] in W.

    R_WB: (3, 3). p_WB: (3,) [m]. J: (6, nv). V_WB: (6,) [rad/s, m/s]. bias: (6,) [rad/s2, m/s2].
    """

    R_WB: Array
    p_WB: Array
    J: Array
    V_WB: Array
    bias: Array

    def point(self, p_BoP_B: Array) -> tuple[Array, Array, Array, Array]:
        """A point P fixed to B: position (3,), Jacobian (3, nv), velocity (3,), bias of the acceleration (3,)."""
        r = self.R_WB.dot(p_BoP_B)
        w = _cross_matrix(self.V_WB[:3])
        # What an angular and a translational vector of B are at P: v + w x r.
        to_P = np.hstack((-_cross_matrix(r), np.eye(3)))
        return self.p_WB + r, to_P.dot(self.J), to_P.dot(self.V_WB), to_P.dot(self.bias) + w.dot(w.dot(r))


@dataclass(frozen=True)
class Dynamics:
    """The body at one state; M v' + h = tau + J' f, with gravity and damping in h.

    The motions of some bodies' frames and of the centre of mass are told in rows, all in W: of each body its angular
    and its translational velocity, in the order of `bodies`, then the velocity of the centre of mass.

    q, v: positions and velocities. M: (nv, nv). h: (nv,) [N m, N].
    com: centre of mass (3,) [m].
    bodies: names of pelvis, ribs and the bodies of the feet. X_WB: rotation matrix and position of each, (n, 3, 4) [m].
    velocity: (6 n + 3,) = J v [rad/s, m/s]; its derivative is J v' + bias. J: (6 n + 3, nv). bias: (6 n + 3,).
    """

    q: Array
    v: Array
    M: Array
    h: Array
    com: Array
    bodies: tuple[str, ...]
    X_WB: Array
    velocity: Array
    J: Array
    bias: Array

    def frame(self, body: str) -> FrameMotion:
        """One body's frame."""
        i = self.bodies.index(body)
        X_WB, rows = self.X_WB[i], slice(6 * i, 6 * i + 6)
        return FrameMotion(X_WB[:, :3], X_WB[:, 3], self.J[rows], self.velocity[rows], self.bias[rows])

    @property
    def com_J(self) -> Array:
        """Jacobian of the centre of mass (3, nv)."""
        return self.J[-3:]

    @property
    def com_bias(self) -> Array:
        """Acceleration of the centre of mass where v' = 0, (3,) [m/s2]."""
        return self.bias[-3:]

    def along(self, which: Indices, p_BoP_W: Array, directions: Directions) -> Array:
        """Jacobian of the velocities of points along directions; shape (points x directions, nv).

        Args:
            which: place of each point's body, (k,).
            p_BoP_W: from the body's origin to the point, in W, shape (k, 3) [m].
            directions: the same at every point.
        """
        k, d = len(which), len(directions.d_W)
        # Of every point and direction the moment and the direction, which a product takes to the joints.
        wrenches = np.empty((k, d, 6))
        wrenches[..., :3] = p_BoP_W.dot(directions.moments).reshape(k, d, 3)
        wrenches[..., 3:] = directions.d_W
        J = self.J[:-3].reshape(len(self.bodies), 6, -1)
        along: Array = np.matmul(wrenches, J.take(which, axis=0)).reshape(k * d, self.v.size)
        return along


class BodyDynamics:
    """Computes `Dynamics` with a plant and a context of its own.

    Args:
        plant: finalised model of the body whose floating base is `Pelvis`, its velocities the first.
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        self.plant = plant
        self.joints = JointMap.of(plant)
        self.mass = plant.CalcTotalMass(plant.CreateDefaultContext())
        self._context = plant.CreateDefaultContext()
        self._world = plant.world_frame()
        self.bodies = (PELVIS, CHEST, *(body for leg in LEGS.values() for body in leg.foot_bodies))
        bodies = [plant.GetBodyByName(name) for name in self.bodies]
        self._frames = [(body.body_frame(), int(body.index())) for body in bodies]
        self._ankles = {side: plant.GetFrameByName(f"{side}Leg_Ankle") for side in SIDES}
        self._damping = np.zeros(plant.num_velocities())
        for name, place in zip(self.joints.names, self.joints.v, strict=True):
            self._damping[place] = plant.GetJointByName(name).default_damping_vector()[0]
        self._no_acceleration = np.zeros(plant.num_velocities())
        self._upward = self._no_acceleration.copy()
        self._upward[3:6] = -plant.gravity_field().gravity_vector()
        self._no_forces = MultibodyForces(plant)

    def at(self, state: Array) -> Dynamics:
        """The body at a plant state [q; v]."""
        plant, context, world = self.plant, self._context, self._world
        plant.SetPositionsAndVelocities(context, state)
        q, v = state[: plant.num_positions()], state[plant.num_positions() :]
        n = len(self._frames)
        X_WB, J, bias = np.empty((n, 3, 4)), np.empty((6 * n + 3, v.size)), np.empty(6 * n + 3)
        accelerations = plant.CalcSpatialAccelerationsFromVdot(context, self._no_acceleration)
        for i, (frame, body) in enumerate(self._frames):
            rows = slice(6 * i, 6 * i + 6)
            X_WB[i] = frame.CalcPoseInWorld(context).GetAsMatrix34()
            J[rows] = plant.CalcJacobianSpatialVelocity(context, BY_V, frame, ORIGIN, world, world)
            bias[rows] = accelerations[body].get_coeffs()
        M = plant.CalcMassMatrix(context)
        # To a body that is accelerated upward at rest, inertia is what gravity is to one that is not.
        h = plant.CalcInverseDynamics(context, self._upward, self._no_forces)
        # Translational rows of a floating base: momentum and its rate (the pelvis' velocities are given in W).
        np.divide(M[3:6], self.mass, out=J[-3:])
        bias[-3:] = h[3:6] / self.mass - self._upward[3:6]
        com = plant.CalcCenterOfMassPositionInWorld(context)
        return Dynamics(q, v, M, h + self._damping * v, com, self.bodies, X_WB, J.dot(v), J, bias)

    def body_state(self, state: Array, time: float, foot_forces: Mapping[Side, float]) -> BodyState:
        """What the step planner wants to know, from a plant state [q; v] and the feet's vertical forces [N]."""
        plant, context = self.plant, self._context
        plant.SetPositionsAndVelocities(context, state)
        x, y, z = plant.CalcCenterOfMassPositionInWorld(context).tolist()
        vx, vy, _ = plant.CalcCenterOfMassTranslationalVelocityInWorld(context).tolist()
        right, left = (self._foot_state(side, foot_forces[side]) for side in SIDES)
        return BodyState(time, complex(x, y), complex(vx, vy), z, right, left)

    def _foot_state(self, side: Side, force: float) -> FootState:
        ankle = self._ankles[side]
        (xx, _, _, px), (xy, _, _, py), (xz, _, _, pz) = ankle.CalcPoseInWorld(self._context).GetAsMatrix34().tolist()
        wx, wy, _, vx, vy, vz = ankle.CalcSpatialVelocityInWorld(self._context).get_coeffs().tolist()
        yaw = math.atan2(xy, xx)
        return FootState(
            position=complex(px, py),
            velocity=complex(vx, vy),
            height=pz,
            height_rate=vz,
            yaw=yaw,
            pitch=math.asin(clip(-xz, -1.0, 1.0)),
            pitch_rate=math.cos(yaw) * wy - math.sin(yaw) * wx,
            force=force,
        )


def _cross_matrix(a: Array) -> Array:
    x, y, z = a.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
