"""The segments of a body as gait laboratories define them: head, three parts of the trunk, three of each limb."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from humanwalk.body.de_leva import DE_LEVA, Sex, Table
from humanwalk.body.growth import ADULT_AGE, Growth, growth
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import REFERENCE_STATURE
from humanwalk.sides import SIDES

TRUNK = ("upper_trunk", "middle_trunk", "lower_trunk")
ARM = ("upper_arm", "forearm", "hand")
LEG = ("thigh", "shank", "foot")

ANKLE_HEIGHT = 0.068 / REFERENCE_STATURE
"""Height of the ankle joint over stature (Winter .039), at all ages and in both sexes."""

FLESH_DENSITY = 1050.0
"""Density of limbs [kg/m3] (Dempster 1955, from memory: 1050 to 1160), for widths that are not measured."""

WIDTHS = {
    "head": 0.154 / REFERENCE_STATURE,
    "upper_trunk": 0.46 / REFERENCE_STATURE,
    "middle_trunk": 0.26 / REFERENCE_STATURE,
    "lower_trunk": 0.175 / REFERENCE_STATURE,
    "hand": 0.0788 / REFERENCE_STATURE,
    "foot": 0.095 / REFERENCE_STATURE,
}
"""Widths over stature where they are not those of a cylinder: those of the thesis' body, for want of a table.

The width of the upper trunk is the distance of the shoulder joints, that of the lower trunk the distance of the hips.
"""


@dataclass(frozen=True)
class Region:
    """One segment of a person, in standing.

    Attributes:
        length: Between the joints [m]; hand and foot: to the tip. The parts of the trunk add up to the distance of hip
            joints and C7, the head reaches from C7 to the vertex.
        width: [m], see `WIDTHS`; of the other limbs that of a cylinder of flesh.
        mass: [kg].
        com: Distance of the center of mass from the upper end; foot: from the heel [m].
        gyration: Radii of gyration about x forward, y left, z up through the center of mass [m].
    """

    length: float
    width: float
    mass: float
    com: float
    gyration: Vector3


Regions = Mapping[str, Region]
"""Regions by name; those of limbs begin with right_ or left_."""


def region_names() -> Iterator[tuple[str, str]]:
    """Yield the name of every region, and its name in the table, from the head down."""
    yield from ((name, name) for name in ("head", *TRUNK))
    yield from ((f"{side.lower()}_{name}", name) for name in (*ARM, *LEG) for side in SIDES)


def regions(sex: Sex, age: float, mass: float, stature: float) -> Regions:
    """Return the segments of a person after de Leva; of a child after Jensen, see `humanwalk.body.growth`.

    Lengths of head and limbs are the table's shares of the stature. The parts of the trunk keep their ratios and take
    the rest of the stature: 6 % less than the table's in men, 0.3 % more in women. Radii of gyration are shares of the
    table's lengths, so that moments of inertia at the table's stature and mass are the table's.

    Args:
        sex: Column of the table.
        age: [years].
        mass: Body mass [kg].
        stature: Standing height [m].
    """
    table, grown = DE_LEVA[sex], growth(age)
    rows = table.rows
    shares = {name: rows[name].mass * grown.mass[name] for name in ("head", *ARM, *LEG)}
    of_trunk = 1.0 - shares["head"] - 2.0 * math.fsum(shares[name] for name in (*ARM, *LEG))
    adult_trunk = math.fsum(rows[name].mass for name in TRUNK)
    shares |= {name: of_trunk * rows[name].mass / adult_trunk for name in TRUNK}
    lengths, adult = (_lengths(table, proportions, stature) for proportions in (grown, growth(ADULT_AGE)))
    found = {}
    for name, row in region_names():
        nominal = rows[row].length * stature / table.stature * lengths[row] / adult[row]
        kx, ky, kz = rows[row].gyration
        width = WIDTHS[row] * stature if row in WIDTHS else limb_width(shares[row] * mass, lengths[row])
        found[name] = Region(
            length=lengths[row],
            width=width * (grown.head if row == "head" else 1.0),
            mass=shares[row] * mass,
            com=rows[row].com * lengths[row],
            gyration=(kx * nominal, ky * nominal, kz * nominal),
        )
    return found


def limb_width(mass: float, length: float) -> float:
    """Return the diameter of a cylinder of flesh [m] by its mass [kg] and length [m]."""
    return math.sqrt(4.0 * mass / (math.pi * FLESH_DENSITY * length))


def _lengths(table: Table, grown: Growth, stature: float) -> dict[str, float]:
    """Lengths of the regions by their names in the table [m]; trunk, head and leg add up to the stature."""
    scale = stature / table.stature
    lengths = {name: scale * table.rows[name].length for name in table.rows}
    lengths |= {name: grown.limbs * lengths[name] for name in (*ARM, "thigh", "shank")}
    lengths["head"] *= grown.head
    below_trunk = ANKLE_HEIGHT * stature + lengths["shank"] + lengths["thigh"]
    trunk = (stature - below_trunk - lengths["head"]) / math.fsum(lengths[name] for name in TRUNK)
    return lengths | {name: trunk * lengths[name] for name in TRUNK}
