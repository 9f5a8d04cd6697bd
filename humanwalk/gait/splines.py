"""Cubic Hermite splines over control points, one segment per unit of the global parameter u.

The splines of the thesis' programs (appendices A and B). Its text derives uniform B-splines (Eq 4-10 to 4-20), of which
it calls the cubic one Hermite (erratum E5); those do not pass through the control points and are not used.
"""

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from humanwalk.numerics import Array


class CubicHermite:
    """Cubic Hermite spline through n control points; C1.

    Lengths have the unit of the control points; u runs over [0, segments].

    Attributes:
        segments: number of cubic pieces, n - 1.
        coefficients: of the powers 0 to 3 of u within each segment, for each coordinate; shape (segments, d, 4).
    """

    def __init__(self, control_points: npt.ArrayLike, tangents: npt.ArrayLike | None = None) -> None:
        """Make the spline.

        Args:
            control_points: shape (n, d).
            tangents: shape (n, d) [length per segment]; default: `hermite_tangents`.

        Raises:
            ValueError: fewer than two points, a number that is not finite, or tangents of another shape.
        """
        points = np.asarray(control_points, dtype=np.float64)
        if points.ndim != 2 or len(points) < 2 or not np.all(np.isfinite(points)):
            raise ValueError(
                f"control_points has shape {points.shape}; it must be (n, d) with n >= 2 and finite numbers: "
                "give one row per point"
            )
        slopes = hermite_tangents(points) if tangents is None else np.asarray(tangents)
        if slopes.shape != points.shape:
            raise ValueError(
                f"tangents has shape {slopes.shape}; it must be {points.shape} as control_points: "
                "give one tangent per point"
            )
        self.segments = len(points) - 1
        self._curve = CubicHermiteSpline(np.arange(len(points)), points, slopes)
        self.coefficients: Array = np.ascontiguousarray(self._curve.c[::-1].transpose(1, 2, 0))

    def position(self, u: npt.ArrayLike) -> Array:
        """Points at the global parameter u: shape (..., d) for u of shape (...).

        Raises ValueError if a u lies outside [0, segments].
        """
        return self.derivative(u, order=0)

    def derivative(self, u: npt.ArrayLike, order: int = 1) -> Array:
        """Derivative of an order with respect to u: shape (..., d).

        At a control point it is the value of the segment that begins there.
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


def hermite_tangents(control_points: npt.ArrayLike) -> Array:
    """Tangents of appendices A and B, (n, d): 0.5 (P[i+1] - P[i-1]), at the ends 0.5 times the difference.

    Unit: that of the control points, per segment.
    """
    points = np.asarray(control_points, dtype=np.float64)
    padded = np.concatenate([points[:1], points, points[-1:]])
    return np.asarray(0.5 * (padded[2:] - padded[:-2]))
