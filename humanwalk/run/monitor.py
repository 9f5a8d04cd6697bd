"""Ends a simulation early: after a fall, at a value that is not finite, or at a signal such as Ctrl-C."""

import math
import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, EventStatus, System

from humanwalk.body.joint_map import pelvis_pose
from humanwalk.measures.ends import FELL, INTERRUPTED, NOT_A_NUMBER
from humanwalk.terrain import Terrain

FALL_HEIGHT_SHARE = 0.5
"""Share of its initial height above the terrain below which the pelvis counts as fallen. Over the next tread of stairs
of 18.5 cm it is at 0.59."""

CHECK_PERIOD = 0.01
"""Simulated time between two checks of the state [s]; a check takes time."""

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""Ctrl-C, the request of a system or a scheduler to end, and a terminal that was closed."""


@dataclass
class Monitor:
    """Checks a plant in a root diagram while its simulator advances.

    Attributes:
        watched: the plant; without physics the simulated diagram, which cannot fall.
        terrain: what it walks on.
        on_progress: called with the simulated time [s] at every check.
        reason: why the simulation ended: FELL, NOT_A_NUMBER or INTERRUPTED; empty before that.
        interrupted: set from outside to end the simulation at the next check.
    """

    watched: System
    terrain: Terrain
    on_progress: Callable[[float], None] = lambda time: None
    reason: str = ""
    interrupted: bool = False
    _next_check: float = field(default=0.0, repr=False)
    _fallen_below: float = field(default=-math.inf, repr=False)

    def __call__(self, root_context: Context) -> EventStatus:
        """Simulator monitor: check the state every CHECK_PERIOD."""
        time = root_context.get_time()
        if time < self._next_check:
            return EventStatus.DidNothing()
        # An exact multiple of the period: a check beside the systems' own times would add a step.
        self._next_check = CHECK_PERIOD * (math.floor(time / CHECK_PERIOD + 1e-6) + 1)
        self.reason = self._failure(root_context) or (INTERRUPTED if self.interrupted else "")
        if self.reason:
            return EventStatus.ReachedTermination(self.watched, self.reason)
        self.on_progress(time)
        return EventStatus.Succeeded()

    def advance(self, simulator: Simulator, until: float) -> None:
        """Advance an initialized simulator to a time [s], or until there is a reason to end.

        Faster than as the simulator's monitor, which is called after every step.
        """
        context = simulator.get_context()
        self(context)
        while not self.reason and context.get_time() < until:
            simulator.AdvanceTo(min(self._next_check, until))
            self(context)

    def _failure(self, root_context: Context) -> str:
        plant = self.watched
        if not isinstance(plant, MultibodyPlant):
            return ""
        q = plant.GetPositions(plant.GetMyContextFromRoot(root_context))
        if not np.isfinite(q).all():
            return NOT_A_NUMBER
        x, y, z = q[pelvis_pose(plant)][4:]
        height = z - float(self.terrain.height(np.array((x, y))))
        if self._fallen_below == -math.inf:
            self._fallen_below = FALL_HEIGHT_SHARE * height
        return FELL if height < self._fallen_below else ""

    @contextmanager
    def stop_on_signal(self) -> Iterator[None]:
        """Within the block, STOP_SIGNALS end the simulation at the next check; see `caught_signals`.

        A signal that arrives too late to end the simulation acts at the end of the block, so that a run that is
        written in the block is not lost.
        """

        def stop() -> None:
            self.interrupted = True

        with caught_signals(stop) as received:
            yield
        if received and self.reason != INTERRUPTED:
            os.kill(os.getpid(), received[0])


@contextmanager
def caught_signals(stop: Callable[[], object] = lambda: None) -> Iterator[list[int]]:
    """Within the block, STOP_SIGNALS call `stop` and are listed; a second Ctrl-C acts as before.

    A signal that the process ignores, as SIGHUP under nohup, stays ignored. Outside of the main thread, which alone may
    handle signals, nothing changes.
    """
    before = {number: signal.getsignal(number) for number in STOP_SIGNALS}
    before = {number: handler for number, handler in before.items() if handler not in (signal.SIG_IGN, None)}
    if threading.current_thread() is not threading.main_thread():
        before = {}
    received: list[int] = []

    def catch(number: int, frame: object) -> None:
        if number == signal.SIGINT and number in received:
            signal.signal(number, before[signal.SIGINT])
            os.kill(os.getpid(), number)
        received.append(number)
        stop()

    for number in before:
        signal.signal(number, catch)
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
