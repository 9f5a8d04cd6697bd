"""Two clocks, and the turns that simulations take so that a busy machine disturbs all of them alike."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

CHUNK = 0.1
"""Simulated time of one turn [s]: short, so that what else the machine does hits every simulation; ratios of costs
measured in turns repeat to 2 or 3 %, those measured one after the other to 20 %."""


@dataclass(frozen=True)
class Cost:
    """What something took.

    Attributes:
        wall: on the clock [s].
        cpu: of this thread's processor time [s], which neighbours on a busy machine disturb less.
    """

    wall: float
    cpu: float

    def __add__(self, other: "Cost") -> "Cost":
        return Cost(self.wall + other.wall, self.cpu + other.cpu)


def cost_of(work: Callable[[], object]) -> Cost:
    """Do the work and return its cost."""
    wall, cpu = time.perf_counter(), time.thread_time()
    work()
    return Cost(time.perf_counter() - wall, time.thread_time() - cpu)


def in_turns(
    advance: Mapping[str, Callable[[float], Cost]], until: float, begin: float = 0.0, chunk: float = CHUNK
) -> dict[str, list[Cost]]:
    """Let simulations advance by turns, the order reversed every time, and return the cost of every turn by name.

    Args:
        advance: by name: goes on to a simulated time [s] and returns the cost.
        until: simulated time at the end [s].
        begin: simulated time at which they are [s].
        chunk: simulated time of a turn [s].
    """
    turns = max(1, round((until - begin) / chunk))
    costs: dict[str, list[Cost]] = {name: [] for name in advance}
    for turn, time_ in enumerate(np.linspace(begin, until, turns + 1)[1:]):
        for name in list(advance)[:: -1 if turn % 2 else 1]:
            costs[name].append(advance[name](float(time_)))
    return costs
