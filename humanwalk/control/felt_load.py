"""A load that the model of the body lacks, felt as the force that the ground has to carry in addition.

Momentum and contact forces give the force on the body that nothing in its model explains, as a momentum observer does
(De Luca and Mattone 2003, ICRA, for robot arms). Its vertical part is the weight of the load, and its moment about the
center of mass tells where the load is.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.body.carried_load import NO_LOAD
from humanwalk.contact.ground_force import FootForces
from humanwalk.numerics import Array
from humanwalk.quantity import quantity


@dataclass(frozen=True)
class LoadFeeling:
    """How the walker feels a load."""

    time_constant: float = quantity(1.0, "s", 0.05, 60.0)
    """Time constant with which the load follows what is felt: a stride, over which the acceleration of the load is zero
    in the mean (docs/balance.md, "A load that is felt")."""

    least: float = quantity(0.02, "", 0.001, 10.0)
    """Mass below which no load is felt, per mass of the body; a load of twice the mass is felt whole. Impacts feel like
    up to 0.012 (docs/balance.md, "A load that is felt"). With 10 no load is felt at all."""

    largest: float = quantity(0.6, "", 0.0, 10.0)
    """Largest mass that is felt at once, per mass of the body (our choice): military packs reach 45 kg. It limits what
    an impact adds: contact forces are known once per control period, at an impact not those of the time between."""

    reach: float = quantity(0.4, "m", 0.0, 1.0)
    """Largest distance of the load from the center of mass along and across the chest (our choice): a suitcase in a
    hand. It limits how a push, which turns the body, too, moves the load that is felt."""


def unexplained_wrench(momentum_rate: Array, forces: FootForces, com: Array, weight: float) -> Array:
    """Moment about the center of mass [N m] and force [N] on the body, in W, that ground and weight do not explain.

    Args:
        momentum_rate: Of the angular momentum about the center of mass [N m] and of the momentum [N], in W, shape (6,).
        forces: Ground reactions on the feet.
        com: Center of mass in W [m], shape (3,).
        weight: Of the body [N].

    Returns:
        Shape (6,).
    """
    moments = np.cross(forces.p_WCop - com, forces.f_W)
    explained = np.concatenate((moments.sum(axis=0), forces.f_W.sum(axis=0)))
    explained[2] += forces.free_moment.sum()
    explained[5] -= weight
    return momentum_rate - explained


def limited(wrench: Array, force: float) -> Array:
    """The wrench, reduced in proportion if its vertical force is larger than a limit [N], shape (6,)."""
    return wrench * min(1.0, force / max(abs(float(wrench[5])), 1e-9))


def felt_load(wrench: Array, mass: float, gravity: float, feeling: LoadFeeling) -> Array:
    """Mass of the load [kg], and its position relative to the center of mass [m], shape (4,).

    The load is at the height of the center of mass: a vertical force does not tell its height, and the height of the
    body's center of mass above the ground is the same with it.

    Args:
        wrench: Moment about the center of mass [N m] and force [N] that are felt, z up, shape (6,).
        mass: Of the body [kg].
        gravity: [m/s2].
        feeling: Least load and greatest distance.
    """
    weight, least = -float(wrench[5]), feeling.least * mass
    felt = weight / gravity
    if felt <= least:
        return NO_LOAD
    along, across = np.clip((wrench[1] / weight, -wrench[0] / weight), -feeling.reach, feeling.reach)
    return np.array((felt * min(felt / least - 1.0, 1.0), along, across, 0.0))
