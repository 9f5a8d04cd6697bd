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
from humanwalk.terrain.corrected import CorrectedGround
from humanwalk.terrain.terrain import Ground, Touch

HEEL_ONLY = 0.02
"""Distance of the center of pressure behind the ankle from which on only the heel touches the ground [m]."""

MISSED = 0.02
"""Distance by which the pressure misses the planned one if only the heel touches the ground [m] (our choice)."""

ALIGNED = 0.04
"""Angle between sole and expected ground up to which a foot should touch it with heel and ball [rad]."""

SEARCH_RATE = 1.5
"""Rate at which the ground is expected lower under a ball that does not touch it [rad/s] (our choice)."""

SMOOTHING_TIME = 0.015
"""Time constant with which slope and height under a foot follow what is felt [s] (our choice)."""

NEAR = 0.2
"""Distance from an anchor up to which its own slopes hold [m]: the length of a sole ahead of the ankle (our choice)."""

TREND_TIME = 0.5
"""Time constant with which the slopes beyond follow those under the feet [s]: a step (our choice)."""

MAX_SLOPE = 0.35
"""Largest slope that is felt, relative to the known ground."""

BELOW = 0.012
"""Distance below a sole without load at which the ground is expected [m]: more than `contact_height`, so that the foot
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
        away = xy[..., None, :] - places
        nearest = np.square(away).sum(axis=-1).argmin(axis=-1)
        off = np.take_along_axis(away, nearest[..., None, None], axis=-2)[..., 0, :]
        distance = np.hypot(off[..., 0], off[..., 1])[..., None]
        near = off * np.minimum(1.0, NEAR / np.maximum(distance, NEAR))
        rise = (gradients[nearest] * near + self.trend * (off - near)).sum(axis=-1)
        return offsets[nearest] + rise, np.where(distance <= NEAR, gradients[nearest], self.trend)

    def felt(self, touches: Sequence[Touch], dt: float) -> FeltGround:
        """The ground with what the feet feel within a control period [s]."""
        anchors, trend, share = list(self.anchors), np.array(self.trend), dt / (dt + TREND_TIME)
        for touch in touches:
            anchor = self._anchor(touch, dt)
            anchors[touch.foot] = anchor
            trend += share * (anchor.gradient - trend)
        a, b = trend.tolist()
        return replace(self, anchors=tuple(anchors), trend=(a, b))

    def _anchor(self, touch: Touch, dt: float) -> Anchor:
        share = dt / (dt + SMOOTHING_TIME)
        if touch.pressure is None:
            # The ground is lower than expected as long as the sole does not touch it.
            xy = touch.heel[:2]
            drop = min(0.0, float(touch.heel[2] - BELOW - self.height(xy)))
            return self._moved(xy, drop, np.zeros(2))
        xy = touch.pressure[:2]
        n = self.axes(xy)[2]
        level_error = float(touch.pressure[2] - self.height(xy))
        slopes = np.zeros(2)
        pitch = float(touch.forward @ n)
        if touch.pressure_ahead > -HEEL_ONLY and not touch.is_rolling:
            slopes = share * (-touch.normal[:2] / touch.normal[2] + n[:2] / n[2])
        elif touch.pressure_ahead <= -HEEL_ONLY < touch.planned_ahead - MISSED and abs(pitch) < ALIGNED:
            slopes = -SEARCH_RATE * dt * touch.forward[:2]
        return self._moved(xy, share * level_error, slopes)

    def _moved(self, xy: Array, height: float, slopes: Array) -> Anchor:
        """The anchor at a place whose height and slopes change."""
        offset, gradient = self.correction(xy)
        a, b = np.clip(gradient + slopes, -MAX_SLOPE, MAX_SLOPE).tolist()
        return Anchor((float(xy[0]), float(xy[1])), float(offset) + height, (a, b))
