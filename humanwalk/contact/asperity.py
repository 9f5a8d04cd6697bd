"""The thesis' contact law (2.4, 2.5): a normal penalty per area, and friction of asperities.

Friction is a spring to an anchor on the ground, which breaks away and is dragged along, in parallel with a Coulomb law
of two segments over velocity. Within its bounds the law is linear: along the surface's axes x and y and its normal, a
point with the area A that is e = [stretch of its spring, height above the surface] away from rest is pushed by

    f = A p n - K e - C e'     (Eq 2-32 with the distance that it lost, E8).

Every function acts on any number of contact points at once. A vector along the surface is a complex number.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity

Complex = npt.NDArray[np.complex128]

# Arrays: numpy takes them quicker than Python's numbers.
ZERO, ONE = np.array(0.0), np.array(1.0)
TINY = np.array(1e-300)
"""Makes 0 / 0 a 0."""


@dataclass(frozen=True)
class Knot:
    """A corner of a piecewise linear multiplier, which is constant before the first and after the last."""

    at: float = quantity(0.0, "", 0.0, 1e9)
    """Time [s] or pressure [Pa]."""

    factor: float = quantity(1.0, "", 0.0, 100.0)


@dataclass(frozen=True)
class AsperityParameters:
    """Contact of `contact: asperity`: the thesis' numbers (2.5), and those of erratum E8 where they cannot stand."""

    friction: float = quantity(0.7, "", 0.0, 10.0)
    """Coefficient of friction mu (thesis)."""

    time_multiplier: tuple[Knot, ...] = ()
    """Factor on mu over time; none is the thesis' 1."""

    pressure_multiplier: tuple[Knot, ...] = ()
    """Factor on mu over the normal pressure; none is the thesis' 1."""

    spring_stiffness: float = quantity(5e7, "N/m3", 1e3, 1e9)
    """Of the asperity spring, per area (thesis)."""

    velocity_stiffness: float = quantity(1e6, "N s/m3", 0.0, 1e9)
    """Slope of the velocity law's first segment, per area (thesis)."""

    breaking_factor: float = quantity(0.975, "", 0.0, 1.0)
    """Share of mu f_n at which an asperity breaks away (thesis' max asperity breaking factor)."""

    normal_stiffness: float = quantity(5e7, "N/m3", 1e3, 3e8)
    """Per area. The thesis' 0 carries nobody; E8 derives 1.5e7 to 5e7: quiet standing sinks in 1.0 to 0.3 mm."""

    normal_damping: float = quantity(4e5, "N s/m3", 0.0, 1e8)
    """Per area. With the thesis' 8000 a standing body has a damping ratio of 0.014; this gives 0.7 (E8)."""

    separation_damping: float = quantity(1.0, "", 0.0, 10.0)
    """Factor on the damping while the surfaces part (thesis); the force is never below zero, so it does not pull."""

    normal_pressure: float = quantity(0.0, "Pa", 0.0, 1e6)
    """Added wherever there is contact (thesis' normal contact force per area)."""

    stiction: float = quantity(0.0, "N", 0.0, 1e3)
    """Greatest pull of one point while it is below the surface (thesis' normal stiction force)."""

    averaging: float = quantity(0.75, "", 0.0, 0.99)
    """Weight of the last step in the running mean of the normal force that bounds friction. The thesis gives the
    number (normal averaging factor) and not its use; this use is ours."""

    def __post_init__(self) -> None:
        for name in ("time_multiplier", "pressure_multiplier"):
            for place, (earlier, later) in enumerate(pairwise(getattr(self, name))):
                if later.at <= earlier.at:
                    raise ParameterError(
                        f"asperity.{name}.{place + 1}.at: {later.at:g} comes after {earlier.at:g}; allowed: growing "
                        "numbers; sort the knots"
                    )


def point_stiffness(parameters: AsperityParameters, area: Array) -> Array:
    """K of n points with an area [m2] [N/m], shape (3 n,): x and y of each point first, then the normals."""
    return _of_points(parameters.spring_stiffness * area, parameters.normal_stiffness * area)


def point_damping(parameters: AsperityParameters, area: Array, rising: Array | bool = False) -> Array:
    """C of points, likewise [N s/m]; along the normal it counts by its separation factor where they rise."""
    factor = np.where(rising, parameters.separation_damping, 1.0)
    return _of_points(parameters.velocity_stiffness * area, factor * parameters.normal_damping * area)


def _of_points(along: Array, normal: Array) -> Array:
    return np.concatenate((np.repeat(along, 2), normal))


def friction_bound(parameters: AsperityParameters, normal: Array, load: Array, area: Array, time: float) -> Array:
    """mu, with its multipliers, times the normal force: the most that friction may be [N].

    Args:
        parameters: of the law.
        normal: force of the points along the normal [N], any shape.
        load: its running mean; one that falls faster must not leave more friction than mu times what is left of it.
        area: of the points [m2].
        time: [s].
    """
    firm = np.minimum(load, normal)
    if parameters.stiction:
        firm = np.maximum(firm, ZERO)
    mu = parameters.friction
    if parameters.time_multiplier:
        mu *= float(_multiplier(parameters.time_multiplier, np.asarray(time)))
    bound: Array = mu * firm
    if parameters.pressure_multiplier:
        bound *= _multiplier(parameters.pressure_multiplier, normal / area)
    return bound


def _multiplier(knots: tuple[Knot, ...], at: Array) -> Array:
    return np.interp(at, [knot.at for knot in knots], [knot.factor for knot in knots])


def normal_force(parameters: AsperityParameters, linear: Array, height: Array) -> Array:
    """The linear law's force where a point is below the surface, and never a pull beyond the stiction.

    Args:
        parameters: of the law.
        linear: A p - K h - C h' along the normal [N].
        height: h of the points above the surface [m].
    """
    force: Array = np.maximum(linear, -parameters.stiction) * (height < ZERO)
    return force


def friction_force(
    parameters: AsperityParameters, spring: Complex, linear: Complex, bound: Array
) -> tuple[Complex, Array]:
    """Asperity spring and velocity law, together never more than Coulomb's bound.

    The spring breaks away at its breaking factor times the bound: the anchor is then dragged behind the point, so that
    the spring stays at what it can hold. The velocity law grows by its slope and is cut off where both reach the bound.

    Args:
        parameters: of the law.
        spring: K e of the points along the surface, from anchor to point [N].
        linear: - K e - C e' along the surface [N].
        bound: mu f_n >= 0 [N].

    Returns:
        Force on each point [N], and the share of its stretch that its spring is left with.
    """
    kept = share(parameters.breaking_factor * bound, np.abs(spring))
    force = linear + (ONE - kept) * spring
    return force * share(bound, np.abs(force)), kept


def share(allowed: Array, wanted: Array) -> Array:
    """How much of what is wanted is allowed: 1 where all of it is."""
    portion: Array = np.minimum(ONE, allowed / (wanted + TINY))
    return portion
