"""The result of a benchmark, and its file."""

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
"""Largest file that is read; a result of all shipped scenarios has 20 kB."""

KIND = "humanwalk bench 1"
"""Kind and version of the file."""


@dataclass(frozen=True)
class ScenarioCost:
    """Cost of one scenario; times are seconds per simulated second.

    plant + solvers + systems + logging = cpu.

    Attributes:
        wall: Wall-clock time of a simulation without replay and plots.
        cpu: Its processor time.
        plant: The bare plant in the same motion, bit by bit.
        solvers: Inverse kinematics, or the whole-body program.
        systems: All our other systems, and Drake's calls into Python.
        logging: Added by recording: the sinks, and observers without other consumers.
        by_system: Exclusive processor time of our systems by class.
        startup_s: From the first import to the end of the first step.
        peak_memory_MB: Of a run of `duration_s`.
        duration_s: Simulated time.
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
        """Simulated seconds per wall-clock second."""
        return 1.0 / self.wall

    @property
    def above_plant(self) -> float:
        """Cost of everything except the bare plant, as a fraction of the bare plant."""
        return self.cpu / self.plant - 1.0


@dataclass(frozen=True)
class BenchResult:
    """Costs by scenario, and the machine.

    Attributes:
        scenarios: Costs of the scenarios that were measured at least once.
        repeats: Requested number of repeats of each scenario.
        done: Completed repeats of each requested scenario.
        overrides: Overrides of all scenarios, see `load_scenario`.
        machine: See `machine`.
    """

    scenarios: dict[str, ScenarioCost]
    repeats: int
    done: dict[str, int]
    overrides: dict[str, str]
    machine: dict[str, Any]

    @property
    def complete(self) -> bool:
        """Whether all requested repeats are done."""
        return all(done == self.repeats for done in self.done.values())

    @property
    def progress(self) -> str:
        """Progress as text: "5 of 24 repeats"."""
        return f"{sum(self.done.values())} of {self.repeats * len(self.done)} repeats"


@dataclass(frozen=True)
class BenchFile(BenchResult):
    """The content of a file."""

    kind: str


def machine() -> dict[str, Any]:
    """Processor, number of cores, their load over the last minute, and versions."""
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
    """Read a result of `write_result`.

    Raises:
        ParameterError: It cannot be read, or is not a result of this version.
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
