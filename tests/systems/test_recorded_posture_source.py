"""The recorded posture as ports: piecewise cubic, with velocities that are derivatives, from rest to rest."""

import numpy as np
import pytest
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RotationMatrix

from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.numerics import Array
from humanwalk.systems.recorded_posture_source import RecordedPostureSource

N = 3


def motion(ease_in: float = 0.3, period: float = 0.02, duration: float = 1.0) -> RecordedMotion:
    time = np.arange(0, duration + 0.5 * period, period)
    angles = np.column_stack([np.sin((i + 2) * time) for i in range(N)])
    turns = np.column_stack((0.1 * np.sin(3 * time), 0.2 * np.cos(2 * time), 0.5 * time))
    place = np.column_stack((1.2 * time, 0.02 * np.sin(4 * time), 0.9 + 0.01 * np.cos(8 * time)))
    return RecordedMotion(time, angles, turns, place, ease_in)


def at(source: RecordedPostureSource, time: float) -> dict[str, Array]:
    context = source.CreateDefaultContext()
    context.SetTime(time)
    reference = source.GetOutputPort("pelvis_reference").Eval(context)
    return {
        "desired_state": source.GetOutputPort("desired_state").Eval(context),
        "R_WP": RotationMatrix(Quaternion(reference[:4])).matrix(),
        "p_WP": reference[4:7],
        "w_WP": reference[7:10],
        "v_WP": reference[10:],
    }


def test_ports_are_those_of_the_docstring() -> None:
    source = RecordedPostureSource(motion())
    names = [source.get_output_port(i).get_name() for i in range(source.num_output_ports())]
    assert names == ["desired_state", "pelvis_reference"]
    assert source.num_input_ports() == 0
    assert source.GetOutputPort("desired_state").size() == 2 * N


@pytest.mark.parametrize("ease_in", [0.0, 0.3])
def test_the_motion_passes_through_its_samples_after_the_ease_in(ease_in: float) -> None:
    recorded = motion(ease_in)
    source = RecordedPostureSource(recorded)
    for row in (20, 33, 50):
        found = at(source, recorded.time[row] + 0.5 * ease_in)
        np.testing.assert_allclose(found["desired_state"][:N], recorded.angles[row], atol=1e-9)
        np.testing.assert_allclose(found["p_WP"], recorded.pelvis_position[row], atol=1e-9)


@pytest.mark.parametrize("time", [0.05, 0.2, 0.37, 0.71, 1.11])
def test_velocities_are_time_derivatives(time: float) -> None:
    source, h = RecordedPostureSource(motion()), 1e-6
    before, now, after = at(source, time - h), at(source, time), at(source, time + h)
    rate = (after["desired_state"][:N] - before["desired_state"][:N]) / (2 * h)
    np.testing.assert_allclose(now["desired_state"][N:], rate, atol=1e-5)
    np.testing.assert_allclose(now["v_WP"], (after["p_WP"] - before["p_WP"]) / (2 * h), atol=1e-5)
    R = [state["R_WP"] for state in (before, now, after)]
    w_cross = (R[2] - R[0]) / (2 * h) @ R[1].T
    w = 0.5 * np.array([w_cross[2, 1] - w_cross[1, 2], w_cross[0, 2] - w_cross[2, 0], w_cross[1, 0] - w_cross[0, 1]])
    np.testing.assert_allclose(now["w_WP"], w, atol=1e-5)


def test_motion_starts_and_ends_at_rest() -> None:
    recorded = motion()
    source = RecordedPostureSource(recorded)
    for time, row in ((0.0, 0), (recorded.time[-1] + 1.0, -1)):
        found = at(source, time)
        np.testing.assert_allclose(found["desired_state"][:N], recorded.angles[row], atol=1e-12)
        np.testing.assert_allclose(found["desired_state"][N:], 0.0, atol=1e-12)
        np.testing.assert_allclose(found["w_WP"], 0.0, atol=1e-12)
        np.testing.assert_allclose(found["v_WP"], 0.0, atol=1e-12)


@pytest.mark.parametrize("period", [0.005, 0.01, 0.02, 0.04])
def test_the_sampling_rate_hardly_matters(period: float) -> None:
    """Resampling: the curve between samples is the recorded motion, whatever the rate."""
    source = RecordedPostureSource(motion(ease_in=0.0, period=period))
    for time in (0.1234, 0.5, 0.777):
        np.testing.assert_allclose(
            at(source, time)["desired_state"][:N], np.sin((np.arange(N) + 2) * time), atol=10 * period**2
        )


def test_curve_does_not_overshoot_its_samples() -> None:
    time = np.arange(6.0)
    step = np.array([0, 0, 0, 1, 1, 1.0])[:, None]
    recorded = RecordedMotion(time, step, np.zeros((6, 3)), np.zeros((6, 3)), 0.0)
    values = [recorded.joints(t)[0][0] for t in np.linspace(0, 5, 101)]
    assert min(values) >= -1e-12
    assert max(values) <= 1 + 1e-12


def test_two_samples_are_enough() -> None:
    recorded = RecordedMotion(np.array([0.0, 1.0]), np.array([[0.0], [1.0]]), np.zeros((2, 3)), np.zeros((2, 3)), 0.0)
    angle, rate = recorded.joints(0.25)
    assert (angle[0], rate[0]) == pytest.approx((0.25, 1.0))


def test_the_pelvis_is_recorded() -> None:
    (signal,) = RecordedPostureSource(motion()).signals
    assert signal.name == "pelvis_reference"
    assert len(signal.columns) == signal.port.size()
