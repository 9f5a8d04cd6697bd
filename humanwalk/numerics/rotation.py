"""From one orientation to another, in plain floats: arrays as short as these take longer."""

import math
from collections.abc import Sequence

import numpy as np
from pydrake.math import RotationMatrix

Vector = tuple[float, float, float]


def rotation_vector(axes: Sequence[Sequence[float]], goal: Sequence[Sequence[float]]) -> Vector:
    """Axis times angle [rad] of the rotation that takes a frame's axes x, y, z to those of another."""
    # The cross products of the axes add up to twice sine times axis, the dot products to the trace.
    x = y = z = trace = 0.0
    for (ax, ay, az), (gx, gy, gz) in zip(axes, goal, strict=True):
        x += ay * gz - az * gy
        y += az * gx - ax * gz
        z += ax * gy - ay * gx
        trace += ax * gx + ay * gy + az * gz
    sine2, cosine2 = math.hypot(x, y, z), trace - 1.0
    if cosine2 < 0.0:
        # Beyond a right angle the cross products lose the axis.
        turn = RotationMatrix(np.array(goal).T @ np.array(axes)).ToAngleAxis()
        x, y, z = turn.angle() * turn.axis()
        return x, y, z
    scale = math.atan2(sine2, cosine2) / sine2 if sine2 > 2e-9 else 0.5
    return scale * x, scale * y, scale * z
