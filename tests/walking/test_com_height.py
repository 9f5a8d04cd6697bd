"""The center of mass vaults over each stance leg; between two steps it is lower the faster the walk."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.com_height import ComHeight

HEIGHT = ComHeight()
STEP = 0.52
speeds = st.floats(-1.0, 1.6)


@given(st.floats(0.0, STEP), speeds)
def test_rates_are_derivatives(t: float, speed: float) -> None:
    h = 1e-5
    before, here, after = (HEIGHT.arc(t + d, STEP, speed) for d in (-h, 0.0, h))
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(here[1], abs=1e-5)
    assert (after[1] - before[1]) / (2 * h) == pytest.approx(here[2], abs=1e-4)


@given(speeds)
def test_the_top_is_as_high_at_every_speed(speed: float) -> None:
    top = HEIGHT.arc(HEIGHT.delay + 0.5 * STEP, STEP, speed)[0]
    assert top == pytest.approx(HEIGHT.arc_amplitude(speed, STEP))


def test_it_is_lowest_soon_after_touchdown() -> None:
    heights = {t / 1000: HEIGHT.arc(t / 1000, STEP, 1.4)[0] for t in range(520)}
    assert min(heights, key=heights.get) == pytest.approx(HEIGHT.delay)  # type: ignore[arg-type]


@given(speeds, st.floats(0.3, 1.2))
def test_the_arc_is_proportional_to_the_square_of_the_step_length(speed: float, step: float) -> None:
    top = HEIGHT.arc(HEIGHT.delay + 0.5 * step, step, speed).value
    assert top == pytest.approx(HEIGHT.amplitude * (speed * step) ** 2)


def test_in_standing_there_is_no_arc() -> None:
    assert HEIGHT.arc(0.2, STEP, 0.0) == pytest.approx((0.0, 0.0, 0.0))


LEG, STANDING = 0.864, 0.97


@given(st.floats(-1.0, HEIGHT.fast_speed))
def test_the_tops_of_the_arcs_are_as_high_up_to_the_fast_speed(speed: float) -> None:
    top = HEIGHT.mean(speed, STEP, STANDING) + HEIGHT.arc_amplitude(speed, STEP)
    assert top == pytest.approx(HEIGHT.walking * STANDING)


@given(st.floats(HEIGHT.fast_speed, 3.0), st.floats(0.0, 0.5))
def test_a_faster_walk_is_lower(speed: float, more: float) -> None:
    lower, higher = (HEIGHT.mean(v, STEP, STANDING) + HEIGHT.arc_amplitude(v, STEP) for v in (speed + more, speed))
    assert higher - lower == pytest.approx(HEIGHT.lowering_per_speed * more)


distances = st.floats(-0.5, 0.5)


@given(distances, distances)
def test_a_straight_leg_reaches_the_foothold_from_the_greatest_height(x: float, y: float) -> None:
    highest = HEIGHT.max_com_height_for_reach(complex(x, y), LEG, STANDING)
    assert highest <= STANDING
    beyond = max(abs(x) - HEIGHT.free_reach, 0.0), max(abs(y) - HEIGHT.free_spread, 0.0)
    hip = LEG + highest - STANDING
    assert hip**2 + beyond[0] ** 2 + beyond[1] ** 2 == pytest.approx(LEG**2)


def test_an_ordinary_step_needs_no_lower_body() -> None:
    assert HEIGHT.max_com_height_for_reach(0.37 + 0.08j, LEG, STANDING) == STANDING


def test_it_is_lowered_for_a_long_step_faster_than_it_rises() -> None:
    lowered, ordinary = HEIGHT.approach(0.95, 0.0, 0.97, 0.90), HEIGHT.approach(0.95, 0.0, 0.90, 1.0)
    assert lowered < ordinary < 0.0


@given(st.floats(0.8, 1.0), st.floats(0.8, 1.0), st.floats(0.8, 1.1))
def test_the_mean_height_reaches_its_goal_within_the_limit_without_overshoot(
    start: float, goal: float, limit: float
) -> None:
    height, rate, end = start, 0.0, min(goal, limit)
    for _ in range(1000):
        rate += 0.004 * HEIGHT.approach(height, rate, goal, limit)
        height += 0.004 * rate
        assert min(start, end) - 1e-6 <= height <= max(start, end) + 1e-6
    assert height == pytest.approx(end, abs=1e-4)


@given(st.floats(0.0, 0.3), st.floats(0.0, 1.0))
def test_the_center_of_mass_is_lower_for_a_high_step_up_or_down(rise: float, rolling: float) -> None:
    for step in (rise, -rise):
        assert HEIGHT.max_for_step(step, rolling, 0.98) <= HEIGHT.max_for_step(0.5 * step, rolling, 0.98)
    assert HEIGHT.max_for_step(-rise, rolling, 0.98) <= HEIGHT.max_for_step(rise, rolling, 0.98)
    assert HEIGHT.max_for_step(0.0, 1.0, 0.98) > HEIGHT.walking * 0.98


@given(st.floats(0.0, 0.15), st.floats(0.6, 1.0))
def test_the_mean_height_is_lowered_late_before_a_step_down_and_in_time(depth: float, duration: float) -> None:
    height, rate, end = 0.97, 0.0, 0.97 - depth
    steps = round(duration / 0.001)
    heights = []
    for k in range(steps):
        limit = end + HEIGHT.before_descent(1.0, duration - 0.001 * k)
        rate += 0.001 * HEIGHT.approach(height, rate, 0.97, limit)
        height += 0.001 * rate
        heights.append(height)
    assert heights[-1] == pytest.approx(end, abs=0.04)
    assert heights[steps // 4] > 0.97 - 0.25 * depth - 1e-9
    assert HEIGHT.before_descent(0.0, duration) == 0.0
