"""Ends a simulation that makes no more sense: a fall, a number that is none, a person who pressed Ctrl-C."""

import math
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, EventStatus, System

FALL_HEIGHT_SHARE = 0.6
"""Share of its height at the start below which the pelvis counts as fallen."""

CHECK_PERIOD = 0.01
"""Simulated time between two looks at the state [s]; looking is not free."""


@dataclass
class Monitor:
    """Watches a plant in a root diagram while its simulator advances.

    Attributes:
        watched: the plant; where there is none, the diagram that is simulated, which cannot fall.
        on_progress: called with the simulated time [s] at every look.
        reason: why the simulation was ended: "fell", "not a number", "interrupted"; empty while it goes on.
        interrupted: set from outside to end the simulation at the next look.
    """

    watched: System
    on_progress: Callable[[float], None] = lambda time: None
    reason: str = ""
    interrupted: bool = False
    _next_look: float = field(default=0.0, repr=False)
    _fallen_below: float = field(default=-math.inf, repr=False)
    _height: int = field(default=0, repr=False)

    def __call__(self, root_context: Context) -> EventStatus:
        """Simulator monitor: look at the state every CHECK_PERIOD."""
        time = root_context.get_time()
        if time < self._next_look:
            return EventStatus.DidNothing()
        # A multiple of the period, to the last bit: where the looks are not at the systems' own times, they add steps.
        self._next_look = CHECK_PERIOD * (math.floor(time / CHECK_PERIOD + 1e-6) + 1)
        self.reason = self._body_says(root_context) or ("interrupted" if self.interrupted else "")
        if self.reason:
            return EventStatus.ReachedTermination(self.watched, self.reason)
        self.on_progress(time)
        return EventStatus.Succeeded()

    def advance(self, simulator: Simulator, until: float) -> None:
        """Let an initialised simulator go on to a time [s], or until there is a reason to end.

        Quicker than as the simulator's monitor, which would be called after every step.
        """
        context = simulator.get_context()
        self(context)
        while not self.reason and context.get_time() < until:
            simulator.AdvanceTo(min(self._next_look, until))
            self(context)

    def _body_says(self, root_context: Context) -> str:
        plant = self.watched
        if not isinstance(plant, MultibodyPlant):
            return ""
        q = plant.GetPositions(plant.GetMyContextFromRoot(root_context)).tolist()
        if self._fallen_below == -math.inf:
            self._height = plant.GetBodyByName("Pelvis").floating_positions_start() + 6
            self._fallen_below = FALL_HEIGHT_SHARE * q[self._height]
        if not all(map(math.isfinite, q)):
            return "not a number"
        return "fell" if q[self._height] < self._fallen_below else ""

    @contextmanager
    def stop_on_interrupt(self) -> Iterator[None]:
        """Within the block, Ctrl-C ends the simulation cleanly; a second one does what it always did."""

        def interrupt(signum: int, frame: object) -> None:
            self.interrupted = True
            signal.signal(signal.SIGINT, previous)

        previous = signal.signal(signal.SIGINT, interrupt)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, previous)
