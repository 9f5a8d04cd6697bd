"""The closed foot path of walking, one for both legs, and its timing by the distance walked.

The thesis gives each leg a path of its own, and the phases of the two drift apart (erratum E26). Here both legs use one
loop, half a cycle apart: appendix A's swing over a stance that is exactly flat (E27).

Path frame: x forward, z up [m]; z = 0 is the ground in walking, the hip is above x = L/2, so a standing foot is at
(L/2, -offset) (E32). The phase of a foot is 0 at touchdown, grows with the distance d that the pelvis walks
(d phase / d d = duty_factor / L), and is taken modulo 1.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, overload

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.splines import CubicHermite, hermite_tangents
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import quintic_blend
from humanwalk.quantity import ParameterError, check, quantity

SwingLaw = Literal["thesis", "smooth"]

# Control points of appendix A's swing as fractions of L and H. The program's heights H/3, H/3+C, H/2+C, 2H/3+C, H+C
# contain two lengths independent of H: L/10+L/30 (which is H/3 at L 50, H 20, E28) and C = L/18 (which is 5H/36 there).
# In proportion to H, and scaled so that the apex is H and not H + L/18 (E9, E26), they are multiples of 1/41, and low
# steps have the shape of high ones.
_SWING_X = np.array([0, 1 / 10, 1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 5 / 6, 1])
_SWING_Z = np.array([0, 12, 17, 23, 29, 41, 29, 23, 17, 0]) / 41
_START_X = np.array([1 / 2, 3 / 4, 1])
_START_Z = np.array([0.0, 1.0, 0.0])

_END_TANGENT = 0.25
"""Tangent at both ends as a fraction of L; a longer one turns more softly but reaches farther beyond [0, L]."""

TABLE_SIZE = 4096
"""Pieces of the table of a swing."""


@dataclass(frozen=True)
class FootPathParameters:
    """Size and timing of the foot path (thesis 4.2.3)."""

    step_length: float = quantity(0.5, "m", 0.1, 1.0)
    """L, travel of the foot under the hip in stance. The step over ground is L / (2 duty_factor) (E26)."""

    step_height: float = quantity(0.2, "m", 0.02, 0.4)
    """H, maximum height of the sole above the ground (E9)."""

    offset: float = quantity(0.05, "m", 0.0, 0.3)
    """Height of the pelvis in standing above that in walking (E32)."""

    duty_factor: float = quantity(0.6, "", 0.55, 0.8)
    """Fraction of the cycle in stance (E26: the thesis' own is below 0.5)."""

    toe_drop: float = quantity(0.45, "rad", 0.0, 1.2)
    """Maximum pitch of the sole, toes down, reached at mid-swing. The thesis keeps the orientation of the foot constant
    (4.2.3), which is 0 here; lifting it by H = 0.2 m then needs 45 degrees of dorsiflexion, beyond the range of any
    ankle. 0.45 rad keeps the ankle within 35 degrees."""

    swing: SwingLaw = "thesis"
    """`thesis` is a Hermite spline through appendix A's points by arc length; `smooth` is ours: the same ends and
    height with polynomials in time, and far smaller accelerations."""

    def __post_init__(self) -> None:
        check(self)
        if self.swing not in SWING_LAWS:
            raise ParameterError(f"swing: {self.swing!r} is unknown; allowed: {' or '.join(SWING_LAWS)}; choose one")

    @property
    def walked_step(self) -> float:
        """Length of a step over ground, L / (2 duty_factor) [m] (E26)."""
        return self.step_length / (2.0 * self.duty_factor)

    @property
    def walked_stride(self) -> float:
        """Length of a stride (two steps) over ground, L / duty_factor [m]."""
        return self.step_length / self.duty_factor


def minimum_offset(step_length: float, leg_length: float) -> float:
    """Smallest offset [m] at which a straight leg reaches both ends of stance (E32).

    step_length: L [m]; leg_length: hip to ankle [m], 0.864 for the thesis' man.
    Raises ParameterError if there is none: L/2 exceeds the leg's length.
    """
    if not 0.0 <= step_length <= 2.0 * leg_length:
        raise ParameterError(
            f"step_length: {step_length:g} is out of range; allowed: 0 to {2.0 * leg_length:g} m; "
            "no offset lets the leg reach, shorten the step"
        )
    return leg_length - math.sqrt(leg_length**2 - (0.5 * step_length) ** 2)


class SwingCurve:
    """A swing from ground to ground: (x, z) over tau in [0, 1], in the path frame [m].

    Both ends touch the ground with dx/dtau = -end_speed, dz/dtau = 0: the speed of stance, so that the foot leaves and
    meets the ground without slip (E27). A table of cubic pieces with exact values and slopes at the knots: C1, and
    within 1e-6 m of the exact law for H of at least L/27.
    """

    def __init__(self, x: Array, z: Array, end_speed: float, law: SwingLaw) -> None:
        tau = np.linspace(0.0, 1.0, TABLE_SIZE + 1)
        self._begin, self._end_speed = float(x[0]), end_speed
        self._step = float(x[-1]) - self._begin + end_speed
        self._curve = CubicHermiteSpline(tau, *SWING_LAWS[law](tau, x, z, end_speed))

    def position(self, tau: float) -> tuple[float, float]:
        """(x, z) [m] at tau in [0, 1]."""
        x, z = self._curve(tau).tolist()
        return x, max(z, 0.0)

    def derivative(self, tau: float) -> tuple[float, float]:
        """d(x, z)/dtau [m] at tau in [0, 1]."""
        x, z = self._curve(tau, nu=1).tolist()
        return x, z

    def way(self, tau: Array) -> tuple[Array, Array]:
        """Share of the step over ground that the foot has made at tau, and its derivative; at rest at both ends."""
        x, rate = self._curve(tau)[..., 0], self._curve(tau, nu=1)[..., 0]
        return (x - self._begin + self._end_speed * tau) / self._step, (rate + self._end_speed) / self._step


def thesis_swing(tau: Array, x: Array, z: Array, end_speed: float) -> tuple[Array, Array]:
    """Hermite spline through the points (x, z) as a function of arc length; (n, 2) position and slope.

    The arc length is s(tau) with s' = end_speed and s'' = 0 at both ends; it is monotone if the curve is longer than
    7/15 end_speed, which holds for all allowed parameters.
    """
    points = np.column_stack([x, z])
    tangents = hermite_tangents(points)
    tangents[0] = tangents[-1] = (-_END_TANGENT * x[-1], 0.0)
    curve = ArcLength(CubicHermite(points, tangents))
    blend, blend_rate, _ = quintic_blend(tau)
    s = end_speed * tau + (curve.length - end_speed) * blend
    s_rate = end_speed + (curve.length - end_speed) * blend_rate
    u = curve.parameter_at(s)
    direction = curve.spline.derivative(u)
    direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    return curve.spline.position(u), direction * s_rate[:, None]


def smooth_swing(tau: Array, x: Array, z: Array, end_speed: float) -> tuple[Array, Array]:
    """Ours: relative to stance the foot moves from rest to rest by a quintic, and lifts by 64 (tau - tau^2)^3.

    Only the ends of x and the height of z are used. Position and slope are (n, 2).
    """
    blend, blend_rate, _ = quintic_blend(tau)
    lift, lift_rate = swing_hump(tau)
    travel = x[-1] - x[0] + end_speed
    position = np.column_stack([x[0] - end_speed * tau + travel * blend, z.max() * lift])
    return position, np.column_stack([-end_speed + travel * blend_rate, z.max() * lift_rate])


@overload
def swing_hump(tau: float) -> tuple[float, float]: ...
@overload
def swing_hump(tau: Array) -> tuple[Array, Array]: ...
def swing_hump(tau: float | Array) -> tuple[float | Array, ...]:
    """64 (tau - tau^2)^3 and its derivative: 0 to 1 to 0, with velocity and acceleration 0 at both ends."""
    product = tau * (1.0 - tau)
    return 64.0 * product**3, 192.0 * product**2 * (1.0 - 2.0 * tau)


SWING_LAWS: dict[SwingLaw, Callable[[Array, Array, Array, float], tuple[Array, Array]]] = {
    "thesis": thesis_swing,
    "smooth": smooth_swing,
}
"""Position and slope, (n, 2) each, over tau (n,) for control points x, z and the speed at both ends."""


class FootCycle:
    """Position of one sole in the path frame over its phase: stance, then swing.

    Stance, phase < duty_factor: x = L (1 - phase / duty_factor), z = 0 exactly, so the foot does not move over ground.
    Swing: from (0, 0) over the apex H to (L, 0), the curve `swing`. C1 in phase.
    """

    def __init__(self, parameters: FootPathParameters) -> None:
        self.parameters = p = parameters
        self._swing_fraction = 1.0 - p.duty_factor
        end_speed = p.walked_stride * self._swing_fraction
        self.swing = SwingCurve(_SWING_X * p.step_length, _SWING_Z * p.step_height, end_speed, p.swing)

    def in_stance(self, phase: float) -> bool:
        """Whether the foot of this phase is on the ground."""
        return phase % 1.0 < self.parameters.duty_factor

    def position(self, phase: float) -> tuple[float, float]:
        """(x, z) [m] in the path frame."""
        if self.in_stance(phase):
            return self.parameters.step_length * (1.0 - phase % 1.0 / self.parameters.duty_factor), 0.0
        return self.swing.position(self._tau(phase))

    def derivative(self, phase: float) -> tuple[float, float]:
        """d(x, z)/dphase [m]."""
        if self.in_stance(phase):
            return -self.parameters.step_length / self.parameters.duty_factor, 0.0
        x_rate, z_rate = self.swing.derivative(self._tau(phase))
        return x_rate / self._swing_fraction, z_rate / self._swing_fraction

    def pitch(self, phase: float) -> tuple[float, float]:
        """Pitch of the sole [rad], toes down positive, and its derivative by phase; 0 in stance."""
        if self.in_stance(phase):
            return 0.0, 0.0
        hump, rate = swing_hump(self._tau(phase))
        drop = self.parameters.toe_drop
        return drop * hump, drop * rate / self._swing_fraction

    def progress(self, phase: float) -> tuple[float, float]:
        """Progress of the swing from 0 to 1, and its derivative by phase; 0 in stance."""
        return (0.0, 0.0) if self.in_stance(phase) else (self._tau(phase), 1.0 / self._swing_fraction)

    def _tau(self, phase: float) -> float:
        return (phase % 1.0 - self.parameters.duty_factor) / self._swing_fraction


def start_swing(parameters: FootPathParameters) -> SwingCurve:
    """First swing from standing: the thesis' (L/2, ground), (3L/4, H), then touchdown at (L, 0).

    tau = d / start_distance(parameters). Heights are above the ground and do not contain the drop of the pelvis.
    """
    p = parameters
    return SwingCurve(_START_X * p.step_length, _START_Z * p.step_height, start_distance(p), p.swing)


def start_distance(parameters: FootPathParameters) -> float:
    """Distance [m] that the pelvis walks until the first touchdown, L (1/(2 duty) - 1/2).

    The standing foot is then exactly half a cycle ahead (E26).
    """
    return parameters.walked_step - 0.5 * parameters.step_length
