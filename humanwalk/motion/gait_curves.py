"""Joint angles of both legs over the gait cycle, as smooth periodic functions of phase and speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.body.pelvic_plane import PELVIC_TILT
from humanwalk.gait.normative import CYCLE, SPEED_GROUPS, people
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY

HARMONICS = 8
"""Harmonics of the stride that are kept; six hold 99.7 % of the power of a leg's motion (Winter, Sidwall, Hobson 1974,
J. Biomech. 7(2) 157-159)."""

ANGLES = ("hip_flexion_deg", "knee_flexion_deg", "ankle_dorsiflexion_deg")
"""Human angles of the joints of `Leg.sagittal`."""


class PhaseMotion(NamedTuple):
    """Angles [rad] and their first two derivatives by the phase, shape (3,) each."""

    value: Array
    slope: Array
    curvature: Array


@dataclass(frozen=True)
class GaitCurves:
    """Fourier series of the sagittal joint angles of both legs, at one or more speeds.

    Attributes:
        speeds: At which the curves hold [m/s], increasing, shape (n,).
        coefficients: Complex c_k of value = Re sum c_k exp(2 pi i k phase), k from 0 to HARMONICS; right leg first;
            shape (n, HARMONICS + 1, 2, 3) [rad].
    """

    speeds: Array
    coefficients: Array

    @staticmethod
    def through(speeds: Array, values: Array) -> GaitCurves:
        """The series nearest to values over the gait cycle.

        Args:
            speeds: [m/s], increasing, shape (n,).
            values: At equal distances of the phase from 0 at a leg's touchdown, without the end of the cycle, shape
                (n, points, 2, 3) [rad].
        """
        coefficients = np.fft.rfft(values, axis=1)[:, : HARMONICS + 1] / values.shape[1]
        coefficients[:, 1:] *= 2.0
        return GaitCurves(speeds, coefficients)

    def at(self, side: Side, phase: float, speed: float) -> PhaseMotion:
        """Values of a leg at its phase, interpolated between the nearest speeds."""
        k = np.arange(self.coefficients.shape[1])
        of_leg = self.coefficients[:, :, SIDES.index(side)]
        place = float(np.interp(speed, self.speeds, np.arange(self.speeds.size)))
        low = min(int(place), self.speeds.size - 1)
        high = min(low + 1, self.speeds.size - 1)
        c = of_leg[low] + (place - low) * (of_leg[high] - of_leg[low])
        turning = 2j * np.pi * k
        waves = np.exp(turning * phase)
        return PhaseMotion(*((waves * turning**order @ c).real for order in (0, 1, 2)))

    @property
    def lowest_speed(self) -> float:
        """The lowest speed at which the curves hold [m/s]."""
        return float(self.speeds[0])


def normative_curves(leg_length: float) -> GaitCurves:
    """Angles of people at slow, free and fast dimensionless speeds, both legs alike.

    Args:
        leg_length: Height of the hip joints in standing [m].
    """
    groups = [np.column_stack([people(name, group).mean for name in ANGLES]) for group in SPEED_GROUPS]
    # The cycle ends where it begins: the last point repeats the first.
    angles = np.radians(np.array(groups)[:, : CYCLE.size - 1]) - np.array((PELVIC_TILT, 0.0, 0.0))
    speeds = np.sqrt(GRAVITY * leg_length) * np.array([np.mean(ends) for ends in SPEED_GROUPS.values()])
    return GaitCurves.through(speeds, np.stack((angles, angles), axis=2))
