"""Motions: consistent derivatives; a planar motion reaches a goal that may move in time, with bounded jerk."""

import cmath
import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.motions import PiecewiseCubic, PlanarMotion, ScalarMotion, blend, shortest_blend

DT = 0.004
numbers = st.floats(-10.0, 10.0)
motions = st.builds(ScalarMotion, numbers, numbers, numbers)


@given(motions, motions)
def test_the_sum_adds_values_rates_and_accelerations(a: ScalarMotion, b: ScalarMotion) -> None:
    assert a.plus(b) == pytest.approx([x + y for x, y in zip(a, b, strict=True)])


@given(numbers, numbers, st.floats(0.1, 2.0), st.floats(0.1, 3.0))
def test_a_faster_clock_shortens_a_blend(start: float, end: float, time: float, factor: float) -> None:
    slow = blend(start, end, factor * time, 2.0).time_scaled(factor)
    assert slow == pytest.approx(blend(start, end, time, 2.0 / factor), abs=1e-6)


@given(numbers, numbers, st.floats(0.1, 2.0))
def test_a_blend_rests_before_its_start_and_after_its_end(start: float, end: float, duration: float) -> None:
    assert blend(start, end, -0.1, duration) == pytest.approx((start, 0.0, 0.0), abs=1e-9)
    assert blend(start, end, duration + 0.1, duration) == pytest.approx((end, 0.0, 0.0), abs=1e-9)


@given(st.floats(-2.0, 2.0).filter(lambda change: abs(change) > 0.01), st.floats(10.0, 200.0))
def test_the_largest_acceleration_of_the_shortest_blend_is_the_given_one(change: float, limit: float) -> None:
    duration = shortest_blend(change, limit)
    largest = max(abs(blend(0.0, change, k / 1000 * duration, duration).acceleration) for k in range(1001))
    assert largest == pytest.approx(limit, rel=1e-4)


@given(numbers, numbers, st.floats(0.01, 0.99))
def test_rates_of_a_blend_are_derivatives(start: float, end: float, time: float) -> None:
    h = 1e-5
    before, here, after = (blend(start, end, time + d, 1.0) for d in (-h, 0.0, h))
    assert (after.value - before.value) / (2 * h) == pytest.approx(here.rate, abs=1e-4)
    assert (after.rate - before.rate) / (2 * h) == pytest.approx(here.acceleration, abs=1e-4)


def swing_to(goal_at: Callable[..., Any], duration: float, jerk_limit: float = 1e9) -> list[PlanarMotion]:
    motion, t = PlanarMotion(0.0), 0.0
    path = [motion]
    while t < duration - 0.5 * DT:
        motion = motion.towards(PlanarMotion(goal_at(t)), duration - t, DT, jerk_limit)
        t += DT
        path.append(motion)
    return path


planar = st.builds(complex, numbers, numbers)
planar_motions = st.builds(PlanarMotion, planar, planar, planar)


@given(planar_motions, planar_motions, st.floats(0.001, 0.6))
def test_a_swing_ends_with_the_motion_of_its_goal(motion: PlanarMotion, goal: PlanarMotion, duration: float) -> None:
    t = 0.0
    while t < duration - 1e-9:
        motion = motion.towards(goal, duration - t, DT, math.inf)
        t += DT
    assert motion.position == pytest.approx(goal.position, abs=1e-6)
    assert motion.velocity == pytest.approx(goal.velocity, abs=1e-4)
    assert motion.acceleration == pytest.approx(goal.acceleration, abs=0.1)


@given(planar_motions, planar_motions, st.floats(0.2, 0.6))
def test_half_the_control_period_is_the_same_swing(motion: PlanarMotion, goal: PlanarMotion, duration: float) -> None:
    half = motion.towards(goal, duration, 0.5 * DT, math.inf)
    twice = half.towards(goal, duration - 0.5 * DT, 0.5 * DT, math.inf)
    for got, expected in zip(twice, motion.towards(goal, duration, DT, math.inf), strict=True):
        assert got == pytest.approx(expected, abs=1e-6)


@given(planar_motions, planar_motions, st.floats(0.05, 0.6))
def test_the_way_to_a_goal_is_the_swing(motion: PlanarMotion, goal: PlanarMotion, duration: float) -> None:
    way = motion.way(goal, duration, 4)
    assert way[0] == motion.position
    assert way[-1] == pytest.approx(goal.position, abs=1e-6)
    half = motion.towards(goal, duration, 0.5 * duration, math.inf)
    assert way[2] == pytest.approx(half.position, abs=1e-6)


def test_a_foothold_that_moves_is_reached_too() -> None:
    end = swing_to(lambda t: 0.6 if t < 0.2 else 0.7 + 0.05j, 0.42)[-1]
    assert end.position == pytest.approx(0.7 + 0.05j, abs=1e-6)


def test_velocity_is_the_derivative_of_position() -> None:
    path = swing_to(lambda t: 0.7, 0.4)
    for before, after in pairwise(path):
        mean = 0.5 * (before.velocity + after.velocity)
        assert (after.position - before.position) / DT == pytest.approx(mean, abs=0.01)


def test_jerk_is_bounded() -> None:
    path = swing_to(lambda t: 2.0, 0.4, jerk_limit=1000.0)
    for before, after in pairwise(path):
        assert abs(after.acceleration - before.acceleration) <= 1000.0 * DT + 1e-9


@given(st.floats(-3.1, 3.1))
def test_a_motion_with_the_sideways_of_another_has_both(heading: float) -> None:
    u = cmath.exp(1j * heading)
    along, across = PlanarMotion(1.0 + 2.0j, 3.0, 4.0j), PlanarMotion(-1.0 + 0.5j, 1.0j, 2.0)
    mixed = along.with_sideways_of(across, u)
    for got, x, y in zip(mixed, along, across, strict=True):
        assert (got / u).real == pytest.approx((x / u).real)
        assert (got / u).imag == pytest.approx((y / u).imag)


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=12), st.floats(0.0, 1.0))
def test_a_monotone_spline_stays_between_its_values(values: list[float], progress: float) -> None:
    spline, n = PiecewiseCubic.through(values), len(values) - 1
    i = min(int(progress * n), n - 1)
    low, high = sorted(values[i : i + 2])
    assert low - 1e-9 <= spline.at(progress).value <= high + 1e-9
    assert [spline.at(k / n).value for k in range(n + 1)] == pytest.approx(values, abs=1e-9)
