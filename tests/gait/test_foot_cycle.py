"""The foot path of walking: flat in stance, one lift to H in swing, no slip at either end."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.gait.arc_length import ArcLength
from humanwalk.gait.foot_cycle import (
    FootCycle,
    FootPathParameters,
    SwingCurve,
    minimum_offset,
    smooth_swing,
    start_distance,
    start_swing,
    thesis_swing,
)
from humanwalk.gait.splines import CubicHermite
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import quintic_blend

LAWS = ("thesis", "smooth")
LEG_LENGTH = 0.864  # hip to ankle, thesis' man (E32)

paths = st.builds(
    FootPathParameters,
    step_length=st.floats(0.2, 0.8),
    step_height=st.floats(0.03, 0.3),
    offset=st.just(0.05),
    duty_factor=st.floats(0.55, 0.8),
    swing=st.sampled_from(LAWS),
)
few = settings(max_examples=30)


def swing_points(path: FootPathParameters, n: int = 1501) -> Array:
    share = np.linspace(0.0, 1.0, n)
    phases = path.duty_factor + share[:-1] * (1.0 - path.duty_factor)
    cycle = FootCycle(path)
    return np.array([*(cycle.position(phase) for phase in phases), (path.step_length, 0.0)])


def assert_rises_once_and_falls_once(z: Array, height: float) -> None:
    assert z[0] == pytest.approx(0.0, abs=1e-9)
    assert z[-1] == pytest.approx(0.0, abs=1e-9)
    assert z.min() >= 0.0
    assert z.max() == pytest.approx(height, abs=1e-4 * height)
    assert z.max() <= height + 1e-6
    top = int(z.argmax())
    assert np.all(np.diff(z[: top + 1]) >= -1e-9)
    assert np.all(np.diff(z[top:]) <= 1e-9)


@few
@given(path=paths, share=st.floats(0.0, 1.0, exclude_max=True))
def test_stance_is_a_straight_flat_line_at_constant_speed(path: FootPathParameters, share: float) -> None:
    cycle, phase = FootCycle(path), share * path.duty_factor
    x, z = cycle.position(phase)
    assert x == pytest.approx(path.step_length * (1.0 - share), abs=1e-12)
    assert z == 0.0
    assert cycle.derivative(phase) == (-path.step_length / path.duty_factor, 0.0)
    assert cycle.in_stance(phase)


@few
@given(path=paths)
def test_swing_rises_once_to_the_step_height_and_falls_once(path: FootPathParameters) -> None:
    """The apex is H, not H + L/18 (E9, E26), for low and high steps (E28)."""
    assert_rises_once_and_falls_once(swing_points(path)[:, 1], path.step_height)


@few
@given(path=paths)
def test_swing_reaches_only_a_little_beyond_stance(path: FootPathParameters) -> None:
    x = swing_points(path)[:, 0] / path.step_length
    beyond = 0.025 if path.swing == "thesis" else 0.075
    assert -beyond < x.min() < 0.0
    assert 1.0 < x.max() < 1.0 + beyond


@few
@given(path=paths)
def test_position_and_derivative_continue_over_lift_off_touchdown_and_the_whole_cycle(path: FootPathParameters) -> None:
    cycle, step = FootCycle(path), 1e-9
    for phase in (0.0, path.duty_factor, 0.5 + 0.5 * path.duty_factor):
        before, after = phase - step, phase + step
        np.testing.assert_allclose(cycle.position(before), cycle.position(after), atol=1e-6)
        np.testing.assert_allclose(cycle.derivative(before), cycle.derivative(after), atol=1e-2)
    np.testing.assert_allclose(cycle.position(0.3), cycle.position(1.3), atol=1e-12)
    np.testing.assert_allclose(cycle.position(0.9), cycle.position(-0.1), atol=1e-12)


@few
@given(path=paths, phase=st.floats(0.0, 1.0))
def test_derivative_is_the_limit_of_differences(path: FootPathParameters, phase: float) -> None:
    cycle, h = FootCycle(path), 1e-7
    ahead, behind = np.array(cycle.position(phase + h)), np.array(cycle.position(phase - h))
    slope = np.array(cycle.derivative(phase))
    scale = np.linalg.norm(slope) + path.step_length
    np.testing.assert_allclose(slope, (ahead - behind) / (2 * h), rtol=0, atol=3e-3 * scale)


@few
@given(path=paths, drop=st.floats(0.0, 1.2))
def test_the_toes_drop_once_in_swing_and_the_sole_is_level_in_stance(path: FootPathParameters, drop: float) -> None:
    cycle = FootCycle(replace(path, toe_drop=drop))
    pitch = np.array([cycle.pitch(phase)[0] for phase in np.linspace(0.0, 1.0, 201)])
    in_stance = np.linspace(0.0, 1.0, 201) < path.duty_factor
    np.testing.assert_array_equal(pitch[in_stance], 0.0)
    assert cycle.pitch(0.5 * (1.0 + path.duty_factor))[0] == pytest.approx(drop)
    assert np.all((pitch >= 0.0) & (pitch <= drop + 1e-12))
    assert np.count_nonzero(np.diff(np.sign(np.diff(pitch[~in_stance])))) <= 1


@few
@given(path=paths)
def test_feet_meet_and_leave_the_ground_without_slip(path: FootPathParameters) -> None:
    """E27: at both ends of swing the foot has the velocity of stance, which is zero over ground."""
    for curve, distance in (
        (FootCycle(path).swing, (1.0 - path.duty_factor) * path.walked_stride),
        (start_swing(path), start_distance(path)),
    ):
        for tau in (0.0, 1.0):
            np.testing.assert_allclose(curve.derivative(tau), (-distance, 0.0), atol=1e-9)


@few
@given(path=paths)
def test_start_swing_goes_from_standing_to_touchdown(path: FootPathParameters) -> None:
    curve = start_swing(path)
    points = np.array([curve.position(tau) for tau in np.linspace(0.0, 1.0, 1501)])
    np.testing.assert_allclose(points[0], [path.step_length / 2, 0.0], atol=1e-12)
    np.testing.assert_allclose(points[-1], [path.step_length, 0.0], atol=1e-12)
    assert_rises_once_and_falls_once(points[:, 1], path.step_height)
    x = points[:, 0] / path.step_length
    assert x.min() > 0.46
    assert x.max() < 1.04


@few
@given(path=paths, tau=st.lists(st.floats(0.0, 1.0), min_size=20, max_size=20))
def test_the_table_is_within_a_micrometer_of_the_exact_law(path: FootPathParameters, tau: list[float]) -> None:
    law = thesis_swing if path.swing == "thesis" else smooth_swing
    x, z = np.array([0.0, 0.3, 0.7, 1.0]) * path.step_length, np.array([0, 1, 0.9, 0.0])
    z *= path.step_height
    curve = SwingCurve(x, z, 0.4 * path.step_length, path.swing)
    exact, _ = law(np.array(tau), x, z, 0.4 * path.step_length)
    np.testing.assert_allclose([curve.position(t) for t in tau], exact, rtol=0, atol=1e-6)


def test_thesis_swing_goes_through_the_points_of_appendix_a() -> None:
    """At L 50, H 20 cm: x as printed, y scaled by 36/41 so that the apex is H (E9)."""
    code_cm = [
        (5, 6.666666666666667),
        (50 / 6, 9.444444444444445),
        (12.5, 12.777777777777779),
        (50 / 3, 16.11111111111111),
        (25, 22.77777777777778),
        (100 / 3, 16.11111111111111),
        (37.5, 12.777777777777779),
        (250 / 6, 9.444444444444445),
    ]
    curve = swing_points(FootPathParameters(), n=40001)
    for x_cm, y_cm in code_cm:
        point = np.array([x_cm, y_cm * 36 / 41]) / 100
        assert np.linalg.norm(curve - point, axis=1).min() < 2e-5


def test_thesis_swing_is_a_function_of_arc_length() -> None:
    x, z = np.array([0.0, 0.25, 0.5]), np.array([0.0, 0.2, 0.0])
    tangents = np.array([[-0.125, 0.0], [0.25, 0.0], [-0.125, 0.0]])
    curve = ArcLength(CubicHermite(np.column_stack([x, z]), tangents))
    tau = np.linspace(0.0, 1.0, 11)
    position, _ = thesis_swing(tau, x, z, end_speed=0.3)
    s = 0.3 * tau + (curve.length - 0.3) * quintic_blend(tau)[0]
    np.testing.assert_allclose(position, curve.position(s), atol=1e-12)


@few
@given(path=paths)
def test_the_thesis_swing_does_not_stop_on_its_path(path: FootPathParameters) -> None:
    """The arc length grows monotonically for every allowed size: s' > 0."""
    cycle = FootCycle(replace(path, swing="thesis"))
    speeds = [np.hypot(*cycle.derivative(p)) for p in np.linspace(0.0, 1.0, 401)]
    assert min(speeds) > path.step_length


