"""The thesis' contact law (2.4, 2.5): a normal penalty per area, and friction of asperities.

Friction is a spring to an anchor on the ground, which breaks away and is dragged along, in parallel with a Coulomb law
of two segments over velocity. Every function acts on any number of contact points at once; a point is a piece of sole
with an area.

Lengths count positive into the ground: `depth` [m] and its rate [m/s]. A vector along the surface is a complex number.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from humanwalk.quantity import ParameterError, quantity

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

TINY = 1e-300
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


def friction_coefficient(parameters: AsperityParameters, pressure: Array, time: float) -> Array | float:
    """mu with its multipliers.

    Args:
        parameters: of the law.
        pressure: normal force per area [Pa], any shape; the result has it, too, or is one number.
        time: [s].
    """
    mu: Array | float = parameters.friction
    if parameters.time_multiplier:
        mu *= float(_multiplier(parameters.time_multiplier, np.asarray(time)))
    if parameters.pressure_multiplier:
        mu = mu * _multiplier(parameters.pressure_multiplier, pressure)
    return mu


def _multiplier(knots: tuple[Knot, ...], at: Array) -> Array:
    return np.interp(at, [knot.at for knot in knots], [knot.factor for knot in knots])


def normal_force(parameters: AsperityParameters, area: Array, depth: Array, rate: Array) -> Array:
    """F = A (p + kp d + cp d'), cp times the separation factor while d' < 0; never a pull beyond the stiction.

    Eq 2-32 with the distance that it lost (E8); zero above the surface.

    Args:
        parameters: of the law.
        area: of each point [m2].
        depth, rate: how far below the surface it is [m], and how fast it goes deeper [m/s].

    Returns:
        Force along the surface's normal, away from the ground [N].
    """
    pressure = parameters.normal_stiffness * depth + normal_damping(parameters, rate) * rate
    pressure += parameters.normal_pressure
    force: Array = np.maximum(area * pressure, -parameters.stiction) * (depth > 0.0)
    return force


def normal_damping(parameters: AsperityParameters, rate: Array) -> Array | float:
    """Damping per area [N s/m3] at a rate of the depth [m/s]."""
    if parameters.separation_damping == 1.0:
        return parameters.normal_damping
    return parameters.normal_damping * np.where(rate < 0.0, parameters.separation_damping, 1.0)


def friction_force(
    parameters: AsperityParameters, area: Array, stretch: Complex, velocity: Complex, bound: Array
) -> tuple[Complex, Complex]:
    """Asperity spring and velocity law, together never more than Coulomb's bound.

    The spring breaks away at its breaking factor times the bound: the anchor is then dragged behind the point, so that
    the spring stays at what it can hold. The velocity law grows by its slope and is cut off where both reach the bound.

    Args:
        parameters: of the law.
        area: of each point [m2].
        stretch: from anchor to point [m].
        velocity: of the point along the surface [m/s].
        bound: mu f_n >= 0 [N].

    Returns:
        Force on each point [N], and the stretch that its spring is left with [m].
    """
    spring = parameters.spring_stiffness * area
    held = stretch * share(parameters.breaking_factor * bound, spring * np.abs(stretch))
    force = -spring * held - (parameters.velocity_stiffness * area) * velocity
    return force * share(bound, np.abs(force)), held


def share(allowed: Array, wanted: Array) -> Array:
    """How much of what is wanted is allowed: 1 where all of it is."""
    portion: Array = np.minimum(1.0, allowed / (wanted + TINY))
    return portion
