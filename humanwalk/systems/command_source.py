"""LeafSystem: the commanded velocity over time."""

from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.systems.signal import Signal
from humanwalk.walking.command import CommandParameters, CommandProfile


class CommandSource(LeafSystem):
    """The command profile at the time of the context.

    Outputs:
        command: (3) forward and sideways speed along the walker's heading [m/s], turn rate [rad/s].
    """

    def __init__(self, parameters: CommandParameters) -> None:
        super().__init__()
        self._profile = CommandProfile(parameters)
        port = self.DeclareVectorOutputPort(
            "command", 3, self._calc_command, prerequisites_of_calc={self.time_ticket()}
        )
        columns = ("command.forward_m_s", "command.sideways_m_s", "command.turn_rad_s")
        self.signals = (Signal("command", port, columns),)

    def _calc_command(self, context: Context, output: BasicVector) -> None:
        command = self._profile.at(context.get_time())
        output.SetFromVector([command.forward, command.sideways, command.turn])
