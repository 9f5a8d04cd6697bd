"""Ground that is known only roughly, or not at all, and is corrected where the feet touch it.

Each foot has an anchor: a place with the height and the slopes that were felt there. Every point of the ground takes
the correction of the nearest anchor: its own slopes up to the end of the sole, and those of the last steps beyond, so
that a long slope is expected under the next foothold, and that of a single stone is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import quantity
from humanwalk.terrain.corrected import CorrectedGround
from humanwalk.terrain.terrain import Ground, Touch

ALIGNED = 0.04
"""Angle between sole and expected ground up to which a foot should touch it with heel and ball [rad]."""

MAX_SLOPE = 0.35
"""Largest slope that is felt, relative to the known ground."""


@dataclass(frozen=True)
class Feeling:
    """How the feet feel the ground."""

    heel_only: float = quantity(0.02, "m", 0.0, 0.2)
    """Distance of the center of pressure behind the ankle from which on only the heel touches the ground."""

    missed: float = quantity(0.02, "m", 0.0, 0.2)
    """Distance by which the pressure misses the planned one if only the heel touches the ground (our choice)."""

    search_rate: float = quantity(1.5, "rad/s", 0.0, 10.0)
    """Rate at which the ground is expected lower under a ball that does not touch it (our choice)."""

    still_rate: float = quantity(0.3, "rad/s", 0.0, 10.0)
    """Pitch rate up to which a foot is still: a fifth of `search_rate` (our choice)."""

    smoothing_time: float = quantity(0.015, "s", 0.0, 1.0)
    """Time constant with which slope and height under a foot follow what is felt (our choice)."""

    near: float = quantity(0.2, "m", 0.01, 1.0)
    """Distance from an anchor up to which its own slopes hold: the length of a sole ahead of the ankle (our choice)."""

    trend_time: float = quantity(0.5, "s", 0.01, 10.0)
    """Time constant with which the slopes beyond follow those under the feet: a step (our choice)."""

    below: float = quantity(0.012, "m", 0.0, 0.2)
    """Distance below a sole without load at which the ground is expected: more than `contact_height`, so that the foot
    goes on down."""


class Anchor(NamedTuple):
    """What was felt at one place.

    Attributes:
        place: x, y [m].
        offset: Height above the known ground there [m].
        gradient: Slopes along x and y, relative to the known ground.
    """

    place: tuple[float, float]
    offset: float = 0.0
    gradient: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class FeltGround(CorrectedGround):
    """A known ground with the corrections of two anchors."""

    base: Ground
    anchors: tuple[Anchor | None, ...] = (None, None)
    """Of the right and of the left foot; None before it has felt anything."""

    trend: tuple[float, float] = (0.0, 0.0)
    """Slopes along x and y of the last steps, relative to the known ground."""

    unevenness: float = 0.0
    """See `Ground.unseen` [m]."""

    feeling: Feeling = Feeling()
    """How the feet feel the ground."""

    @property
    def unseen(self) -> float:
        return self.unevenness

    def correction(self, xy: Array) -> tuple[Array, Array]:
        """See `CorrectedGround.correction`."""
        anchors = [anchor for anchor in self.anchors if anchor is not None]
        if not anchors:
            return np.zeros(xy.shape[:-1]), np.zeros(xy.shape)
        places = np.array([anchor.place for anchor in anchors])
        offsets = np.array([anchor.offset for anchor in anchors])
        gradients = np.array([anchor.gradient for anchor in anchors])
        nearest = np.square(xy[..., None, :] - places).sum(axis=-1).argmin(axis=-1)
        off = xy - places[nearest]
        distance = np.hypot(off[..., 0], off[..., 1])[..., None]
        reach = self.feeling.near
        near = off * np.minimum(1.0, reach / np.maximum(distance, reach))
        rise = (gradients[nearest] * near + self.trend * (off - near)).sum(axis=-1)
        return offsets[nearest] + rise, np.where(distance <= reach, gradients[nearest], self.trend)

    def felt(self, touches: Sequence[Touch], dt: float) -> FeltGround:
        """The ground with what the feet feel within a control period [s]."""
        anchors, trend, share = list(self.anchors), np.array(self.trend), dt / (dt + self.feeling.trend_time)
        for touch in touches:
            anchor = self._anchor(touch, dt)
            anchors[touch.foot] = anchor
            trend += share * (anchor.gradient - trend)
        a, b = trend.tolist()
        return replace(self, anchors=tuple(anchors), trend=(a, b))

    def _anchor(self, touch: Touch, dt: float) -> Anchor:
        feeling = self.feeling
        share = dt / (dt + feeling.smoothing_time)
        if touch.pressure is None:
            # The ground is lower than expected as long as the sole does not touch it.
            xy = touch.heel[:2]
            drop = min(0.0, float(touch.heel[2] - feeling.below - self.height(xy)))
            return self._moved(xy, drop, np.zeros(2))
        xy = touch.pressure[:2]
        n = self.axes(xy)[2]
        level_error = 0.0 if touch.is_rolling else float(touch.pressure[2] - self.height(xy))
        slopes = np.zeros(2)
        pitch = float(touch.forward @ n)
        is_on_heel = touch.pressure_ahead <= -feeling.heel_only
        # A foot that does not turn its toes down although it should has something under its ball.
        shows_slope = not is_on_heel or (touch.is_still and pitch > ALIGNED)
        if shows_slope and not touch.is_rolling:
            slopes = share * (-touch.normal[:2] / touch.normal[2] + n[:2] / n[2])
        elif is_on_heel and -feeling.heel_only < touch.planned_ahead - feeling.missed and abs(pitch) < ALIGNED:
            slopes = -feeling.search_rate * dt * touch.forward[:2]
        return self._moved(xy, share * level_error, slopes)

    def _moved(self, xy: Array, height: float, slopes: Array) -> Anchor:
        """The anchor at a place whose height and slopes change."""
        offset, gradient = self.correction(xy)
        a, b = np.clip(gradient + slopes, -MAX_SLOPE, MAX_SLOPE).tolist()
        return Anchor((float(xy[0]), float(xy[1])), float(offset) + height, (a, b))
