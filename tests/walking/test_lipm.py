"""The pendulum: its closed forms agree with its differential equation, and the periodic walk repeats itself."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.lipm import (
    HalfSteps,
    PeriodicGait,
    ZmpSegment,
    backward,
    carried,
    divergent_component,
    forward,
    natural_frequency,
)

points = st.builds(complex, st.floats(-1, 1), st.floats(-1, 1))
frequencies = st.floats(2.0, 5.0)
segments = st.builds(ZmpSegment, points, points, st.floats(0.0, 1.0))


def test_frequency_of_a_pendulum_of_one_metre():
    assert natural_frequency(1.0) == pytest.approx(math.sqrt(9.81))


def test_a_body_at_rest_has_its_dcm_in_its_centre_of_mass():
    assert divergent_component(0.3 + 0.1j, 0.0, 3.0) == 0.3 + 0.1j


@given(st.lists(segments, min_size=1, max_size=3), points, frequencies)
def test_backward_inverts_forward(path, xi, frequency):
    path = tuple(path)
    assert backward(path, forward(path, xi, frequency), frequency) == pytest.approx(xi, abs=1e-9)


@given(st.builds(ZmpSegment, points, points, st.floats(0.05, 0.6)), points, frequencies)
def test_forward_solves_the_differential_equation(segment, xi, frequency):
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
def test_the_centre_of_mass_is_carried_after_the_dcm(com, xi, zmp, t, frequency):
    h = 1e-5
    before, here, after = (carried(com, xi, zmp, t + d, frequency) for d in (0.0, h, 2.0 * h))
    dcm = ZmpSegment(zmp, zmp, t + h).forward(xi, frequency)
    assert carried(com, xi, zmp, 0.0, frequency) == pytest.approx(com)
    assert here + (after - before) / (2.0 * h) / frequency == pytest.approx(dcm, abs=1e-5)


@given(st.builds(ZmpSegment, points, points, st.floats(0.05, 1.0)), points, frequencies, st.floats(0.0, 1.0))
def test_a_segment_can_be_cut_anywhere(segment, xi, frequency, share):
    t = share * segment.duration
    first = ZmpSegment(segment.start, segment.at(t), t)
    whole = segment.forward(xi, frequency)
    assert forward((first, segment.rest(t)), xi, frequency) == pytest.approx(whole, abs=1e-7)


@pytest.mark.parametrize("t, expected", [(-1.0, 0.0), (0.0, 0.0), (0.5, 1.0), (1.0, 2.0), (9.0, 2.0)])
def test_the_zero_moment_point_stays_between_the_ends(t, expected):
    assert ZmpSegment(0.0, 2.0, 1.0).at(t) == pytest.approx(expected)


gaits = st.builds(
    PeriodicGait,
    displacement=st.builds(
        HalfSteps,
        left=st.builds(complex, st.floats(-0.8, 0.8), st.floats(-0.4, -0.05)),
        right=st.builds(complex, st.floats(-0.8, 0.8), st.floats(0.05, 0.4)),
    ),
    turn=st.floats(-0.3, 0.3),
    roll_start=st.builds(complex, st.floats(-0.05, 0.05)),
    roll_end=st.builds(complex, st.floats(0.0, 0.2)),
    double_support=st.floats(0.05, 0.2),
    single_support=st.floats(0.2, 0.6),
)


@given(gaits, frequencies)
def test_the_periodic_walk_repeats_itself(gait, frequency):
    """The DCM at the end of a step, carried through the next step, is the end of that step; twice, it is itself."""
    ends = gait.end_offsets(frequency)
    for left_first in (True, False):
        end, step = (ends.left, gait.displacement.left) if left_first else (ends.right, gait.displacement.right)
        following = ends.right if left_first else ends.left
        seen_from_next = (end - step) * cmath.exp(-1j * gait.turn)
        assert forward(gait.segments(not left_first), seen_from_next, frequency) == pytest.approx(following, abs=1e-9)


@given(gaits, frequencies)
def test_each_step_begins_where_the_one_before_ended(gait, frequency):
    """The zero-moment point does not jump at touchdown."""
    for left in (True, False):
        step = gait.displacement.left if left else gait.displacement.right
        end_of_old = gait.segments(left)[-1].end
        start_of_new = step + gait.segments(not left)[0].start * cmath.exp(1j * gait.turn)
        assert start_of_new == pytest.approx(end_of_old, abs=1e-12)


@given(st.floats(0.1, 0.4), frequencies)
def test_marching_on_the_spot_is_symmetric(width, frequency):
    gait = PeriodicGait(HalfSteps(-1j * width, 1j * width), 0.0, 0.0, 0.0, 0.1, 0.4)
    ends = gait.end_offsets(frequency)
    assert ends.left == pytest.approx(ends.right.conjugate(), abs=1e-12)
    assert 0.0 < -ends.left.imag < width
