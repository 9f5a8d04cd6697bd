"""Hanging arms: the heavier a hand, the less its arm swings."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.hanging_arm import hanging_arms
from humanwalk.body.loads import Backpack, Suitcase
from humanwalk.body.subject import Subject
from humanwalk.numerics import Array
from humanwalk.sides import SIDES, Side, other_side

MASSES, SIDE = st.floats(0.1, 30.0), st.sampled_from(SIDES)


def freedom(subject: Subject, load: Array = NO_LOAD) -> dict[Side, float]:
    return {side: arm.freedom(load) for side, arm in hanging_arms(subject).items()}


def test_arms_without_a_load_are_free() -> None:
    assert freedom(Subject()) == {"Right": 1.0, "Left": 1.0}
    assert freedom(Subject(loads=(Backpack(20.0),))) == pytest.approx({"Right": 1.0, "Left": 1.0})


@given(mass=MASSES, side=SIDE)
def test_an_arm_is_the_less_free_the_more_it_carries(mass: float, side: Side) -> None:
    """Its moment of inertia grows with the mass."""
    light, heavy = (freedom(Subject(loads=(Suitcase(m, side),))) for m in (mass, 2.0 * mass))
    assert 1.0 > light[side] > heavy[side] > 0.0
    assert 1.0 / heavy[side] - 1.0 == pytest.approx(2.0 * (1.0 / light[side] - 1.0))
    assert light[other_side(side)] == pytest.approx(1.0)


def test_an_arm_is_free_if_its_person_does_not_know_of_its_load() -> None:
    assert freedom(Subject(loads=(Suitcase(8.0, known=False),))) == {"Right": 1.0, "Left": 1.0}


@given(mass=MASSES, side=SIDE)
def test_a_load_that_is_felt_at_a_hand_is_in_the_hand(mass: float, side: Side) -> None:
    """A mass at the wrist."""
    arm = hanging_arms(Subject())[side]
    felt = freedom(Subject(), np.array((mass, 0.0, arm.aside, -0.3)))
    assert felt[side] == pytest.approx(arm.inertia / (arm.inertia + mass * arm.length**2))
    assert felt[other_side(side)] == 1.0


@given(mass=MASSES, share=st.floats(-0.5, 0.5))
def test_a_load_that_is_felt_at_the_trunk_is_not_in_a_hand(mass: float, share: float) -> None:
    aside = hanging_arms(Subject())["Left"].aside
    assert freedom(Subject(), np.array((mass, -0.2, share * aside, 0.0))) == {"Right": 1.0, "Left": 1.0}
