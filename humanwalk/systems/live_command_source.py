"""LeafSystem: the velocity commanded by hand."""

from pydrake.systems.framework import Context

from humanwalk.systems.command_source import CommandSource
from humanwalk.walking.command import Command


class LiveCommandSource(CommandSource):
    """A command profile that is changed while the simulation runs, between two advances.

    Speeds change at the bounded rates of the profile, however abruptly the hand moves. The profile at the end, given
    to a `CommandSource` from the beginning, outputs the same bits.
    """

    def steer(self, context: Context, time: float, target: Command) -> None:
        """Command other speeds from a time on.

        Args:
            context: Of this system.
            time: Later than the context's time [s].
            target: The speeds.

        Raises:
            ValueError: The time is not later: outputs that were evaluated would change.
        """
        if time <= context.get_time():
            raise ValueError(f"a command at {time:g} s is not later than {context.get_time():g} s")
        changed = self.profile(context).steered(time, target)
        context.get_mutable_abstract_parameter(self._profile).set_value(changed)
