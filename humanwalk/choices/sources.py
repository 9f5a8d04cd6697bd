"""Sources of what happens to the walker: from the scenario, or by hand."""

from dataclasses import dataclass

from humanwalk.systems.command_source import CommandSource
from humanwalk.systems.live_command_source import LiveCommandSource
from humanwalk.systems.live_push_source import LivePushSource
from humanwalk.systems.push_source import PushSource


@dataclass(frozen=True)
class Sources:
    """Systems that command and push the walker; the rest of the diagram is the same with all of them.

    Attributes:
        command: the system `command` of controllers that follow a command.
        pushes: the system `pushes`.
    """

    command: type[CommandSource] = CommandSource
    pushes: type[PushSource] = PushSource


FROM_SCENARIO = Sources()
LIVE = Sources(LiveCommandSource, LivePushSource)
