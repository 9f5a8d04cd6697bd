"""Tasks of the whole-body program: accelerations that center of mass, trunk and feet should have."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import CHEST, LEGS, PELVIS
from humanwalk.control.body_dynamics import Dynamics, FrameMotion
from humanwalk.control.whole_body_contacts import SolesOnGround
from humanwalk.control.whole_body_parameters import TaskGains, WholeBodyParameters
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import cross_matrix, rotation_vector, yaw_pitch, yaw_roll
from humanwalk.walking.walking_reference import FootReference, FootTask, WalkingReference, com_acceleration

REST = np.zeros(3)

BALL_PER_HEEL = np.array((-3.0, 1.0, 1.0))
"""Position of the ball of a foot relative to the ankle, per that of the heel."""


class Task(NamedTuple):
    """Desired value of J v'.

    Attributes:
        J: (rows, nv).
        acceleration: desired J v', that is the desired acceleration minus the bias, (rows,) [rad/s2, m/s2].
        weight: cost per squared error.
    """

    J: Array
    acceleration: Array
    weight: float


class Foot(NamedTuple):
    """A foot at one state.

    Attributes:
        hindfoot, toes: frames of its first and last body.
        p_BHeel: middle of the heel in the hindfoot's frame [m], (3,).
        heel_height: of that point above the terrain [m].
        p_TToes: middle of the contact points of the toes in their frame [m], (3,).
        is_steered: whether the ankle has muscles that turn the foot.
    """

    hindfoot: FrameMotion
    toes: FrameMotion
    p_BHeel: Array
    heel_height: float
    p_TToes: Array
    is_steered: bool

    @property
    def p_BGuided(self) -> Array:
        """Point of the hindfoot that follows the path of the swing [m], (3,).

        It is the ankle, or the ball of a foot that the ankle does not turn: its toes point down while the knee is bent.
        """
        return REST if self.is_steered else self.p_BHeel * BALL_PER_HEEL

    def sinking(self, R_WS: Array, p: WholeBodyParameters) -> Array:
        """Desired velocity of a stance foot in W [m/s], (3,): 0, or toward the ground if it is still in the air."""
        return -p.sinking_speed * R_WS[:, 2] if self.heel_height > p.contact_height else REST


def tasks(
    body: Dynamics,
    soles: SolesOnGround,
    reference: WalkingReference,
    p: WholeBodyParameters,
    passive_ankles: Collection[Side] = (),
    more: Iterable[Task] = (),
) -> tuple[Array, Array, Array]:
    """All tasks at one state, row by row: J (rows, nv), desired J v' (rows,), weight (rows,).

    Args:
        body: at this state.
        soles: at this state.
        reference: what feet, center of mass and trunk should do.
        p: gains and weights.
        passive_ankles: sides without muscles at the ankle.
        more: tasks in addition to those of the plan.
    """
    found = [
        *_center_of_mass(body, reference, p),
        _center_of_pressure(body, reference, p),
        _rotation(body.frame(PELVIS), yaw_roll(reference.pelvis_yaw, reference.pelvis_roll), p.pelvis, p),
        _rotation(body.frame(CHEST), yaw_pitch(reference.chest_yaw, 0.0), p.chest, p),
    ]
    for side in SIDES:
        leg, foot = LEGS[side], reference.foot(side)
        is_steered = side not in passive_ankles
        frames = body.frame(leg.hindfoot), body.frame(leg.toe_segment)
        state = Foot(*frames, *soles.heel(side), soles.toes(side), is_steered)
        found.extend(_FOOT_TASKS[foot.task](state, foot, p))
    found.extend(more)
    J, acceleration, weight = zip(*(task for task in found if task.weight > 0.0), strict=True)
    return np.concatenate(J), np.concatenate(acceleration), np.repeat(weight, [len(a) for a in acceleration])


def _center_of_mass(body: Dynamics, reference: WalkingReference, p: WholeBodyParameters) -> Iterator[Task]:
    """Horizontal acceleration from the centroidal moment pivot, vertical acceleration from the reference height."""
    com, gains = body.com, p.com_height
    x, y, z = com.position.tolist()
    height, rate, lift = reference.com_height
    level = com_acceleration(complex(x, y), reference.pivot, z - reference.ground_height, lift)
    up = lift + gains.stiffness * (height - z) + gains.damping * (rate - com.velocity[2])
    yield Task(com.J[:2], np.array((level.real, level.imag)) - com.bias[:2], p.com_weight)
    yield Task(com.J[2:], up - com.bias[2:], gains.weight)


def _center_of_pressure(body: Dynamics, reference: WalkingReference, p: WholeBodyParameters) -> Task:
    """No moment of the contact forces about the level axes through the zero-moment point Z.

    With f and tau the force and the moment about the pelvis P that the equations of motion need at the floating base,
    that moment is tau + p_ZP x f. Per m h it is an acceleration: that of a center of mass at the height h without
    angular momentum about it.
    """
    zmp = np.array((reference.zmp.real, reference.zmp.imag, reference.ground_height))
    p_ZP = cross_matrix(body.frame(PELVIS).p_WB - zmp)
    scale = 1.0 / (body.mass * (body.com.position[2] - reference.ground_height))
    J, bias = (scale * (part[:3] + p_ZP @ part[3:6])[:2] for part in (body.M, body.h))
    return Task(J, -bias, p.pressure_weight)


def _rotation(
    frame: FrameMotion,
    R_WG: Array,
    gains: TaskGains,
    p: WholeBodyParameters,
    velocity: Array = REST,
    acceleration: Array = REST,
) -> Task:
    """A frame should have the orientation R_WG, with an angular velocity and acceleration in W."""
    error = rotation_vector(frame.R_WB, R_WG)
    desired = acceleration + gains.stiffness * error + gains.damping * (velocity - frame.V_WB[:3])
    return Task(frame.J[:3], desired - frame.bias[:3], p.rotation_radius**2 * gains.weight)


def _turn(foot: Foot, rotation: Task) -> Task:
    """The rotation of a foot; of one on a passive ankle only about the vertical, which is the hip's."""
    if foot.is_steered:
        return rotation
    return Task(rotation.J[2:], rotation.acceleration[2:], rotation.weight)


