"""Loads that a person carries: rigid bodies welded to a segment, uniform and without contact.

Each kind is a frozen dataclass whose parts are a function of the skeleton that carries it. `known` tells whether the
walker's own model of its body includes the load; the balanced walker feels a load that it lacks.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, Protocol

from humanwalk.body.shapes import Box, Cylinder, Shape, Vector3
from humanwalk.body.skeleton import Segment, Skeleton, Weld
from humanwalk.body.visual import Color, Visual, capsule, ellipsoid
from humanwalk.body.visuals import CHEST_CENTER, CHEST_RADII
from humanwalk.quantity import quantity
from humanwalk.sides import OUTWARD, SIDES

CLOTH: Color = (0.20, 0.36, 0.30)
POCKET: Color = (0.26, 0.45, 0.38)
STRAP: Color = (0.11, 0.12, 0.13)
CASE: Color = (0.45, 0.16, 0.18)

STRAP_PATH: tuple[Vector3, ...] = (
    (-0.090, 0.095, 0.170),
    (-0.045, 0.095, 0.205),
    (0.010, 0.095, 0.205),
    (0.060, 0.095, 0.175),
    (0.094, 0.092, 0.110),
    (0.104, 0.095, 0.030),
    (0.085, 0.125, -0.050),
    (0.020, 0.165, -0.080),
    (-0.060, 0.150, -0.100),
)
"""Left strap of a backpack on the skin of the reference human: from the bag over the shoulder, down the chest and below
the arm back to the bag, in the frame of the rib cage [m]."""

GRIP = 0.10
"""Distance of the grip of a hanging hand below the wrist of the reference human [m]."""


@dataclass(frozen=True)
class LoadPart:
    """A rigid part of a load.

    Attributes:
        name: Part of the name of its body.
        parent: Segment that it is welded to.
        center: Center in the segment's frame [m].
        shape: Uniform solid.
        mass: [kg].
        drawn: What is drawn; body names and centers are relative to the part.
    """

    name: str
    parent: str
    center: Vector3
    shape: Shape
    mass: float
    drawn: tuple[Visual, ...]


class Load(Protocol):
    """One kind of load."""

    @property
    def known(self) -> bool:
        """Whether the walker's model of its body includes the load."""

    @property
    def total(self) -> float:
        """Mass of all parts [kg]."""

    def parts(self, skeleton: Skeleton) -> Iterator[LoadPart]:
        """Yield the parts on the body that carries the load."""


@dataclass(frozen=True)
class Backpack:
    """A box on the back of the chest."""

    mass: float = quantity(10.0, "kg", 0.1, 80.0)
    """Mass; military packs reach 45 kg."""

    depth: float = quantity(0.20, "m", 0.02, 0.6)
    """Size fore-aft."""

    width: float = quantity(0.30, "m", 0.05, 0.8)
    """Size sideways."""

    height: float = quantity(0.45, "m", 0.05, 1.0)
    """Size up."""

    raised: float = quantity(0.0, "m", -0.4, 0.4)
    """Height of its middle above the middle of the chest."""

    known: bool = True
    """Whether the walker's model of its body includes the load."""

    @property
    def total(self) -> float:
        return self.mass

    def parts(self, skeleton: Skeleton) -> Iterator[LoadPart]:
        along, across, up = skeleton.size("Ribs")
        x = -CHEST_RADII[0] * along - 0.5 * self.depth
        center = (x, 0.0, CHEST_CENTER * up + self.raised)
        drawn = [
            _box("bag", (0.0, 0.0, 0.0), (self.depth, self.width, self.height), CLOTH),
            _box(
                "pocket",
                (-0.5 * self.depth, 0.0, -0.15 * self.height),
                (0.3 * self.depth, 0.8 * self.width, 0.5 * self.height),
                POCKET,
            ),
        ]
        for side, outward in OUTWARD.items():
            path = [(px * along - x, outward * py * across, pz * up - center[2]) for px, py, pz in STRAP_PATH]
            ends = ((0.5 * self.depth, *path[0][1:]), *path, (0.5 * self.depth, *path[-1][1:]))
            for i, (start, end) in enumerate(pairwise(ends)):
                drawn.append(capsule("", f"{side.lower()}_strap_{i}", start, end, 0.014 * across, STRAP))
        yield LoadPart("Bag", "Ribs", center, Box(self.depth, self.width, self.height), self.mass, tuple(drawn))