def test_smooth_swing_has_far_smaller_accelerations() -> None:
    """The reason for a second law: peak acceleration of the foot at the default sizes."""
    phases, peak = np.linspace(0.0, 1.0, 4001), {}
    for law in LAWS:
        cycle = FootCycle(FootPathParameters(swing=law))  # type: ignore[arg-type]
        rates = np.array([cycle.derivative(p) for p in phases])
        peak[law] = np.linalg.norm(np.gradient(rates, phases, axis=0), axis=1).max()
    assert peak["smooth"] < 0.25 * peak["thesis"]


def test_the_path_is_the_same_shape_at_every_size() -> None:
    small, large = (FootPathParameters(L, H) for L, H in ((0.25, 0.05), (0.5, 0.1)))
    np.testing.assert_allclose(2 * swing_points(small), swing_points(large), atol=1e-9)


def test_timing_at_the_thesis_speed() -> None:
    """E26: v 1.4 with L 0.5 and duty 0.6 is a stride of 0.595 s, 202 steps a minute."""
    path = FootPathParameters()
    assert path.walked_stride / 1.4 == pytest.approx(0.595, abs=5e-4)
    assert 60.0 * 1.4 / path.walked_step == pytest.approx(202, abs=0.5)
    assert path.walked_step == pytest.approx(0.5 / 1.2)
    assert path.walked_stride == pytest.approx(2 * path.walked_step)
    assert path.walked_stride / 1.1 == pytest.approx(0.76, abs=5e-3)


