"""Writes people's slow walk as a recording, joint angles and path of the pelvis: python tools/slow_trial.py slow.csv

The curves are those of the slow group of Schwartz et al. (2008) at its own speed, with people's walk ratio.
"""

import math
import sys
from pathlib import Path

import numpy as np

from humanwalk.body import SIDES
from humanwalk.body.limbs import LEGS
from humanwalk.body.subject import Subject
from humanwalk.motion.gait_curves import normative_curves

DURATION, RATE = 8.0, 50.0
"""Length [s] and sampling rate [Hz]."""

WALK_RATIO = 0.36
"""Length times duration of a step [m s]."""


HIP_HEIGHT = Subject().skeleton.hip_height
CURVES = normative_curves(HIP_HEIGHT)


def write(path: Path, speed: float, step: float, duration: float) -> None:
    """Write people's walk as a table.

    Args:
        path: CSV file to write.
        speed: Of the pelvis and of the curves [m/s].
        step: Duration of a step [s].
        duration: Of the recording [s].
    """
    time = np.arange(0.0, duration, 1.0 / RATE)
    zero = np.zeros(time.size)
    columns = {"time": time, "pelvis_tx": speed * time, "pelvis_ty": zero + HIP_HEIGHT, "pelvis_tz": zero}
    for side, offset in zip(SIDES, (0.0, 0.5), strict=True):
        angles = np.array([CURVES.at(side, t / (2.0 * step) + offset, speed).value for t in time])
        columns |= {f"{joint}.angle_rad": angles[:, i] for i, joint in enumerate(LEGS[side].sagittal)}
        columns |= {f"{joint}.angle_rad": zero for joint in LEGS[side].hip[1:]}
    header = ",".join(columns)
    np.savetxt(path, np.column_stack(list(columns.values())), delimiter=",", header=header, comments="")


if __name__ == "__main__":
    slow = float(CURVES.speeds[0])
    write(Path(sys.argv[1]), slow, math.sqrt(WALK_RATIO / slow), DURATION)
