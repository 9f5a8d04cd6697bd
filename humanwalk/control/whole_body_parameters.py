"""Gains, weights and limits of the whole-body program."""

from __future__ import annotations

import math
from dataclasses import dataclass

from humanwalk.quantity import quantity


@dataclass(frozen=True)
class TaskGains:
    """Desired acceleration of a task per error, and its weight against the other tasks."""

    stiffness: float = quantity(100.0, "1/s2", 0.0, 1e4)
    """Acceleration per position error."""

    damping: float = quantity(20.0, "1/s", 0.0, 500.0)
    """Acceleration per velocity error."""

    weight: float = quantity(1.0, "", 0.0, 1e5)
    """Cost per squared acceleration error; that of an angular acceleration is multiplied by the square of
    `rotation_radius`."""


@dataclass(frozen=True)
class PrescribedGains:
    """Gains of joints whose accelerations are prescribed and not traded off against other tasks."""

    stiffness: float = quantity(60.0, "1/s2", 0.0, 1e4)
    """Acceleration per angle error."""

    damping: float = quantity(15.5, "1/s", 0.0, 500.0)
    """Acceleration per rate error."""


def critical(stiffness: float, weight: float) -> TaskGains:
    """Gains of a critically damped task."""
    return TaskGains(stiffness, 2.0 * math.sqrt(stiffness), weight)


@dataclass(frozen=True)
class ForcePivot:
    """The point above the center of mass to which the force on each foot points while both feet are loaded.

    In people the lines of the forces of single support meet in such a point (Maus et al. 2010, Nature Communications
    1:70). In double support the sum of both forces points to the center of mass (Vielemeyer et al. 2021, J. Biomech.
    120:110387); how the feet share it decides the moments of the hips (docs/decisions/0036-force-pivot.md).
    """

    height: float = quantity(1.11, "m", 0.0, 2.0)
    """Height above the center of mass."""

    unit: float = quantity(3.0, "N", 0.5, 1e6)
    """Part of the force of a foot across its line that costs as much as an acceleration error of 1 m/s2 with the weight
    1; the cost fades as the foot behind is unloaded."""


@dataclass(frozen=True)
class BallTwist:
    """Largest moment about the vertical of a foot whose heel is up, per vertical force.

    With more than the ball of the foot carries the foot twists on it. When the body has to be caught, the moment
    matters more than the twist (docs/likeness_trials.md, "Does a limit of the twist on the ball help?").
    """

    arm: float = quantity(0.008, "m", 0.001, 0.1)
    """Largest moment per vertical force while the DCM is near its reference."""

    dcm_error: float = quantity(0.03, "m", 0.0, 1.0)
    """Distance of the DCM from its reference from which on the moment may be larger."""

    gain: float = quantity(1.0, "", 0.0, 10.0)
    """By how much the largest moment per vertical force grows with that distance."""

    fast_speed: float = quantity(1.45, "m/s", 0.0, 5.0)
    """Forward speed from which on the moment may be larger. The swinging leg turns the body about the vertical, the
    more the faster the walk; a foot that carries too little moment pushes the body sideways instead, and the walker
    fell at 1.6 m/s (docs/decisions/0050-fast-walks.md)."""

    per_speed: float = quantity(0.2, "s", 0.0, 1.0)
    """By how much the largest moment per vertical force grows with the speed above `fast_speed`."""

    def at(self, dcm_error: float, speed: float) -> float:
        """Largest moment per vertical force [m].

        Args:
            dcm_error: Distance of the DCM from its reference [m].
            speed: Forward speed [m/s].
        """
        caught = self.gain * max(dcm_error - self.dcm_error, 0.0)
        return self.arm + caught + self.per_speed * max(speed - self.fast_speed, 0.0)


