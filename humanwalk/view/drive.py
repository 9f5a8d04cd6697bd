"""Drives a walker by hand: one walk, from its start to a fall, a reset, Ctrl-C or its duration."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum

from pydrake.geometry import Meshcat

from humanwalk.choices.sources import LIVE
from humanwalk.measures.ends import COMPLETED, FELL, INTERRUPTED
from humanwalk.measures.fall import report_fall
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD
from humanwalk.run.driven import Driven, require_drivable
from humanwalk.run.monitor import CHECK_PERIOD, Monitor, caught_signals
from humanwalk.run.outcome import Outcome
from humanwalk.run.pace import Pace
from humanwalk.run.simulate import Prepared, prepare, simulate_prepared
from humanwalk.scenario import Scenario
from humanwalk.view.drive_page import DrivePage, Hand
from humanwalk.walking.push import all_pushes

IDLE_PERIOD = 0.03
"""Wall-clock time between two readings of the page while time stands still [s]."""

SHOW_PERIOD = 0.1
"""Wall-clock time between two updates of the figures on the page [s]."""


MIN_DURATION = 2.0 * CHECK_PERIOD
"""Walks that are no longer than this are not saved [s]: Ctrl-C before a browser has opened the page."""


class Ended(Enum):
    """What ended a driven walk."""

    WALK = "the walk itself: its duration, a fall or a failure"
    RESET = "the button"
    INTERRUPT = "Ctrl-C"


@dataclass(frozen=True)
class Drive:
    """A driven walk that has ended.

    Attributes:
        outcome: Its scenario has the commands and pushes that were given, and repeats it.
        ended: What ended it.
        record: Whether it is to be saved.
    """

    outcome: Outcome
    ended: Ended
    record: bool


def drive(
    scenario: Scenario,
    page: DrivePage,
    replay: Meshcat | None = None,
    record: bool = True,
    on_checkpoint: Callable[[Outcome], None] | None = None,
    checkpoint_period: float = CHECKPOINT_PERIOD,
    on_end: Callable[[Drive], object] | None = None,
) -> Drive:
    """Simulate a scenario at the pace of the clock, driven by the page.

    Time stands still while no browser shows the page.

    Args:
        scenario: Its command holds until a hand changes it; its pushes are added to those of the page.
        page: Shows the walk, and commands it.
        replay: Records the motion for a replay page.
        record: Whether the walk is saved unless the page decides otherwise.
        on_checkpoint, checkpoint_period: See `humanwalk.run.simulate.simulate`.
        on_end: Called with the walk while signals such as SIGTERM still wait, to save it.

    Raises:
        ParameterError: The scenario cannot be driven or simulated.
    """
    require_drivable(scenario)
    prepared = prepare(scenario, replay, live=page.meshcat, sources=LIVE)
    monitor = Monitor(prepared.watched, scenario.terrain)
    frame = CHECK_PERIOD * math.ceil(1.0 / (scenario.recording.frame_rate * CHECK_PERIOD))
    driver = Driver(Driven(scenario, prepared), prepared, page, monitor, frame, record)
    walks: list[Drive] = []

    def checkpoint(outcome: Outcome) -> None:
        if on_checkpoint is not None:
            on_checkpoint(replace(outcome, scenario=driver.driven.recorded()))

    def end(outcome: Outcome) -> None:
        walks.append(driver.walk(outcome))
        if on_end is not None:
            on_end(walks[0])

    try:
        simulate_prepared(scenario, prepared, monitor, driver.look, checkpoint, checkpoint_period, end, fall_rate=1.0)
    except KeyboardInterrupt:
        # While the body falls, after the walk was saved.
        if not walks:
            raise
        return replace(walks[0], ended=Ended.INTERRUPT)
    return walks[0]


def wait_for_reset(page: DrivePage) -> Ended:
    """Keep the page as it is until the button for a reset or Ctrl-C is pressed."""
    with caught_signals() as received:
        while not received:
            if page.read().reset:
                return Ended.RESET
            time.sleep(IDLE_PERIOD)
    return Ended.INTERRUPT


class Driver:
    """Reads the page at every check of a simulation, hands on what it finds, and paces the simulation.

    Attributes:
        driven: The simulation.
        reset: Whether the button ended it.
        record: Whether it is to be saved.
    """

    def __init__(
        self, driven: Driven, prepared: Prepared, page: DrivePage, monitor: Monitor, frame: float, record: bool = True
    ) -> None:
        """Show the commanded speeds on the page.

        Args:
            driven: The simulation.
            prepared: The same.
            page: What is read.
            monitor: Ends the simulation.
            frame: Time of a single step [s].
            record: See `drive`.
        """
        self.driven, self.reset, self.record = driven, False, record
        self._page, self._monitor, self._frame = page, monitor, frame
        self._root, self._view = prepared.simulator.get_mutable_context(), prepared.live_view
        self._pace = Pace()
        self._pause_at = math.inf
        self._target = driven.target
        self._full = False
        self._shown_at = -math.inf
        page.begin(driven.target, record=record)

    def look(self, simulated: float) -> None:
        """Act on the page; return when a simulated time [s] is due."""
        hand = self._act(simulated)
        while not self._monitor.interrupted and (simulated >= self._pause_at or not self._page.watched):
            self._show("paused" if self._page.watched else "no browser", simulated)
            time.sleep(IDLE_PERIOD)
            self._pace.restart(simulated)
            hand = self._act(simulated)
        self._pace.wait(simulated, hand.rate)
        self._show(self.driven.gait_phase(), simulated)

    def walk(self, outcome: Outcome) -> Drive:
        """The walk that has ended, and what ended it; the page shows why."""
        by_hand = outcome.end == INTERRUPTED
        # A hand ends a walk as its duration does.
        end = COMPLETED if by_hand else outcome.end
        scenario = self.driven.recorded()
        pushes = all_pushes(scenario.pushes, scenario.seed)
        reason = report_fall(outcome.signals, scenario.subject.mass, pushes)["description"] if end == FELL else end
        self._page.show(self.driven.time, 0.0, 0.0, f"{reason}; reset with R", ended=True)
        ended = Ended.WALK if not by_hand else Ended.RESET if self.reset else Ended.INTERRUPT
        record = self.record and self.driven.time > MIN_DURATION
        return Drive(replace(outcome, scenario=scenario, end=end), ended, record)

    def _act(self, simulated: float) -> Hand:
        hand, driven = self._page.read(), self.driven
        if hand.target is not None:
            self._full |= not driven.steer(hand.target)
        elif driven.target != self._target and driven.target is not None:
            # The scenario's own command has changed.
            self._page.set_speeds(driven.target)
        self._target = driven.target
        for bearing in hand.pushes:
            self._full |= not driven.push(hand.impulse, bearing)
        if hand.pause:
            self._pause_at = simulated if self._pause_at > simulated else math.inf
        if hand.step:
            self._pause_at = simulated + self._frame
        if hand.reset:
            self.reset = self._monitor.interrupted = True
        self.record = hand.record
        if self._view is not None:
            self._view.follow(self._view.GetMyMutableContextFromRoot(self._root), hand.follow)
        return hand

    def _show(self, state: str, simulated: float) -> None:
        speed = self.driven.measure()
        if time.monotonic() - self._shown_at >= SHOW_PERIOD:
            self._shown_at = time.monotonic()
            full = ", no more can be recorded" if self._full else ""
            self._page.show(simulated, speed, self._pace.factor, f"{state}{full}")
