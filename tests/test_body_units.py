"""Parameters of the reference body in the units of another: every one by the unit of its field."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.subject import Subject
from humanwalk.body_units import BodyScale, dimensions, scaled
from humanwalk.choices import ACTUATIONS, CONTACTS, BalancedController, RecordedController, ThesisController
from humanwalk.quantity import GRAVITY, ParameterError, numbers_of, quantity
from humanwalk.scenario import Scenario
from humanwalk.walking.knowledge import KNOWLEDGE

FACTORS = st.floats(0.3, 3.0)
SCALES = st.builds(BodyScale, FACTORS, FACTORS)

SOLVER_UNITS = {"m, rad", "years"}
"""Units of a tolerance of inverse kinematics and of the age, which are no parameters of a body in motion."""


@dataclass(frozen=True)
class Leaf:
    length: float = quantity(0.5, "m", 0.0, 1.0)
    count: int = quantity(3, "", 0, 10)
    label: str = "no quantity"


@dataclass(frozen=True)
class Tree:
    leaf: Leaf = Leaf()
    several: tuple[Leaf, ...] = (Leaf(0.1), Leaf(0.2))
    by_name: dict[str, Leaf] = field(default_factory=lambda: {"a": Leaf(0.3)})
    time: float = quantity(2.0, "s", 0.0, 10.0)


def all_parameters() -> Iterator[tuple[str, str]]:
    """Name and unit of every quantity of a scenario, with each of its choices."""
    trees: list[Any] = [Scenario(), ThesisController(), BalancedController(), RecordedController("recording.csv")]
    trees += [kind() for kinds in (CONTACTS, ACTUATIONS, KNOWLEDGE) for kind in kinds.values()]
    for tree in trees:
        yield from ((f"{type(tree).__name__}.{name}", of["unit"]) for name, _, of in numbers_of(tree))


def test_the_unit_of_every_parameter_has_dimensions() -> None:
    units = {unit for _, unit in all_parameters()} - SOLVER_UNITS
    assert len(units) > 15
    for unit in units:
        dimensions(unit)


@pytest.mark.parametrize("unit", ["furlong", "N x/rad", *sorted(SOLVER_UNITS)])
def test_an_unknown_unit_is_refused(unit: str) -> None:
    with pytest.raises(ParameterError, match="unknown symbol"):
        dimensions(unit)


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        ("", (0, 0, 0)),
        ("rad", (0, 0, 0)),
        ("1/s2", (0, 0, -2)),
        ("rad s/m", (0, -1, 1)),
        ("N m s/rad", (1, 2, -1)),
        ("N s/m3", (1, -2, -1)),
        ("Pa", (1, -1, -2)),
    ],
)
def test_dimensions_follow_from_the_symbols(unit: str, expected: tuple[int, int, int]) -> None:
    assert dimensions(unit) == expected


@given(scale=SCALES)
def test_gravity_is_the_same_for_all_bodies(scale: BodyScale) -> None:
    assert scale.factor("m/s2") == pytest.approx(1.0)


@given(scale=SCALES)
def test_forces_are_measured_by_weight_and_moments_by_weight_times_length(scale: BodyScale) -> None:
    mass, length = scale.mass, scale.length
    for unit, expected in {
        "N": mass,
        "N m/rad": mass * length,
        "N m s/rad": mass * length * math.sqrt(length),
        "N/m": mass / length,
        "m/s": math.sqrt(length),
    }.items():
        assert scale.factor(unit) == pytest.approx(expected)


@given(scale=SCALES)
def test_a_tree_is_scaled_field_by_field(scale: BodyScale) -> None:
    tree = scaled(Tree(), scale)
    leaves = (tree.leaf, *tree.several, *tree.by_name.values())
    assert [leaf.length for leaf in leaves] == pytest.approx([scale.length * x for x in (0.5, 0.1, 0.2, 0.3)])
    assert all((leaf.count, leaf.label) == (3, "no quantity") for leaf in leaves)
    assert tree.time == pytest.approx(scale.time * 2.0)


def test_the_reference_body_keeps_every_bit() -> None:
    controller, thesis = BalancedController(), Subject(sex="unspecified")
    assert thesis.scale == BodyScale(1.0, 1.0)
    fitted = controller.fitted(thesis)
    # The height of its walk alone follows from its proportions, not from its units.
    height = replace(fitted.planner.height, walking=controller.planner.height.walking)
    assert replace(fitted, planner=replace(fitted.planner, height=height)) == controller


@given(scale=SCALES)
def test_the_inverse_scale_returns_the_parameters(scale: BodyScale) -> None:
    inverse = BodyScale(1.0 / scale.length, 1.0 / scale.mass)
    before, after = (
        dict((name, value) for name, value, _ in numbers_of(tree))
        for tree in (Tree(), scaled(scaled(Tree(), scale), inverse))
    )
    assert after == pytest.approx(before)


def test_a_taller_person_takes_longer_steps_of_longer_duration() -> None:
    tall = Subject(mass=90.0, stature=2.0)
    steps = [
        BalancedController().fitted(body).planner.timing.step / math.sqrt(body.skeleton.hip_height / GRAVITY)
        for body in (tall, Subject())
    ]
    assert steps[0] == pytest.approx(steps[1])
