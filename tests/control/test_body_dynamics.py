"""Dynamics of the body against Drake's own quantities."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.limbs import CHEST, LEGS
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY


@pytest.fixture(scope="module")
def dynamics(plant: MultibodyPlant) -> BodyDynamics:
    return BodyDynamics(plant)


def random_state(plant: MultibodyPlant, seed: int) -> Array:
    random = np.random.default_rng(seed)
    q = plant.GetPositions(plant.CreateDefaultContext()) + random.normal(0.0, 0.2, plant.num_positions())
    q[:4] /= np.linalg.norm(q[:4])
    return np.concatenate((q, random.normal(0.0, 0.5, plant.num_velocities())))


@settings(max_examples=10)
@given(seed=st.integers(0, 1000), load=st.sampled_from((NO_LOAD, np.array((20.0, -0.2, 0.1, -0.3)))))
def test_accelerations_are_the_differences_of_the_velocities(
    dynamics: Any, plant: MultibodyPlant, seed: int, load: Array
) -> None:
    """Of a point of the foot and of the center of mass, along a motion with constant v'."""
    state, h = random_state(plant, seed), 1e-6
    q, v = state[: plant.num_positions()], state[plant.num_positions() :]
    vdot = np.random.default_rng(seed + 1).normal(0.0, 1.0, v.size)
    context = plant.CreateDefaultContext()
    plant.SetPositionsAndVelocities(context, state)
    qdot = plant.MapVelocityToQDot(context, v)
    after, before = (dynamics.at(np.concatenate((q + s * qdot, v + s * vdot)), load) for s in (h, -h))
    point = np.array((0.1, 0.02, -0.05))
    for of in (lambda body: body.com, lambda body: body.frame(LEGS["Left"].hindfoot).point(point)):
        here = of(dynamics.at(state, load))  # type: ignore[no-untyped-call]
        difference = (of(after).velocity - of(before).velocity) / (2 * h)  # type: ignore[no-untyped-call]
        np.testing.assert_allclose(here.J @ vdot + here.bias, difference, rtol=0, atol=1e-5)
        np.testing.assert_allclose(here.J @ v, here.velocity, rtol=0, atol=1e-12)


@settings(max_examples=10)
@given(seed=st.integers(0, 1000), mass=st.floats(1.0, 60.0))
def test_a_load_adds_its_inertia_its_weight_and_its_share_of_the_center_of_mass(
    dynamics: Any, plant: MultibodyPlant, seed: int, mass: float
) -> None:
    """At rest, where h is the weight alone."""
    state = random_state(plant, seed)
    state[plant.num_positions() :] = 0.0
    place = np.array((-0.2, 0.1, -0.3))
    free, loaded = dynamics.at(state), dynamics.at(state, np.array((mass, *place)))
    point = free.frame(CHEST).point(place)
    np.testing.assert_allclose(loaded.M, free.M + mass * point.J.T @ point.J, atol=1e-8)
    np.testing.assert_allclose(loaded.h, free.h + mass * GRAVITY * point.J[2], atol=1e-8)
    total = free.mass + mass
    assert loaded.mass == pytest.approx(total)
    np.testing.assert_allclose(loaded.com.position, (free.mass * free.com.position + mass * point.position) / total)
    np.testing.assert_allclose(loaded.com.J, (free.mass * free.com.J + mass * point.J) / total, atol=1e-12)