@pytest.mark.parametrize(
    ("length_cm", "offset_cm"),
    [(30, 1.3), (40, 2.3), (50, 3.70), (60, 5.4), (70, 7.4), (80, 9.8)],
)
def test_minimum_offset_is_that_of_the_errata(length_cm: int, offset_cm: float) -> None:
    """E32, hip to ankle 86.4 cm."""
    digits = 5e-3 if length_cm == 50 else 5e-2
    assert minimum_offset(length_cm / 100, LEG_LENGTH) * 100 == pytest.approx(offset_cm, abs=1.01 * digits)


@given(length=st.floats(0.0, 1.6))
def test_minimum_offset_lets_a_straight_leg_just_reach(length: float) -> None:
    hip_height = LEG_LENGTH - minimum_offset(length, LEG_LENGTH)
    assert math.hypot(hip_height, length / 2) == pytest.approx(LEG_LENGTH)


@pytest.mark.parametrize("length", [1.8, -0.1, math.nan])
def test_a_step_longer_than_two_legs_has_no_offset(length: float) -> None:
    with pytest.raises(ValueError, match="step_length: "):
        minimum_offset(length, LEG_LENGTH)


@pytest.mark.parametrize("field", ["step_length", "step_height", "offset", "duty_factor"])
@pytest.mark.parametrize("value", [-0.1, 50.0, math.nan])
def test_values_out_of_range_are_rejected(field: Any, value: Any) -> None:
    with pytest.raises(ValueError, match=f"{field}: .*allowed"):
        FootPathParameters(**{field: value})


def test_a_running_duty_factor_is_rejected() -> None:
    """E26: the thesis' own duty, 0.42 to 0.46, leaves both feet in the air."""
    with pytest.raises(ValueError, match="duty_factor"):
        FootPathParameters(duty_factor=0.46)


def test_an_unknown_swing_is_rejected() -> None:
    with pytest.raises(ValueError, match=r"swing: .*thesis or smooth"):
        FootPathParameters(swing="moon")  # type: ignore[arg-type]
