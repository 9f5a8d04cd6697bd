"""Right and left, in the order in which the two sides of the body appear everywhere."""

from typing import Literal

Side = Literal["Right", "Left"]
SIDES: tuple[Side, Side] = ("Right", "Left")
