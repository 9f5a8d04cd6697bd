"""Joint torques by a quadratic program: the accelerations that serve all tasks best and that the ground permits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import ContactSphere
from humanwalk.control.body_dynamics import BodyDynamics, Directions, Dynamics
from humanwalk.control.quadratic_program import QuadraticProgram
from humanwalk.numerics import Array, Indices
from humanwalk.numerics.rotation import Vector, rotation_vector
from humanwalk.quantity import quantity
from humanwalk.walking.walking_reference import FootReference, FootTask, WalkingReference, com_acceleration

FREE = np.array(((-1e4,), (1e4,)))
"""Bounds of an acceleration that has none [rad/s2, m/s2]."""
LEAST, MOST = np.array(((-1e4,), (-1e3,))), np.array(((1e3,), (1e4,)))
"""Least and greatest values of an acceleration's lower and upper bound at the ends of a joint's range [rad/s2]."""


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


SOLES: tuple[tuple[Side, bool], ...] = tuple(product(SIDES, (True, False)))
"""The parts of the feet that may press or not as one: of each foot the hind-foot (True), and the rest."""


@dataclass(frozen=True)
class Soles:
    """The contact points under the bodies of both feet, k of them.

    body: place of each point's body among those of `Dynamics`, (k,). point: in that body's frame, (k, 3, 1) [m].
    sole: place of the part of a foot that it is under in `SOLES`, (k,).
    """

    body: Indices
    point: Array
    sole: Indices

    @staticmethod
    def of(spheres: Sequence[ContactSphere], bodies: Sequence[str]) -> Soles:
        """The lowest points of the spheres, in their order, when the feet stand flat."""
        return Soles(
            np.array([bodies.index(sphere.body) for sphere in spheres]),
            np.array([(*sphere.center[:2], sphere.center[2] - sphere.radius) for sphere in spheres])[:, :, None],
            np.array([SOLES.index((side_of(sphere.body), sphere.body.endswith("Ankle"))) for sphere in spheres]),
        )

    def heel(self, side: Side) -> Array:
        """The middle of the points under a foot's hind-foot, in its frame (3,) [m]."""
        middle: Array = self.point[self.sole == SOLES.index((side, True)), :, 0].mean(axis=0)
        return middle


