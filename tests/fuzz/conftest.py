"""Fuzzing: one round of inputs with a fixed seed as an ordinary test, or random rounds until a time is over.

HUMANWALK_FUZZ_SECONDS is the time of all targets together [s]; `make fuzz` sets it. The number of inputs is printed.
"""

import os
import random
import resource
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from humanwalk.quantity import ParameterError

SECONDS = float(os.environ.get("HUMANWALK_FUZZ_SECONDS", "0"))
CORPUS = Path(__file__).parent / "corpus"
LARGEST_MEMORY_KB = 2_000_000
LONGEST = 20.0
"""Processor time of a hang [s]."""
INPUTS = "fuzz inputs"


def peak_memory() -> int:
    """Largest memory of this process so far [kB]; earlier tests of the process count, so only its growth is checked."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


@st.composite
def mutated(draw: Any, contents: Sequence[bytes], tokens: Sequence[bytes]) -> bytes:
    """One of some contents with up to four changes: bytes flipped, cut, repeated or replaced by a token or number."""
    content = bytearray(draw(st.sampled_from(contents)))
    for _ in range(draw(st.integers(0, 4))):
        begin = draw(st.integers(0, len(content)))
        end = min(len(content), begin + draw(st.sampled_from([0, 1, 4, 30, 1000])))
        change = draw(st.sampled_from(["token", "token", "word", "flip", "cut", "repeat", "end", "splice"]))
        if change == "token":
            content[begin:end] = draw(st.sampled_from(tokens))
        elif change == "word":
            # What stands between a separator and the next.
            while end < len(content) and content[end] not in b" ,:]}\t\n\"'<>":
                end += 1
            content[begin:end] = draw(st.sampled_from(tokens))
        elif change == "flip" and begin < len(content):
            content[begin] ^= 1 << draw(st.integers(0, 7))
        elif change == "cut":
            del content[begin:end]
        elif change == "repeat":
            content[begin:begin] = content[begin:end] * draw(st.sampled_from([1, 2, 50]))
        elif change == "end":
            del content[begin:]
        else:
            content[begin:begin] = draw(st.sampled_from(contents))[:2000]
    return bytes(content)


class Fuzzer:
    """Runs checks on inputs in a working directory of its own; what appears beside it or in it is noticed."""

    def __init__(self, root: Path, seconds: float) -> None:
        """Make `root`/in, the working directory; `seconds` is the time to fuzz, 0 for one round with a fixed seed."""
        self.root, self.place, self.inputs, self._seconds = root, root / "in", 0, seconds
        self.place.mkdir()

    mutated = staticmethod(mutated)

    @staticmethod
    def corpus(kind: str) -> list[bytes]:
        """Contents of the files of a kind, in the order of their names."""
        return [path.read_bytes() for path in sorted((CORPUS / kind).iterdir())]

    def run(self, check: Callable[[Any], None], drawn: SearchStrategy[Any], first: Iterable[Any], inputs: int) -> None:
        """Check the `first` inputs, then rounds of as many as `inputs` that are drawn."""

        def count(value: Any) -> None:
            self.inputs += 1
            check(value)

        for value in first:
            count(value)
        end, number = time.monotonic() + self._seconds, random.SystemRandom().randrange(2**32) if self._seconds else 0
        while True:
            limits = settings(
                max_examples=inputs,
                derandomize=False,
                database=None,
                deadline=None,
                suppress_health_check=list(HealthCheck),
            )
            seed(number)(limits(given(drawn)(count)))()
            number += 1
            if time.monotonic() >= end:
                return

    def attempt(self, use: Callable[[], object]) -> bool:
        """Whether `use` accepts its input; otherwise it refuses it in one printable line, and raises nothing else."""
        start, memory, accepted = time.process_time(), peak_memory(), True
        try:
            use()
        except ParameterError as error:
            assert str(error)
            assert str(error).isprintable()
            accepted = False
        assert time.process_time() - start < LONGEST
        assert peak_memory() - memory < LARGEST_MEMORY_KB
        assert [entry.name for entry in self.root.iterdir()] == ["in"]
        return accepted


@pytest.fixture
def fuzzer(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Fuzzer:
    """A fuzzer with this target's share of the time."""
    targets = sum("fuzzer" in getattr(item, "fixturenames", ()) for item in request.session.items)
    made = Fuzzer(tmp_path, SECONDS / targets)
    monkeypatch.chdir(made.place)
    request.node.fuzzer = made
    return made


def pytest_runtest_teardown(item: Any) -> None:
    """Count the inputs; properties travel from the processes of a parallel run to the summary."""
    if hasattr(item, "fuzzer"):
        item.user_properties.append((INPUTS, item.fuzzer.inputs))


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Print the number of inputs by target and class."""
    counts = {
        report.nodeid.rpartition("/")[2]: dict(report.user_properties)[INPUTS]
        for reports in terminalreporter.stats.values()
        for report in reports
        if INPUTS in dict(getattr(report, "user_properties", ()))
    }
    for name, count in sorted(counts.items()):
        terminalreporter.write_line(f"{count:8d} inputs: {name}")
    if counts:
        terminalreporter.write_line(f"{sum(counts.values()):8d} inputs in all")
