"""Adaptive feedforward: the Lyapunov function, the bounds of the estimates, and what does not adapt."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.adaptive_feedforward import (
    AdaptationParameters,
    adaptation_gains,
    adapted,
    feedforward_torque,
    regressor,
    require_passive,
)
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError

N = 3
LOW, HIGH = np.stack((np.zeros(N), np.full(N, -50.0))), np.full((2, N), 50.0)
NONE, ALL = np.zeros(N, bool), np.ones(N, bool)
seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def step(theta: Array, Y: Array, s: Array, gains: Array, leakage: float = 0.0, h: float = 0.002) -> Array:
    return adapted(theta, Y, s, gains, (LOW, HIGH), leakage, NONE, h)


def lyapunov(x: Array, true: Array, kp: Array, damping: Array, rate: float, gains: Array) -> float:
    """V = I s^2 / 2 + (kp + lambda (b - lambda I)) e^2 / 2 + (theta - theta*)^T Gamma^-1 (theta - theta*) / 2.

    Args:
        x: e, e', J, L, shape (4, N).
        true: theta* = (I, c), shape (2, N).
        kp: stiffness; `damping`: b = kd and the joint's own.
        rate: lambda.
        gains: Gamma, shape (2, N).
    """
    e, e_rate, theta = x[0], x[1], x[2:]
    s = e_rate + rate * e
    stiffness = kp + rate * (damping - rate * true[0])
    return float(0.5 * np.sum(true[0] * s**2 + stiffness * e**2 + ((theta - true) ** 2 / gains).sum(axis=0)))


@given(seeds)
def test_the_lyapunov_function_of_the_ideal_joint_decreases(rng: np.random.Generator) -> None:
    """Joints I a + b (v - v_d) + c = torque: V' = -(b - lambda I) e'^2 - lambda kp e^2 whatever the estimates.

    V' is the derivative along the motion, by a central difference: exact but for rounding, since V is quadratic.
    """
    kp, damping, inertia = 10.0 ** rng.uniform(1, 4, N), 10.0 ** rng.uniform(0, 2, N), 10.0 ** rng.uniform(-1, 1, N)
    rate = float(rng.uniform(0.1, 0.99) * (damping / inertia).min())
    true = np.stack((inertia, rng.uniform(-20, 20, N)))
    parameters = AdaptationParameters(error_rate=rate, leakage=0.0)
    bound = parameters.reference_error * kp / inertia
    gains = adaptation_gains(kp, bound, parameters)
    x = np.stack((*rng.normal(size=(2, N)), rng.uniform(1, 40, N), rng.uniform(-40, 40, N)))
    Y = regressor(rng.uniform(-1, 1, N) * bound, bound)

    e, e_rate, theta = x[0], x[1], x[2:]
    acceleration = (feedforward_torque(true - theta, Y) - damping * e_rate - kp * e) / inertia
    h = 1e-6
    theta_rate = (
        adapted(theta, Y, e_rate + rate * e, gains, (-np.inf * HIGH, np.inf * HIGH), 0.0, NONE, h) - theta
    ) / h
    rates = np.stack((e_rate, acceleration, *theta_rate))

    up, down = (lyapunov(x + sign * rates, true, kp, damping, rate, gains) for sign in (1.0, -1.0))
    expected = -np.sum((damping - rate * inertia) * e_rate**2 + rate * kp * e**2)
    scale = lyapunov(x, true, kp, damping, rate, gains) + abs(up) + abs(down)
    assert 0.5 * (up - down) == pytest.approx(expected, rel=1e-6, abs=1e-6 * scale)
    assert expected < 0


@given(seeds)
def test_the_projection_brings_no_estimate_farther_from_a_value_within_the_bounds(rng: np.random.Generator) -> None:
    theta, true = (LOW + rng.uniform(size=(2, N)) * (HIGH - LOW) for _ in range(2))
    Y, s, gains = rng.normal(size=(2, N)), 1e3 * rng.normal(size=N), 10.0 ** rng.uniform(-2, 3, (2, N))
    free = adapted(theta, Y, s, gains, (-np.inf * HIGH, np.inf * HIGH), 0.0, NONE, 0.002)
    assert np.all(np.abs(step(theta, Y, s, gains) - true) <= np.abs(free - true) + 1e-12)


@given(seeds, st.floats(0.0, 10.0))
def test_estimates_stay_within_their_bounds(rng: np.random.Generator, leakage: float) -> None:
    theta, gains = np.zeros((2, N)), 10.0 ** rng.uniform(-2, 4, (2, N))
    for _ in range(20):
        theta = step(theta, 100.0 * rng.normal(size=(2, N)), 100.0 * rng.normal(size=N), gains, leakage)
        assert np.all((theta >= LOW) & (theta <= HIGH))


@given(seeds, st.floats(0.01, 10.0))
def test_without_error_the_estimates_decay_at_the_leakage_rate(rng: np.random.Generator, leakage: float) -> None:
    theta, h = rng.uniform(1, 40, (2, N)), 0.001
    after = theta
    for _ in range(100):
        after = step(after, rng.normal(size=(2, N)), np.zeros(N), np.ones((2, N)), leakage, h)
    np.testing.assert_allclose(after, theta * (1 - h * leakage) ** 100)
    np.testing.assert_allclose(after, theta * np.exp(-0.1 * leakage), rtol=6e-3)


def test_saturated_joints_do_not_adapt() -> None:
    theta, Y = np.ones((2, N)), np.ones((2, N))
    frozen = np.array([True, False, True])
    after = adapted(theta, Y, np.ones(N), np.ones((2, N)), (LOW, HIGH), 1.0, frozen, 0.1)
    np.testing.assert_array_equal(np.any(after != theta, axis=0), [False, False, False])
    after = adapted(theta, Y, 2 * np.ones(N), np.ones((2, N)), (LOW, HIGH), 1.0, frozen, 0.1)
    np.testing.assert_array_equal(np.all(after != theta, axis=0), ~frozen)


def test_joints_without_stiffness_do_not_adapt() -> None:
    np.testing.assert_array_equal(adaptation_gains(np.zeros(N), np.ones(N), AdaptationParameters()), 0.0)


@given(st.floats(1.0, 1e4), st.floats(0.1, 100.0), st.floats(0.01, 100.0))
def test_a_constant_error_raises_the_load_by_the_stiffness_torque_in_the_adaptation_time(
    kp: float, error_rate: float, time: float
) -> None:
    p = AdaptationParameters(adaptation_time=time, error_rate=error_rate, leakage=0.0)
    gains, error, bound = adaptation_gains(np.full(N, kp), np.ones(N), p), 1e-4, np.inf * HIGH
    Y = regressor(np.zeros(N), np.ones(N))
    theta = adapted(np.zeros((2, N)), Y, np.full(N, error_rate * error), gains, (-bound, bound), 0.0, NONE, time)
    np.testing.assert_allclose(theta, [np.zeros(N), np.full(N, kp * error)])


@given(seeds)
def test_the_regressor_is_bounded(rng: np.random.Generator) -> None:
    a, bound = 1e3 * rng.normal(size=N), 10.0 ** rng.uniform(0, 3, N)
    Y = regressor(a, bound)
    assert np.all(np.abs(Y[0]) <= bound)
    np.testing.assert_array_equal(Y[0][np.abs(a) <= bound], a[np.abs(a) <= bound])
    np.testing.assert_array_equal(Y[1], 1.0)


def test_the_error_rate_must_be_smaller_than_damping_over_inertia_where_joints_adapt() -> None:
    kd, inertia = np.array([10.0, 1.0, 30.0]), np.ones(3)
    require_passive(kd, inertia, np.array([True, False, True]), 9.9)
    require_passive(kd, inertia, NONE, 1e3)
    with pytest.raises(ParameterError, match=r"^error_rate: 5 .*; allowed: below 1 1/s with these gains; lower it"):
        require_passive(kd, inertia, ALL, 5.0)