def side_of(body: str) -> Side:
    """The side that a leg's body is of."""
    return "Right" if body.startswith("Right") else "Left"


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
        self.limits = joints.effort_limits[order]
        gains = [self._posture_gains(name) for name in self.names]
        self._stiffness, self._damping = np.array([(g.stiffness, g.damping) for g in gains]).T.copy()
        tasks = [g for g in gains if isinstance(g, TaskGains)]
        self._free = m = 6 + len(tasks)
        """Number of velocities whose accelerations are unknown: the first ones."""
        assert gains[: m - 6] == tasks, "the model file has a prescribed joint before a free one"
        self._weight = np.array([g.weight for g in tasks])
        self._diagonal = parameters.effort + np.concatenate((np.zeros(6), self._weight))
        margin = np.array([parameters.knee_margin * ("LegTibia" in name) for name in self.names])
        self._range = np.array((joints.lower[order] + margin, joints.upper[order]))[:, : m - 6]
        torque_limits = np.concatenate((np.zeros(6), self.limits[: m - 6]))
        self._torque_range = np.array((-torque_limits, torque_limits))
        self._place = {name: i for i, name in enumerate(dynamics.bodies)}
        self._soles = Soles.of(spheres, dynamics.bodies)
        self._heel = {side: self._soles.heel(side).tolist() for side in SIDES}
        mu, self._unit = parameters.friction, parameters.force**-0.5
        """Forces are counted in the unit whose square costs 1/2 [N]."""
        edges = np.array(((mu, 0, 1), (-mu, 0, 1), (0, mu, 1), (0, -mu, 1)), dtype=float)
        self._edges = Directions.of(self._unit * edges)

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
        program, prescribed, points = self.program(body, reference, posture)
        solution = program.solution()
        if solution is None:
            return None
        acceleration, edge_forces = np.concatenate((solution[0], prescribed)), np.maximum(solution[1], 0.0)
        torque = body.M.dot(acceleration) + body.h
        # The program's B is -J' of the edges; the prescribed joints carry no foot.
        torque[: self._free] += program.B.dot(edge_forces)
        forces = np.zeros((self._soles.body.size, 3))
        forces[points] = edge_forces.reshape(-1, 4).dot(self._edges.d_W)
        return WholeBodySolution(acceleration, forces, np.minimum(np.maximum(torque[6:], -self.limits), self.limits))

    def program(
        self, body: Dynamics, reference: WalkingReference, posture: Posture
    ) -> tuple[QuadraticProgram, Array, Indices]:
        """The program, whose unknowns are the accelerations of base, legs and back and the forces along the edges.

        Returns:
            the program; the accelerations of the joints that are prescribed; the places of the points that may press,
            four edges each.
        """
        p, m = self.parameters, self._free
        q, v = body.q.take(self._q), body.v[6:]
        wanted = self._stiffness * (posture.angle - q) + self._damping * (posture.rate - v)
        wanted, prescribed = wanted[: m - 6], wanted[m - 6 :]

        J, a, w = self._tasks(body, reference)
        a -= J[:, m:].dot(prescribed)
        J = J[:, :m]
        WJ = w[:, None] * J
        H = J.T.dot(WJ)
        H.ravel()[:: m + 1] += self._diagonal
        g = -a.dot(WJ)
        g[6:] -= self._weight * wanted

        # The equations of motion M v' + h - J' f = tau: of the base, whose tau is 0, and of the joints.
        points, J_edges, most = self._contacts(body, reference)
        k = most.size
        bounds = np.empty((2, k + 2 * m))
        bounds[:, :k] = 0.0
        bounds[1, :k] = most
        bounds[:, k : k + m] = FREE
        towards_ends = p.range_stiffness * (self._range - q[: m - 6]) - p.range_damping * v[: m - 6]
        bounds[:, k + 6 : k + m] = np.minimum(np.maximum(towards_ends, LEAST), MOST)
        bounds[:, k + m :] = self._torque_range - (body.h[:m] + body.M[:m, m:].dot(prescribed))
        program = QuadraticProgram(H, g, body.M[:m, :m], -J_edges[:, :m].T, *bounds)
        return program, prescribed, points

    # Tasks: rows of J v' + bias = a with weight w.

    def _tasks(self, body: Dynamics, reference: WalkingReference) -> tuple[Array, Array, Array]:
        """J, a - bias and w."""
        p, tasks = self.parameters, _Tasks(body)
        x, y, z = body.com.tolist()
        height, rate, lift = reference.com_height
        over_ground = com_acceleration(complex(x, y), reference.zmp, z - reference.ground_height, lift)
        gains, com = p.com_height, 6 * len(body.bodies)
        up = lift + gains.stiffness * (height - z) + gains.damping * (rate - tasks.velocity[-1])
        tasks.add((com, com + 1), (over_ground.real, over_ground.imag), p.com_weight)
        tasks.add((com + 2,), (up,), gains.weight)
        tasks.turn(self._place["Pelvis"], reference.pelvis_yaw, p.pelvis)
        tasks.turn(self._place["Ribs"], reference.chest_yaw, p.chest)
        for side in SIDES:
            foot, ankle = reference.foot(side), self._place[f"{side}Leg_Ankle"]
            if foot.task is FootTask.SWING:
                self._swing(tasks, foot, ankle)
            elif foot.task is FootTask.HEEL_OFF:
                self._stand(tasks, self._place[f"{side}Leg_FootToes"], 0.0)
                self._raise_heel(tasks, foot, ankle)
            elif foot.task is FootTask.HEEL_STRIKE:
                heel, J, velocity, bias = body.frame(f"{side}Leg_Ankle").point(self._heel[side])
                goal = np.array((0.0, 0.0, self._sinking(heel[2])))
                tasks.add_other(J, bias, p.stance.damping * (goal - velocity), p.stance.weight)
                tasks.turn(ankle, foot.yaw, p.heel_strike)
            else:
                up_B, (x, y, z) = tasks.X_WB[ankle][2], self._heel[side]
                heel_height = up_B[0] * x + up_B[1] * y + up_B[2] * z + up_B[3]
                self._stand(tasks, ankle, self._sinking(heel_height))
        return tasks.rows()

    def _sinking(self, height: float) -> float:
        """Upward speed of a foot that should stand: none, or down where it has not reached the ground yet."""
        return -self.parameters.sinking_speed if height > self.parameters.contact_height else 0.0

    def _stand(self, tasks: _Tasks, place: int, upward: float) -> None:
        """A body of a foot does not move but for an upward speed [m/s]."""
        gains = self.parameters.stance
        wx, wy, wz, vx, vy, vz = tasks.velocity[6 * place : 6 * place + 6]
        wanted = [gains.damping * u for u in (-wx, -wy, -wz, -vx, -vy, upward - vz)]
        tasks.add(range(6 * place, 6 * place + 6), wanted, gains.weight)

    def _raise_heel(self, tasks: _Tasks, foot: FootReference, ankle: int) -> None:
        """A foot pitches about its own axis; its toes stand."""
        x, y = -math.sin(foot.yaw), math.cos(foot.yaw)
        angle, rate, acceleration = foot.pitch
        (error_x, error_y, _), (wx, wy, _) = tasks.rotation_error(ankle, foot.yaw, angle), tasks.turning(ankle)
        gains = self.parameters.heel_off
        wanted = acceleration + gains.stiffness * (x * error_x + y * error_y)
        wanted += gains.damping * (rate - (x * wx + y * wy))
        axis, J, bias = np.array((x, y)), *tasks.motion(slice(6 * ankle, 6 * ankle + 2))
        tasks.add_other(axis.dot(J)[None], (axis.dot(bias),), (wanted,), gains.weight)

    def _swing(self, tasks: _Tasks, foot: FootReference, ankle: int) -> None:
        p, gains = self.parameters, self.parameters.swing_position
        way, (height, rate, lift) = foot.position, foot.height
        x, y, z = (row[3] for row in tasks.X_WB[ankle])
        vx, vy, vz = tasks.velocity[6 * ankle + 3 : 6 * ankle + 6]
        over_ground = way.acceleration + gains.stiffness * (way.position - complex(x, y))
        over_ground += gains.damping * (way.velocity - complex(vx, vy))
        if abs(over_ground) > p.swing_acceleration_limit:
            over_ground *= p.swing_acceleration_limit / abs(over_ground)
        up = lift + gains.stiffness * (height - z) + gains.damping * (rate - vz)
        tasks.add(range(6 * ankle + 3, 6 * ankle + 6), (over_ground.real, over_ground.imag, up), gains.weight)
        tasks.turn(ankle, foot.yaw, p.swing_rotation, *foot.pitch)

    def _contacts(self, body: Dynamics, reference: WalkingReference) -> tuple[Indices, Array, Array]:
        """Places of the points that may press (k,), Jacobian of their edges (4 k, nv), the bound of their forces."""
        p, soles = self.parameters, self._soles
        load = np.array([self._load(reference.foot(side), is_heel) for side, is_heel in SOLES]).take(soles.sole)
        X_WB = body.X_WB.take(soles.body, axis=0)
        p_BoP_W = np.matmul(X_WB[:, :, :3], soles.point)[:, :, 0]
        is_low = X_WB[:, 2, 3] + p_BoP_W[:, 2] < p.contact_height
        (points,) = (is_low & (load > 0.0)).nonzero()
        J_edges = body.along(soles.body.take(points), p_BoP_W.take(points, axis=0), self._edges)
        return points, J_edges, (p.largest_force / self._unit * load.take(points)).repeat(4)

    @staticmethod
    def _load(foot: FootReference, is_heel: bool) -> float:
        """Share of its strength that a part of a foot may press with."""
        return 0.0 if is_heel and foot.task is FootTask.HEEL_OFF else foot.load


