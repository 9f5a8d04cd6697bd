"""How a swinging foot clears the ground between two footholds: the height to add, and when to move forward.

The plane that turns from the old to the new foothold while the ankle moves is the ground of an ordinary swing. What
stands out of it under the sole is cleared by an additional lift. A foot beside a riser rises before it moves forward,
and one that lands below an edge moves forward before it sinks.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import quintic_blend
from humanwalk.quantity import quantity
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.footholds import Foothold, lies_on
from humanwalk.walking.motions import PiecewiseCubic, ScalarMotion

INTERVALS = 16
"""Number of equal parts of the swing at whose ends the additional lift is given."""

SAMPLES = 4 * INTERVALS + 1
"""Number of places of the ankle, and of times of the swing, that are tried."""

TIMES = np.linspace(0.0, 1.0, SAMPLES)
"""Progress of the swing at which the ground is tried."""

WIDTH = 10
"""Number of samples before and after a time for whose ground its lift is sufficient: a sixth of the swing."""

SHORTEST_PART = WIDTH / (SAMPLES - 1)
"""Shortest part of the swing in which the additional lift begins, ends, or follows a foot that is late."""

ENDING = 0.25
"""Part of the swing before touchdown in which the margin decreases."""

POINTS = (10, 5)
"""Numbers of points along and across the sole below which the ground is tried: 3 cm apart for the reference body."""

RAISING = 0.25
"""Part of the swing in which a foot rises by what it does not see of the ground, and in which it sinks again."""

LONGEST_PART = 0.45
"""Longest part of the swing in which a foot only rises or sinks; it has to move in the rest."""


@dataclass(frozen=True)
class ClearanceParameters:
    """How the swing clears the ground."""

    margin: float = quantity(0.03, "m", 0.0, 0.2)
    """Height by which the sole clears what stands out of the ground."""

    tolerance: float = quantity(0.005, "m", 0.0, 0.05)
    """Height up to which nothing stands out: an ordinary swing clears it."""

    nearness: float = quantity(0.12, "m", 0.0, 0.3)
    """Distance from its footholds up to which a foot is beside a riser, or below an edge."""

    rising: float = quantity(0.25, "", 0.0, LONGEST_PART)
    """Part of the swing in which a foot beside a riser only rises."""

    sinking: float = quantity(0.25, "", 0.0, LONGEST_PART)
    """Part of the swing in which a foot below an edge only sinks."""

    sinking_per_drop: float = quantity(0.81, "1/m", 0.0, 5.0)
    """Increase of `sinking` per height of a step down: 0.4 on stairs of 18.5 cm."""

    hold: float = quantity(0.06, "s", 0.0, 0.5)
    """Time in which a foot that only rises or sinks corrects its place (our choice)."""

    def sinking_part(self, rise: float) -> float:
        """Part of the swing in which a foot below an edge only sinks, where the ground rises by `rise` [m]."""
        return min(self.sinking + self.sinking_per_drop * max(-rise, 0.0), LONGEST_PART)


class Clearance(NamedTuple):
    """What a swing adds to that on a plane.

    Attributes:
        lift: Additional height at the inner ends of the `INTERVALS` [m].
        depart, arrive: Progress at which the foot begins and ends to move over the plane.
    """

    lift: tuple[float, ...] = (0.0,) * (INTERVALS - 1)
    depart: float = 0.0
    arrive: float = 1.0

    def at(self, progress: float) -> ScalarMotion:
        """Additional height, and its derivatives by the progress."""
        if not any(self.lift):
            return ScalarMotion()
        return PiecewiseCubic.through((0.0, *self.lift, 0.0)).at(progress)

    def raised(self, height: float) -> Clearance:
        """The clearance with an additional height [m] on the whole way, but for its first and last part."""
        if height == 0.0:
            return self
        times = np.linspace(0.0, 1.0, INTERVALS + 1)[1:-1]
        near = quintic_blend(np.clip(np.minimum(times, 1.0 - times) / RAISING, 0.0, 1.0))[0]
        return self._replace(lift=tuple((np.array(self.lift) + height * near).tolist()))

    def time_to_depart(self, progress: float, remaining: float, hold: float) -> float:
        """Time until the foot departs, at a progress with a remaining time to touchdown; at least `hold` [s, all]."""
        return max((self.depart - progress) / (1.0 - progress) * remaining, hold)

    def time_to_arrive(self, progress: float, remaining: float, hold: float) -> float:
        """Time until the foot is above its foothold [s]; see `time_to_depart`."""
        return max((self.arrive - progress) / max(1.0 - progress, 1e-9) * remaining, hold)

    def filtered(self, goal: Clearance, smoothing: float) -> Clearance:
        """The clearance moved toward another one by a share of the difference.

        A foot that has begun to rise before it moves, or to arrive before it sinks, goes on to do so: near the limit of
        `nearness` it would otherwise start and stop from one control period to the next.
        """
        lift = tuple(a + smoothing * (b - a) for a, b in zip(self.lift, goal.lift, strict=True))
        return Clearance(lift, max(self.depart, goal.depart), min(self.arrive, goal.arrive))


def quintic_way(progress: Array) -> Array:
    """Share of the way that an ordinary swing of the balanced walker has made at a progress."""
    share: Array = quintic_blend(progress)[0]
    return share


class OrdinarySwing(NamedTuple):
    """A swing without addition.

    Attributes:
        lowest: Height of the sole's lowest point above the plane at `TIMES` [m], shape (SAMPLES,), or at all of them.
        way: Share of the way that the foot has made at a progress.
        now: Progress, and ankle over the level plane at it [m]: a foot that is behind its way passes edges later. None:
            the foot is on its way.
    """

    lowest: Array | float = 0.0
    way: Callable[[Array], Array] = quintic_way
    now: tuple[float, complex] | None = None


ON_ITS_WAY = OrdinarySwing()
"""A swing of the balanced walker whose sole is never below the plane."""


def clearance(
    ground: Ground,
    start: Foothold,
    goal: Foothold,
    yaw: float,
    sole: SoleExtent,
    law: ClearanceParameters,
    swing: OrdinarySwing = ON_ITS_WAY,
) -> Clearance:
    """Return what a swing from one foothold to another has to add: to clear what is known of the ground, and the rest.

    Args:
        ground: What is known of the ground.
        start: Where the foot leaves the ground.
        goal: Where it goes.
        yaw: Heading of the foot [rad].
        sole: Extent of the sole.
        law: Parameters.
        swing: The swing without addition.
    """
    if start.face.covers_as(goal.face) and lies_on(start.face, start.position, yaw, sole):
        return Clearance().raised(ground.unseen)
    above = height_above_plane(ground, start, goal, TIMES, yaw, sole)
    # The toes of a foot that left its face steeply pitched pass below the plane.
    below = np.where(np.abs(TIMES - 0.5) <= 0.5 - SHORTEST_PART, np.maximum(-swing.lowest, 0.0), 0.0)
    if above.max() <= law.tolerance and not below.any():
        return Clearance().raised(ground.unseen)
    rise = goal.ground - start.ground
    near = law.nearness / max(abs(goal.position - start.position), 2.0 * law.nearness)
    leaving, landing = near >= TIMES, 1.0 - near <= TIMES
    # Near a foothold its own ground stands out by this of the plane, which is on its way to the other one.
    least = law.margin + near * abs(rise)
    depart, arrive = 0.0, 1.0
    if above[leaving].max() > least:
        depart, above[leaving] = law.rising, above[leaving].max()
    if above[landing].max() > least:
        arrive, above[landing] = 1.0 - law.sinking_part(rise), above[landing].max()
    # What is needed at times of the swing; before the foot departs, and after it has arrived, it rises and sinks.
    moved = swing.way(np.clip((TIMES - depart) / (arrive - depart), 0.0, 1.0))
    if swing.now is not None:
        progress, ankle = swing.now
        moved = _delayed(moved, progress, _share_of_way(ankle, start.position, goal.position), arrive)
    # The ground of an ordinary swing rises with the progress, not with the way.
    ahead = (swing.way(TIMES) - moved) * rise
    margin = law.margin * np.minimum(1.0, (1.0 - TIMES) / ENDING)
    stands_out = np.interp(moved, TIMES, above)
    needed = np.where(stands_out > law.tolerance, np.maximum(stands_out - ahead + margin - swing.lowest, 0.0), below)
    return Clearance(_smooth_lift(needed, depart, arrive), depart, arrive).raised(ground.unseen)


def _smooth_lift(needed: Array, depart: float, arrive: float) -> tuple[float, ...]:
    """Additional height at the inner ends of the `INTERVALS` [m] that is sufficient at all `TIMES`.

    Args:
        needed: Additional height that is needed at `TIMES` [m], shape (SAMPLES,).
        depart, arrive: See `Clearance`.
    """
    # Widened and then averaged over the same time, it is still sufficient, and smooth.
    around = np.lib.stride_tricks.sliding_window_view(np.pad(needed, 2 * WIDTH), 2 * WIDTH + 1).max(axis=1)
    smooth = np.lib.stride_tricks.sliding_window_view(around, 2 * WIDTH + 1) @ np.hanning(2 * WIDTH + 3)[1:-1]
    lift = smooth / (WIDTH + 1.0)
    # The foot does not sink between two heights.
    lift = np.minimum(np.maximum.accumulate(lift), np.maximum.accumulate(lift[::-1])[::-1])
    lift *= quintic_blend(np.clip(TIMES / max(depart, SHORTEST_PART), 0.0, 1.0))[0]
    lift *= quintic_blend(np.clip((1.0 - TIMES) / max(1.0 - arrive, SHORTEST_PART), 0.0, 1.0))[0]
    every = (SAMPLES - 1) // INTERVALS
    return tuple(lift[every:-1:every].tolist())


def _delayed(moved: Array, progress: float, made: float, arrive: float) -> Array:
    """Share of the way at `TIMES` of a foot that has made less of it at a progress, and catches up until it arrives.

    Args:
        moved: Share of the way at `TIMES` of a foot that is on its way.
        progress: Progress of the swing.
        made: Share of the way that the foot has made.
        arrive: Progress at which it arrives.
    """
    late = max(float(np.interp(progress, TIMES, moved)) - made, 0.0)
    remaining: Array = np.clip((arrive - TIMES) / max(arrive - progress, SHORTEST_PART), 0.0, 1.0)
    return np.maximum(moved - late * remaining, 0.0)


def _share_of_way(ankle: complex, start: complex, goal: complex) -> float:
    """Share of the way from start to goal at which an ankle is."""
    way = goal - start
    return ((ankle - start) * way.conjugate()).real / max(abs(way) ** 2, 1e-9)


def height_above_plane(
    ground: Ground, start: Foothold, goal: Foothold, share: Array, yaw: float, sole: SoleExtent
) -> Array:
    """Return the greatest height [m] of the ground under the sole above the plane that turns from start to goal.

    Args:
        ground, start, goal, yaw, sole: See `clearance`.
        share: Shares of the way of the ankle, shape (n,).
    """
    x = np.linspace(-sole.back, sole.front, POINTS[0])
    y = np.linspace(-sole.half_width, sole.half_width, POINTS[1])
    under = cmath.exp(1j * yaw) * (x[:, None] + 1j * y).ravel()
    points = (start.position + share * (goal.position - start.position))[:, None] + under
    xy = np.stack((points.real, points.imag), axis=-1)
    plane = (1.0 - share[:, None]) * start.face.height(xy) + share[:, None] * goal.face.height(xy)
    above: Array = (ground.height(xy) - plane).max(axis=1)
    # An edge between two places counts for both.
    beside: Array = np.maximum(np.append(above[1:], above[-1]), np.append(above[0], above[:-1]))
    return np.maximum(above, beside)
