"""Everything that a whole-body controller needs to know of the body at one state: inertia, Jacobians, biases."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable

from humanwalk.body import SIDES, Side
from humanwalk.body.groups import FOOT_BODIES
from humanwalk.control.joint_map import JointMap
from humanwalk.control.walking_reference import BodyState, FootState

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Directions:
    """Directions d in W, shape (k, 3), and the linear map from an arm r to all moments r x d, shape (3, 3 k)."""

    d_W: Array
    moments: Array

    @staticmethod
    def of(d_W: Array) -> Directions:
        """The directions of the rows of an array."""
        return Directions(d_W, np.hstack([_cross_matrix(d) for d in d_W]))


@dataclass(frozen=True)
class FrameMotion:
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
        r = self.R_WB @ p_BoP_B
        w = self.V_WB[:3]
        cross = _cross_matrix(r)
        J = self.J[3:] - cross @ self.J[:3]
        velocity = self.V_WB[3:] - cross @ w
        bias = self.bias[3:] - cross @ self.bias[:3] + _cross_matrix(w) @ _cross_matrix(w) @ r
        return self.p_WB + r, J, velocity, bias

    def along(self, points: Array, directions: Directions) -> Array:
        """Jacobian of the velocities of points along directions; shape (points x directions, nv).

        Args:
            points: fixed to B, in B, shape (k, 3) [m].
            directions: the same at every point.
        """
        # Of every point and direction the moment and the direction, which one product takes to the joints.
        wrenches = np.empty((len(points), len(directions.d_W), 6))
        wrenches[..., :3] = ((points @ self.R_WB.T) @ directions.moments).reshape(len(points), -1, 3)
        wrenches[..., 3:] = directions.d_W
        along: Array = wrenches.reshape(-1, 6) @ self.J
        return along


@dataclass(frozen=True)
class Dynamics:
    """The body at one state; M v' + h = tau + J' f, with gravity and damping in h.

    q, v: positions and velocities. M: (nv, nv). h: (nv,) [N m, N].
    com, com_velocity: of the centre of mass in W, (3,) [m, m/s]; its acceleration is com_J v' + com_bias.
    frames: by body name.
    """

    q: Array
    v: Array
    M: Array
    h: Array
    com: Array
    com_velocity: Array
    com_J: Array
    com_bias: Array
    frames: dict[str, FrameMotion]


class BodyDynamics:
    """Computes `Dynamics` with a plant and a context of its own.

    Args:
        plant: finalised model of the body whose floating base is `Pelvis`.
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        self.plant = plant
        self.joints = JointMap.of(plant)
        self.mass = plant.CalcTotalMass(plant.CreateDefaultContext())
        self._context = plant.CreateDefaultContext()
        self._world = plant.world_frame()
        names = ("Pelvis", "Ribs", *FOOT_BODIES["Right"], *FOOT_BODIES["Left"])
        self._frames = {name: plant.GetFrameByName(name) for name in names}
        self._damping = np.zeros(plant.num_velocities())
        for name, place in zip(self.joints.names, self.joints.v, strict=True):
            self._damping[place] = plant.GetJointByName(name).default_damping_vector()[0]

    def at(self, state: Array, frames: Sequence[str]) -> Dynamics:
        """The body at a plant state [q; v], with the frames of the bodies that are named."""
        plant, context = self.plant, self._context
        plant.SetPositionsAndVelocities(context, state)
        v = state[plant.num_positions() :]
        M = plant.CalcMassMatrix(context)
        coriolis = plant.CalcBiasTerm(context)
        # Translational rows of a floating base: momentum and its rate (the pelvis' velocities are given in W).
        return Dynamics(
            q=state[: plant.num_positions()],
            v=v,
            M=M,
            h=coriolis - plant.CalcGravityGeneralizedForces(context) + self._damping * v,
            com=plant.CalcCenterOfMassPositionInWorld(context),
            com_velocity=M[3:6] @ v / self.mass,
            com_J=M[3:6] / self.mass,
            com_bias=coriolis[3:6] / self.mass,
            frames={name: self._frame(name, v) for name in frames},
        )

    def _frame(self, name: str, v: Array) -> FrameMotion:
        plant, context, frame = self.plant, self._context, self._frames[name]
        X_WB = frame.CalcPoseInWorld(context).GetAsMatrix34()
        of_origin = (context, JacobianWrtVariable.kV, frame, np.zeros(3), self._world, self._world)
        J = plant.CalcJacobianSpatialVelocity(*of_origin)
        bias = plant.CalcBiasSpatialAcceleration(*of_origin)
        return FrameMotion(X_WB[:, :3], X_WB[:, 3], J, J @ v, bias.get_coeffs())

    def body_state(self, state: Array, time: float, foot_forces: dict[Side, float]) -> BodyState:
        """What the step planner wants to know, from a plant state [q; v] and the feet's vertical forces [N]."""
        plant, context = self.plant, self._context
        plant.SetPositionsAndVelocities(context, state)
        com = plant.CalcCenterOfMassPositionInWorld(context)
        velocity = plant.CalcCenterOfMassTranslationalVelocityInWorld(context)
        right, left = (self._foot_state(side, foot_forces[side]) for side in SIDES)
        return BodyState(time, complex(com[0], com[1]), complex(velocity[0], velocity[1]), com[2], right, left)

    def _foot_state(self, side: Side, force: float) -> FootState:
        frame = self._frames[f"{side}Leg_Ankle"]
        X_WB = frame.CalcPoseInWorld(self._context).GetAsMatrix34()
        V_WB = frame.CalcSpatialVelocityInWorld(self._context).get_coeffs()
        R, p, w, v = X_WB[:, :3], X_WB[:, 3], V_WB[:3], V_WB[3:]
        yaw = math.atan2(R[1, 0], R[0, 0])
        return FootState(
            position=complex(p[0], p[1]),
            velocity=complex(v[0], v[1]),
            height=float(p[2]),
            height_rate=float(v[2]),
            yaw=yaw,
            pitch=math.asin(max(min(-R[2, 0], 1.0), -1.0)),
            pitch_rate=float(-math.sin(yaw) * w[0] + math.cos(yaw) * w[1]),
            force=force,
        )


def _cross_matrix(a: Array) -> Array:
    return np.array(((0.0, -a[2], a[1]), (a[2], 0.0, -a[0]), (-a[1], a[0], 0.0)))
