"""Three splines over control points, one segment per unit of the global parameter u.

The thesis compares a quadratic B-spline (Eq 4-10..4-13), a cubic that it calls Hermite but whose
weights are the uniform cubic B-spline's (Eq 4-17..4-20, erratum E5), and the true cubic Hermite
spline that its programs use (appendices A and B). Evaluation is scipy's.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BSpline, CubicHermiteSpline, PPoly

from humanwalk.numerics import Array


def _checked_points(control_points: npt.ArrayLike, minimum: int) -> Array:
    points = np.array(control_points, dtype=np.float64)
    if points.ndim != 2 or len(points) < minimum or not np.all(np.isfinite(points)):
        raise ValueError(
            f"control_points has shape {points.shape}; it must be (n, d) with n >= {minimum} and "
            "finite numbers: give one row a point"
        )
    return points


class Spline:
    """A piecewise polynomial curve with `segments` pieces; u runs over [0, segments].

    Lengths have the unit of the control points; u has none.
    """

    def __init__(self, curve: PPoly | BSpline, segments: int, control_points: Array) -> None:
        self._curve = curve
        self.segments = segments
        self.control_points = control_points
        self.control_points.flags.writeable = False

    @property
    def dimension(self) -> int:
        """Number d of coordinates of a point."""
        return int(self.control_points.shape[1])

    def position(self, u: npt.ArrayLike) -> Array:
        """Points at the global parameter u: shape (..., d) for u of shape (...).

        Raises ValueError if a u lies outside [0, segments].
        """
        return self.derivative(u, order=0)

    def derivative(self, u: npt.ArrayLike, order: int = 1) -> Array:
        """Derivative of the given order with respect to u: shape (..., d).

        At a joint of two segments it is the value of the segment that begins there.
        Raises ValueError if a u lies outside [0, segments].
        """
        values = np.asarray(u, dtype=np.float64)
        inside = (values >= 0.0) & (values <= self.segments)
        if not np.all(inside):
            worst = values[~inside].flat[0]
            raise ValueError(
                f"u = {worst:g} is outside [0, {self.segments}]: u counts segments from the start of the curve"
            )
        return np.asarray(self._curve(values, nu=order), dtype=np.float64)


class CubicHermite(Spline):
    """Cubic Hermite spline: passes through every control point; C1.

    The tangent at point i is 0.5 (P[i+1] - P[i-1]), at the two ends 0.5 (neighbour difference),
    as in the programs of appendices A and B, unless `tangents` (n, d) [length per segment] are
    given. `closed` adds the segment from the last point back to the first.
    """

    def __init__(
        self,
        control_points: npt.ArrayLike,
        tangents: npt.ArrayLike | None = None,
        closed: bool = False,
    ) -> None:
        points = _checked_points(control_points, 3 if closed else 2)
        slopes = hermite_tangents(points, closed) if tangents is None else np.asarray(tangents)
        if slopes.shape != points.shape:
            raise ValueError(
                f"tangents has shape {slopes.shape}; it must be {points.shape} as control_points: "
                "give one tangent a point"
            )
        knots, slopes = (_wrapped(points, 1), _wrapped(slopes, 1)) if closed else (points, slopes)
        segments = len(knots) - 1
        curve = CubicHermiteSpline(np.arange(segments + 1.0), knots, slopes)
        super().__init__(curve, segments, points)
        self.coefficients: Array = np.ascontiguousarray(curve.c[::-1].transpose(1, 2, 0))
        """Of the powers 0 to 3 of u within each segment, for each coordinate; shape (segments, d, 4)."""


class _UniformBSpline(Spline):
    degree: int

    def __init__(self, control_points: npt.ArrayLike, closed: bool = False) -> None:
        k = self.degree
        points = _checked_points(control_points, k + 1)
        coefficients = _wrapped(points, k) if closed else points
        n = len(coefficients)
        curve = BSpline(np.arange(n + k + 1.0) - k, coefficients, k)
        super().__init__(curve, n - k, points)


class UniformQuadraticBSpline(_UniformBSpline):
    """Uniform quadratic B-spline (Eq 4-10..4-13): C1, misses its control points.

    Segment i has the weights (1 - 2u + u^2, 1 + 2u - 2u^2, u^2) / 2 on points i, i+1, i+2.
    """

    degree = 2


class UniformCubicBSpline(_UniformBSpline):
    """Uniform cubic B-spline, which the thesis calls Hermite (Eq 4-17..4-20, E5): C2, misses too.

    Segment i has the weights (1-3u+3u^2-u^3, 4-6u^2+3u^3, 1+3u+3u^2-3u^3, u^3) / 6 on i..i+3.
    """

    degree = 3


def hermite_tangents(control_points: npt.ArrayLike, closed: bool = False) -> Array:
    """Tangents of appendices A and B, (n, d): 0.5 (P[i+1] - P[i-1]), at open ends 0.5 (difference).

    Unit: that of the control points, per segment.
    """
    points = np.asarray(control_points, dtype=np.float64)
    padded = (
        np.concatenate([points[-1:], points, points[:1]])
        if closed
        else np.concatenate([points[:1], points, points[-1:]])
    )
    return np.asarray(0.5 * (padded[2:] - padded[:-2]), dtype=np.float64)


def _wrapped(points: Array, count: int) -> Array:
    return np.concatenate([points, points[:count]])
