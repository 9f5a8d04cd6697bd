"""Tables of benchmark results."""

from collections.abc import Callable, Mapping

from rich import box
from rich.table import Table

from humanwalk.bench.result import BenchResult, ScenarioCost
from humanwalk.quantity import ParameterError

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
    of = result.machine
    part = "" if result.complete else f", not complete: {result.progress}"
    table = _table(
        f"ms per simulated second, median of {result.repeats}{part}; {of['processor']}, load {of['load']:.1f}"
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
    differs = _differences(old, new)
    differs += [f"{which} has {one.progress}" for which, one in (("old", old), ("new", new)) if not one.complete]
    table = _table("new / old" + (f"; different conditions: {', '.join(differs)}" if differs else ""))
    for name, row in ratios(old, new).items():
        table.add_row(name, *("-" if value is None else format(value, ".2f") for value in row.values()))
    return table


def _differences(old: BenchResult, new: BenchResult) -> list[str]:
    def conditions(result: BenchResult) -> Mapping[str, object]:
        versions = {name: value for name, value in result.machine.items() if name not in ("load", "humanwalk")}
        return versions | {"settings": result.overrides}

    before, after = conditions(old), conditions(new)
    return [name for name in before if before[name] != after.get(name)]


def _table(title: str) -> Table:
    table = Table(title=title, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    table.add_column("scenario", no_wrap=True)
    for heading, _, _ in COLUMNS:
        table.add_column(heading, justify="right")
    return table
