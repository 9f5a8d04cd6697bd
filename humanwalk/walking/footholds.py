"""Footholds on the ground: where a foot stands, and the nearest place where its whole sole lies on one face.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.terrain.face import ENDLESS, Face
from humanwalk.terrain.terrain import Ground

FREE = 1e-3
"""Height above a face up to which ground beside it is part of it [m]."""

MAX_OVERHANG = 1.0 / 3.0
"""Largest share of a sole beyond the edges of a face that is too short for it, as people's heels are on stairs."""

LEVEL = Face((-ENDLESS, -ENDLESS), (ENDLESS, ENDLESS), 0.0, (0.0, 0.0), 0.7, (0.86, 0.87, 0.86))
"""The plane z = 0."""


@dataclass(frozen=True)
class FootholdSearch:
    """Which faces of the ground are footholds."""

    edge_margin: float = quantity(0.02, "m", 0.0, 0.1)
    """Distance of the sole from the edges of its face, where the face is long enough."""

    max_rise: float = quantity(0.25, "m", 0.0, 0.6)
    """Largest difference in height between the feet."""

    distance: float = quantity(0.45, "m", 0.0, 1.0)
    """Largest distance from the expected foothold, along x and along y."""

    lateral_weight: float = quantity(2.0, "", 0.1, 10.0)
    """Weight of a sideways distance from the desired foothold relative to a forward one."""

    height_weight: float = quantity(0.25, "", 0.0, 10.0)
    """Weight of the difference in height from the stance foot relative to a forward distance, so that the
    walker does not take two low steps of a stair at once."""

    same_face: float = quantity(0.1, "m", 0.0, 1.0)
    """Distance by which another face must be nearer than the one that the foot is on its way to (our choice)."""


class Foothold(NamedTuple):
    """Where a foot stands: its ankle over the level plane, the height of the ground below it [m], and the face."""

    position: complex
    ground: float
    face: Face = LEVEL

    @staticmethod
    def on(ground: Ground, position: complex) -> Foothold:
        """The foothold at a position."""
        xy = np.array((position.real, position.imag))
        return Foothold(position, float(ground.height(xy)), ground.face_at(xy))

    @property
    def R_WS(self) -> Array:
        """Axes of the ground in W, the normal last; a foot that stands flat has them, turned by its yaw."""
        return self.face.R_SW.T

    def step_to(self, other: Foothold) -> float:
        """Height of another foothold above the plane of this one [m]: 0 on a slope, the rise on stairs."""
        return other.ground - _height(self.face, other.position)


def _height(face: Face, point: complex) -> float:
    return face.intercept + face.gradient[0] * point.real + face.gradient[1] * point.imag


def places_on(face: Face, desired: complex, yaw: float, sole: SoleExtent, margin: float) -> list[complex]:
    """Return the ankles nearest to a desired one with which the sole lies on a face.

    Args:
        face: The face.
        desired: Desired position of the ankle.
        yaw: Heading of the foot.
        sole: Extent of the sole.
        margin: Desired distance of the sole from the edges; where there is no room for it, the sole is in the middle.

    Returns:
        One ankle; on a face that is too short for the sole two, with which it protrudes at either end; none if more
        than `MAX_OVERHANG` of it would protrude.
    """
    u, across = cmath.exp(1j * yaw), 1j * sole.half_width
    corners = [u * (x + y) for x in (-sole.back, sole.front) for y in (-across, across)]
    choices = []
    for low, high, parts, value in (
        (face.lower[0], face.upper[0], [corner.real for corner in corners], desired.real),
        (face.lower[1], face.upper[1], [corner.imag for corner in corners], desired.imag),
    ):
        first, last = low - min(parts), high - max(parts)
        if last - first < -MAX_OVERHANG * (sole.back + sole.front):
            return []
        kept = min(margin, 0.5 * (last - first))
        choices.append([clip(value, first + kept, last - kept)] if last >= first else [first, last])
    return [complex(x, y) for x in choices[0] for y in choices[1]]


def has_free_ground(ground: Ground, place: complex, face: Face, yaw: float, sole: SoleExtent) -> bool:
    """Whether nothing under a sole on the plane of a face stands out of it."""
    x, y = np.linspace(-sole.back, sole.front, 9), np.linspace(-sole.half_width, sole.half_width, 4)
    points = place + cmath.exp(1j * yaw) * (x[:, None] + 1j * y).ravel()
    xy = np.stack((points.real, points.imag), axis=-1)
    return bool((ground.height(xy) <= face.height(xy) + FREE).all())


def nearest_foothold(
    ground: Ground,
    desired: complex,
    yaw: float,
    sole: SoleExtent,
    search: FootholdSearch,
    is_reachable: Callable[[complex, float], bool],
    current: Face | None = None,
    expected: complex | None = None,
    is_final: bool = False,
    level: float = 0.0,
) -> Foothold:
    """Return the foothold nearest to a desired one with the whole sole on one face.

    Args:
        ground: What is known of the ground.
        desired: Desired position of the ankle.
        yaw: Heading of the foot.
        sole: Extent of the sole.
        search: Which faces are footholds.
        is_reachable: Whether a foot can go to a position at a height [m].
        current: Face that the foot is on its way to; it is preferred.
        expected: What will be desired when the foot lands, if that differs: it decides on the face.
        is_final: Whether the face does not change any more.
        level: Height from which differences are avoided [m].

    Returns:
        The foothold; the desired place itself where none is in reach.
    """
    here = Foothold.on(ground, desired)
    is_current = current is None or here.face.covers_as(current)
    has_room = places_on(here.face, desired, yaw, sole, search.edge_margin) == [desired]
    if is_current and has_room and is_reachable(desired, here.ground):
        return here
    expected = desired if expected is None else expected
    u, best, least = cmath.exp(1j * yaw), here, float("inf")
    for face in ground.faces_near(np.array((expected.real, expected.imag)), search.distance):
        same = current is not None and face.covers_as(current)
        if is_final and not same:
            continue
        places = places_on(face, desired, yaw, sole, search.edge_margin)
        for place in places:
            off, height = (place - expected) / u, _height(face, place)
            if max(abs(off.real), abs(off.imag)) > search.distance or not is_reachable(place, height):
                continue
            if len(places) > 1 and not has_free_ground(ground, place, face, yaw, sole):
                continue
            cost = abs(complex(off.real, search.lateral_weight * off.imag)) - search.same_face * same
            cost += search.height_weight * abs(height - level)
            if cost < least:
                best, least = Foothold(place, height, face), cost
    return best
