"""The lead of the left foot over the right one is measured along the heading; the pelvis drops with the steps."""

import cmath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.counter_rotation import CounterRotation, foot_lead
from humanwalk.walking.walking_reference import BodyState, FootState

points = st.builds(complex, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def foot(position: complex, velocity: complex = 0j) -> FootState:
    return FootState(position, velocity, height=0.07, height_rate=0.0, yaw=0.0, pitch=0.0, pitch_rate=0.0, force=350.0)


@given(points, points, st.floats(-3.0, 3.0))
def test_the_lead_does_not_depend_on_position_and_orientation_in_the_world(
    offset: complex, velocity: complex, heading: float
) -> None:
    u = cmath.exp(1j * heading)
    right, left = foot(offset), foot(offset + (0.3 + 0.1j) * u, velocity * u)
    body = BodyState(com=offset, com_velocity=0j, com_height=0.97, right=right, left=left)
    assert foot_lead(body, heading) == pytest.approx((0.3, velocity.real), abs=1e-9)


@given(st.floats(0.0, 1.2), st.floats(-1.0, 2.0), st.floats(0.1, 1.0))
def test_the_pelvis_drops_in_the_first_part_of_a_forward_step(progress: float, speed: float, share: float) -> None:
    rotation = CounterRotation(drop=0.06, drop_share=share)
    assert 0.0 <= rotation.drop_at(progress, speed) <= rotation.drop_at(0.5 * share, speed)
    assert rotation.drop_at(0.5 * share, speed) == pytest.approx(0.06 * max(speed, 0.0))
    assert rotation.drop_at(0.0, speed) == 0.0
    assert rotation.drop_at(max(share, progress), speed) == pytest.approx(0.0)
