"""The pendulum: its closed forms agree with its differential equation, and the periodic walk repeats itself."""

import cmath
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES
from humanwalk.sides import other_side
from humanwalk.walking.lipm import (
    PeriodicGait,
    PerStance,
    ZmpSegment,
    backward,
    com_after,
    divergent_component,
    forward,
    natural_frequency,
    remainder,
)

points = st.builds(complex, st.floats(-1, 1), st.floats(-1, 1))
frequencies = st.floats(2.0, 5.0)
segments = st.builds(ZmpSegment, points, points, st.floats(0.0, 1.0))


def test_frequency_of_a_pendulum_of_one_meter() -> None:
    assert natural_frequency(1.0) == pytest.approx(math.sqrt(9.81))


def test_at_rest_the_dcm_is_the_center_of_mass() -> None:
    assert divergent_component(0.3 + 0.1j, 0.0, 3.0) == 0.3 + 0.1j


@given(st.lists(segments, min_size=1, max_size=3), points, frequencies)
def test_backward_inverts_forward(path: Any, xi: Any, frequency: Any) -> None:
    path = tuple(path)
    assert backward(path, forward(path, xi, frequency), frequency) == pytest.approx(xi, abs=1e-9)


@given(st.builds(ZmpSegment, points, points, st.floats(0.05, 0.6)), points, frequencies)
def test_forward_solves_the_differential_equation(segment: ZmpSegment, xi: complex, frequency: float) -> None:
    steps = 2000
    dt = segment.duration / steps
    y = xi
    for i in range(steps):
        # Heun's method on xi' = w (xi - z).
        slope = frequency * (y - segment.at(i * dt))
        slope_end = frequency * (y + dt * slope - segment.at((i + 1) * dt))
        y += 0.5 * dt * (slope + slope_end)
    assert segment.forward(xi, frequency) == pytest.approx(y, abs=1e-4)


@given(points, points, points, st.floats(0.0, 0.5), frequencies)
def test_the_center_of_mass_converges_to_the_dcm(
    com: complex, xi: complex, zmp: complex, t: float, frequency: float
) -> None:
    h = 1e-5
    before, here, after = (com_after(t + d, com, xi, zmp, frequency) for d in (0.0, h, 2.0 * h))
    dcm = ZmpSegment(zmp, zmp, t + h).forward(xi, frequency)
    assert com_after(0.0, com, xi, zmp, frequency) == pytest.approx(com)
    assert here + (after - before) / (2.0 * h) / frequency == pytest.approx(dcm, abs=1e-5)


@given(st.builds(ZmpSegment, points, points, st.floats(0.05, 1.0)), points, frequencies, st.floats(0.0, 1.0))
def test_a_segment_can_be_cut_anywhere(segment: ZmpSegment, xi: complex, frequency: float, fraction: float) -> None:
    t = fraction * segment.duration
    first = ZmpSegment(segment.start, segment.at(t), t)
    whole = segment.forward(xi, frequency)
    assert forward((first, segment.remainder(t)), xi, frequency) == pytest.approx(whole, abs=1e-7)


@pytest.mark.parametrize("t, expected", [(-1.0, 0.0), (0.0, 0.0), (0.5, 1.0), (1.0, 2.0), (9.0, 2.0)])
def test_the_zero_moment_point_stays_between_the_ends(t: float, expected: float) -> None:
    assert ZmpSegment(0.0, 2.0, 1.0).at(t) == pytest.approx(expected)


gaits = st.builds(
    PeriodicGait,
    displacement=st.builds(
        PerStance,
        left=st.builds(complex, st.floats(-0.8, 0.8), st.floats(-0.4, -0.05)),
        right=st.builds(complex, st.floats(-0.8, 0.8), st.floats(0.05, 0.4)),
    ),
    turn=st.floats(-0.3, 0.3),
    roll=st.builds(complex, st.floats(0.0, 0.2)),
    double_support=st.floats(0.05, 0.2),
    single_support=st.floats(0.2, 0.6),
    pivot=st.floats(0.0, 0.1),
    hold=st.sampled_from((0.0, 0.1, 0.2)),
)


@given(gaits, frequencies)
def test_the_periodic_walk_repeats_itself(gait: PeriodicGait, frequency: float) -> None:
    """The DCM at the end of a step, propagated through the next step, is the end of that step."""
    ends = gait.end_offsets(frequency)
    for stance in SIDES:
        start = (ends.on(stance) - gait.displacement.on(stance)) * cmath.exp(-1j * gait.turn)
        following = other_side(stance)
        assert forward(gait.segments(following), start, frequency) == pytest.approx(ends.on(following), abs=1e-9)


