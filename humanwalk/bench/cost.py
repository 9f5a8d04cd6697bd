"""Wall-clock and processor time, and simulations by turns, so that a busy machine affects all of them equally."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from humanwalk.run.monitor import Monitor
from humanwalk.run.simulate import Prepared, prepare
from humanwalk.scenario import Scenario

CHUNK = 0.1
"""Simulated time of one turn [s]: short, so that other load affects every simulation; ratios of costs measured by
turns repeat within 2 to 3 %, those measured one after the other within 20 %."""


@dataclass(frozen=True)
class Cost:
    """Time that a piece of work takes.

    Attributes:
        wall: Wall-clock time [s].
        cpu: Processor time of this thread [s], which other processes affect less.
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
    """Advance simulations by turns, in alternating order, and return the cost of every turn by name.

    Args:
        advance: By name: advances to a simulated time [s] and returns the cost.
        until: Final simulated time [s].
        begin: Present simulated time [s].
        chunk: Simulated time of a turn [s].
    """
    turns = max(1, round((until - begin) / chunk))
    costs: dict[str, list[Cost]] = {name: [] for name in advance}
    for turn, time_ in enumerate(np.linspace(begin, until, turns + 1)[1:]):
        for name in list(advance)[:: -1 if turn % 2 else 1]:
            costs[name].append(advance[name](float(time_)))
    return costs


class TimedWalk:
    """An initialized simulation of a scenario, with the monitor that ends it at a fall.

    Attributes:
        prepared: Simulator, plant and recorder.
    """

    def __init__(self, scenario: Scenario, record: bool = True) -> None:
        """Build and initialize it, with or without recording."""
        self.prepared: Prepared = prepare(scenario, record=record)
        self._monitor = Monitor(self.prepared.watched, scenario.terrain)
        self.prepared.simulator.Initialize()

    @property
    def ended(self) -> str:
        """Why the simulation ended, see Monitor; empty while it continues."""
        return self._monitor.reason

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self.prepared.simulator.get_context().get_time())

    def make_table(self) -> Cost:
        """Make the table of the recorded signals; returns the cost."""
        recorder = self.prepared.recorder
        assert recorder is not None
        return cost_of(lambda: recorder.table(self.prepared.simulator.get_context()))

    def advance(self, until: float) -> Cost:
        """Advance to a simulated time [s], unless it has ended; returns the cost."""
        return cost_of(lambda: self._monitor.advance(self.prepared.simulator, until))
