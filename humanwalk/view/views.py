"""Cameras that follow the walker: those of the replay page, of videos and of snapshots."""

import math
from dataclasses import dataclass
from typing import Literal, get_args

from humanwalk.body.shapes import Vector3


@dataclass(frozen=True)
class Camera:
    """Camera in W translated to the pelvis: x and y count from the pelvis, z from the ground there [m].

    The page lifts it where the ground below it is higher (replay_scene.js).
    """

    position: Vector3
    target: Vector3


View = Literal["follow", "side", "front", "above", "orbit"]
VIEWS = get_args(View)

FIXED: dict[str, Camera] = {
    "follow": Camera((2.6, -3.9, 1.4), (0.0, 0.0, 0.79)),
    "side": Camera((0.0, -4.7, 1.0), (0.0, 0.0, 0.86)),
    "front": Camera((4.7, 0.0, 1.2), (0.0, 0.0, 0.86)),
    # Not exactly from above: the picture's vertical is the walker's left.
    "above": Camera((0.0, -0.02, 6.0), (0.0, 0.0, 0.5)),
}
"""Views whose camera moves with the walker and does not turn; a page begins with the first."""

FIELD_OF_VIEW_DEG = 27.0

ORBIT_PERIOD_S = 10.0
"""Time of the replay for one turn of the `orbit` camera around the walker, which begins as `follow`."""


def camera(view: str, time: float) -> Camera:
    """Camera of a view at a time of the replay [s]."""
    if view in FIXED:
        return FIXED[view]
    start = FIXED["follow"]
    radius = math.hypot(*start.position[:2])
    angle = math.atan2(start.position[1], start.position[0]) + 2.0 * math.pi * time / ORBIT_PERIOD_S
    return Camera((radius * math.cos(angle), radius * math.sin(angle), start.position[2]), start.target)
