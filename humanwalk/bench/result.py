"""The result of a benchmark, its file and its tables."""

import json
import os
import platform
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich import box
from rich.table import Table

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
    info = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.*)", info.read_text(encoding="utf-8") if info.exists() else "", re.MULTILINE)
    processor = found[1].strip() if found else platform.processor() or platform.machine()
    return {"processor": processor, "cores": os.cpu_count(), "load": os.getloadavg()[0]} | versions()


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


Column = tuple[str, Callable[[ScenarioCost], float], str]

COLUMNS: tuple[Column, ...] = (
    ("wall", lambda cost: 1e3 * cost.wall, ".0f"),
    ("cpu", lambda cost: 1e3 * cost.cpu, ".0f"),
    ("plant", lambda cost: 1e3 * cost.plant, ".0f"),
    ("IK/QP", lambda cost: 1e3 * cost.solvers, ".0f"),
    ("other", lambda cost: 1e3 * cost.systems, ".0f"),
    ("log", lambda cost: 1e3 * cost.logging, ".0f"),
    ("above %", lambda cost: 100 * cost.above_plant, ".0f"),
    ("x real", lambda cost: cost.realtime_factor, ".2f"),
    ("start s", lambda cost: cost.startup_s, ".2f"),
    ("MB", lambda cost: cost.peak_memory_MB, ".0f"),
)
"""Heading, value, format; times are milliseconds per simulated second. `above` is the cost of everything except the
plant, in percent of it; `x real` is the real-time factor."""


def cost_table(result: BenchResult) -> Table:
    """Costs by scenario."""
    on, part = result.machine, "" if result.complete else f", not complete: {result.progress}"
    table = _table(
        f"ms per simulated second, median of {result.repeats}{part}; {on['processor']}, load {on['load']:.1f}"
    )
    for name, cost in result.scenarios.items():
        table.add_row(name, *(format(value(cost), form) for _, value, form in COLUMNS))
    return table


def system_table(result: BenchResult) -> Table:
    """Time of our systems by scenario, most expensive first."""
    table = Table("scenario", "our systems, ms per simulated second", box=box.SIMPLE_HEAD)
    for name, cost in result.scenarios.items():
        table.add_row(name, ", ".join(f"{system} {1e3 * seconds:.1f}" for system, seconds in cost.by_system.items()))
    return table


def ratios(old: BenchResult, new: BenchResult) -> dict[str, dict[str, float | None]]:
    """Ratio new / old by scenario and column; None where the old value is not positive.

    Raises:
        ParameterError: No scenario is in both.
    """
    both = [name for name in old.scenarios if name in new.scenarios]
    if not both:
        raise ParameterError(
            f"--compare: no scenario is in both, {', '.join(old.scenarios)} and {', '.join(new.scenarios)}; "
            "allowed: results with a common scenario; measure the same"
        )

    def ratio(name: str, value: Callable[[ScenarioCost], float]) -> float | None:
        before = value(old.scenarios[name])
        return value(new.scenarios[name]) / before if before > 0 else None

    return {name: {heading: ratio(name, value) for heading, value, _ in COLUMNS} for name in both}


def comparison_table(old: BenchResult, new: BenchResult) -> Table:
    """Ratios new / old by scenario; the title names differing conditions."""
    before, after = (result.machine | {"settings": result.overrides} for result in (old, new))
    differs = [name for name in before if name not in ("load", "humanwalk") and before[name] != after.get(name)]
    differs += [f"{which} has {one.progress}" for which, one in (("old", old), ("new", new)) if not one.complete]
    table = _table("new / old" + (f"; different conditions: {', '.join(differs)}" if differs else ""))
    for name, row in ratios(old, new).items():
        table.add_row(name, *("-" if value is None else format(value, ".2f") for value in row.values()))
    return table


def _table(title: str) -> Table:
    table = Table(title=title, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    table.add_column("scenario", no_wrap=True)
    for heading, _, _ in COLUMNS:
        table.add_column(heading, justify="right")
    return table
