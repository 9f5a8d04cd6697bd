"""The thesis' walk: from standing into steps; feet do not move in stance and are half a cycle apart."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import FootTarget, GaitTarget, WalkingGait
from humanwalk.numerics import Array

HALF_WIDTH = 0.0875

gaits = st.builds(
    WalkingGait,
    st.builds(
        FootPathParameters,
        step_length=st.floats(0.2, 0.8),
        step_height=st.floats(0.03, 0.3),
        offset=st.floats(0.0, 0.1),
        duty_factor=st.floats(0.55, 0.8),
        swing=st.sampled_from(["thesis", "smooth"]),
    ),
    st.just(HALF_WIDTH),
    st.builds(SpeedRamp, st.floats(0.2, 2.0), st.floats(0.1, 3.0)),
    st.sampled_from(["Right", "Left"]),
)
few = settings(max_examples=25)
TIMES = np.linspace(0.0, 5.0, 401)


def feet(target: GaitTarget) -> tuple[FootTarget, FootTarget]:
    return target.right, target.left


def swing_foot(gait: WalkingGait, target: GaitTarget) -> Any:
    return target.right if gait.first_swing == "Right" else target.left


def over_ground(gait: WalkingGait, target: GaitTarget, foot: FootTarget) -> Array:
    """Sole in the world: pelvis moved forward and dropped from its standing height."""
    standing_sole = -gait.parameters.offset
    return foot.position + np.array([target.pelvis.distance, 0.0, -target.pelvis.drop - standing_sole])


@few
@given(gait=gaits)
def test_both_feet_stand_at_the_start(gait: WalkingGait) -> None:
    for t in (-1.0, 0.0):
        target = gait.target(t)
        assert target.pelvis.distance == target.pelvis.drop == target.pelvis.speed == 0.0
        for foot, y in zip(feet(target), (-HALF_WIDTH, HALF_WIDTH), strict=True):
            np.testing.assert_allclose(foot.position, [0.0, y, -gait.parameters.offset], atol=1e-12)
            np.testing.assert_array_equal(foot.velocity, 0.0)
            assert foot.in_stance


@few
@given(gait=gaits)
def test_feet_are_half_a_cycle_apart(gait: WalkingGait) -> None:
    for t in [*TIMES, 1e3]:
        target = gait.target(t)
        apart = (target.right.phase - target.left.phase) % 1.0
        assert apart == pytest.approx(0.5, abs=1e-9)
        assert (gait.phase("Right", t), gait.phase("Left", t)) == (
            target.right.phase,
            target.left.phase,
        )


@few
@given(gait=gaits)
def test_a_foot_is_always_on_the_ground_and_never_below_it(gait: WalkingGait) -> None:
    for t in TIMES:
        target = gait.target(t)
        assert target.right.in_stance or target.left.in_stance
        for foot in feet(target):
            height = over_ground(gait, target, foot)[2]
            assert height == pytest.approx(foot.height, abs=1e-12)
            assert height >= -1e-15
            assert 0.0 <= foot.height <= gait.parameters.step_height + 1e-6


@few
@given(gait=gaits)
def test_a_foot_in_stance_does_not_move_in_the_world(gait: WalkingGait) -> None:
    for t in TIMES:
        target = gait.target(t)
        for foot in feet(target):
            if foot.in_stance:
                velocity = foot.velocity + np.array([target.pelvis.speed, 0.0, -target.pelvis.drop_rate])
                np.testing.assert_allclose(velocity, 0.0, atol=1e-12)
                assert foot.height == foot.height_rate == 0.0


@few
@given(gait=gaits)
def test_feet_in_stance_are_at_their_footsteps(footsteps: Callable[..., Any], gait: WalkingGait) -> None:
    target_at, steps = gait.target, footsteps(gait, 4.0)
    assert [step.touchdown for step in steps] == sorted(step.touchdown for step in steps)
    for step in steps:
        if step.lift_off > step.touchdown:
            target = target_at(0.5 * (step.touchdown + min(step.lift_off, 10.0)))
            foot = target.right if step.side == "Right" else target.left
            assert foot.in_stance
            np.testing.assert_allclose(over_ground(gait, target, foot), step.position, rtol=0, atol=1e-9)


@few
@given(gait=gaits)
def test_first_touchdown_is_in_front_with_the_other_foot_half_a_cycle_on(gait: WalkingGait) -> None:
    p, target = gait.parameters, gait.target(gait.start_time)
    first, other = feet(target) if gait.first_swing == "Right" else feet(target)[::-1]
    assert target.pelvis.distance == pytest.approx(p.step_length * (0.5 / p.duty_factor - 0.5))
    assert target.pelvis.drop == pytest.approx(p.offset, abs=1e-12)
    np.testing.assert_allclose(first.position[::2], [p.step_length / 2, 0.0], atol=1e-9)
    assert other.position[0] == pytest.approx(p.step_length * (0.5 - 0.5 / p.duty_factor))
    assert other.phase == pytest.approx(0.5)


@few
@given(gait=gaits)
def test_the_pelvis_drops_by_the_offset_once(gait: WalkingGait) -> None:
    drops = np.array([gait.pelvis(t).drop for t in TIMES])
    assert np.all(np.diff(drops) >= -1e-15)
    assert gait.pelvis(gait.start_time + 1.0).drop == gait.parameters.offset


@settings(max_examples=60)
@given(gait=gaits, t=st.floats(1e-4, 5.0))
def test_velocities_are_the_limits_of_differences(gait: WalkingGait, t: float) -> None:
    h = 1e-6
    now, ahead, behind = gait.target(t), gait.target(t + h), gait.target(t - h)
    for foot, after, before in zip(feet(now), feet(ahead), feet(behind), strict=True):
        difference = np.subtract(after.position, before.position) / (2 * h)
        scale = 1.0 + np.linalg.norm(foot.velocity)
        np.testing.assert_allclose(foot.velocity, difference, rtol=0, atol=2e-2 * scale)
        rate = (after.height - before.height) / (2 * h)
        assert foot.height_rate == pytest.approx(rate, abs=2e-2 * scale)
        rate = (after.pitch - before.pitch) / (2 * h)
        assert foot.pitch_rate == pytest.approx(rate, abs=1e-3)
    pelvis, after, before = now.pelvis, ahead.pelvis, behind.pelvis  # type: ignore[assignment]
    for value, rate in (("distance", "speed"), ("drop", "drop_rate")):  # type: ignore[assignment]
        difference = (getattr(after, value) - getattr(before, value)) / (2 * h)
        assert getattr(pelvis, rate) == pytest.approx(difference, abs=1e-4)  # type: ignore[call-overload]
    if abs(t - gait.ramp.duration) > h:
        for rate, acceleration in (("speed", "acceleration"), ("drop_rate", "drop_acceleration")):  # type: ignore[assignment]
            difference = (getattr(after, rate) - getattr(before, rate)) / (2 * h)  # type: ignore[call-overload]
            assert getattr(pelvis, acceleration) == pytest.approx(difference, abs=2e-2)


@few
@given(gait=gaits)
def test_velocities_have_no_jump(footsteps: Callable[..., Any], gait: WalkingGait) -> None:
    """With a speed ramp the velocities of the feet are continuous at toe-off and touchdown."""
    events = {e for step in footsteps(gait, 3.0) for e in (step.touchdown, step.lift_off)}
    for t in (e for e in events if np.isfinite(e)):
        before, after = gait.target(t - 1e-9), gait.target(t + 1e-9)
        for a, b in zip(feet(before), feet(after), strict=True):
            np.testing.assert_allclose(a.velocity, b.velocity, rtol=0, atol=1e-3)


def test_the_speed_does_not_change_where_the_feet_go() -> None:
    slow, fast = (WalkingGait(FootPathParameters(), HALF_WIDTH, SpeedRamp(v, 0.8)) for v in (0.5, 1.5))
    for d in np.linspace(0.0, 1.5, 40):
        a, b = (gait.target(gait.ramp.time_at(d)) for gait in (slow, fast))
        np.testing.assert_allclose(a.left.position, b.left.position, atol=1e-9)
        np.testing.assert_allclose(a.right.position, b.right.position, atol=1e-9)


def test_the_other_leg_first_is_the_mirror_image() -> None:
    right, left = (WalkingGait(FootPathParameters(), HALF_WIDTH, SpeedRamp(), side) for side in ("Right", "Left"))
    for t in TIMES:
        a, b = right.target(t), left.target(t)
        np.testing.assert_array_equal(np.multiply(a.right.position, [1, -1, 1]), b.left.position)
        np.testing.assert_array_equal(np.multiply(a.left.position, [1, -1, 1]), b.right.position)


def test_with_speed_zero_both_feet_stand() -> None:
    gait = WalkingGait(FootPathParameters(), HALF_WIDTH, SpeedRamp(0.0))
    assert all(foot.in_stance for foot in feet(gait.target(100.0)))
    assert gait.start_time == np.inf


@pytest.mark.parametrize("width", [0.0, 9.0, np.nan])
def test_an_unusable_hip_width_is_rejected(width: float) -> None:
    with pytest.raises(ValueError, match="hip_half_width"):
        WalkingGait(FootPathParameters(), width, SpeedRamp())


def test_an_unknown_side_is_rejected() -> None:
    with pytest.raises(ValueError, match=r'first_swing: .*"Right" or "Left"'):
        WalkingGait(FootPathParameters(), HALF_WIDTH, SpeedRamp(), "right")  # type: ignore[arg-type]
