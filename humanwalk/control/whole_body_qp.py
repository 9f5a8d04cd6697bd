"""Joint torques by a quadratic program: the accelerations that serve all tasks best and that the ground permits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import daqp
import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dpotrf, dtrtri

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import ContactSphere
from humanwalk.control.body_dynamics import BodyDynamics, Directions, Dynamics, FrameMotion
from humanwalk.control.walking_reference import FootReference, FootTask, WalkingReference, com_acceleration
from humanwalk.quantity import quantity

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int_]

EQUATION = 5
"""DAQP's word for a constraint that is an equation."""
MOST_ITERATIONS = 500
"""Changes of the active set; a walk's programs take 8 on average, 50 at most."""


@dataclass(frozen=True)
class TaskGains:
    """Acceleration that a task asks for per error, and how much it counts against the others."""

    stiffness: float = quantity(100.0, "1/s2", 0.0, 1e4)
    """Acceleration per error of the position."""

    damping: float = quantity(20.0, "1/s", 0.0, 500.0)
    """Acceleration per error of the velocity."""

    weight: float = quantity(1.0, "", 0.0, 1e5)
    """Cost per squared error of the acceleration."""


@dataclass(frozen=True)
class PrescribedGains:
    """Acceleration that joints have per error of their posture, exactly: there is nothing to weigh it against."""

    stiffness: float = quantity(60.0, "1/s2", 0.0, 1e4)
    """Acceleration per error of the angle."""

    damping: float = quantity(15.5, "1/s", 0.0, 500.0)
    """Acceleration per error of the rate."""


def critical(stiffness: float, weight: float) -> TaskGains:
    """Gains of a critically damped task."""
    return TaskGains(stiffness, 2.0 * math.sqrt(stiffness), weight)


@dataclass(frozen=True)
class WholeBodyParameters:
    """Tasks and limits of the whole-body controller."""

    com_weight: float = quantity(300.0, "", 0.0, 1e5)
    """Weight of the centre of mass over ground; its acceleration follows from the zero-moment point alone. A foot that
    swings in a hurry asks for 60 m/s2, the centre of mass for 3: it must not be drawn along."""

    com_height: TaskGains = critical(100.0, 50.0)
    """Height of the centre of mass."""

    stance: TaskGains = TaskGains(0.0, 50.0, 1000.0)
    """Feet on the ground do not move."""

    sinking_speed: float = quantity(0.5, "m/s", 0.0, 2.0)
    """A foot that should stand and is still in the air goes down this fast."""

    heel_strike: TaskGains = critical(600.0, 1000.0)
    """Rotation of a foot that landed on its heel."""

    heel_off: TaskGains = critical(400.0, 40.0)
    """Pitch of a foot whose heel rises."""

    swing_position: TaskGains = critical(300.0, 50.0)
    """Position of the swinging foot's ankle."""

    swing_rotation: TaskGains = critical(400.0, 20.0)
    """Rotation of the swinging foot."""

    swing_acceleration_limit: float = quantity(60.0, "m/s2", 10.0, 1000.0)
    """Greatest level acceleration that is asked of a swinging foot: a foothold that jumps must not upset the body."""

    pelvis: TaskGains = critical(200.0, 5.0)
    """Rotation of the pelvis."""

    chest: TaskGains = critical(150.0, 5.0)
    """Rotation of the ribs."""

    spine: TaskGains = critical(100.0, 0.3)
    """Posture of the back."""

    feet: TaskGains = critical(400.0, 30.0)
    """Posture of ankle twist, mid-foot and toes."""

    legs: TaskGains = TaskGains(0.0, 0.0, 0.001)
    """Posture of hips, knees and ankles; only makes the solution unique."""

    arms: PrescribedGains = PrescribedGains()
    """Posture of arms, shoulder girdle, neck and head."""

    effort: float = quantity(1e-4, "", 0.0, 1.0)
    """Cost per squared joint acceleration."""

    force: float = quantity(1e-6, "1/N2", 1e-12, 1.0)
    """Cost per squared contact force."""

    friction: float = quantity(0.55, "", 0.1, 1.0)
    """Coefficient that the contact forces keep within; the ground gives 0.7."""

    largest_force: float = quantity(1500.0, "N", 100.0, 1e4)
    """Bound of a contact force along each edge of its friction pyramid."""

    contact_height: float = quantity(0.008, "m", 0.001, 0.05)
    """A point of the sole that is higher than this presses on nothing."""

    range_stiffness: float = quantity(900.0, "1/s2", 0.0, 1e4)
    """Bound of a joint's acceleration towards the end of its range, per distance from it."""

    range_damping: float = quantity(60.0, "1/s", 0.0, 500.0)
    """And per velocity."""

    knee_margin: float = quantity(0.05, "rad", 0.0, 0.5)
    """The knee's range ends this much before it is straight, where a leg cannot be shortened."""

    hold: float = quantity(0.02, "s", 0.0, 0.2)
    """The last torques are held this long when the program has no solution; then joints are only damped."""