@dataclass(frozen=True)
class WholeBodyParameters:
    """Tasks and limits of the whole-body controller."""

    com_weight: float = quantity(775.0, "", 0.0, 1e5)
    """Weight of the horizontal acceleration of the center of mass, which follows from the planned pivot alone.
    A fast swing foot demands 60 m/s2, the center of mass 3 m/s2; the weight keeps the first from disturbing it."""

    pressure_weight: float = quantity(1000.0, "", 0.0, 1e5)
    """Weight of the center of pressure at the planned zero-moment point, per squared acceleration of the center of mass
    that would move it there. With `com_weight` alone the angular momentum of the swinging leg moves the pressure."""

    com_height: TaskGains = critical(100.0, 197.0)
    """Height of the center of mass."""

    stance: TaskGains = TaskGains(0.0, 39.0, 1000.0)
    """Zero velocity of a foot in stance."""

    sinking_speed: float = quantity(1.8, "m/s", 0.0, 5.0)
    """Speed at which a stance foot that is still in the air moves toward the ground."""

    heel_strike: TaskGains = critical(1500.0, 1000.0)
    """Rotation of a foot after heel strike."""

    heel_off: TaskGains = critical(400.0, 30.0)
    """Pitch of a foot whose heel rises."""

    swing_position: TaskGains = critical(335.0, 38.5)
    """Position of the swing ankle; of the ball of a foot on a passive ankle."""

    swing_rotation: TaskGains = critical(400.0, 20.0)
    """Rotation of the swing foot."""

    swing_acceleration_limit: float = quantity(100.0, "m/s2", 10.0, 1000.0)
    """Maximum desired horizontal acceleration of the swing foot; limits the effect of a foothold that jumps."""

    pelvis: TaskGains = critical(200.0, 1.85)
    """Rotation of the pelvis."""

    chest: TaskGains = critical(150.0, 13.0)
    """Rotation of the chest."""

    spine: TaskGains = critical(100.0, 0.6)
    """Posture of the spine. With a smaller weight the trunk sways on the pelvis, and the moments of the hips vary more
    (docs/likeness_trials.md, "Does a firm spine help?")."""

    feet: TaskGains = critical(400.0, 30.0)
    """Posture of ankle rotation, midfoot and toes."""

    legs: TaskGains = TaskGains(0.0, 0.0, 0.001)
    """Posture of hips, knees and ankles; only makes the solution unique."""

    arms: PrescribedGains = PrescribedGains()
    """Posture of arms, shoulder girdle, neck and head."""

    friction: float = quantity(0.55, "", 0.1, 1.0)
    """Largest friction coefficient of the planned contact forces; below that of ordinary ground, 0.7, as a margin."""

    friction_use: float = quantity(0.8, "", 0.1, 1.0)
    """Share of the ground's friction coefficient that planned contact forces use at most."""

    ball_twist: BallTwist = BallTwist()
    """Limit of the moment about the vertical of a foot whose heel is up."""

    contact_height: float = quantity(0.008, "m", 0.001, 0.05)
    """Height of a contact point above the ground from which on it carries no force."""

    knee_margin: float = quantity(0.1, "rad", 0.0, 0.5)
    """Flexion at which the knee's range ends here; a straight leg cannot be shortened."""

    rotation_radius: float = quantity(1.0, "m", 0.01, 10.0)
    """Length by which angular accelerations are multiplied where they are weighed against those of points."""

    force_unit: float = quantity(1000.0, "N", 1.0, 1e6)
    """Force along an edge of a friction pyramid that costs as much as an acceleration error of 1 m/s2 with the weight 1
    (our choice); distributes the load over the contact points."""

    torque_unit: float = quantity(3.6, "N m", 0.1, 1e6)
    """Torque of a joint of the legs that costs as much as an acceleration error of 1 m/s2 with the weight 1. It matters
    where the tasks leave the torques free: the two legs do not work against each other in double support
    (docs/likeness_trials.md, "Which mechanisms make the forces human?")."""

    force_pivot: ForcePivot = ForcePivot()
    """Directions of the forces in double support."""

    max_contact_force: float = quantity(1500.0, "N", 100.0, 1e5)
    """Maximum force along each edge (our choice): twice the weight of the body."""

    joint_limit_stiffness: float = quantity(900.0, "1/s2", 0.0, 1e4)
    """Bound of a joint's acceleration toward its limit per distance (our choice): a critically damped stop with a time
    constant of 1/30 s."""

    joint_limit_damping: float = quantity(60.0, "1/s", 0.0, 500.0)
    """The same per velocity."""

    joint_limit_acceleration: float = quantity(1000.0, "rad/s2", 10.0, 1e5)
    """Largest acceleration that a joint limit requires."""

    hold: float = quantity(0.02, "s", 0.0, 0.2)
    """Time for which the last torques are held after a QP failure; then the joints are only damped."""
