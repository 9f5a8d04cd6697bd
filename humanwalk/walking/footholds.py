"""Footholds on the ground: where a foot stands, and the nearest place where its whole sole lies on one face.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
import math
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
"""Tolerance [m]: ground up to this height above a face is part of it, and ground up to this distance inside the outline
of a sole is beside the sole."""

LENGTHWISE = math.sqrt(0.5)
"""Smallest component of the heading along an axis of a face at which the sole counts as lengthwise there."""

LEVEL = Face((-ENDLESS, -ENDLESS), (ENDLESS, ENDLESS), 0.0, (0.0, 0.0), 0.7, (0.86, 0.87, 0.86))
"""The plane z = 0."""


@dataclass(frozen=True)
class FootholdSearch:
    """Which faces of the ground are footholds."""

    edge_margin: float = quantity(0.02, "m", 0.0, 0.1)
    """Distance of the sole from the edges of its face, where the face is long enough. With 1 cm more turns
    over low boxes were completed, but fewer walks over high ones (docs/decisions/0053-turns-on-boxes.md)."""

    heel_room: float = quantity(0.01, "m", 0.0, 0.1)
    """Distance of the heel from the edge behind it on a face of about the length of the sole. A heel that is nearer
    catches the edge of the tread above (docs/decisions/0047-short-treads.md)."""

    max_overhang: float = quantity(0.01, "m", 0.0, 0.2)
    """Largest excess of the length of a sole over that of its face. With 2 cm walkers fell on stairs up
    (docs/decisions/0047-short-treads.md)."""

    max_rise: float = quantity(0.25, "m", 0.0, 0.6)
    """Largest difference in height between the feet."""

    distance: float = quantity(0.45, "m", 0.0, 1.0)
    """Largest distance from the expected foothold, along and across the foot; faces are searched within it along x and
    y of W."""

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


def places_on(face: Face, desired: complex, yaw: float, sole: SoleExtent, search: FootholdSearch) -> list[complex]:
    """Return the ankles nearest to a desired one with which the sole lies on a face, the preferred one first.

    Args:
        face: The face.
        desired: Desired position of the ankle.
        yaw: Heading of the foot.
        sole: Extent of the sole.
        search: Distances from the edges.

    Returns:
        One ankle. Two on a face less than `heel_room` longer than the sole: the heel keeps its distance, and the toes
        may protrude; or the sole is in the middle of a face that is long enough for it, and its heel protrudes from a
        shorter one. None on a face that is shorter than the sole by more than `max_overhang`.
    """
    u, corners = cmath.exp(1j * yaw), _corners(yaw, sole)
    xs, ys = (
        _places_along(low - min(parts), high - max(parts), value, ahead, search)
        for low, high, parts, value, ahead in (
            (face.lower[0], face.upper[0], [corner.real for corner in corners], desired.real, u.real),
            (face.lower[1], face.upper[1], [corner.imag for corner in corners], desired.imag, u.imag),
        )
    )
    return [complex(x, y) for x in xs for y in ys]


def lies_on(face: Face, place: complex, yaw: float, sole: SoleExtent) -> bool:
    """Whether a sole with its ankle at a place lies on a face, within its edges."""
    corners = place + np.array(_corners(yaw, sole))
    return bool((face.margin(np.stack((corners.real, corners.imag), axis=-1)) >= 0.0).all())


def _corners(yaw: float, sole: SoleExtent) -> list[complex]:
    """Corners of a sole from its ankle [m]."""
    u, across = cmath.exp(1j * yaw), 1j * sole.half_width
    return [u * (x + y) for x in (-sole.back, sole.front) for y in (-across, across)]


def _places_along(first: float, last: float, desired: float, ahead: float, search: FootholdSearch) -> list[float]:
    """Return the coordinates of `places_on` along one axis of a face, the preferred one first.

    Args:
        first, last: Coordinates at which the sole ends at the lower and at the upper edge.
        desired: Desired coordinate.
        ahead: Component of the heading.
        search: Distances from the edges.
    """
    room = last - first
    if room < -search.max_overhang:
        return []
    heel = search.heel_room if abs(ahead) >= LENGTHWISE else 0.0
    if room >= heel:
        kept = min(search.edge_margin, 0.5 * room)
        return [clip(desired, first + kept, last - kept)]
    # With a room of `heel_room` this is the middle, so that the foothold does not jump.
    heel = min(heel, heel - 0.5 * room)
    rear, front, sign = (first, last, 1.0) if ahead > 0.0 else (last, first, -1.0)
    return [rear + sign * heel, 0.5 * (first + last) if room >= 0.0 else front]


def has_free_ground(ground: Ground, place: complex, face: Face, yaw: float, sole: SoleExtent) -> bool:
    """Whether nothing under a sole on the plane of a face stands out of it."""
    x = np.linspace(FREE - sole.back, sole.front - FREE, 9)
    y = np.linspace(FREE - sole.half_width, sole.half_width - FREE, 4)
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
    expected = desired if expected is None else expected
    u = cmath.exp(1j * yaw)

    def is_current(face: Face) -> bool:
        return current is not None and face.covers_as(current)

    def on_face(face: Face) -> Foothold | None:
        places = places_on(face, desired, yaw, sole, search)
        for place in places:
            off, height = (place - expected) / u, _height(face, place)
            is_near = max(abs(off.real), abs(off.imag)) <= search.distance
            is_in_reach = is_near and is_reachable(place, height)
            if is_in_reach and (len(places) == 1 or has_free_ground(ground, place, face, yaw, sole)):
                return Foothold(place, height, face)
        return None

    def cost(foothold: Foothold) -> float:
        off = (foothold.position - expected) / u
        distance = abs(complex(off.real, search.lateral_weight * off.imag))
        bonus = search.same_face * is_current(foothold.face)
        return distance - bonus + search.height_weight * abs(foothold.ground - level)

    here = Foothold.on(ground, desired)
    is_face_allowed = current is None or is_current(here.face)
    has_room = places_on(here.face, desired, yaw, sole, search) == [desired]
    if is_face_allowed and has_room and is_reachable(desired, here.ground):
        return here
    faces = ground.faces_near(np.array((expected.real, expected.imag)), search.distance)
    found = (on_face(face) for face in faces if is_current(face) or not is_final)
    return min((foothold for foothold in found if foothold is not None), key=cost, default=here)