class QuadraticProgram(NamedTuple):
    """min a'Ha/2 + g'a + f'f/2 subject to lower <= (f, a, A a + B f) <= upper; where both are equal it is an equation.

    H: (m, m). g: (m,). A: (rows, m). B: (rows, k). lower, upper: (k + m + rows,).
    """

    H: Array
    g: Array
    A: Array
    B: Array
    lower: Array
    upper: Array

    def solution(self) -> tuple[Array, Array] | None:
        """The least a and f, or None where the solver finds none.

        The same program has the same solution to the last bit.
        """
        # DAQP inverts H in plain loops, which would take longer than all the rest. With H = U'U and y = U a the cost is
        # y'y/2 and linear terms; the bounds of a become rows, those of f stay simple ones, of the first variables.
        U, undefined = dpotrf(self.H.T, clean=1)
        if undefined:
            return None
        to_a, _ = dtrtri(U, overwrite_c=1)
        (rows, m), k = self.A.shape, self.B.shape[1]
        constraints, cost = np.zeros((m + rows, k + m)), np.zeros(k + m)
        constraints[:m, k:] = to_a
        constraints[m:, :k] = self.B
        np.matmul(self.A, to_a, out=constraints[m:, k:])
        np.matmul(self.g, to_a, out=cost[k:])
        # DAQP passes over a constraint that is not a number.
        if not math.isfinite(np.vdot(constraints, constraints) + cost @ cost + self.lower @ self.upper):
            return None
        kind = np.multiply(self.lower == self.upper, EQUATION, dtype=np.int32)
        identity = _identity(k + m)
        x, _, flag, _ = daqp.solve(identity, cost, constraints, self.upper, self.lower, kind, iter_limit=MOST_ITERATIONS)
        return (to_a @ x[k:], x[:k]) if flag > 0 else None


@cache
def _identity(size: int) -> Array:
    return np.eye(size)


@dataclass(frozen=True)
class Soles:
    """The contact points under the bodies of both feet, k of them.

    body: place of each point's body among the frames of `Dynamics`, (k,). point: in that body's frame, (k, 3, 1) [m].
    is_right, is_heel: whether it is under the right foot, under a hind-foot, (k,).
    """

    body: Indices
    point: Array
    is_right: npt.NDArray[np.bool_]
    is_heel: npt.NDArray[np.bool_]

    @staticmethod
    def of(spheres: Sequence[ContactSphere], bodies: Sequence[str]) -> Soles:
        """The lowest points of the spheres, in their order, when the feet stand flat."""
        return Soles(
            np.array([bodies.index(sphere.body) for sphere in spheres]),
            np.array([(*sphere.center[:2], sphere.center[2] - sphere.radius) for sphere in spheres])[:, :, None],
            np.array([sphere.body.startswith("Right") for sphere in spheres]),
            np.array([sphere.body.endswith("Ankle") for sphere in spheres]),
        )

    def heel(self, side: Side) -> Array:
        """The middle of the points under a foot's hind-foot, in its frame (3,) [m]."""
        middle: Array = self.point[self.is_heel & (self.is_right == (side == "Right")), :, 0].mean(axis=0)
        return middle


@dataclass(frozen=True)
class WholeBodySolution:
    """What the program found.

    acceleration: v' of all nv velocities.
    forces: (points, 3) in W, in the order of the spheres [N].
    torque: of all joints, in the order of the velocities from the seventh on [N m].
    """

    acceleration: Array
    forces: Array
    torque: Array


@dataclass(frozen=True)
class Posture:
    """Angles and rates that joints should have, in the order of the velocities from the seventh on [rad, rad/s]."""

    angle: Array
    rate: Array


