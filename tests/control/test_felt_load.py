"""A load that is felt: mass and place of what ground and weight do not explain."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact.ground_force import FootForces
from humanwalk.control.felt_load import LoadFeeling, felt_load, limited, unexplained_wrench
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY

MASS, FEELING = 70.0, LoadFeeling()
HEAVY = st.floats(2.0 * FEELING.least * MASS, 60.0)
LIGHT = st.floats(-30.0, FEELING.least * MASS)
OFFSETS = st.floats(-FEELING.reach, FEELING.reach)


def weight_at(mass: float, along: float, across: float) -> Array:
    """Moment about the center of mass and force of a weight beside it."""
    force = np.array((0.0, 0.0, -mass * GRAVITY))
    return np.concatenate((np.cross((along, across, 0.0), force), force))


@given(seed=st.integers(0, 1000))
def test_ground_and_weight_explain_how_a_body_without_a_load_moves(seed: int) -> None:
    random = np.random.default_rng(seed)
    feet, com = random.normal(0.0, 100.0, (2, 8)), random.normal(size=3)
    force = feet[:, :3].sum(axis=0) - (0.0, 0.0, MASS * GRAVITY)
    moment = sum(np.cross(foot[3:6] - com, foot[:3]) + np.array((0.0, 0.0, foot[6])) for foot in feet)
    rate = np.concatenate((moment, force))
    np.testing.assert_allclose(unexplained_wrench(rate, FootForces.of(feet), com, MASS * GRAVITY), 0.0, atol=1e-9)


@given(mass=HEAVY, along=OFFSETS, across=OFFSETS)
def test_a_load_that_stands_still_is_felt_where_it_is(mass: float, along: float, across: float) -> None:
    """The body stands with the center of pressure below the center of mass of body and load."""
    com = np.array((0.3, -0.2, 1.0))
    place = com[:2] + mass / (MASS + mass) * np.array((along, across))
    feet = np.zeros((2, 8))
    feet[:, 2], feet[:, 3:5] = (MASS + mass) * GRAVITY / 2, place
    wrench = unexplained_wrench(np.zeros(6), FootForces.of(feet), com, MASS * GRAVITY)
    np.testing.assert_allclose(wrench, weight_at(mass, along, across), atol=1e-9)
    np.testing.assert_allclose(felt_load(wrench, MASS, GRAVITY, FEELING), (mass, along, across, 0.0), atol=1e-9)


@given(seed=st.integers(0, 1000), limit=st.floats(1.0, 1e3))
def test_an_impact_counts_as_a_limited_force(seed: int, limit: float) -> None:
    wrench = np.random.default_rng(seed).normal(0.0, 300.0, 6)
    less = limited(wrench, limit)
    assert abs(less[5]) <= limit * (1.0 + 1e-12)
    np.testing.assert_allclose(np.outer(less, wrench), np.outer(wrench, less))
    if abs(wrench[5]) <= limit:
        np.testing.assert_array_equal(less, wrench)


@given(mass=LIGHT, along=OFFSETS)
def test_a_light_load_is_not_felt(mass: float, along: float) -> None:
    np.testing.assert_array_equal(felt_load(weight_at(mass, along, 0.0), MASS, GRAVITY, FEELING), 0.0)


@given(share=st.floats(1.0, 2.0))
def test_a_load_is_felt_gradually(share: float) -> None:
    least = FEELING.least * MASS
    mass = felt_load(weight_at(share * least, 0.1, 0.0), MASS, GRAVITY, FEELING)[0]
    assert mass == pytest.approx(share * (share - 1.0) * least)


@given(moment=st.floats(-1e3, 1e3))
def test_a_load_is_felt_within_reach(moment: float) -> None:
    wrench = weight_at(10.0, 0.0, 0.0)
    wrench[:2] = moment
    load = felt_load(wrench, MASS, GRAVITY, FEELING)
    assert np.abs(load[1:3]).max() <= FEELING.reach
    assert load[3] == 0.0
