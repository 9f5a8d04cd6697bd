"""Arc-length parametrization of a spline.

The thesis resamples its curves with a greedy rule that gives 9 to 10 % less than the desired speed and can leave the
curve (erratum E16); here the arc length is integrated and inverted to rounding.
"""

import numpy as np
import numpy.typing as npt

from humanwalk.gait.splines import CubicHermite
from humanwalk.numerics import Array

_PANELS_PER_SEGMENT = 8
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


class ArcLength:
    """A spline as a function of its arc length s in [0, length], in the unit of the control points.

    Lengths come from 16-point Gauss-Legendre integration on eighths of a segment, the inverse from bracketed Newton
    steps.
    """

    def __init__(self, spline: CubicHermite) -> None:
        self.spline = spline
        panels = spline.segments * _PANELS_PER_SEGMENT
        self._u_of_panel = np.linspace(0.0, spline.segments, panels + 1)
        lengths = self._integral(self._u_of_panel[:-1], self._u_of_panel[1:])
        self._s_of_panel = np.concatenate([[0.0], np.cumsum(lengths)])
        if self.length <= 0.0:
            raise ValueError("control_points make a curve of length 0; it must be > 0: give distinct points")

    @property
    def length(self) -> float:
        """Length of the curve."""
        return float(self._s_of_panel[-1])

    def parameter_at(self, s: npt.ArrayLike) -> Array:
        """Global parameter u at which the arc length is s, shape of s.

        Raises ValueError if an s lies outside [0, length].
        """
        target = np.asarray(s, dtype=np.float64)
        slack = 1e-12 * self.length
        inside = (target >= -slack) & (target <= self.length + slack)
        if not np.all(inside):
            raise ValueError(
                f"s = {target[~inside].flat[0]:g} is outside [0, {self.length:g}]: s is the distance along the curve"
            )
        target = np.clip(target, 0.0, self.length)
        panel = np.clip(np.searchsorted(self._s_of_panel, target, side="right") - 1, 0, len(self._s_of_panel) - 2)
        start, s_start = self._u_of_panel[panel], self._s_of_panel[panel]
        low, high = start, self._u_of_panel[panel + 1]
        span = self._s_of_panel[panel + 1] - s_start
        fraction = np.divide(target - s_start, span, out=np.zeros_like(target), where=span > 0.0)
        u = low + fraction * (high - low)
        for _ in range(60):
            error = s_start + self._integral(start, u) - target
            if np.all(np.abs(error) <= 4e-16 * self.length):
                break
            low, high = np.where(error < 0.0, u, low), np.where(error > 0.0, u, high)
            speed = self._speed(u)
            newton = u - np.divide(error, speed, out=np.full_like(u, np.inf), where=speed > 0.0)
            u = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        return np.asarray(u)

    def position(self, s: npt.ArrayLike) -> Array:
        """Points at arc length s: shape (..., d)."""
        return self.spline.position(self.parameter_at(s))

    def resample(self, ds: float) -> Array:
        """Points at s = 0, ds, 2 ds, ... up to the end: shape (n, d).

        With ds = speed * time step this is the constant speed that the thesis intends (E16).
        Raises ValueError unless 0 < ds <= length.
        """
        if not 0.0 < ds <= self.length:
            raise ValueError(f"ds = {ds:g} is outside (0, {self.length:g}]: give a spacing within the curve")
        count = int(np.floor(self.length / ds * (1.0 + 1e-12)))
        return self.position(np.minimum(np.arange(count + 1) * ds, self.length))

    def _speed(self, u: Array) -> Array:
        return np.asarray(np.linalg.norm(self.spline.derivative(u), axis=-1))

    def _integral(self, start: Array, stop: Array) -> Array:
        half = 0.5 * (stop - start)
        u = start[..., None] + half[..., None] * (_NODES + 1.0)
        return np.asarray(half * (self._speed(u) @ _WEIGHTS))
