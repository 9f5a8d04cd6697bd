"""Adaptive feedforward of the joints: estimates of the inertia J and the load L of each joint, fed forward as torque.

The law of Slotine and Li (On the Adaptive Control of Robot Manipulators, Int. J. Robotics Research 6(3), 1987), joint
by joint, with the regressor Y of the desired motion (Sadegh and Horowitz, Int. J. Robotics Research 9(3), 1990):

    torque = PD law + Y theta,    theta' = Gamma Y s,    Y = (a_d, 1),    theta = (J, L),
    s = (v_d - v) + lambda (q_d - q).

docs/theory.md has the Lyapunov function.
"""

from dataclasses import dataclass

import numpy as np

from humanwalk.numerics import Array, Mask
from humanwalk.quantity import ParameterError, quantity


@dataclass(frozen=True)
class AdaptationParameters:
    """Rates and bounds of the adaptation."""

    adaptation_time: float = quantity(0.5, "s", 0.01, 100.0)
    """T: under a constant error the load estimate rises by the torque of the PD stiffness in this time."""

    error_rate: float = quantity(20.0, "1/s", 0.1, 100.0)
    """lambda: weight of the angle error in s. It must be smaller than kd over the inertia of each joint."""

    leakage: float = quantity(0.05, "1/s", 0.0, 10.0)
    """Rate at which the estimates decay to zero (sigma-modification)."""

    reference_error: float = quantity(0.02, "rad", 1e-4, 1.0)
    """e_0: bound of the desired acceleration, as the error that the PD law has there without feedforward: kp e_0 / I.
    In the thesis' walk the errors of the joints are up to 0.016 rad rms."""

    max_inertia_ratio: float = quantity(2.0, "", 0.0, 10.0)
    """Bound of the estimated inertia, as a multiple of the joint's inertia I in neutral standing."""


def regressor(acceleration: Array, max_acceleration: Array) -> Array:
    """Y = (a_d, 1), shape (2, n), with desired accelerations clipped to bounds [rad/s2], shape (n,) each."""
    return np.stack((acceleration.clip(-max_acceleration, max_acceleration), np.ones_like(acceleration)))


def feedforward_torque(theta: Array, Y: Array) -> Array:
    """Y theta of each joint [N m], shape (n,), from estimates and regressor of shape (2, n)."""
    torque: Array = (Y * theta).sum(axis=0)
    return torque


def adaptation_gains(kp: Array, max_acceleration: Array, parameters: AdaptationParameters) -> Array:
    """Diagonal of Gamma: of J [kg m2 / (rad/s2 rad)], then of L [N m/rad], shape (2, n).

    The load adapts like the torque of an integral action with integral time T; J a_d adapts as fast where the
    acceleration is at its bound.
    """
    load = kp / (parameters.error_rate * parameters.adaptation_time)
    return np.stack((load / max_acceleration**2, load))


def adapted(
    theta: Array, Y: Array, s: Array, gains: Array, bounds: tuple[Array, Array], leakage: float, frozen: Mask, h: float
) -> Array:
    """Estimates after a step: theta + h (Gamma Y s - sigma theta), projected onto their bounds.

    The leakage sigma is the sigma-modification of Ioannou and Kokotovic (Automatica 20(5), 1984), the projection that
    of Ioannou and Sun (Robust Adaptive Control, 1996, section 8.4.2).

    Args:
        theta: J [kg m2] and L [N m], shape (2, n).
        Y: regressor, shape (2, n).
        s: (v_d - v) + lambda (q_d - q) [rad/s], shape (n,).
        gains: diagonal of Gamma, shape (2, n).
        bounds: least and greatest theta, shape (2, n) each.
        leakage: sigma [1/s].
        frozen: joints that do not adapt, because their torque saturates, shape (n,).
        h: step [s].
    """
    return np.where(frozen, theta, (theta + h * (gains * Y * s - leakage * theta)).clip(*bounds))


def require_passive(kd: Array, inertia: Array, adapts: Mask, error_rate: float) -> None:
    """Raise ParameterError unless lambda < kd / I for all joints that adapt, as the stability proof requires.

    Args:
        kd: damping [N m s/rad], shape (n,).
        inertia: of the joints I [kg m2], shape (n,).
        adapts: joints that adapt, shape (n,).
        error_rate: lambda [1/s].
    """
    highest = float(np.min((kd / inertia)[adapts], initial=np.inf))
    if error_rate >= highest:
        raise ParameterError(
            f"error_rate: {error_rate:g} is not smaller than kd over the inertia of each joint; allowed: below "
            f"{highest:.4g} 1/s with these gains; lower it, or raise kd"
        )
