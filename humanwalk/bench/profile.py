"""Exclusive processor time of our systems."""

import functools
import inspect
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from pydrake.systems.framework import Context, InputPort, LeafSystem

UPSTREAM = "upstream"
"""Name under which an `ExclusiveClock` counts Drake's computations that systems trigger through their input ports."""


class ExclusiveClock:
    """Accumulates, by name, the time of functions without that of the functions that they call.

    Attributes:
        seconds: Exclusive time by name [s].
        calls: Number of calls by name.
    """

    def __init__(self, clock: Callable[[], float] = time.thread_time) -> None:
        """Start at zero, with a clock that returns seconds."""
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self.calls: Counter[str] = Counter()
        self._clock = clock
        self._inner: list[float] = []

    def run[T](self, name: str, function: Callable[..., T], *arguments: Any) -> T:
        """Call the function and return its result; its time counts for `name`."""
        begun = self._clock()
        self._inner.append(0.0)
        try:
            return function(*arguments)
        finally:
            total = self._clock() - begun
            self.seconds[name] += total - self._inner.pop()
            self.calls[name] += 1
            if self._inner:
                self._inner[-1] += total


@contextmanager
def profiled(seconds: Callable[[], float] = time.thread_time) -> Iterator[ExclusiveClock]:
    """Within the block, Python LeafSystems that are made and simulated are timed, by the name of their class.

    Drake computes on demand: reading an input port triggers everything upstream, such as the plant's contact
    solution, which the plant's own step uses again later. Every port is therefore read twice: the first time counts as
    `UPSTREAM` (Python systems in it count separately); the second, from Drake's cache, is the system's cost of reading.

    Args:
        seconds: The clock.
    """
    clock = ExclusiveClock(seconds)
    eval_port = InputPort.Eval
    declare = {name: getattr(LeafSystem, name) for name in dir(LeafSystem) if name.startswith("Declare")}

    def timed(argument: Any) -> Any:
        owner = getattr(argument, "__self__", None)
        if not (inspect.ismethod(argument) and isinstance(owner, LeafSystem)):
            return argument
        return functools.wraps(argument)(functools.partial(clock.run, type(owner).__name__, argument))

    def timing(original: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(original)
        def declare_timed(*arguments: Any, **named: Any) -> Any:
            return original(*map(timed, arguments), **{key: timed(value) for key, value in named.items()})

        return declare_timed

    @functools.wraps(eval_port)
    def read(port: InputPort, context: Context) -> Any:
        clock.run(UPSTREAM, eval_port, port, context)
        return eval_port(port, context)

    for name, original in declare.items():
        setattr(LeafSystem, name, timing(original))
    InputPort.Eval = read  # type: ignore[method-assign]
    try:
        yield clock
    finally:
        for name, original in declare.items():
            setattr(LeafSystem, name, original)
        InputPort.Eval = eval_port  # type: ignore[method-assign]
