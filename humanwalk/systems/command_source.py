"""Diagram: what the walker is asked for."""

from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from humanwalk.walking.command import CommandParameters, CommandProfile


class CommandSource(Diagram):
    """The scenario's command over time, which a TrajectorySource reads out: no Python while it is simulated.

    Outputs:
        command: (3) forward and sideways speed along the walker's heading [m/s], turn rate [rad/s].
    """

    def __init__(self, parameters: CommandParameters) -> None:
        super().__init__()
        self._profile = CommandProfile(parameters)
        knots = self._profile.knots
        samples = list(zip(*(self.command(time) for time in knots), strict=True))
        builder = DiagramBuilder()
        profile = builder.AddNamedSystem(
            "profile", TrajectorySource(PiecewisePolynomial.FirstOrderHold(knots, samples))
        )
        builder.ExportOutput(profile.get_output_port(), "command")
        builder.BuildInto(self)

    def command(self, time: float) -> list[float]:
        """The output at a time [s]."""
        command = self._profile.at(time)
        return [command.forward, command.sideways, command.turn]
