"""Keeps simulated time in step with the clock on the wall."""

import time
from collections.abc import Callable

MAX_LAG = 0.05
"""Time that simulation may be late and still catch up [s]: longer than drawing a frame takes."""

FACTOR_PERIOD = 0.5
"""Wall-clock time over which the real-time factor is measured [s]."""


class Pace:
    """Delays a simulation that is faster than commanded; one that is slower stays evenly slow.

    Drake's own pace (`Simulator.set_target_realtime_rate`) makes up for lost time at full speed: after a pause or on
    a machine that is busy for a while, time would run.

    Attributes:
        factor: Simulated seconds per second, measured over the last FACTOR_PERIOD; 0 before that.
    """

    def __init__(
        self, clock: Callable[[], float] = time.monotonic, sleep: Callable[[float], object] = time.sleep
    ) -> None:
        """Make a pace; a test may bring its own clock [s]."""
        self._clock, self._sleep = clock, sleep
        self.factor = 0.0
        self.restart(0.0)

    def restart(self, simulated: float) -> None:
        """Count from a simulated time [s] on, as after a pause."""
        self._due = self._measured_at = self._clock()
        self._simulated = self._measured_from = simulated

    def wait(self, simulated: float, rate: float) -> None:
        """Return when a simulated time [s] is due at a rate of simulated seconds per second."""
        self._due += (simulated - self._simulated) / rate
        self._simulated = simulated
        now = self._clock()
        if now < self._due:
            self._sleep(self._due - now)
        else:
            self._due = max(self._due, now - MAX_LAG)
        elapsed = self._clock() - self._measured_at
        if elapsed >= FACTOR_PERIOD:
            self.factor = (simulated - self._measured_from) / elapsed
            self._measured_at, self._measured_from = self._clock(), simulated
