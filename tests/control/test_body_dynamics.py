"""Dynamics of the body against Drake's own quantities."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.limbs import LEGS
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.numerics import Array


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