class WholeBodyQp:
    """Builds and solves the program; keeps nothing from one call to the next.

    Args:
        dynamics: of the body. Its prescribed joints (arms, neck and head) come last.
        spheres: contact points of the soles.
        parameters: tasks and limits.
    """

    def __init__(
        self, dynamics: BodyDynamics, spheres: Sequence[ContactSphere], parameters: WholeBodyParameters
    ) -> None:
        self.parameters = parameters
        joints = dynamics.joints
        order = np.argsort(joints.v)
        self.names = tuple(joints.names[i] for i in order)
        self._q = joints.q[order]
        self.lower, self.upper = joints.lower[order].copy(), joints.upper[order].copy()
        self.limits = joints.effort_limits[order]
        gains = [self._posture_gains(name) for name in self.names]
        self._posture = tuple(np.array([getattr(g, f, 0.0) for g in gains]) for f in ("stiffness", "damping", "weight"))
        is_free = [g is not parameters.arms for g in gains]
        self._free = 6 + sum(is_free)
        """Number of velocities whose accelerations are unknown: the first ones."""
        assert all(is_free[: self._free - 6]), "the model file has a prescribed joint before a free one"
        for i, name in enumerate(self.names):
            if "LegTibia" in name:
                self.lower[i] += parameters.knee_margin
        self._soles = Soles.of(spheres, dynamics.bodies)
        self._heel = {side: self._soles.heel(side) for side in SIDES}
        mu, self._unit = parameters.friction, parameters.force**-0.5
        """Forces are counted in the unit whose square costs 1/2 [N]."""
        edges = np.array(((mu, 0, 1), (-mu, 0, 1), (0, mu, 1), (0, -mu, 1)), dtype=float)
        self._edges = Directions.of(self._unit * edges)
        free_joints = self._free - 6
        self._diagonal = parameters.effort + np.concatenate((np.zeros(6), self._posture[2][:free_joints]))
        self._torque_limits = np.concatenate((np.zeros(6), self.limits[:free_joints]))

    def _posture_gains(self, name: str) -> TaskGains | PrescribedGains:
        p = self.parameters
        if is_foot_posture(name):
            return p.feet
        if "Leg" in name:
            return p.legs
        if name.startswith(("Lumbar", "Thoracic")):
            return p.spine
        return p.arms

    def solve(self, body: Dynamics, reference: WalkingReference, posture: Posture) -> WholeBodySolution | None:
        """The solution, or None where the solver finds none."""
        program, qdd, points = self.program(body, reference, posture)
        solution = program.solution()
        if solution is None:
            return None
        m = self._free
        qdd[:m], edge_forces = solution[0], np.maximum(solution[1], 0.0)
        torque = body.M @ qdd + body.h
        # Program B is -J' of the edges; the prescribed joints carry no foot.
        torque[:m] += program.B @ edge_forces
        forces = np.zeros((self._soles.body.size, 3))
        forces[points] = edge_forces.reshape(-1, 4) @ self._edges.d_W
        return WholeBodySolution(qdd, forces, np.minimum(np.maximum(torque[6:], -self.limits), self.limits))

    def program(
        self, body: Dynamics, reference: WalkingReference, posture: Posture
    ) -> tuple[QuadraticProgram, Array, Indices]:
        """The program, whose unknowns are the accelerations of base, legs and back and the forces along the edges.

        Returns:
            the program; the accelerations of all velocities, of which only those prescribed are not 0 (nv,); the places
            of the points that may press, four edges each.
        """
        p, m = self.parameters, self._free
        q, v = body.q[self._q], body.v[6:]
        stiffness, damping, weight = self._posture
        wanted = stiffness * (posture.angle - q) + damping * (posture.rate - v)
        qdd0 = np.zeros(body.v.size)
        qdd0[m:] = wanted[m - 6 :]

        J, a, w = self._tasks(body, reference)
        a -= J @ qdd0
        J = J[:, :m]
        WJ = w[:, None] * J
        H = J.T @ WJ
        H.flat[:: m + 1] += self._diagonal
        g = -(a @ WJ)
        g[6:] -= (weight * wanted)[: m - 6]

        # The equations of motion M v' + h - J' f = tau: of the base, whose tau is 0, and of the joints.
        points, J_edges, most = self._contacts(body, reference)
        k = most.size
        rest = (body.h + body.M @ qdd0)[:m]
        lower, upper = np.full(k + 2 * m, -1e4), np.full(k + 2 * m, 1e4)
        lower[:k], upper[:k] = 0.0, most
        slowing = p.range_damping * v
        towards_lower = p.range_stiffness * (self.lower - q) - slowing
        towards_upper = p.range_stiffness * (self.upper - q) - slowing
        lower[k + 6 : k + m] = np.minimum(np.maximum(towards_lower, -1e4), 1e3)[: m - 6]
        upper[k + 6 : k + m] = np.minimum(np.maximum(towards_upper, -1e3), 1e4)[: m - 6]
        lower[k + m :], upper[k + m :] = -self._torque_limits - rest, self._torque_limits - rest
        return QuadraticProgram(H, g, body.M[:m, :m], -J_edges[:, :m].T, lower, upper), qdd0, points

    # Tasks: rows of J v' = a with weight w.

    def _tasks(self, body: Dynamics, reference: WalkingReference) -> tuple[Array, Array, Array]:
        p, tasks = self.parameters, _Tasks()
        x, y, z = body.com.tolist()
        height, rate, lift = reference.com_height
        over_ground = com_acceleration(complex(x, y), reference.zmp, z, lift)
        gains = p.com_height
        up = lift + gains.stiffness * (height - z) + gains.damping * (rate - float(body.com_velocity[2]))
        tasks.add(body.com_J[:2], body.com_bias[:2], (over_ground.real, over_ground.imag), p.com_weight)
        tasks.add(body.com_J[2:], body.com_bias[2:], (up,), gains.weight)
        for name, yaw, gains in (("Pelvis", reference.pelvis_yaw, p.pelvis), ("Ribs", reference.chest_yaw, p.chest)):
            tasks.turn(body.frames[name], yaw, gains)
        for side in SIDES:
            foot = reference.foot(side)
            ankle = body.frames[f"{side}Leg_Ankle"]
            if foot.task is FootTask.SWING:
                self._swing(tasks, foot, ankle)
            elif foot.task is FootTask.HEEL_OFF:
                toes = body.frames[f"{side}Leg_FootToes"]
                tasks.add(toes.J, toes.bias, (-p.stance.damping * toes.V_WB).tolist(), p.stance.weight)
                sine, cosine = math.sin(foot.yaw), math.cos(foot.yaw)
                angle, rate, acceleration = foot.pitch
                ex, ey, _ = _rotation_error(foot.yaw, angle, ankle.R_WB)
                wx, wy, *_ = ankle.V_WB.tolist()
                error, error_rate = cosine * ey - sine * ex, rate - (cosine * wy - sine * wx)
                wanted = acceleration + p.heel_off.stiffness * error + p.heel_off.damping * error_rate
                axis = np.array(((-sine, cosine),))
                tasks.add(axis @ ankle.J[:2], axis @ ankle.bias[:2], (wanted,), p.heel_off.weight)
            elif foot.task is FootTask.HEEL_STRIKE:
                heel, J, velocity, bias = ankle.point(self._heel[side])
                vx, vy, vz = velocity.tolist()
                wanted_heel = (-vx, -vy, self._sinking(heel[2]) - vz)
                tasks.add(J, bias, [p.stance.damping * u for u in wanted_heel], p.stance.weight)
                tasks.turn(ankle, foot.yaw, p.heel_strike)
            else:
                heel_height = float(ankle.p_WB[2] + ankle.R_WB[2] @ self._heel[side])
                wx, wy, wz, vx, vy, vz = ankle.V_WB.tolist()
                wanted_foot = (-wx, -wy, -wz, -vx, -vy, self._sinking(heel_height) - vz)
                tasks.add(ankle.J, ankle.bias, [p.stance.damping * u for u in wanted_foot], p.stance.weight)
        return tasks.rows()

    def _sinking(self, height: float) -> float:
        """Upward speed of a foot that should stand: none, or down where it has not reached the ground yet."""
        return -self.parameters.sinking_speed if height > self.parameters.contact_height else 0.0

    def _swing(self, tasks: _Tasks, foot: FootReference, ankle: FrameMotion) -> None:
        p, gains = self.parameters, self.parameters.swing_position
        way, (height, rate, lift) = foot.position, foot.height
        x, y, z = ankle.p_WB.tolist()
        vx, vy, vz = ankle.V_WB[3:].tolist()
        over_ground = way.acceleration + gains.stiffness * (way.position - complex(x, y))
        over_ground += gains.damping * (way.velocity - complex(vx, vy))
        if abs(over_ground) > p.swing_acceleration_limit:
            over_ground *= p.swing_acceleration_limit / abs(over_ground)
        up = lift + gains.stiffness * (height - z) + gains.damping * (rate - vz)
        tasks.add(ankle.J[3:], ankle.bias[3:], (over_ground.real, over_ground.imag, up), gains.weight)
        tasks.turn(ankle, foot.yaw, p.swing_rotation, *foot.pitch)

    def _contacts(self, body: Dynamics, reference: WalkingReference) -> tuple[Indices, Array, Array]:
        """Places of the points that may press (k,), Jacobian of their edges (4 k, nv), the bound of the edges' forces."""
        p, soles = self.parameters, self._soles
        right, left = reference.right, reference.left
        load = np.where(soles.is_right, right.load, left.load)
        for foot, is_its in ((right, soles.is_right), (left, ~soles.is_right)):
            if foot.task is FootTask.HEEL_OFF:
                load[is_its & soles.is_heel] = 0.0
        X_WB = body.frames.X_WB[soles.body]
        p_BoP_W = (X_WB[:, :, :3] @ soles.point)[:, :, 0]
        is_low = X_WB[:, 2, 3] + p_BoP_W[:, 2] < p.contact_height
        points = np.flatnonzero(is_low & (load > 0.0))
        along = body.frames.along(soles.body[points], p_BoP_W[points], self._edges)
        return points, along.reshape(4 * points.size, body.v.size), np.repeat(p.largest_force / self._unit * load[points], 4)


