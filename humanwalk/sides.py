"""Right and left, in the order in which the two sides of the body appear everywhere."""

from typing import Literal

Side = Literal["Right", "Left"]
SIDES: tuple[Side, Side] = ("Right", "Left")

OUTWARD: dict[Side, float] = {"Right": -1.0, "Left": 1.0}
"""Sign of y on the outer side of a limb."""


def other_side(side: Side) -> Side:
    """The other side of the body."""
    return "Left" if side == "Right" else "Right"
