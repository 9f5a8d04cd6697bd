"""What a benchmark found, as numbers and as a file."""

import json
import os
import platform
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from humanwalk.files import write_text
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.provenance import versions
from humanwalk.run.schema import read_json

MAX_RESULT_BYTES = 1_000_000

KIND = "humanwalk bench 1"
"""What the files call themselves; the number changes with what is in them."""


@dataclass(frozen=True)
class ScenarioCost:
    """What one scenario costs; times are seconds for a simulated second.

    plant + solvers + systems + logging = cpu.

    Attributes:
        wall: on the clock, as a user simulates it, without replay and plots.
        cpu: the same as processor time.
        plant: the bare plant, walking the same walk bit by bit.
        solvers: inverse kinematics, or the whole-body program.
        systems: everything else of ours, and Drake's way into Python and back.
        logging: what recording adds: the sinks, and the observers that nothing else asks.
        by_system: processor time of our systems by class, without that of what they pull.
        startup_s: from the first import to the end of the first step.
        peak_memory_MB: of a run of `duration_s`.
        duration_s: simulated time.
    """

    wall: float
    cpu: float
    plant: float
    solvers: float
    systems: float
    logging: float
    by_system: dict[str, float]
    startup_s: float
    peak_memory_MB: float
    duration_s: float

    @property
    def realtime_factor(self) -> float:
        """Simulated seconds per second on the clock."""
        return 1.0 / self.wall

    @property
    def above_plant(self) -> float:
        """Everything above the bare plant, as a share of the bare plant."""
        return self.cpu / self.plant - 1.0


@dataclass(frozen=True)
class BenchResult:
    """Costs by scenario, and what they were measured on.

    Attributes:
        scenarios: of those that were measured at least once.
        repeats: how often each was to be measured.
        done: how often each that was asked for was measured.
        overrides: of all of them, see `load_scenario`.
        machine: see `machine`.
    """

    scenarios: dict[str, ScenarioCost]
    repeats: int
    done: dict[str, int]
    overrides: dict[str, str]
    machine: dict[str, Any]

    @property
    def complete(self) -> bool:
        """Whether everything that was asked for was measured as often as it was to be."""
        return all(done == self.repeats for done in self.done.values())

    @property
    def progress(self) -> str:
        """How much of it is there: "5 of 24 repeats"."""
        return f"{sum(self.done.values())} of {self.repeats * len(self.done)} repeats"


@dataclass(frozen=True)
class BenchFile(BenchResult):
    """The content of a file."""

    kind: str


def machine() -> dict[str, Any]:
    """Processor, number of cores, their load by others and us over the last minute, and versions."""
    return {"processor": _processor(), "cores": os.cpu_count(), "load": os.getloadavg()[0]} | versions()


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def write_result(path: Path, result: BenchResult) -> None:
    """Write a result as JSON, whole or not at all."""
    write_text(path, json.dumps({"kind": KIND} | asdict(result), indent=2) + "\n")


def read_result(path: Path) -> BenchResult:
    """Read a result that `write_result` wrote.

    Raises:
        ParameterError: it cannot be read, or is something else.
    """
    data = read_json(path, MAX_RESULT_BYTES, BenchFile)
    if data.pop("kind") != KIND:
        raise ParameterError(
            f"{printable(path)}: not a result of this version's benchmark; allowed: a file of `humanwalk bench -o`; "
            "measure again"
        )
    costs = {name: ScenarioCost(**cost) for name, cost in data["scenarios"].items()}
    for name, cost in costs.items():
        if min(cost.wall, cost.cpu, cost.plant) <= 0.0:
            raise ParameterError(f"{printable(path)}: {name} takes no time; allowed: times above 0; measure again")
    return BenchResult(**data | {"scenarios": costs})