@dataclass(frozen=True)
class _Tasks:
    """Rows that are gathered one task after the other."""

    J: list[Array] = field(default_factory=list)
    bias: list[Array] = field(default_factory=list)
    wanted: list[float] = field(default_factory=list)
    weight: list[float] = field(default_factory=list)

    def add(self, J: Array, bias: Array, acceleration: Sequence[float], weight: float) -> None:
        """J v' + bias should be this acceleration."""
        self.J.append(J)
        self.bias.append(bias)
        self.wanted.extend(acceleration)
        self.weight.extend([weight] * len(acceleration))

    def turn(
        self,
        frame: FrameMotion,
        yaw: float,
        gains: TaskGains,
        pitch: float = 0.0,
        pitch_rate: float = 0.0,
        pitch_acceleration: float = 0.0,
    ) -> None:
        """A frame should be turned by a yaw that stays and a pitch that changes."""
        axis = (-math.sin(yaw), math.cos(yaw), 0.0)
        error, velocity = _rotation_error(yaw, pitch, frame.R_WB), frame.V_WB[:3].tolist()
        wanted = [
            pitch_acceleration * n + gains.stiffness * e + gains.damping * (pitch_rate * n - w)
            for n, e, w in zip(axis, error, velocity, strict=True)
        ]
        self.add(frame.J[:3], frame.bias[:3], wanted, gains.weight)

    def rows(self) -> tuple[Array, Array, Array]:
        """All rows: J, what J v' should be, weight."""
        wanted: Array = np.array(self.wanted) - np.concatenate(self.bias)
        return np.concatenate(self.J), wanted, np.array(self.weight)


def is_foot_posture(joint_name: str) -> bool:
    """Whether a joint is one of those of the foot that keep a posture: ankle twist, mid-foot and toes."""
    return any(word in joint_name for word in ("AnkleTwist", "FootMiddle", "FootToes"))


Vector = tuple[float, float, float]


def _rotation_error(yaw: float, pitch: float, R_WB: Array) -> Vector:
    """Rotation vector in W that turns R_WB into Rz(yaw) Ry(pitch); exact up to a right angle, then bounded."""
    c, s, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    wanted = ((c * cp, s * cp, -sp), (-s, c, 0.0), (c * sp, s * sp, cp))
    # The sum of the cross products of actual and wanted axes is twice sine times axis, that of the dot products the trace.
    x = y = z = trace = 0.0
    for (ax, ay, az), (wx, wy, wz) in zip(R_WB.T.tolist(), wanted, strict=True):
        x += ay * wz - az * wy
        y += az * wx - ax * wz
        z += ax * wy - ay * wx
        trace += ax * wx + ay * wy + az * wz
    length = math.hypot(x, y, z)
    scale = math.atan2(length, trace - 1.0) / length if length > 2e-9 else 0.5
    return scale * x, scale * y, scale * z
