"""Right and left."""

from humanwalk.sides import OUTWARD, SIDES, other_side


def test_the_opposite_of_the_opposite_side_is_the_side() -> None:
    assert all(other_side(other_side(side)) == side != other_side(side) for side in SIDES)


def test_outward_is_to_the_left_for_the_left_side_only() -> None:
    assert OUTWARD == {"Right": -1.0, "Left": 1.0}
