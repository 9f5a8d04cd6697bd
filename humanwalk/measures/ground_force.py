"""The vertical ground reaction force of a stance: peaks, the dip between them, and contact lost after heel strike."""

import numpy as np
import pyarrow as pa

from humanwalk.body import Side
from humanwalk.measures.events import FootEvents, in_contact
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array, Indices

FORCE_CUTOFF_HZ = 15.0
"""The ground force of walking has 99 % of its power below: Antonsson and Mann (1985), J. Biomech. 18(1) 39-47."""

MIN_DIP = 0.05
"""Smallest depth of a dip beside a peak of the vertical force [body weights]."""


def vertical_force(signals: pa.Table, side: Side, weight: float) -> Array:
    """Vertical force on a foot below FORCE_CUTOFF_HZ, without the impact of the heel, over `weight` [N], (rows,)."""
    # Importing scipy.signal takes half a second, which every walk would wait before its start.
    from scipy.signal import butter, sosfiltfilt

    force: Array = signals[f"{side.lower()}_foot.force_z_N"].to_numpy() / weight
    rate = 1.0 / float(np.median(np.diff(signals[TIME].to_numpy())))
    # A record of fewer than two samples per period of the cutoff holds nothing above it.
    if rate > 2.0 * FORCE_CUTOFF_HZ:
        force = sosfiltfilt(butter(2, FORCE_CUTOFF_HZ, fs=rate, output="sos"), force)
    return force


def force_peaks(force: Array, foot: FootEvents) -> Array:
    """First peak, dip and second peak of a force over every whole stance, shape (rows,) -> (stances, 3).

    The peaks are the greatest values in either half of the stance, the dip is the least value between them. A stance of
    one row has no halves, and is left out.
    """
    peaks = []
    for a, b in foot.stances:
        if b - a < 2:
            continue
        middle = a + (b - a) // 2
        first, second = a + int(force[a:middle].argmax()), middle + int(force[middle:b].argmax())
        peaks.append((force[first], force[first : second + 1].min(), force[second]))
    return np.array(peaks).reshape(-1, 3)


def peak_counts(force: Array, foot: FootEvents) -> Indices:
    """Number of peaks in every whole stance that rise by MIN_DIP from the dips beside them, shape (stances,)."""
    from scipy.signal import find_peaks

    return np.array([find_peaks(force[a:b], prominence=MIN_DIP)[0].size for a, b in foot.stances], dtype=int)


def contact_lost(signals: pa.Table, side: Side, foot: FootEvents) -> Array:
    """Time for which the foot is off the ground in the first half of every whole stance [s], shape (stances,).

    A heel that bounces after heel strike loses contact, although the stance goes on (`humanwalk.measures.events`).
    """
    period = float(np.median(np.diff(foot.time)))
    off = ~in_contact(signals[f"{side.lower()}_foot.force_z_N"].to_numpy())
    return np.array([period * int(off[a : a + (b - a) // 2].sum()) for a, b in foot.stances])
