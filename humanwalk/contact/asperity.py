"""The thesis' contact law (2.4, 2.5): a normal penalty per area, and friction of asperities.

Friction is a spring to an anchor on the ground, which breaks away and is dragged along, in parallel with a Coulomb law
of two segments over velocity. Within its bounds the law is linear. In the surface frame S (axes x and y along the
surface, z its normal) the force on a point with the area A, the stretch of its spring and its height above the surface
in e, is

    f = A p n - K e - C e'     (Eq 2-32 with the distance that it lost, E8).

Every function takes any number of contact points at once.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity

TINY = 1e-300
"""Turns 0 / 0 into 0."""


@dataclass(frozen=True)
class Knot:
    """A corner of a piecewise linear multiplier, which is constant before the first and after the last."""

    at: float = quantity(0.0, "", 0.0, 1e9)
    """Time [s] or pressure [Pa]."""

    factor: float = quantity(1.0, "", 0.0, 100.0)
    """Factor on the coefficient of friction."""


@dataclass(frozen=True)
class AsperityParameters:
    """The thesis' contact law with its values (2.5), except where erratum E8 shows that they cannot hold a body.

    The coefficient of friction is the terrain's.
    """

    time_multiplier: tuple[Knot, ...] = ()
    """Factor on the coefficient of friction over time; no knots stand for the thesis' constant 1."""

    pressure_multiplier: tuple[Knot, ...] = ()
    """Factor on the coefficient of friction over the normal pressure; no knots stand for the thesis' constant 1."""

    spring_stiffness: float = quantity(5e7, "N/m3", 1e3, 1e9)
    """Stiffness of the asperity spring per area (thesis)."""

    velocity_stiffness: float = quantity(1e6, "N s/m3", 0.0, 1e9)
    """Slope of the velocity law's first segment per area (thesis)."""

    breaking_factor: float = quantity(0.975, "", 0.0, 1.0)
    """Fraction of mu f_n at which an asperity breaks away (thesis' max asperity breaking factor)."""

    normal_stiffness: float = quantity(5e7, "N/m3", 1e3, 3e8)
    """Stiffness along the normal per area. The thesis' 0 cannot carry weight; E8 derives 1.5e7 to 5e7, with which quiet
    standing sinks by 1.0 to 0.3 mm."""

    normal_damping: float = quantity(4e5, "N s/m3", 0.0, 1e8)
    """Damping along the normal per area. The thesis' 8000 gives a standing body a damping ratio of 0.014, this one 0.7
    (E8)."""

    separation_damping: float = quantity(1.0, "", 0.0, 10.0)
    """Factor on the normal damping while the surfaces separate (thesis); the force never becomes a pull."""

    normal_pressure: float = quantity(0.0, "Pa", 0.0, 1e6)
    """Pressure that is added wherever there is contact (thesis' normal contact force per area)."""

    stiction: float = quantity(0.0, "N", 0.0, 1e3)
    """Largest pull on one point while it is below the surface (thesis' normal stiction force)."""

    averaging: float = quantity(0.75, "", 0.0, 0.99)
    """Weight of the last step in the running mean of the normal force that bounds friction. The thesis gives the value
    (normal averaging factor) but not its use; this use is our choice."""

    mobility_period: float = quantity(0.01, "s", 0.0005, 0.05)
    """Time between two updates of the mobility of the foot bodies, on which the implicit step is based (our choice)."""

    def __post_init__(self) -> None:
        for name in ("time_multiplier", "pressure_multiplier"):
            for place, (earlier, later) in enumerate(pairwise(getattr(self, name))):
                if later.at <= earlier.at:
                    raise ParameterError(
                        f"contact.asperity.{name}.{place + 1}.at: {later.at:g} comes after {earlier.at:g}; allowed: "
                        "increasing numbers; sort the knots"
                    )


def point_stiffness(parameters: AsperityParameters, area: Array) -> Array:
    """Return the stiffness of n points with areas [m2], shape (n,), along the surface's x, y, normal [N/m], (n, 3)."""
    tangential = parameters.spring_stiffness
    return np.outer(area, (tangential, tangential, parameters.normal_stiffness))


def point_damping(parameters: AsperityParameters, area: Array, rising: bool = False) -> Array:
    """Return the damping of n points like `point_stiffness` [N s/m]; `rising` points move away from the surface."""
    tangential = parameters.velocity_stiffness
    normal = parameters.normal_damping * (parameters.separation_damping if rising else 1.0)
    return np.outer(area, (tangential, tangential, normal))


def friction_bound(
    parameters: AsperityParameters, mu: Array | float, normal: Array, load: Array, area: Array, time: float
) -> Array:
    """Return the largest friction force of each point [N]: mu, with its multipliers, times the normal force.

    Args:
        parameters: Of the law.
        mu: Coefficient of friction of the terrain at the points.
        normal: Normal force of the points [N], any shape.
        load: Running mean of the normal force [N]. The smaller of the two counts, so that a normal force that falls
            faster than its mean leaves no more friction than mu times itself.
        area: Area of the points [m2].
        time: Time [s].
    """
    factor = _multiplier(parameters.time_multiplier, time) * _multiplier(parameters.pressure_multiplier, normal / area)
    return mu * factor * np.maximum(np.minimum(load, normal), 0.0)


def _multiplier(knots: tuple[Knot, ...], at: Array | float) -> Array | float:
    if not knots:
        return 1.0
    return np.interp(at, [knot.at for knot in knots], [knot.factor for knot in knots])


def normal_force(parameters: AsperityParameters, linear: Array, height: Array) -> Array:
    """Return the normal force of points [N]: the linear law below the surface, limited to the stiction as a pull.

    `linear` is A p - K h - C h' along the normal [N], `height` is h of the points above the surface [m].
    """
    return np.where(height < 0.0, np.maximum(linear, -parameters.stiction), 0.0)


def friction_force(parameters: AsperityParameters, spring: Array, linear: Array, bound: Array) -> tuple[Array, Array]:
    """Return asperity spring and velocity law, limited together to Coulomb's bound.

    The spring breaks away at its breaking factor times the bound: the anchor is then dragged behind the point, so that
    the spring stays at this limit. The velocity law grows by its slope and is cut off where both reach the bound.

    Args:
        parameters: Of the law.
        spring: K e of the points along the surface, from anchor to point [N], shape (n, 2).
        linear: - K e - C e' along the surface [N], shape (n, 2).
        bound: mu f_n >= 0 [N], shape (n,).

    Returns:
        Force on each point [N], shape (n, 2), and the fraction of its stretch that each spring keeps, shape (n,).
    """
    kept = limit_ratio(parameters.breaking_factor * bound, norm(spring))
    force = linear + (1.0 - kept)[:, None] * spring
    return force * limit_ratio(bound, norm(force))[:, None], kept


def norm(vectors: Array) -> Array:
    """Return the lengths of n vectors along the surface, shape (n,) for (n, 2)."""
    return np.hypot(vectors[:, 0], vectors[:, 1])


def limit_ratio(limit: Array, magnitude: Array) -> Array:
    """Return the factor in [0, 1] that reduces magnitudes to their limit; 1 where the limit is not exceeded."""
    return np.minimum(1.0, limit / (magnitude + TINY))
