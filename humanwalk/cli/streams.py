"""Standard streams that fail: a full disk, a closed terminal, a reader that has stopped."""

import os
import signal
import sys
from collections.abc import Callable
from typing import IO, Any


class BestEffort:
    """A text stream that drops what it cannot write: no message is worth a run."""

    def __init__(self, stream: IO[str]) -> None:
        """Wrap a stream."""
        self._stream = stream

    def write(self, text: str) -> int:
        self._attempt(lambda: self._stream.write(text))
        return len(text)

    def flush(self) -> None:
        self._attempt(self._stream.flush)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def _attempt(self, action: Callable[[], object]) -> None:
        try:
            action()
        except (OSError, ValueError):
            discard(self._stream)


def discard(stream: IO[str]) -> None:
    """Send the rest of a stream nowhere, so that the interpreter's last flush succeeds."""
    try:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), stream.fileno())
    except (OSError, ValueError):
        return


def open_missing() -> None:
    """Open standard streams that the caller has closed, before another file gets their numbers."""
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)
            if nowhere != number:
                os.dup2(nowhere, number)
                os.close(nowhere)
            setattr(sys, name, os.fdopen(number, mode, closefd=False))


def exit_on_signals() -> None:
    """Let SIGTERM and SIGHUP end the program like Ctrl-C, with its clean-up, unless they are ignored."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, lambda number, frame: sys.exit(128 + number))