class _Tasks:
    """Rows of tasks at one state of the body, gathered one after the other; most are rows of the body's own motions.

    In plain numbers, for all these vectors are short:

    X_WB: rotation matrix and position of each body, three rows of four.
    velocity: as in `Dynamics`.
    """

    def __init__(self, body: Dynamics) -> None:
        self._body = body
        self.X_WB: list[list[list[float]]] = body.X_WB.tolist()
        self.velocity: list[float] = body.velocity.tolist()
        self._rows: list[int] = []
        self._wanted: list[float] = []
        self._weight: list[float] = []
        self._others: list[tuple[Array, npt.ArrayLike, npt.ArrayLike, list[float]]] = []

    def add(self, rows: Sequence[int], acceleration: Sequence[float], weight: float) -> None:
        """Some of the body's motions should have these accelerations."""
        self._rows.extend(rows)
        self._wanted.extend(acceleration)
        self._weight.extend([weight] * len(rows))

    def add_other(self, J: Array, bias: npt.ArrayLike, acceleration: npt.ArrayLike, weight: float) -> None:
        """J v' + bias should be this acceleration."""
        self._others.append((J, bias, acceleration, [weight] * len(J)))

    def motion(self, rows: slice) -> tuple[Array, Array]:
        """J and bias of some of the body's motions."""
        return self._body.J[rows], self._body.bias[rows]

    def turning(self, place: int) -> list[float]:
        """Angular velocity of a body [rad/s]."""
        return self.velocity[6 * place : 6 * place + 3]

    def rotation_error(self, place: int, yaw: float, pitch: float) -> Vector:
        """Rotation vector in W that turns a body into Rz(yaw) Ry(pitch)."""
        c, s, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
        x, y, z, _ = zip(*self.X_WB[place], strict=True)
        return rotation_vector((x, y, z), ((c * cp, s * cp, -sp), (-s, c, 0.0), (c * sp, s * sp, cp)))

    def turn(
        self,
        place: int,
        yaw: float,
        gains: TaskGains,
        pitch: float = 0.0,
        pitch_rate: float = 0.0,
        pitch_acceleration: float = 0.0,
    ) -> None:
        """A body should be turned by a yaw that stays and a pitch that changes."""
        axis = (-math.sin(yaw), math.cos(yaw), 0.0)
        wanted = [
            pitch_acceleration * n + gains.stiffness * e + gains.damping * (pitch_rate * n - w)
            for n, e, w in zip(axis, self.rotation_error(place, yaw, pitch), self.turning(place), strict=True)
        ]
        self.add(range(6 * place, 6 * place + 3), wanted, gains.weight)

    def rows(self) -> tuple[Array, Array, Array]:
        """All rows: J, what J v' should be, weight."""
        rows = np.array(self._rows)
        J, wanted = self._body.J.take(rows, axis=0), self._wanted - self._body.bias.take(rows)
        if not self._others:
            return J, wanted, np.array(self._weight)
        other_J, bias, acceleration, weight = zip(*self._others, strict=True)
        wanted = np.concatenate((wanted, np.concatenate(acceleration) - np.concatenate(bias)))
        return np.concatenate((J, *other_J)), wanted, np.concatenate((self._weight, *weight))


def is_foot_posture(joint_name: str) -> bool:
    """Whether a joint is one of those of the foot that keep a posture: ankle twist, mid-foot and toes."""
    return any(word in joint_name for word in ("AnkleTwist", "FootMiddle", "FootToes"))
