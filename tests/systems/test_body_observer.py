"""Body observer: the soles and the center of mass of a plant state."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from humanwalk.body.limbs import PELVIS
from humanwalk.body.skeleton import Skeleton
from humanwalk.contact.ground_force import FootForces
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import yaw_pitch
from humanwalk.sides import SIDES
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.terrain import Plane
from humanwalk.walking.walking_reference import BodyState

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@pytest.fixture(scope="module")
def observer(plant: MultibodyPlant) -> BodyObserver:
    return BodyObserver(plant)


@pytest.fixture(scope="module")
def observed(observer: BodyObserver) -> Callable[..., Any]:
    """(soles, com) of a plant state."""

    def outputs(state: Array) -> tuple[Array, Array]:
        context = observer.CreateDefaultContext()
        observer.GetInputPort("state").FixValue(context, state)
        return (
            observer.GetOutputPort("soles").Eval(context),
            observer.GetOutputPort("com").Eval(context),
        )

    return outputs


def random_state(plant: MultibodyPlant, rng: np.random.Generator) -> tuple[Array, Array]:
    q = plant.GetPositions(plant.CreateDefaultContext())
    q[:4] = rng.normal(size=4)
    q[:4] /= np.linalg.norm(q[:4])
    q[4:] += rng.normal(scale=0.3, size=q.size - 4)
    return q, rng.normal(size=plant.num_velocities())


def test_ports(observer: BodyObserver, plant: MultibodyPlant) -> None:
    inputs = [observer.get_input_port(i) for i in range(observer.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [
        ("state", plant.num_multibody_states()),
        ("load", 4),
    ]
    for port, name in ((observer.GetOutputPort("soles"), "soles"), (observer.GetOutputPort("com"), "com")):
        assert (port.get_name(), port.size()) == (name, 6)


def test_neutral_standing_agrees_with_the_skeleton(
    observed: Callable[..., Any], plant: MultibodyPlant, skeleton: Skeleton
) -> None:
    soles, com = observed(plant.GetPositionsAndVelocities(plant.CreateDefaultContext()))
    width = skeleton.hip_half_width
    np.testing.assert_allclose(soles, [0, -width, 0, 0, width, 0], atol=1e-9)
    np.testing.assert_allclose(com[:3], skeleton.com, atol=1e-6)
    np.testing.assert_allclose(com[3:], 0.0, atol=1e-12)


@settings(max_examples=25)
@given(rng=seeds)
def test_com_velocity_is_the_rate_of_its_position(
    observed: Callable[..., Any], plant: MultibodyPlant, rng: np.random.Generator
) -> None:
    q, v = random_state(plant, rng)
    h = 1e-6
    q_rate = plant.MapVelocityToQDot(_at(plant, q), v)
    ahead, behind = (observed(np.concatenate((q + s * h * q_rate, v)))[1][:3] for s in (1, -1))
    np.testing.assert_allclose(observed(np.concatenate((q, v)))[1][3:], (ahead - behind) / (2 * h), atol=1e-6)


def _at(plant: MultibodyPlant, q: Array) -> Context:
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, q)
    return context


@given(rng=seeds, shift=st.tuples(*[st.floats(-5, 5)] * 3))
@settings(max_examples=25)
def test_a_translation_of_the_body_translates_its_points(
    observed: Callable[..., Any], plant: MultibodyPlant, rng: np.random.Generator, shift: tuple[float, float, float]
) -> None:
    q, v = random_state(plant, rng)
    moved = q.copy()
    moved[4:7] += shift
    soles, com = observed(np.concatenate((q, v)))
    soles_there, com_there = observed(np.concatenate((moved, v)))
    np.testing.assert_allclose(soles_there, soles + np.tile(shift, 2), atol=1e-9)
    np.testing.assert_allclose(com_there, com + np.concatenate((shift, np.zeros(3))), atol=1e-9)


def test_each_port_has_a_signal_with_a_column_per_element(observer: BodyObserver) -> None:
    assert [signal.name for signal in observer.signals] == ["soles", "com"]
    assert all(len(signal.columns) == signal.port.size() for signal in observer.signals)
    assert observer.signals[0].columns[3] == "left_sole.x_m"


@pytest.mark.parametrize("slope", [-0.3, 0.0, 0.2])
@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (0.4, 0.0), (0.0, 0.3), (-1.0, -0.2)])
def test_yaw_and_pitch_of_the_feet_are_relative_to_the_terrain(
    observer: BodyObserver, plant: Any, slope: float, yaw: float, pitch: float
) -> None:
    """With all joints at zero the feet have the orientation of the pelvis."""
    context, terrain = plant.CreateDefaultContext(), Plane(slope=slope)
    R_WF = terrain.axes(np.zeros(2)).T @ yaw_pitch(yaw, pitch)
    pelvis = plant.GetBodyByName(PELVIS)
    X_WP = pelvis.EvalPoseInWorld(context)
    X_WP.set_rotation(type(X_WP.rotation())(R_WF))
    plant.SetFreeBodyPose(context, pelvis, X_WP)
    observed = observer.CreateDefaultContext()
    observer.GetInputPort("state").FixValue(observed, plant.GetPositionsAndVelocities(context))
    ankles = observer.GetOutputPort("ankles").Eval(observed).reshape(2, 5, 3)
    forces = FootForces.of(np.arange(16.0))
    body = BodyState.measured(observer.GetOutputPort("com").Eval(observed), ankles, forces, terrain)
    assert (body.right.force, body.left.force) == (2.0, 10.0)
    assert body.right.pressure.tolist() == [3.0, 4.0, 5.0]
    for foot in (body.right, body.left):
        assert (foot.yaw, foot.pitch) == pytest.approx((yaw, pitch), abs=1e-9)
        assert foot.pitch_rate == pytest.approx(0.0, abs=1e-9)
        np.testing.assert_allclose(foot.forward, R_WF[:, 0], atol=1e-9)
        np.testing.assert_allclose(foot.normal, R_WF[:, 2], atol=1e-9)


@settings(max_examples=25)
@given(rng=seeds)
def test_velocities_of_the_ankles_are_the_rates_of_their_poses(
    observer: BodyObserver, plant: MultibodyPlant, rng: np.random.Generator
) -> None:
    """In W, and of the feet relative to a plane."""
    (q, v), terrain, h = random_state(plant, rng), Plane(slope=0.2, cross_slope=-0.1), 1e-6
    q_rate = plant.MapVelocityToQDot(_at(plant, q), v)

    def observed(q: Array) -> tuple[Array, BodyState]:
        context = observer.CreateDefaultContext()
        observer.GetInputPort("state").FixValue(context, np.concatenate((q, v)))
        ankles = observer.GetOutputPort("ankles").Eval(context).reshape(2, 5, 3)
        return ankles, BodyState.measured(np.zeros(6), ankles, FootForces.of(np.zeros(16)), terrain)

    (ankles, body), (ahead, body_ahead), (behind, body_behind) = (observed(q + s * h * q_rate) for s in (0, 1, -1))
    velocity, x, z, w = ankles[:, 1:].swapaxes(0, 1)
    rates = ((ahead - behind) / (2 * h))[:, [0, 2, 3]].swapaxes(0, 1)
    np.testing.assert_allclose((velocity, np.cross(w, x), np.cross(w, z)), rates, atol=1e-6)
    for side in SIDES:
        foot, earlier, later = (state.foot(side) for state in (body, body_behind, body_ahead))
        for name, rate in (("position", "velocity"), ("height", "height_rate"), ("pitch", "pitch_rate")):
            change = getattr(later, name) - getattr(earlier, name)
            # Near the vertical the pitch has no rate.
            if abs(foot.pitch) < 1.3 or name != "pitch":
                assert getattr(foot, rate) == pytest.approx(change / (2 * h), abs=1e-5), name
