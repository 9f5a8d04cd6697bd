"""Touchdown and toe-off of the feet: the one definition for measures, report and plots.

A foot is in swing when it is without contact for at least MIN_SWING_S. Touchdown is the first contact after a swing,
toe-off the end of the last contact before one. A heel that bounces after touchdown, or a toe that drags before
toe-off, loses contact for less than that and stays in stance; a foot that brushes the ground during swing stays in
swing.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pyarrow as pa

from humanwalk.body import Side
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array, Indices, Mask

CONTACT_ON_N = 50.0
CONTACT_OFF_N = 20.0
"""Vertical force from which an unloaded foot is in contact, and down to which a loaded one stays in contact [N].

Force plates detect contact at 20 N: Zeni, Richards, Higginson (2008), Gait Posture 27(4) 710-714. The simulated force
has no noise of a sensor, but it flutters about the threshold when a foot grazes the ground: 30 N apart, 4 % of body
weight, each crossing is one event. A heel strike passes both thresholds within 2 ms.
"""

MIN_SWING_S = 0.1
"""Shortest swing [s]; a shorter loss of contact is a bounce.

A leg swings for 0.4 s in walking (Perry and Burnfield 2010, chapter 1) and not under 0.3 s in a sprint: Weyand et al.
(2000), J. Appl. Physiol. 89(5) 1991-1999. Bounces of the simulated heel last 0.02 to 0.03 s.
"""

WHOLE_SWING_S = 0.3
"""Time in the air after which contact ends a swing [s]: people swing a leg for at least that long (Weyand et al.)."""

MIN_STANCE_S = 0.05
"""Shortest stance between two swings [s]; a shorter contact is a scuff. A sprinter's lasts 0.1 s (Weyand et al.)."""


@dataclass(frozen=True)
class FootEvents:
    """Contact of one foot over a record, and its events as rows of the record.

    Attributes:
        time: of the rows [s], shape (rows,).
        contact: whether the foot is in stance, shape (rows,).
        touchdowns: first rows of the stances, without a stance that the record begins with.
        toe_offs: first rows after the stances, without a stance that the record ends with.
        counted: whether a row counts, shape (rows,); strides and stances need all of their rows.
    """

    time: Array
    contact: Mask
    touchdowns: Indices
    toe_offs: Indices
    counted: Mask

    @property
    def touchdown_times(self) -> Array:
        """Times of the touchdowns [s]."""
        return self.time[self.touchdowns]

    @property
    def strides(self) -> list[tuple[int, int]]:
        """Rows of each touchdown and the next, if all rows between them count."""
        return [(a, b) for a, b in pairwise(self.touchdowns.tolist()) if self.counted[a:b].all()]

    @property
    def stances(self) -> list[tuple[int, int]]:
        """Rows of touchdown and toe-off of each whole stance, if all rows between them count."""
        after = np.searchsorted(self.toe_offs, self.touchdowns)
        whole = [
            (int(down), int(self.toe_offs[i]))
            for down, i in zip(self.touchdowns, after, strict=True)
            if i < self.toe_offs.size
        ]
        return [(a, b) for a, b in whole if self.counted[a:b].all()]


def foot_events(time: Array, force: Array, counted: Mask | None = None) -> FootEvents:
    """Find stance, touchdown and toe-off of one foot.

    A phase that the record cuts off at its start or end is not known to be a stance or a swing unless it is as long as
    one: it makes no event. But contact after a swing of WHOLE_SWING_S is a touchdown, however soon the record ends.

    Args:
        time: of the samples [s], increasing, shape (rows,).
        force: vertical ground reaction force [N], shape (rows,).
        counted: whether a row counts, shape (rows,); None if all do.
    """
    contact = in_contact(force)
    counted = np.ones_like(contact) if counted is None else counted
    rows = force.size

    def short(mask: Mask, least: float) -> Iterator[tuple[int, int]]:
        """Stretches that last for less than a time [s], but for one that fills the record."""
        for first, end in stretches(mask):
            if end - first < rows and time[min(end, rows - 1)] - time[first] < least:
                yield first, end

    for first, end in short(~contact, MIN_SWING_S):
        if first > 0 and end < rows:
            contact[first:end] = True
    for first, end in short(contact, MIN_STANCE_S):
        before = np.flatnonzero(contact[:first])
        swing = time[first] - time[before[-1] if before.size else 0]
        contact[first:end] = end == rows and swing >= WHOLE_SWING_S
    # The record cuts these off: they are counted as the phase beside them.
    for first, end in short(~contact, MIN_SWING_S):
        contact[first:end] = True
    change = np.diff(contact.astype(int))
    return FootEvents(
        time=time,
        contact=contact,
        touchdowns=np.flatnonzero((change > 0) & counted[1:]) + 1,
        toe_offs=np.flatnonzero((change < 0) & counted[1:]) + 1,
        counted=counted,
    )


def events_of(signals: pa.Table, side: Side, counted: Mask | None = None) -> FootEvents:
    """Events of one foot of a record; see `foot_events`."""
    return foot_events(signals[TIME].to_numpy(), signals[f"{side.lower()}_foot.force_z_N"].to_numpy(), counted)


def in_contact(force: Array) -> Mask:
    """Whether a vertical force [N] is contact, shape (rows,): it begins at CONTACT_ON_N and ends at CONTACT_OFF_N.

    Between the two the state of the row before holds.
    """
    on, off = force >= CONTACT_ON_N, force <= CONTACT_OFF_N
    decided = np.where(on | off, np.arange(force.size), 0)
    return on[np.maximum.accumulate(decided)]


def stretches(mask: Mask) -> list[tuple[int, int]]:
    """First row, and row after the last one, of every stretch of true rows."""
    edges = np.flatnonzero(np.diff(mask.astype(int), prepend=0, append=0))
    return [(int(first), int(end)) for first, end in edges.reshape(-1, 2)]
