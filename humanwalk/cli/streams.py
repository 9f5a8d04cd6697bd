"""Standard streams that fail: a full disk, a closed terminal, a reader that has stopped."""

import _weakrefset
import io
import logging
import os
import signal
import sys
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
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


def encode_all(stream: object) -> None:
    """Let a text stream take every character: a file or pipe has UTF-8, a terminal escapes what it cannot show."""
    if isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(encoding=None if stream.isatty() else "utf-8", errors="backslashreplace")


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


NOT_INTERRUPTED = ("<frozen importlib._bootstrap>", logging.__file__, weakref.__file__, _weakrefset.__file__)
"""Code in which no exception may be raised: it aborts a compiled extension that is being loaded; Drake's log, which
calls Python's, drops it; Python drops it in callbacks of weak references, as in destructors, and prints a traceback."""

WAITING_PERIOD = 0.05
"""Time between two looks at whether such code has ended [s]."""

DROPPED_PERIOD = 5.0
"""Time after which a signal that should have ended the program is sent again [s], in case its exception was dropped.
Longer than any clean-up."""


@contextmanager
def signals_as_exits() -> Iterator[None]:
    """Within the block, which is the program, SIGTERM and SIGHUP end it like Ctrl-C, unless they are ignored.

    All three wait for the end of imports, log messages and destructors, see `NOT_INTERRUPTED`, and are sent again if
    the program goes on, see `DROPPED_PERIOD`. After the block all is written: a signal ends the process at once, since
    Python prints tracebacks of exceptions that are raised while it shuts down.
    """
    again: list[int] = []

    def end(number: int, frame: FrameType | None) -> None:
        waits = _must_wait(frame)
        again.append(number)
        signal.setitimer(signal.ITIMER_REAL, WAITING_PERIOD if waits else DROPPED_PERIOD)
        if waits:
            return
        if number == signal.SIGINT:
            raise KeyboardInterrupt
        sys.exit(128 + number)

    unset = (signal.SIG_DFL, signal.default_int_handler)
    numbers = [n for n in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if signal.getsignal(n) in unset]
    for number in numbers:
        signal.signal(number, end)
    # Sent again, for a simulation may have begun, which handles them itself.
    signal.signal(signal.SIGALRM, lambda _, frame: os.kill(os.getpid(), again.pop(0)))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)


def _must_wait(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename in NOT_INTERRUPTED or frame.f_code.co_name == "__del__":
            return True
        frame = frame.f_back
    return False