def _motion(
    frame: FrameMotion, p: WholeBodyParameters, w: Array = REST, v: Array = REST, p_BP: Array = REST
) -> Iterator[Task]:
    """A frame in stance should turn with the angular velocity w, and its point P move with the velocity v, in W."""
    point = frame.point(p_BP)
    turning, moving = p.stance.damping * (w - frame.V_WB[:3]), p.stance.damping * (v - point.velocity)
    yield Task(frame.J[:3], turning - frame.bias[:3], p.rotation_radius**2 * p.stance.weight)
    yield Task(point.J, moving - point.bias, p.stance.weight)


def _flat(foot: Foot, reference: FootReference, p: WholeBodyParameters) -> Iterator[Task]:
    yield from _motion(foot.hindfoot, p, v=foot.sinking(reference.R_WS, p))


def _heel_strike(foot: Foot, reference: FootReference, p: WholeBodyParameters) -> Iterator[Task]:
    """The heel stands, and the foot turns until it is parallel to the terrain."""
    heel = foot.hindfoot.point(foot.p_BHeel)
    desired = p.stance.damping * (foot.sinking(reference.R_WS, p) - heel.velocity)
    yield Task(heel.J, desired - heel.bias, p.stance.weight)
    yield _turn(foot, _rotation(foot.hindfoot, reference.R_WS @ yaw_pitch(reference.yaw, 0.0), p.heel_strike, p))


def _heel_off(foot: Foot, reference: FootReference, p: WholeBodyParameters) -> Iterator[Task]:
    """The toes stand, or roll over their tips, and the hindfoot pitches about its own axis."""
    angle, rate, acceleration = reference.pitch
    R_WG = reference.R_WS @ yaw_pitch(reference.yaw, angle)
    axis = R_WG[:, 1]
    extension, extending = reference.toes
    if angle > extension:
        yield from _motion(foot.toes, p, w=(rate - extending) * axis, p_BP=foot.p_TToes)
    else:
        yield from _motion(foot.toes, p)
    whole = _rotation(foot.hindfoot, R_WG, p.heel_off, p, rate * axis, acceleration * axis)
    if foot.is_steered:
        yield Task(axis[None] @ whole.J, axis[None] @ whole.acceleration, whole.weight)


def _swing(foot: Foot, reference: FootReference, p: WholeBodyParameters) -> Iterator[Task]:
    """The guided point follows the path that it has in the reference, and the foot its yaw and pitch."""
    frame, gains, path = foot.hindfoot, p.swing_position, reference.position
    height, rate, lift = reference.height
    angle, pitch_rate, pitch_acceleration = reference.pitch
    R_WG = reference.R_WS @ yaw_pitch(reference.yaw, angle)
    axis = R_WG[:, 1]
    # From the ankle of the reference to its guided point.
    r, w = R_WG @ foot.p_BGuided, cross_matrix(pitch_rate * axis)
    position = np.array((path.position.real, path.position.imag, height)) + r
    velocity = np.array((path.velocity.real, path.velocity.imag, rate)) + w @ r
    desired = np.array((path.acceleration.real, path.acceleration.imag, lift))
    desired += w @ (w @ r) + pitch_acceleration * (cross_matrix(axis) @ r)
    guided = frame.point(foot.p_BGuided)
    desired += gains.stiffness * (position - guided.position) + gains.damping * (velocity - guided.velocity)
    level = np.hypot(desired[0], desired[1])
    if level > p.swing_acceleration_limit:
        desired[:2] *= p.swing_acceleration_limit / level
    yield Task(guided.J, desired - guided.bias, gains.weight)
    yield _turn(foot, _rotation(frame, R_WG, p.swing_rotation, p, pitch_rate * axis, pitch_acceleration * axis))


_FOOT_TASKS: dict[FootTask, Callable[[Foot, FootReference, WholeBodyParameters], Iterator[Task]]] = {
    FootTask.FLAT: _flat,
    FootTask.HEEL_STRIKE: _heel_strike,
    FootTask.HEEL_OFF: _heel_off,
    FootTask.SWING: _swing,
}
