"""A simulation that is driven by hand, and the scenario that repeats it."""

import math
from collections import deque
from dataclasses import replace

import numpy as np

from humanwalk.body.limbs import PELVIS
from humanwalk.numerics.scalars import wrapped
from humanwalk.quantity import ParameterError
from humanwalk.run.monitor import CHECK_PERIOD
from humanwalk.run.simulate import Prepared
from humanwalk.scenario import Scenario
from humanwalk.systems.live_command_source import LiveCommandSource
from humanwalk.systems.live_push_source import LivePushSource
from humanwalk.walking.command import Command
from humanwalk.walking.push import Push

MAX_POINTS = 700
MAX_PUSHES = 200
"""Changes of the command and pushes that a driven run keeps: its scenario has 90 kB then, and may have 100."""

DIGITS = 6
"""Decimals of recorded numbers: a file stays short, and holds exactly what was simulated."""

SPEED_PERIOD = 1.0
"""Time over which the speed is averaged [s], about a stride."""


def require_drivable(scenario: Scenario) -> None:
    """Raise ParameterError unless the body is simulated."""
    if not scenario.controller.physics:
        raise ParameterError(
            "drive: a recording without physics cannot be pushed or steered; allowed: scenarios with physics; "
            "set controller.recorded.kinematic=false"
        )


class Driven:
    """The live sources of a prepared simulation; what a hand does acts at the next check of the monitor."""

    def __init__(self, scenario: Scenario, prepared: Prepared) -> None:
        """Take the sources.

        Args:
            scenario: What was prepared.
            prepared: With `choices.sources.LIVE`.
        """
        assert prepared.plant is not None
        self._scenario, self._walker, self._plant = scenario, prepared.walker, prepared.plant
        self._root = prepared.simulator.get_mutable_context()
        pushes = prepared.walker.GetSubsystemByName("pushes")
        assert isinstance(pushes, LivePushSource)
        self._pushes = pushes
        self._command: LiveCommandSource | None = None
        if prepared.walker.HasSubsystemNamed("command"):
            command = prepared.walker.GetSubsystemByName("command")
            assert isinstance(command, LiveCommandSource)
            self._command = command
        self._given = list(scenario.pushes.given)
        self._path: deque[tuple[float, float, float]] = deque(maxlen=round(SPEED_PERIOD / CHECK_PERIOD) + 1)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self._root.get_time())

    @property
    def target(self) -> Command | None:
        """The speeds that are commanded at the next check; None where the controller follows no command."""
        if self._command is None:
            return None
        return self._command.profile(self._command.GetMyContextFromRoot(self._root)).target_at(self._next_check)

    @property
    def heading(self) -> float:
        """Yaw of the pelvis in W [rad]."""
        X_WP = self._plant.GetBodyByName(PELVIS).EvalPoseInWorld(self._plant.GetMyContextFromRoot(self._root))
        ahead = X_WP.rotation().matrix()[:, 0]
        return math.atan2(ahead[1], ahead[0])

    def steer(self, target: Command) -> bool:
        """Command other speeds; returns whether they could be recorded."""
        assert self._command is not None
        context = self._command.GetMyMutableContextFromRoot(self._root)
        if len(self._command.profile(context).parameters.points) >= MAX_POINTS:
            return False
        speeds = (round(speed, DIGITS) for speed in (target.forward, target.sideways, target.turn))
        self._command.steer(context, self._next_check, Command(*speeds))
        return True

    def push(self, impulse: float, bearing: float) -> bool:
        """Push the chest for the usual duration; returns whether the push could be recorded.

        Args:
            impulse: [N s].
            bearing: Direction of the force [rad]: 0 along the walker's heading, pi/2 to its left.
        """
        if len(self._given) >= MAX_PUSHES:
            return False
        direction = round(wrapped(self.heading + bearing), DIGITS)
        push = Push(time=self._next_check, impulse=round(impulse, DIGITS), direction=direction)
        self._pushes.push(self._pushes.GetMyMutableContextFromRoot(self._root), push)
        self._given.append(push)
        return True

    def recorded(self) -> Scenario:
        """The scenario that repeats what was simulated so far."""
        scenario = replace(
            self._scenario,
            description=f"{self._scenario.description}, driven by hand",
            duration=max(self.time, CHECK_PERIOD),
            pushes=replace(self._scenario.pushes, given=tuple(self._given)),
        )
        if self._command is None:
            return scenario
        profile = self._command.profile(self._command.GetMyContextFromRoot(self._root))
        return replace(scenario, controller=replace(scenario.controller, command=profile.parameters))

    def measure(self) -> float:
        """Mean speed of the center of mass over ground in the last SPEED_PERIOD [m/s]; call it at every check."""
        x, y = self._output("com")[:2]
        if not self._path or self.time > self._path[-1][0]:
            self._path.append((self.time, x, y))
        before, x_before, y_before = self._path[0]
        elapsed = self.time - before
        return math.hypot(x - x_before, y - y_before) / elapsed if elapsed > 0.0 else 0.0

    def gait_phase(self) -> str:
        """What the feet are to do, and the gait cycle of the right one; empty where nothing is scheduled."""
        if not self._walker.HasOutputPort("contact_schedule"):
            return ""
        right, left = self._output("contact_schedule") > 0.5
        cycle = 100.0 * self._output("phase")[0]
        if right and left:
            return f"double support, {cycle:.0f} %" if cycle else "standing"
        return f"{'left' if right else 'right'} swing, {cycle:.0f} %"

    @property
    def _next_check(self) -> float:
        return round(self.time + CHECK_PERIOD, DIGITS)

    def _output(self, port: str) -> np.ndarray:
        return np.asarray(self._walker.GetOutputPort(port).Eval(self._walker.GetMyContextFromRoot(self._root)))
