"""Orientations of pelvis and soles in W, from the recorded pelvis and joint angles."""

import numpy as np
import pyarrow as pa
from scipy.spatial.transform import Rotation

from humanwalk.body import Side, human
from humanwalk.body.limbs import LEGS
from humanwalk.measures.signals import matrix
from humanwalk.numerics import Array


def pelvis_rotation(signals: pa.Table) -> Rotation:
    """R_WP of the pelvis frame at every row."""
    return Rotation.from_quat(matrix(signals, [f"pelvis.quaternion_{part}" for part in "xyzw"]))


def heading_rotation(facing: Array | complex) -> Rotation:
    """Rotation about the vertical from x to headings of length 1, x + iy; one, or one for every row."""
    return Rotation.from_rotvec(np.multiply.outer(np.angle(facing), (0.0, 0.0, 1.0)))


def sole_rotation(signals: pa.Table, side: Side) -> Rotation:
    """R_WS of a sole frame at every row: that of the pelvis, turned by the joints of the leg from hip to ankle."""
    turn = pelvis_rotation(signals)
    for name in LEGS[side].chain:
        angle = signals[f"{name}.angle_rad"].to_numpy()
        turn = turn * Rotation.from_rotvec(np.outer(angle, human().joint(name).axis))
    return turn