@given(gaits, frequencies)
def test_each_step_begins_where_the_one_before_ended(gait: PeriodicGait, frequency: float) -> None:
    """The pivot does not jump at touchdown."""
    for stance in SIDES:
        end_of_old = gait.segments(stance)[-1].end
        start_of_new = gait.segments(other_side(stance))[0].start * cmath.exp(1j * gait.turn)
        start_of_new += gait.displacement.on(stance)
        assert start_of_new == pytest.approx(end_of_old, abs=1e-12)


@given(gaits, st.lists(gaits, min_size=1, max_size=3), frequencies)
def test_the_dcm_at_the_end_of_a_step_leads_into_the_gaits_that_follow(
    gait: PeriodicGait, following: list[PeriodicGait], frequency: float
) -> None:
    """Through a double support from the end of the pivot of one gait, and a single support, both of the next one."""
    for stance in SIDES:
        this, side = gait, stance
        dcm = gait.end_offset(stance, frequency, *following)
        for after in following:
            begin = this.segments(other_side(side))[0].start
            path = (ZmpSegment(begin, -after.pivot, after.double_support), *after.along_foot)
            start = (dcm - this.displacement.on(side)) * cmath.exp(-1j * this.turn)
            dcm, this, side = forward(path, start, frequency), after, other_side(side)
        assert dcm == pytest.approx(this.end_offsets(frequency).on(side), abs=1e-6)
        assert gait.end_offset(stance, frequency, gait) == gait.end_offset(stance, frequency)


@given(gaits)
def test_the_zero_moment_point_does_not_move_in_the_last_part_of_single_support(gait: PeriodicGait) -> None:
    _, *single = gait.segments("Left")
    assert sum(segment.duration for segment in single) == pytest.approx(gait.single_support)
    assert single[-1].end == gait.pivot_end
    if gait.hold > 0.0:
        assert single[-1].duration == gait.hold
        # The distance of the pivot from the zero-moment point grows from -pivot to pivot at a constant rate.
        distance = gait.pivot * (1.0 - 2.0 * gait.hold / gait.single_support)
        assert single[-1].start - distance == pytest.approx(gait.roll)
        assert single[-1].end - gait.pivot == pytest.approx(gait.roll)


@given(st.builds(ZmpSegment, points, points, st.floats(0.05, 0.6)), points, st.floats(-3.0, 3.0), st.floats(0.0, 1.0))
def test_a_moved_segment_is_a_point_of_the_segment_moved(
    segment: ZmpSegment, by: complex, heading: float, fraction: float
) -> None:
    direction, t = cmath.exp(1j * heading), fraction * segment.duration
    assert segment.moved(by, direction).at(t) == pytest.approx(by + direction * segment.at(t))


@given(st.lists(segments, min_size=1, max_size=3), st.floats(0.0, 3.0), points, frequencies)
def test_the_remainder_is_what_follows_a_time(path: Any, t: float, xi: Any, frequency: float) -> None:
    """The DCM at a time, propagated through the remainder, ends where it does through the whole."""
    path = tuple(path)
    total = sum(segment.duration for segment in path)
    rest = remainder(path, t)
    assert sum(segment.duration for segment in rest) == pytest.approx(max(total - t, 0.0), abs=1e-9)
    if t <= total:
        at_end = forward(path, xi, frequency)
        assert forward(rest, backward(rest, at_end, frequency), frequency) == pytest.approx(at_end, abs=1e-6)
        assert rest[-1].end == path[-1].end


@given(gaits)
def test_the_pivot_is_behind_the_zero_moment_point_when_a_swing_begins_and_ahead_when_it_ends(
    gait: PeriodicGait,
) -> None:
    """By the same distance, so that the angular momentum of a step is that of the one before."""
    _, *swing = gait.segments("Left")
    assert swing[0].start == pytest.approx(-gait.pivot)
    assert swing[-1].end == pytest.approx(gait.roll + gait.pivot)


@given(st.floats(0.1, 0.4), frequencies)
def test_marching_on_the_spot_is_symmetric(width: float, frequency: float) -> None:
    gait = PeriodicGait(PerStance(-1j * width, 1j * width), 0.0, 0.0, 0.1, 0.4)
    ends = gait.end_offsets(frequency)
    assert ends.left == pytest.approx(ends.right.conjugate(), abs=1e-12)
    assert 0.0 < -ends.left.imag < width
