"""Joint torques by a quadratic program: weighted tasks under Newton's laws, friction, torque and joint limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from humanwalk.body import SIDES
from humanwalk.body.contact import ContactSphere
from humanwalk.body.impairments import NO_TORQUE
from humanwalk.body.limbs import JOINT_GROUPS, LEGS
from humanwalk.body.upright import passive_ankles
from humanwalk.control.body_dynamics import BodyDynamics, Dynamics
from humanwalk.control.quadratic_program import QuadraticProgram
from humanwalk.control.whole_body_contacts import EDGES, Contacts, Soles
from humanwalk.control.whole_body_parameters import TaskGains, WholeBodyParameters
from humanwalk.control.whole_body_tasks import Task, tasks
from humanwalk.numerics import Array
from humanwalk.walking.walking_reference import WalkingReference

EFFORT_COST = 1e-4
"""Cost per squared acceleration of base and joints (our choice): small against the weights of the tasks."""

LOCKED_TORQUE = 1e4
"""Torque that a locked joint carries [N m]; never active."""

UNLIMITED = np.array(((-np.inf,), (np.inf,)))
"""Range of a joint without muscles."""

UNBOUNDED = np.tile(((-1e4,), (1e4,)), 6)
"""Lower and upper bounds of the accelerations of the floating base [rad/s2, m/s2]; never active."""

NOT_POSITIVE = np.array(((-1e4,), (0.0,)))
"""Lower and upper bound of what must not be positive; the lower one is never active."""

JOINT_LIMIT_RANGE = np.array(((-10.0, -1.0), (1.0, 10.0)))
"""Lower ends, then upper ends, of the ranges of the lower and of the upper bound of a joint's acceleration, relative to
the largest that a joint limit requires."""


@dataclass(frozen=True)
class WholeBodySolution:
    """Solution of the program.

    Attributes:
        acceleration: v', (nv,) [m/s2, rad/s2].
        forces: on the contact points in W, in the order of the spheres, (points, 3) [N].
        torque: of all joints, in the order of the velocities from the seventh on [N m].
    """

    acceleration: Array
    forces: Array
    torque: Array


@dataclass(frozen=True)
class Posture:
    """Desired angles and rates of all joints, in the order of the velocities from the seventh on [rad, rad/s]."""

    angle: Array
    rate: Array


class WholeBodyQp:
    """Builds and solves the program; keeps no state between calls.

    Attributes:
        names: joints in the order of the velocities from the seventh on.
        limits: torque limits of their actuators [N m]; 0 where the joint is locked.
    """

    def __init__(
        self,
        dynamics: BodyDynamics,
        spheres: Sequence[ContactSphere],
        parameters: WholeBodyParameters,
    ) -> None:
        """Make the program.

        Args:
            dynamics: of the body; its prescribed joints (arms, neck and head) come last.
            spheres: contact points of the soles.
            parameters: tasks and limits.
        """
        self.parameters = parameters
        joints = dynamics.joints
        order = np.argsort(joints.v)
        self.names = tuple(joints.names[i] for i in order)
        self.limits = joints.effort_limits[order]
        self._q = joints.q[order]
        self._soles = Soles.of(spheres, dynamics.bodies)

        gains = [_posture_gains(parameters).get(name, parameters.arms) for name in self.names]
        self._stiffness, self._damping = np.array([(g.stiffness, g.damping) for g in gains]).T
        weighted = [g for g in gains if isinstance(g, TaskGains)]
        self._free = m = 6 + len(weighted)
        """Number of velocities whose accelerations are unknown: the first ones."""
        assert gains[: m - 6] == weighted, "the model file has a prescribed joint before a free one"
        self._weight = np.array([g.weight for g in weighted])
        radius = np.repeat((parameters.rotation_radius, 1.0, parameters.rotation_radius), (3, 3, len(weighted)))
        self._regularization = np.diag(radius**2 * (EFFORT_COST + np.concatenate((np.zeros(6), self._weight))))

        lower, upper = joints.lower[order], joints.upper[order]
        knees = np.isin(self.names, JOINT_GROUPS["knee"])
        lower[knees] = np.clip(parameters.knee_margin, lower[knees], upper[knees])
        self._range = np.array((lower, upper))[:, : m - 6]
        # A locked joint is held by its structure, anywhere in its play.
        locked = joints.locked[order]
        self.limits[locked] = 0.0
        self._locked = locked[: m - 6]
        # Nothing in the program's reach keeps a joint without muscles within its range.
        passive = ~locked & (self.limits <= NO_TORQUE)
        self._range[:, passive[: m - 6]] = UNLIMITED
        self._passive_ankles = passive_ankles(dynamics.plant)
        legs = [6 + self.names.index(joint) for leg in LEGS.values() for joint in leg.chain]
        self._effort = np.setdiff1d(legs, 6 + np.flatnonzero(locked))
        """Joints whose torque is an effort, among the velocities: the structure of a locked joint makes none."""
        torque_limits = np.concatenate((np.zeros(6), np.where(locked, LOCKED_TORQUE, self.limits)[: m - 6]))
        self._torque_range = np.array((-torque_limits, torque_limits))

    def solve(
        self, body: Dynamics, reference: WalkingReference, posture: Posture, style: Sequence[Task] = ()
    ) -> WholeBodySolution | None:
        """The solution, or None if the solver finds none; see `program`."""
        program, prescribed, contacts = self.program(body, reference, posture, style)
        solution = program.solution()
        if solution is None:
            return None
        edge_forces, acceleration = np.split(solution, [len(contacts.J_edges)])
        edge_forces, acceleration = np.maximum(edge_forces, 0.0), np.concatenate((acceleration, prescribed))
        torque = body.M @ acceleration + body.h - contacts.J_edges.T @ edge_forces
        forces = np.zeros((self._soles.side.size, 3))
        forces[contacts.points] = contacts.forces(edge_forces)
        return WholeBodySolution(acceleration, forces, np.clip(torque[6:], -self.limits, self.limits))

    def program(
        self, body: Dynamics, reference: WalkingReference, posture: Posture, style: Sequence[Task] = ()
    ) -> tuple[QuadraticProgram, Array, Contacts]:
        """The program at one state.

        Its unknowns are the k forces along the edges of the friction pyramids, then the m accelerations of base, legs
        and spine.

        Args:
            body: the body at this state.
            reference: plan of the steps.
            posture: desired angles.
            style: tasks in addition to those of the plan.

        Returns:
            The program; the accelerations of the prescribed joints; the contacts.
        """
        p, m = self.parameters, self._free
        q, v = body.q[self._q], body.v[6:]
        desired = self._stiffness * (posture.angle - q) + self._damping * (posture.rate - v)
        desired, prescribed = desired[: m - 6], desired[m - 6 :]
        soles = self._soles.on(reference.ground, body)
        contacts = soles.contacts(body, reference, p)
        k = len(contacts.J_edges)

        # Each force along an edge costs its square.
        H, g = np.eye(k + m), np.zeros(k + m)
        H[:k, :k] += _pivot_cost(contacts, body, reference, p)
        J, a, w = tasks(body, soles, reference, p, self._passive_ankles, style)
        a -= J[:, m:] @ prescribed
        J = J[:, :m]
        WJ = w[:, None] * J
        H[k:, k:] = J.T @ WJ + self._regularization
        g[k:] = -a @ WJ
        g[k + 6 :] -= p.rotation_radius**2 * self._weight * desired

        # The equations of motion: the generalized forces are A (f, v') + load.
        A, load = np.hstack((-contacts.J_edges[:, :m].T, body.M[:m, :m])), body.h[:m] + body.M[:m, m:] @ prescribed
        effort = A[self._effort] / p.torque_unit
        H += effort.T @ effort
        g += load[self._effort] / p.torque_unit @ effort

        twist = np.pad(contacts.twist(p.ball_twist.at(reference.dcm_error, reference.speed)), ((0, 0), (0, m)))

        distance = np.where(self._locked, 0.0, self._range - q[: m - 6])
        toward_limits = p.joint_limit_stiffness * distance - p.joint_limit_damping * v[: m - 6]
        low, high = p.joint_limit_acceleration * JOINT_LIMIT_RANGE[:, :, None]
        bounds = (
            np.repeat(contacts.limits, EDGES, axis=1),
            UNBOUNDED,
            np.clip(toward_limits, low, high),
            self._torque_range - load,
            np.repeat(NOT_POSITIVE, len(twist), axis=1),
        )
        return QuadraticProgram(H, g, np.vstack((A, twist)), *np.hstack(bounds)), prescribed, contacts


def _pivot_cost(contacts: Contacts, body: Dynamics, reference: WalkingReference, p: WholeBodyParameters) -> Array:
    """Cost of forces that do not point to the pivot, while both feet are loaded, (edges, edges)."""
    k = len(contacts.J_edges)
    if np.unique(contacts.side).size < len(SIDES):
        return np.zeros((k, k))
    pivot = body.com.position + np.array((0.0, 0.0, p.force_pivot.height))
    across = contacts.across(pivot) / p.force_pivot.unit
    first, second = (reference.foot(side).load for side in SIDES)
    both = 4.0 * first * second / (first + second) ** 2
    return both * across @ across.T


def _posture_gains(parameters: WholeBodyParameters) -> Mapping[str, TaskGains]:
    """Gains of the posture by joint, for all joints whose accelerations are free."""
    return (
        dict.fromkeys((joint for leg in LEGS.values() for joint in leg.chain), parameters.legs)
        | dict.fromkeys((joint for leg in LEGS.values() for joint in leg.foot_joints), parameters.feet)
        | dict.fromkeys(JOINT_GROUPS["spine"], parameters.spine)
    )
