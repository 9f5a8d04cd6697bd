"""Events of the feet."""

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array

CONTACT_ON_N = 50.0
CONTACT_OFF_N = 20.0
"""Vertical force at which an unloaded foot counts as landed, and a loaded one as lifted [N]."""

SHORTEST_PHASE_S = 0.05
"""Contact or flight of a foot shorter than this is a bounce and no event [s]."""


def foot_contact(signals: pa.Table, side: str) -> npt.NDArray[np.bool_]:
    """Whether a foot is on the ground, by its vertical force with hysteresis and without bounces; shape (rows,)."""
    time = signals[TIME].to_numpy()
    force = signals[f"{side.lower()}_foot.force_z_N"].to_numpy()
    return contact_with_hysteresis(time, force)


def contact_with_hysteresis(time: Array, force: Array) -> npt.NDArray[np.bool_]:
    """On above CONTACT_ON_N, off below CONTACT_OFF_N; phases shorter than SHORTEST_PHASE_S are merged away."""
    on, off = force >= CONTACT_ON_N, force <= CONTACT_OFF_N
    decided = np.where(on | off, np.arange(force.size), 0)
    decided[0] = 0
    contact: npt.NDArray[np.bool_] = on[np.maximum.accumulate(decided)]
    edges = np.flatnonzero(np.diff(contact.astype(int))) + 1
    # A body that starts standing feels no force yet: that is no landing.
    if edges.size and time[edges[0]] - time[0] < SHORTEST_PHASE_S:
        contact[: edges[0]] = contact[edges[0]]
        edges = edges[1:]
    for begin, end in pairwise(edges):
        if time[end] - time[begin] < SHORTEST_PHASE_S:
            contact[begin:end] = contact[begin - 1]
    return contact


def touchdowns(signals: pa.Table, side: str) -> Array:
    """Times [s] at which a foot lands after having been lifted."""
    contact = foot_contact(signals, side).astype(int)
    times: Array = signals[TIME].to_numpy()[1:][np.diff(contact) > 0]
    return times
