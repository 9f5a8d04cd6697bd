"""LeafSystem: pushes given by hand."""

from pydrake.systems.framework import Context

from humanwalk.systems.push_source import PushSource
from humanwalk.walking.push import Push


class LivePushSource(PushSource):
    """The scenario's pushes, and pushes that are added while the simulation runs, between two advances.

    All of them, given to a `PushSource` from the beginning, output the same bits.
    """

    def push(self, context: Context, push: Push) -> None:
        """Add a push.

        Args:
            context: Of this system.
            push: It begins later than the context's time.

        Raises:
            ParameterError: The push names a body that the plant does not have.
            ValueError: The push does not begin later: outputs that were evaluated would change.
        """
        if push.time <= context.get_time():
            raise ValueError(f"a push at {push.time:g} s is not later than {context.get_time():g} s")
        self.set_pushes(context, (*self.pushes(context), push))