@dataclass(frozen=True)
class Vest:
    """A weight vest: half of the mass before the chest, half behind it."""

    mass: float = quantity(10.0, "kg", 0.1, 60.0)
    """Mass of both halves."""

    thickness: float = quantity(0.03, "m", 0.005, 0.2)
    """Thickness of each half."""

    known: bool = True
    """Whether the walker's model of its body includes the load."""

    @property
    def total(self) -> float:
        return self.mass

    def parts(self, skeleton: Skeleton) -> Iterator[LoadPart]:
        along, across, up = skeleton.size("Ribs")
        rx, ry, rz = CHEST_RADII[0] * along, CHEST_RADII[1] * across, CHEST_RADII[2] * up
        plate = Box(self.thickness, 1.5 * ry, 1.6 * rz)
        for name, sign in (("Front", 1.0), ("Back", -1.0)):
            x = sign * (rx + 0.5 * self.thickness)
            drawn = (
                ellipsoid("", "shell", (-x, 0.0, 0.0), (rx + 0.012, ry + 0.008, 0.88 * rz), CLOTH),
                _box("plate", (0.0, 0.0, 0.0), (self.thickness, 0.9 * ry, 0.9 * rz), POCKET),
            )
            yield LoadPart(name, "Ribs", (x, 0.0, CHEST_CENTER * up), plate, 0.5 * self.mass, drawn)


@dataclass(frozen=True)
class AnkleWeights:
    """A cuff around each shank, above the ankle."""

    mass: float = quantity(1.0, "kg", 0.05, 20.0)
    """Mass of each of the two cuffs."""

    height: float = quantity(0.10, "m", 0.02, 0.3)
    """Size of a cuff along the shank."""

    known: bool = True
    """Whether the walker's model of its body includes the load."""

    @property
    def total(self) -> float:
        return 2.0 * self.mass

    def parts(self, skeleton: Skeleton) -> Iterator[LoadPart]:
        for side in SIDES:
            shank = f"{side}Leg_Tibia"
            girth, _, up = skeleton.size(shank)
            ankle = skeleton.origins[f"{side}Leg_Ankle"][2] - skeleton.origins[shank][2]
            cuff = Cylinder(0.056 * girth, self.height)
            drawn = Visual("", "cuff", "cylinder", (cuff.radius, cuff.length), (0, 0, 0), (0, 0, 0), CLOTH)
            center = (0.0, 0.0, float(ankle) + 0.05 * up + 0.5 * self.height)
            yield LoadPart(f"{side}Cuff", shank, center, cuff, self.mass, (drawn,))


@dataclass(frozen=True)
class Suitcase:
    """A box that hangs from one hand and does not swing in it."""

    mass: float = quantity(10.0, "kg", 0.1, 60.0)
    """Mass."""

    side: Literal["Right", "Left"] = "Right"
    """Hand that carries it."""

    depth: float = quantity(0.40, "m", 0.02, 1.0)
    """Size fore-aft."""

    width: float = quantity(0.15, "m", 0.02, 0.5)
    """Size sideways."""

    height: float = quantity(0.30, "m", 0.02, 0.6)
    """Size down."""

    known: bool = True
    """Whether the walker's model of its body includes the load."""

    @property
    def total(self) -> float:
        return self.mass

    def parts(self, skeleton: Skeleton) -> Iterator[LoadPart]:
        hand = f"{self.side}Arm_Hand"
        outward, grip = OUTWARD[self.side], GRIP * skeleton.size(hand)[2]
        handle = 0.05
        center = (0.0, 0.3 * outward * self.width, -grip - handle - 0.5 * self.height)
        top, y = 0.5 * self.height, -center[1]
        drawn = [_box("case", (0.0, 0.0, 0.0), (self.depth, self.width, self.height), CASE)]
        bar = [(x, y, z) for x, z in ((-0.07, top), (-0.06, top + handle), (0.06, top + handle), (0.07, top))]
        for i in range(3):
            drawn.append(capsule("", f"handle_{i}", bar[i], bar[i + 1], 0.010, STRAP))
        for x in (-0.35 * self.depth, 0.35 * self.depth):
            size = (0.06 * self.depth, 1.03 * self.width, 1.02 * self.height)
            drawn.append(_box(f"belt_{'back' if x < 0 else 'front'}", (x, 0.0, 0.0), size, STRAP))
        yield LoadPart("Case", hand, center, Box(self.depth, self.width, self.height), self.mass, tuple(drawn))


LOADS: dict[str, type[Load]] = {
    "backpack": Backpack,
    "vest": Vest,
    "ankle_weights": AnkleWeights,
    "suitcase": Suitcase,
}
"""The loads that a scenario can name."""


def loaded(skeleton: Skeleton, loads: Sequence[Load]) -> Skeleton:
    """Return a skeleton that carries loads, each part a segment welded to the body."""
    segments, welds = list(skeleton.segments), list(skeleton.welds)
    for number, load in enumerate(loads, 1):
        for part in load.parts(skeleton):
            name = f"Load_{number}_{part.name}"
            drawn = tuple(replace(visual, body=name) for visual in part.drawn)
            segments.append(Segment(name, part.shape, part.mass, (0.0, 0.0, 0.0), "carried load", drawn=drawn))
            welds.append(Weld(part.parent, name, part.center))
    return replace(skeleton, segments=tuple(segments), welds=tuple(welds))


def _box(part: str, center: Vector3, size: Vector3, color: Color) -> Visual:
    return Visual("", part, "box", size, center, (0, 0, 0), color)
