"""The closed foot path of walking, one for both legs, and its timing by the distance walked.

The thesis gives each leg its own path, and the two never keep step (erratum E26). Here both legs
use one loop, half a cycle apart: appendix A's swing over a stance that is exactly flat (E27).

Path frame: x forward, z up [m]; z = 0 is the ground while walking, the hip is above x = L/2, so a
standing foot is at (L/2, -offset) (E32). The phase of a foot is 0 at touchdown, grows with the
distance d that the pelvis walks (d phase / d d = duty_factor / L), and is taken modulo 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, overload

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.splines import CubicHermite, hermite_tangents
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import quintic_blend
from humanwalk.quantity import ParameterError, check, quantity

SwingLaw = Literal["thesis", "smooth"]

# Control points of appendix A's swing as shares of L and H. The code's heights H/3, H/3+C, H/2+C,
# 2H/3+C, H+C hold two lengths not tied to H: L/10+L/30 (which is H/3 at L 50, H 20, E28) and
# C = L/18 (which is 5H/36 there). Tied to H, and scaled so that the apex is H itself and not
# H + L/18 (E9, E26), they are whole 41sts, and low steps keep the shape of high ones.
_SWING_X = np.array([0, 1 / 10, 1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 5 / 6, 1])
_SWING_Z = np.array([0, 12, 17, 23, 29, 41, 29, 23, 17, 0]) / 41
_START_X = np.array([1 / 2, 3 / 4, 1])
_START_Z = np.array([0.0, 1.0, 0.0])

_END_TANGENT = 0.25  # share of L; longer turns more softly but reaches further beyond [0, L]
_CELLS = 4096


@dataclass(frozen=True)
class FootPathParameters:
    """Size and timing of the foot path (thesis 4.2.3).

    step_length: L, the travel of the foot under the hip in stance [m], 0.1..1. The step walked is
        L / (2 duty_factor), (E26).
    step_height: H, highest commanded height of the sole above the ground [m], 0.02..0.4 (E9).
    offset: how far the pelvis is lower in walking than in standing [m], 0..0.3 (E32).
    duty_factor: share of the cycle in stance, 0.55..0.8 (E26: the thesis' own is below 0.5).
    toe_drop: greatest pitch of the sole, toes down, reached at mid-swing [rad], 0..1.2. The thesis keeps the
        foot's orientation constant (4.2.3); lifting it by H = 0.2 m then takes 45 degrees of dorsiflexion, beyond
        any ankle's range. 0.45 rad keeps the ankle within 35 degrees. 0 is the thesis' assumption.
    swing: "thesis" walks a Hermite spline through appendix A's points by arc length; "smooth" is
        ours: the same ends and height with polynomials in time, and far smaller accelerations.
    """

    step_length: float = quantity(0.5, "m", 0.1, 1.0)
    step_height: float = quantity(0.2, "m", 0.02, 0.4)
    offset: float = quantity(0.05, "m", 0.0, 0.3)
    duty_factor: float = quantity(0.6, "", 0.55, 0.8)
    toe_drop: float = quantity(0.45, "rad", 0.0, 1.2)
    swing: SwingLaw = "thesis"

    def __post_init__(self) -> None:
        check(self)
        if self.swing not in ("thesis", "smooth"):
            raise ParameterError(f'swing: {self.swing!r} is unknown; allowed: "thesis" or "smooth"; choose one of them')

    @property
    def walked_step(self) -> float:
        """Length of a step over ground, L / (2 duty_factor) [m] (E26)."""
        return self.step_length / (2.0 * self.duty_factor)

    @property
    def walked_stride(self) -> float:
        """Length of a stride (two steps) over ground, L / duty_factor [m]."""
        return self.step_length / self.duty_factor

    def stride_time(self, speed: float) -> float:
        """Time of a full cycle [s] at `speed` [m/s]: L / (duty_factor speed); inf at rest."""
        return self.walked_stride / speed if speed > 0.0 else math.inf

    def cadence(self, speed: float) -> float:
        """Steps a minute at `speed` [m/s]."""
        return 60.0 * speed / self.walked_step


def minimum_offset(step_length: float, leg_length: float) -> float:
    """Smallest offset [m] at which a straight leg reaches both ends of stance (E32).

    step_length: L [m]; leg_length: hip to ankle [m], 0.864 for the thesis' man.
    Raises ValueError if no offset would do: L/2 beyond the leg's length.
    """
    if not 0.0 <= step_length <= 2.0 * leg_length:
        raise ParameterError(
            f"step_length: {step_length:g} is out of range; allowed: 0 to {2.0 * leg_length:g} m; "
            "no offset lets the leg reach, shorten the step"
        )
    return leg_length - math.sqrt(leg_length**2 - (0.5 * step_length) ** 2)


class SwingCurve:
    """A swing from ground to ground: (x, z) over tau in [0, 1], in the path frame [m].

    Both ends touch the ground with dx/dtau = -end_speed, dz/dtau = 0: with the speed of stance, so
    that the foot leaves and meets the ground without slip (E27). Tabulated as 4096 cubic pieces
    with exact values and slopes at the joints: C1, and within 1e-6 m of
    the exact law while H is at least L/27.
    """

    def __init__(self, x: Array, z: Array, end_speed: float, law: SwingLaw) -> None:
        tau = np.linspace(0.0, 1.0, _CELLS + 1)
        exact = thesis_swing if law == "thesis" else smooth_swing
        position, rate = exact(tau, x, z, end_speed)
        pieces = CubicHermiteSpline(tau, position, rate)
        # Plain floats: a control loop asks for one point at a time.
        self._cells: list[list[list[float]]] = pieces.c.transpose(1, 2, 0).tolist()

    def position(self, tau: float) -> tuple[float, float]:
        """(x, z) [m] at tau in [0, 1]."""
        cell, h = self._locate(tau)
        (a3, a2, a1, a0), (b3, b2, b1, b0) = self._cells[cell]
        z = ((b3 * h + b2) * h + b1) * h + b0
        return ((a3 * h + a2) * h + a1) * h + a0, max(z, 0.0)

    def derivative(self, tau: float) -> tuple[float, float]:
        """d(x, z)/dtau [m] at tau in [0, 1]."""
        cell, h = self._locate(tau)
        (a3, a2, a1, _), (b3, b2, b1, _) = self._cells[cell]
        return (3.0 * a3 * h + 2.0 * a2) * h + a1, (3.0 * b3 * h + 2.0 * b2) * h + b1

    @staticmethod
    def _locate(tau: float) -> tuple[int, float]:
        cell = min(max(int(tau * _CELLS), 0), _CELLS - 1)
        return cell, tau - cell / _CELLS


def thesis_swing(tau: Array, x: Array, z: Array, end_speed: float) -> tuple[Array, Array]:
    """Hermite spline through the points (x, z), walked by arc length; (n, 2) position and slope.

    The arc length runs s(tau) with s' = end_speed and s'' = 0 at both ends; monotone whenever the
    curve is longer than 7/15 end_speed, which every allowed parameter set meets.
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
    """Ours: over ground the foot moves rest to rest by the quintic, and lifts by 64 (tau-tau^2)^3.

    Only the ends of x and the height of z are used. Position and slope are (n, 2).
    """
    blend, blend_rate, _ = quintic_blend(tau)
    lift, lift_rate = swing_hump(tau)
    way = x[-1] - x[0] + end_speed
    position = np.column_stack([x[0] - end_speed * tau + way * blend, z.max() * lift])
    rate = np.column_stack([-end_speed + way * blend_rate, z.max() * lift_rate])
    return position, rate


@overload
def swing_hump(tau: float) -> tuple[float, float]: ...
@overload
def swing_hump(tau: Array) -> tuple[Array, Array]: ...
def swing_hump(tau: float | Array) -> tuple[float | Array, ...]:
    """64 (tau - tau^2)^3 and its derivative: 0 to 1 to 0, at rest with no acceleration at both ends."""
    product = tau * (1.0 - tau)
    return 64.0 * product**3, 192.0 * product**2 * (1.0 - 2.0 * tau)


class FootCycle:
    """Position of one sole in the path frame over its phase: stance, then swing.

    Stance, phase < duty_factor: x = L (1 - phase / duty_factor), z = 0 exactly, so the foot is
    still over ground. Swing: back from (0, 0) over the apex H to (L, 0). C1 in phase.
    """

    def __init__(self, parameters: FootPathParameters) -> None:
        self.parameters = parameters
        p = parameters
        swing_share = 1.0 - p.duty_factor
        self._swing_share = swing_share
        self._swing = SwingCurve(
            _SWING_X * p.step_length,
            _SWING_Z * p.step_height,
            p.walked_stride * swing_share,
            p.swing,
        )

    def in_stance(self, phase: float) -> bool:
        """Whether the foot of this phase is on the ground."""
        return phase % 1.0 < self.parameters.duty_factor

    def position(self, phase: float) -> tuple[float, float]:
        """(x, z) [m] in the path frame."""
        phase %= 1.0
        duty = self.parameters.duty_factor
        if phase < duty:
            return self.parameters.step_length * (1.0 - phase / duty), 0.0
        return self._swing.position((phase - duty) / self._swing_share)

    def derivative(self, phase: float) -> tuple[float, float]:
        """d(x, z)/dphase [m]."""
        phase %= 1.0
        duty = self.parameters.duty_factor
        if phase < duty:
            return -self.parameters.step_length / duty, 0.0
        x_rate, z_rate = self._swing.derivative((phase - duty) / self._swing_share)
        return x_rate / self._swing_share, z_rate / self._swing_share

    def pitch(self, phase: float) -> tuple[float, float]:
        """Pitch of the sole [rad], toes down positive, and its derivative by phase; 0 in stance."""
        phase %= 1.0
        duty = self.parameters.duty_factor
        if phase < duty:
            return 0.0, 0.0
        hump, rate = swing_hump((phase - duty) / self._swing_share)
        drop = self.parameters.toe_drop
        return drop * hump, drop * rate / self._swing_share

    def sample(self, phase: npt.ArrayLike) -> Array:
        """Positions (n, 2) [m] at many phases (n,), for plots."""
        return np.array([self.position(float(value)) for value in np.ravel(phase)])


def start_swing(parameters: FootPathParameters) -> SwingCurve:
    """First swing, from standing: thesis' (L/2, ground), (3L/4, H), then touchdown at (L, 0).

    tau = d / start_distance(parameters). Heights are above the ground: the drop of the pelvis
    (offset) is not in them.
    """
    p = parameters
    return SwingCurve(_START_X * p.step_length, _START_Z * p.step_height, start_distance(p), p.swing)


def start_distance(parameters: FootPathParameters) -> float:
    """Distance [m] that the pelvis walks until the first touchdown, L (1/(2 duty) - 1/2).

    The standing foot is then exactly half a cycle ahead (E26).
    """
    return parameters.walked_step - 0.5 * parameters.step_length
