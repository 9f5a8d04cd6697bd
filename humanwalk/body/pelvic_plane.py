"""The pelvic plane of clinical gait analysis: through the anterior iliac spines and the middle of the posterior ones.

In upright standing the pelvis frame of the model is level, and this plane is tilted forward, by 11 degrees: 11.3 with a
standard deviation of 4.3 in standing women (Levine, Whittle 1996, JOSPT 24(3) 130-135), 13 with 5 in pelves
whose anterior spines and pubic symphysis are in one vertical plane (Preece et al. 2008, J. Man. Manip. Ther. 16(2)
113-117). Clinical pelvic tilt and hip flexion are angles of this plane.
"""

import numpy as np

from humanwalk.body.anatomy import human
from humanwalk.body.markers import markers
from humanwalk.body.skeleton import Skeleton


def plane_tilt(skeleton: Skeleton) -> float:
    """Forward tilt of the pelvic plane relative to the pelvis frame [rad]: positive, the anterior spines are lower."""
    place = {marker.name: np.array(marker.position) for marker in markers(skeleton)}
    anterior, posterior = ((place[f"R{name}"] + place[f"L{name}"]) / 2 for name in ("ASI", "PSI"))
    forward, _, up = anterior - posterior
    return float(np.arctan2(-up, forward))


PELVIC_TILT = plane_tilt(human())
"""Of every body: landmarks scale with it [rad]."""
