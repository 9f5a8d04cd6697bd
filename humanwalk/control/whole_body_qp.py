"""Joint torques by a quadratic program: the accelerations that serve all tasks best and that the ground permits."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import daqp
import numpy as np
import numpy.typing as npt

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import ContactSphere
from humanwalk.body.groups import FOOT_BODIES
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

    sinking_speed: float = quantity(1.8, "m/s", 0.0, 5.0)
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

    force: float = quantity(1e-6, "1/N2", 0.0, 1.0)
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
    """min x'Hx/2 + g'x subject to lower <= (x, A x) <= upper; where both are equal it is an equation."""

    H: Array
    g: Array
    A: Array
    lower: Array
    upper: Array

    def solution(self) -> Array | None:
        """The least x, or None where the solver finds none.

        The same program has the same solution to the last bit.
        """
        # DAQP passes over a constraint that is not a number.
        if not all(np.isfinite(part).all() for part in self):
            return None
        kind = np.where(self.lower == self.upper, EQUATION, 0).astype(np.int32)
        x, _, flag, _ = daqp.solve(self.H, self.g, self.A, self.upper, self.lower, kind, iter_limit=MOST_ITERATIONS)
        return x if flag > 0 else None


@dataclass(frozen=True)
class SolePoints:
    """The contact points under one body of a foot.

    points: in the body's frame (k, 3) [m]. places: of these points among all that a solution's forces are given for.
    """

    side: Side
    body: str
    points: Array
    places: Indices

    @property
    def is_heel(self) -> bool:
        """Whether this is the hind-foot."""
        return self.body.endswith("Ankle")


def _soles(spheres: Sequence[ContactSphere]) -> tuple[SolePoints, ...]:
    lowest = np.array([(*sphere.center[:2], sphere.center[2] - sphere.radius) for sphere in spheres])
    soles = []
    for side in SIDES:
        for body in FOOT_BODIES[side]:
            places = np.array([i for i, sphere in enumerate(spheres) if sphere.body == body])
            soles.append(SolePoints(side, body, lowest[places], places))
    return tuple(soles)


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
        dynamics: of the body.
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
        is_arm = np.array([g is parameters.arms for g in gains])
        self._prescribed = np.flatnonzero(is_arm) + 6
        self._free = np.concatenate((np.arange(6), np.flatnonzero(~is_arm) + 6))
        self._free_joints = np.flatnonzero(~is_arm)
        for i, name in enumerate(self.names):
            if "LegTibia" in name:
                self.lower[i] += parameters.knee_margin
        self._soles = _soles(spheres)
        self._heel = {sole.side: sole.points.mean(axis=0) for sole in self._soles if sole.is_heel}
        mu = parameters.friction
        self._edges = Directions.of(np.array(((mu, 0, 1), (-mu, 0, 1), (0, mu, 1), (0, -mu, 1)), dtype=float))

    def _posture_gains(self, name: str) -> TaskGains | PrescribedGains:
        p = self.parameters
        if is_foot_posture(name):
            return p.feet
        if "Leg" in name:
            return p.legs
        if name.startswith(("Lumbar", "Thoracic")):
            return p.spine
        return p.arms

    @staticmethod
    def frames(reference: WalkingReference) -> list[str]:
        """The bodies whose frames a program for this reference needs."""
        names = ["Pelvis", "Ribs"]
        for side in SIDES:
            in_the_air = reference.foot(side).task is FootTask.SWING
            names += [f"{side}Leg_Ankle"] if in_the_air else FOOT_BODIES[side]
        return names

    def solve(self, body: Dynamics, reference: WalkingReference, posture: Posture) -> WholeBodySolution | None:
        """The solution, or None where the solver finds none."""
        program, qdd0, B, points = self.program(body, reference, posture)
        x = program.solution()
        if x is None:
            return None
        m = self._free.size
        qdd = qdd0.copy()
        qdd[self._free] = x[:m]
        edge_forces = np.maximum(x[m:], 0.0)
        torque = (body.M @ qdd + body.h - B.T @ edge_forces)[6:]
        forces = np.zeros((sum(len(sole.places) for sole in self._soles), 3))
        forces[points] = edge_forces.reshape(-1, 4) @ self._edges.d_W
        return WholeBodySolution(qdd, forces, np.clip(torque, -self.limits, self.limits))

    def program(
        self, body: Dynamics, reference: WalkingReference, posture: Posture
    ) -> tuple[QuadraticProgram, Array, Array, Indices]:
        """The program, and what makes torques of its solution.

        Returns:
            the program; the prescribed accelerations (nv,); the Jacobian along the edges of the contact forces
            (edges, nv); the places of the points that these edges belong to.
        """
        p = self.parameters
        q, v = body.q[self._q], body.v[6:]
        stiffness, damping, weight = self._posture
        wanted = stiffness * (posture.angle - q) + damping * (posture.rate - v)
        qdd0 = np.zeros(body.v.size)
        qdd0[self._prescribed] = wanted[self._prescribed - 6]

        J, a, w = self._tasks(body, reference)
        a = a - J @ qdd0
        J = J[:, self._free]
        points, B, most = self._contacts(body, reference)

        m, k = self._free.size, most.size
        free_joints = self._free_joints
        WJ = w[:, None] * J
        H = np.zeros((m + k, m + k))
        H[:m, :m] = J.T @ WJ
        diagonal = np.full(m, p.effort)
        diagonal[6:] += weight[free_joints]
        H[np.arange(m), np.arange(m)] += diagonal
        H[np.arange(m, m + k), np.arange(m, m + k)] = p.force
        g = np.zeros(m + k)
        g[:m] = -(a @ WJ)
        g[6:m] -= weight[free_joints] * wanted[free_joints]

        # The equations of motion M v' + h - B' f = tau: of the base, whose tau is 0, and of the joints.
        motion = np.empty((m, m + k))
        motion[:, :m] = body.M[self._free[:, None], self._free]
        motion[:, m:] = -B[:, self._free].T
        rest = (body.h + body.M @ qdd0)[self._free]
        lower, upper = np.full(2 * m + k, -1e4), np.full(2 * m + k, 1e4)
        slowing = p.range_damping * v
        lower[6:m] = np.clip(p.range_stiffness * (self.lower - q) - slowing, -1e4, 1e3)[free_joints]
        upper[6:m] = np.clip(p.range_stiffness * (self.upper - q) - slowing, -1e3, 1e4)[free_joints]
        lower[m : m + k], upper[m : m + k] = 0.0, most
        torque_limits = np.concatenate((np.zeros(6), self.limits[free_joints]))
        lower[m + k :], upper[m + k :] = -torque_limits - rest, torque_limits - rest
        program = QuadraticProgram(H, g, motion, lower, upper)
        return program, qdd0, B, points

    # Tasks: rows of J v' = a with weight w.

    def _tasks(self, body: Dynamics, reference: WalkingReference) -> tuple[Array, Array, Array]:
        p = self.parameters
        Js: list[Array] = []
        accelerations: list[Array] = []
        weights: list[float] = []

        def add(J: Array, acceleration: Array, weight: float) -> None:
            Js.append(J)
            accelerations.append(acceleration)
            weights.extend([weight] * len(J))

        height, rate, lift = reference.com_height
        c = complex(body.com[0], body.com[1])
        over_ground = com_acceleration(c, reference.zmp, body.com[2], lift)
        up = (
            lift
            + p.com_height.stiffness * (height - body.com[2])
            + p.com_height.damping * (rate - body.com_velocity[2])
        )
        add(body.com_J[:2], np.array((over_ground.real, over_ground.imag)) - body.com_bias[:2], p.com_weight)
        add(body.com_J[2:], np.array((up,)) - body.com_bias[2:], p.com_height.weight)
        for name, yaw, gains in (("Pelvis", reference.pelvis_yaw, p.pelvis), ("Ribs", reference.chest_yaw, p.chest)):
            frame = body.frames[name]
            error = _rotation_error(_rotation(yaw, 0.0), frame.R_WB)
            wanted = gains.stiffness * error - gains.damping * frame.V_WB[:3]
            add(frame.J[:3], wanted - frame.bias[:3], gains.weight)
        for side in SIDES:
            foot = reference.foot(side)
            ankle = body.frames[f"{side}Leg_Ankle"]
            if foot.task is FootTask.SWING:
                self._add_swing(add, foot, ankle)
            elif foot.task is FootTask.HEEL_OFF:
                toes = body.frames[f"{side}Leg_FootToes"]
                add(toes.J, -p.stance.damping * toes.V_WB - toes.bias, p.stance.weight)
                axis = np.array((-math.sin(foot.yaw), math.cos(foot.yaw), 0.0))
                angle, rate, acceleration = foot.pitch
                error_y = axis @ _rotation_error(_rotation(foot.yaw, angle), ankle.R_WB)
                wanted_y = (
                    acceleration + p.heel_off.stiffness * error_y + p.heel_off.damping * (rate - axis @ ankle.V_WB[:3])
                )
                add(axis[None, :] @ ankle.J[:3], np.array((wanted_y - axis @ ankle.bias[:3],)), p.heel_off.weight)
            elif foot.task is FootTask.HEEL_STRIKE:
                heel, J, velocity, bias = ankle.point(self._heel[side])
                add(J, p.stance.damping * (self._sinking(heel[2]) - velocity) - bias, p.stance.weight)
                error = _rotation_error(_rotation(foot.yaw, 0.0), ankle.R_WB)
                wanted = p.heel_strike.stiffness * error - p.heel_strike.damping * ankle.V_WB[:3]
                add(ankle.J[:3], wanted - ankle.bias[:3], p.heel_strike.weight)
            else:
                heel = ankle.p_WB + ankle.R_WB @ self._heel[side]
                wanted = np.concatenate((np.zeros(3), self._sinking(heel[2]))) - ankle.V_WB
                add(ankle.J, p.stance.damping * wanted - ankle.bias, p.stance.weight)
        return np.vstack(Js), np.concatenate(accelerations), np.array(weights)

    def _sinking(self, height: float) -> Array:
        """Velocity of a foot that should stand: none, or down where it has not reached the ground yet."""
        late = height > self.parameters.contact_height
        return np.array((0.0, 0.0, -self.parameters.sinking_speed if late else 0.0))

    def _add_swing(self, add: object, foot: FootReference, ankle: FrameMotion) -> None:
        p = self.parameters
        assert callable(add)
        way, (z, dz, ddz), (pitch, dpitch, ddpitch) = foot.position, foot.height, foot.pitch
        position = np.array((way.position.real, way.position.imag, z))
        velocity = np.array((way.velocity.real, way.velocity.imag, dz))
        acceleration = np.array((way.acceleration.real, way.acceleration.imag, ddz))
        gains = p.swing_position
        wanted = acceleration + gains.stiffness * (position - ankle.p_WB) + gains.damping * (velocity - ankle.V_WB[3:])
        over_ground = math.hypot(wanted[0], wanted[1])
        if over_ground > p.swing_acceleration_limit:
            wanted[:2] *= p.swing_acceleration_limit / over_ground
        add(ankle.J[3:], wanted - ankle.bias[3:], gains.weight)
        axis = np.array((-math.sin(foot.yaw), math.cos(foot.yaw), 0.0))
        gains = p.swing_rotation
        error = _rotation_error(_rotation(foot.yaw, pitch), ankle.R_WB)
        wanted = ddpitch * axis + gains.stiffness * error + gains.damping * (dpitch * axis - ankle.V_WB[:3])
        add(ankle.J[:3], wanted - ankle.bias[:3], gains.weight)

    def _contacts(self, body: Dynamics, reference: WalkingReference) -> tuple[Indices, Array, Array]:
        """Places of the points that may press (k,), their force per edge as generalised force (4 k, nv), its bound."""
        p = self.parameters
        places, blocks, most = [], [], []
        for sole in self._soles:
            foot = reference.foot(sole.side)
            if foot.load <= 0.0 or (foot.task is FootTask.HEEL_OFF and sole.is_heel):
                continue
            frame = body.frames[sole.body]
            low = np.flatnonzero(frame.p_WB[2] + sole.points @ frame.R_WB[2] < p.contact_height)
            if low.size:
                places.append(sole.places[low])
                blocks.append(frame.along(sole.points[low], self._edges))
                most.append(np.full(4 * low.size, p.largest_force * foot.load))
        if not places:
            return np.zeros(0, dtype=int), np.zeros((0, body.v.size)), np.zeros(0)
        return np.concatenate(places), np.concatenate(blocks), np.concatenate(most)


def is_foot_posture(joint_name: str) -> bool:
    """Whether a joint is one of those of the foot that keep a posture: ankle twist, mid-foot and toes."""
    return any(word in joint_name for word in ("AnkleTwist", "FootMiddle", "FootToes"))


def _rotation(yaw: float, pitch: float) -> Array:
    """Rz(yaw) Ry(pitch)."""
    u = cmath.exp(1j * yaw)
    c, s, cp, sp = u.real, u.imag, math.cos(pitch), math.sin(pitch)
    return np.array(((c * cp, -s, c * sp), (s * cp, c, s * sp), (-sp, 0.0, cp)))


def _rotation_error(wanted: Array, actual: Array) -> Array:
    """Rotation vector in W that turns `actual` into `wanted`; exact up to a right angle, then bounded."""
    R = wanted @ actual.T
    sine = 0.5 * np.array((R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]))
    length = math.sqrt(sine @ sine)
    if length < 1e-9:
        return sine
    error: Array = sine * (math.atan2(length, 0.5 * (R.trace() - 1.0)) / length)
    return error
