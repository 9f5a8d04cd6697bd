"""Dynamics and measured state of the body against Drake's own quantities."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import yaw_pitch
from humanwalk.terrain import Plane

NO_FORCES = {"Right": 0.0, "Left": 0.0}


@pytest.fixture(scope="module")
def dynamics(plant: MultibodyPlant) -> BodyDynamics:
    return BodyDynamics(plant)


def random_state(plant: MultibodyPlant, seed: int) -> Array:
    random = np.random.default_rng(seed)
    q = plant.GetPositions(plant.CreateDefaultContext()) + random.normal(0.0, 0.2, plant.num_positions())
    q[:4] /= np.linalg.norm(q[:4])
    return np.concatenate((q, random.normal(0.0, 0.5, plant.num_velocities())))


@settings(max_examples=10)
@given(seed=st.integers(0, 1000))
def test_accelerations_are_the_differences_of_the_velocities(dynamics: Any, plant: MultibodyPlant, seed: int) -> None:
    """Of a point of the foot and of the center of mass, along a motion with constant v'."""
    state, h = random_state(plant, seed), 1e-6
    q, v = state[: plant.num_positions()], state[plant.num_positions() :]
    vdot = np.random.default_rng(seed + 1).normal(0.0, 1.0, v.size)
    context = plant.CreateDefaultContext()
    plant.SetPositionsAndVelocities(context, state)
    qdot = plant.MapVelocityToQDot(context, v)
    after, before = (dynamics.at(np.concatenate((q + s * qdot, v + s * vdot))) for s in (h, -h))
    point = np.array((0.1, 0.02, -0.05))
    for of in (lambda body: body.com, lambda body: body.frame(LEGS["Left"].hindfoot).point(point)):
        here = of(dynamics.at(state))  # type: ignore[no-untyped-call]
        difference = (of(after).velocity - of(before).velocity) / (2 * h)  # type: ignore[no-untyped-call]
        np.testing.assert_allclose(here.J @ vdot + here.bias, difference, rtol=0, atol=1e-5)
        np.testing.assert_allclose(here.J @ v, here.velocity, rtol=0, atol=1e-12)


@pytest.mark.parametrize("slope", [-0.3, 0.0, 0.2])
@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (0.4, 0.0), (0.0, 0.3), (-1.0, -0.2)])
def test_yaw_and_pitch_of_the_feet_are_relative_to_the_terrain(
    dynamics: Any, plant: Any, slope: float, yaw: float, pitch: float
) -> None:
    """With all joints at zero the feet have the orientation of the pelvis."""
    context, terrain = plant.CreateDefaultContext(), Plane(slope=slope)
    R_WF = terrain.axes(np.zeros(2)).T @ yaw_pitch(yaw, pitch)
    pelvis = plant.GetBodyByName(PELVIS)
    X_WP = pelvis.EvalPoseInWorld(context)
    X_WP.set_rotation(type(X_WP.rotation())(R_WF))
    plant.SetFreeBodyPose(context, pelvis, X_WP)
    body = dynamics.body_state(plant.GetPositionsAndVelocities(context), np.zeros(6), NO_FORCES, terrain)
    for foot in (body.right, body.left):
        assert (foot.yaw, foot.pitch) == pytest.approx((yaw, pitch), abs=1e-9)
        assert foot.pitch_rate == pytest.approx(0.0, abs=1e-9)
