"""LeafSystem: what the walker is asked for."""

from pydrake.systems.framework import BasicVector, Context, LeafSystem, OutputPort

from humanwalk.control.command import CommandParameters, CommandProfile


class CommandSource(LeafSystem):
    """The scenario's command over time.

    Outputs:
        command: (3) forward and sideways speed along the walker's heading [m/s], turn rate [rad/s].
    """

    def __init__(self, parameters: CommandParameters) -> None:
        super().__init__()
        self._profile = CommandProfile(parameters)
        self._output = self.DeclareVectorOutputPort(
            "command", 3, self._calc, prerequisites_of_calc={self.time_ticket()}
        )

    def _calc(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.command(context.get_time()))

    def command(self, time: float) -> list[float]:
        """The output at a time [s]."""
        command = self._profile.at(time)
        return [command.forward, command.sideways, command.turn]

    def get_command_output_port(self) -> OutputPort:
        """Output command."""
        return self._output
