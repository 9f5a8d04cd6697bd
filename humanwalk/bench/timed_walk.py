"""A simulation as by `simulate`, advanced in parts that are timed."""

from humanwalk.bench.cost import Cost, cost_of
from humanwalk.run.monitor import Monitor
from humanwalk.run.simulate import Prepared, prepare
from humanwalk.scenario import Scenario


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
