"""Curves over the gait cycle are periodic and smooth, and people's are those that walks are scored with."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES, human
from humanwalk.body.pelvic_plane import PELVIC_TILT
from humanwalk.gait.normative import CYCLE, dimensionless_speed, people, speed_group
from humanwalk.motion.gait_curves import ANGLES, GaitCurves, normative_curves
from humanwalk.sides import Side

LEG = human().hip_height
CURVES = normative_curves(LEG)
phases = st.floats(0.0, 1.0)


@given(st.sampled_from(SIDES), phases, st.floats(0.3, 2.0))
def test_curves_are_periodic(side: Side, phase: float, speed: float) -> None:
    here, later = CURVES.at(side, phase, speed), CURVES.at(side, phase + 1.0, speed)
    for value, again in zip(here, later, strict=True):
        assert value == pytest.approx(again, abs=1e-9)


@given(st.sampled_from(SIDES), phases, st.floats(0.3, 2.0))
def test_slopes_and_curvatures_are_derivatives(side: Side, phase: float, speed: float) -> None:
    h = 1e-5
    before, here, after = (CURVES.at(side, phase + d, speed) for d in (-h, 0.0, h))
    assert (after.value - before.value) / (2.0 * h) == pytest.approx(here.slope, abs=1e-4)
    assert (after.slope - before.slope) / (2.0 * h) == pytest.approx(here.curvature, abs=1e-2)


@pytest.mark.parametrize("speed", CURVES.speeds.tolist())
def test_peoples_curves_are_those_of_their_speed_group(speed: float) -> None:
    group = speed_group(dimensionless_speed(speed, LEG))
    zero = np.array((PELVIC_TILT, 0.0, 0.0))
    angles = np.degrees([CURVES.at("Left", phase / 100.0, speed).value + zero for phase in CYCLE])
    for column, name in enumerate(ANGLES):
        band = people(name, group)
        assert np.abs(angles[:, column] - band.mean).max() < 0.5 * band.sd.mean()


def test_between_two_speeds_angles_are_between() -> None:
    slow, free, _ = CURVES.speeds
    low, middle, high = (CURVES.at("Right", 0.7, v).value for v in (slow, 0.5 * (slow + free), free))
    assert middle == pytest.approx(0.5 * (low + high))
    assert CURVES.at("Right", 0.7, 0.5 * slow).value == pytest.approx(low)


def test_a_series_goes_through_smooth_angles_of_each_leg() -> None:
    phase = np.arange(50) / 50.0
    right = np.column_stack((np.cos(2 * np.pi * phase), 0.3 + 0.1 * np.sin(4 * np.pi * phase), 0.0 * phase))
    curves = GaitCurves.through(np.array([1.0]), np.stack((right, -right), axis=1)[None])
    for row in (0, 13, 49):
        assert curves.at("Right", phase[row], 5.0).value == pytest.approx(right[row])
        assert curves.at("Left", phase[row], 0.0).value == pytest.approx(-right[row])
