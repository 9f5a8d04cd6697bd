"""LeafSystem: the commanded velocity over time."""

from pydrake.common.value import Value
from pydrake.systems.framework import AbstractParameterIndex, BasicVector, Context, LeafSystem

from humanwalk.systems.signal import Signal
from humanwalk.walking.command import CommandParameters, CommandProfile


class CommandSource(LeafSystem):
    """The command profile at the time of the context.

    The profile is a parameter of the context, so that one walker can be commanded in many ways from one state.

    Outputs:
        command: (3) forward and sideways speed along the walker's heading [m/s], turn rate [rad/s].
    """

    def __init__(self, parameters: CommandParameters) -> None:
        super().__init__()
        profile = Value(CommandProfile(parameters))
        self._profile = AbstractParameterIndex(self.DeclareAbstractParameter(profile))
        port = self.DeclareVectorOutputPort(
            "command",
            3,
            self._calc_command,
            prerequisites_of_calc={self.time_ticket(), self.abstract_parameter_ticket(self._profile)},
        )
        columns = ("command.forward_m_s", "command.sideways_m_s", "command.turn_rad_s")
        self.signals = (Signal("command", port, columns),)

    def profile(self, context: Context) -> CommandProfile:
        """The profile in this system's context."""
        profile: CommandProfile = context.get_abstract_parameter(self._profile).get_value()
        return profile

    def _calc_command(self, context: Context, output: BasicVector) -> None:
        command = self.profile(context).at(context.get_time())
        output.SetFromVector([command.forward, command.sideways, command.turn])
