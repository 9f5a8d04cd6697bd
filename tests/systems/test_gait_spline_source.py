"""Gait spline source: poses in the pelvis frame, their exact rates, and stance feet at rest in the world."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity

from humanwalk.body.skeleton import Skeleton
from humanwalk.control.inverse_kinematics import pose_error
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.numerics import Array
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.terrain import Course
from humanwalk.terrain.slope import Slope
from humanwalk.walking.gait_on_ground import GaitOnGround

SIDES = ("Right", "Left")
STEP = 1e-6
times = st.floats(0.0, 6.0)


@pytest.fixture(scope="module")
def source(gait: WalkingGait, skeleton: Skeleton) -> GaitSplineSource:
    return GaitSplineSource(gait, skeleton)


@pytest.fixture(scope="module")
def at(source: GaitSplineSource) -> Callable[..., Any]:
    """Every output by name at a time [s], and poses and velocities of pelvis_reference and sole_targets."""
    context = source.CreateDefaultContext()

    def outputs(t: float) -> dict[str, Array | RigidTransform | SpatialVelocity]:
        context.SetTime(t)
        found = {
            source.get_output_port(i).get_name(): source.get_output_port(i).Eval(context)
            for i in range(source.num_output_ports())
        }
        right, left = np.split(found["sole_targets"], 2)
        for pair, values in (("WP", found["pelvis_reference"]), ("PRs", right), ("PLs", left)):
            found[f"X_{pair}"] = RigidTransform(Quaternion(values[:4]), values[4:7])
            found[f"V_{pair}"] = SpatialVelocity(values[7:])
        return found

    return outputs


def test_ports(source: GaitSplineSource) -> None:
    assert source.num_input_ports() == 0
    names = {source.get_output_port(i).get_name() for i in range(source.num_output_ports())}
    assert names == {"sole_targets", "pelvis_reference", "phase", "contact_schedule"}
    soles = source.GetOutputPort("sole_targets")
    assert (soles.get_name(), soles.size()) == ("sole_targets", 26)
    pelvis = source.GetOutputPort("pelvis_reference")
    assert (pelvis.get_name(), pelvis.size()) == ("pelvis_reference", 13)
    assert (source.GetOutputPort("phase").get_name(), source.GetOutputPort("phase").size()) == ("phase", 2)
    assert source.GetOutputPort("contact_schedule").get_name() == "contact_schedule"
    assert source.GetOutputPort("contact_schedule").size() == 2


@pytest.mark.parametrize(("pose", "velocity"), [("X_PRs", "V_PRs"), ("X_PLs", "V_PLs"), ("X_WP", "V_WP")])
@settings(max_examples=200)
@given(t=times)
def test_velocities_are_the_rates_of_the_poses(
    at: Callable[..., Any], gait: WalkingGait, pose: str, velocity: str, t: float
) -> None:
    behind, ahead = max(t - STEP, 0.0), t + STEP
    quotient = pose_error(at(ahead)[pose], at(behind)[pose]) / (ahead - behind)
    # Accelerations stay below 500 in SI units, one of them may begin within the difference.
    np.testing.assert_allclose(at(t)[velocity].get_coeffs(), quotient, atol=500 * STEP + 1e-6)


@pytest.mark.parametrize("t", [0.0, 0.364999, 0.365, 0.365001])
def test_velocities_do_not_jump_where_the_speed_ramp_begins_and_ends(at: Callable[..., Any], t: float) -> None:
    for name in ("V_PRs", "V_PLs", "V_WP"):
        before, after = (at(max(t + e, 0.0))[name].get_coeffs() for e in (-STEP, STEP))
        np.testing.assert_allclose(before, after, atol=1000 * STEP)


@settings(max_examples=200)
@given(t=times)
def test_a_sole_in_stance_is_at_rest_and_level_in_the_world(
    at: Callable[..., Any], footsteps: Callable[..., Any], gait: WalkingGait, t: float
) -> None:
    here = at(t)
    for i, side in enumerate(SIDES):
        X_WS = here["X_WP"] @ here[f"X_P{side[0]}s"]
        if not here["contact_schedule"][i]:
            assert X_WS.translation()[2] > -1e-9
            continue
        landed = max(
            (s for s in footsteps(gait, t + 1.0) if s.side == side and s.touchdown <= t + 1e-9),
            key=lambda s: s.touchdown,
        )
        np.testing.assert_allclose(X_WS.translation(), landed.position, atol=1e-7)
        np.testing.assert_allclose(X_WS.rotation().matrix(), np.eye(3), atol=1e-9)


@given(t=times)
def test_stance_is_the_first_part_of_the_phase(at: Callable[..., Any], gait: WalkingGait, t: float) -> None:
    here = at(t)
    for i, side in enumerate(SIDES):
        assert 0.0 <= here["phase"][i] < 1.0
        # The first swing starts from standing: its phase is nominal.
        if side != gait.first_swing or t >= gait.start_time:
            assert here["contact_schedule"][i] == float(here["phase"][i] < gait.parameters.duty_factor)


@given(t=times)
def test_feet_are_half_a_cycle_apart_and_one_is_always_down(at: Callable[..., Any], t: float) -> None:
    here = at(t)
    right, left = here["phase"]
    assert (right - left) % 1.0 == pytest.approx(0.5, abs=1e-9)
    assert here["contact_schedule"].sum() >= 1
    assert set(here["contact_schedule"]) <= {0.0, 1.0}


TILTED = Slope(slope=0.08, cross_slope=-0.07, length=3.0)


@pytest.mark.parametrize("t", np.linspace(0.5, 2.5, 21))
def test_on_a_tilted_face_soles_lie_on_it_and_velocities_are_the_rates_of_the_poses(
    skeleton: Skeleton, t: float
) -> None:
    terrain = Course(pieces=(TILTED,))
    walk = GaitOnGround(FootPathParameters(), SpeedRamp(1.4, 0.365), "Right", terrain, skeleton)
    source = GaitSplineSource(walk, skeleton)
    context = source.CreateDefaultContext()

    def outputs(time: float) -> tuple[list[RigidTransform], list[Array], Array]:
        context.SetTime(time)
        rows = np.split(source.GetOutputPort("sole_targets").Eval(context), 2)
        pelvis = source.GetOutputPort("pelvis_reference").Eval(context)
        poses = [RigidTransform(Quaternion(row[:4]), row[4:7]) for row in (*rows, pelvis)]
        return poses, [row[7:] for row in (*rows, pelvis)], source.GetOutputPort("phase").Eval(context)

    (poses, velocities, phases), (after, _, _), (before, _, _) = (outputs(time) for time in (t, t + STEP, t - STEP))
    for velocity, late, early in zip(velocities, after, before, strict=True):
        np.testing.assert_allclose(velocity, pose_error(late, early) / (2 * STEP), atol=500 * STEP)
    for X_PS, phase in zip(poses[:2], phases, strict=True):
        X_WS = poses[2] @ X_PS
        xy = X_WS.translation()[:2]
        # Later in stance the heel may rise.
        if phase <= 0.5 * walk.parameters.duty_factor:
            assert X_WS.translation()[2] == pytest.approx(float(terrain.height(xy)), abs=1e-9)
            np.testing.assert_allclose(X_WS.rotation().matrix(), terrain.axes(xy).T, atol=1e-9)


def test_it_starts_standing_on_both_feet(at: Callable[..., Any], skeleton: Skeleton) -> None:
    start = at(0.0)
    np.testing.assert_array_equal(start["contact_schedule"], [1, 1])
    np.testing.assert_allclose(start["X_WP"].translation(), [0, 0, skeleton.hip_height], atol=1e-12)
    for name in ("V_PRs", "V_PLs", "V_WP"):
        np.testing.assert_allclose(start[name].get_coeffs(), 0.0, atol=1e-12)


def test_pelvis_walks_upright_along_x(at: Callable[..., Any], gait: WalkingGait) -> None:
    steady = at(4.0)
    np.testing.assert_allclose(steady["V_WP"].get_coeffs(), [0, 0, 0, gait.ramp.speed, 0, 0], atol=1e-12)
    np.testing.assert_allclose(steady["X_WP"].rotation().matrix(), np.eye(3), atol=1e-12)


@given(t=times, preview=st.floats(0.0, 0.05))
def test_the_preview_applies_to_the_soles_only(
    source: GaitSplineSource, gait: WalkingGait, skeleton: Skeleton, preview: float, t: float
) -> None:
    ahead = GaitSplineSource(gait, skeleton, preview)

    def value(system: GaitSplineSource, name: str, time: float) -> Array:
        context = system.CreateDefaultContext()
        context.SetTime(time)
        return system.GetOutputPort(name).Eval(context)

    for name, time in (("sole_targets", t + preview), ("pelvis_reference", t), ("phase", t)):
        np.testing.assert_allclose(value(ahead, name, t), value(source, name, time), atol=1e-12)


@given(t=times)
def test_the_pelvis_sinks_by_the_offset_until_the_first_touchdown(
    at: Callable[..., Any], gait: WalkingGait, skeleton: Skeleton, t: float
) -> None:
    height = skeleton.hip_height - at(t)["X_WP"].translation()[2]
    assert -1e-12 <= height <= gait.parameters.offset + 1e-12
    if t >= gait.start_time:
        assert height == pytest.approx(gait.parameters.offset, abs=1e-12)


def test_every_port_but_the_soles_has_a_signal_with_a_column_per_element(source: GaitSplineSource) -> None:
    assert [signal.name for signal in source.signals] == ["phase", "contact_schedule", "pelvis_reference"]
    assert all(len(signal.columns) == signal.port.size() for signal in source.signals)
