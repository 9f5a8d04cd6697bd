"""The table of walks on terrain: how many of each study and ground are completed.

`humanwalk study terrain_rough -o runs/terrain_rough`, then `python benchmarks/pages.py runs/terrain_rough`.
"""

from collections.abc import Iterator, Sequence
from statistics import median

from likeness import Row
from studies import PUSH_IMPULSE, RESULTS, study_results, survival_texts, table

from humanwalk.study.study import load_study

UNITS = {PUSH_IMPULSE: "{:g} N s"}
"""How numbers of a factor are written."""

GROUNDS: dict[str, tuple[str, tuple[str, ...]]] = {
    "terrain": ("", ("ground",)),
    "terrain_edges": ("0.5 to 1.4 m ahead", ("ground",)),
    "terrain_treads": ("stairs up and down", ("body",)),
    "terrain_rough": ("boxes of ±5 cm", ()),
    "terrain_rough_blind": ("boxes of ±2 cm, blind", ()),
    "terrain_blind": ("blind", ("ground",)),
    "terrain_stones": ("stones of 30 cm, gaps of 20 cm, ±5 cm", ()),
    "terrain_stops": ("stop and go", ("ground",)),
    "terrain_turns": ("turn on boxes of ±2 cm", ("speed",)),
    "terrain_commands": ("commands at random", ("ground",)),
    "terrain_bodies": ("", ("body", "ground")),
    "terrain_pushes": ("push of 30 N s", ("ground",)),
    "terrain_stairs_pushes": ("stairs", ("ground", PUSH_IMPULSE)),
    "terrain_mixed": ("bodies, loads, grounds, speeds and pushes at random", ()),
    "terrain_course": ("every kind of ground, 43 m", ()),
}
"""What the walks of a study have in common, and the factors that tell its grounds apart."""


def terrain_walks() -> str:
    """A line for each ground of each study that has been simulated; walked: median of the completed walks."""
    headings = ["ground", "study", "commanded m/s", "walked m/s", "s", "completed", "95 % interval"]
    return table(headings, [line for name in GROUNDS if (RESULTS / f"{name}.csv").exists() for line in _lines(name)])


def _lines(name: str) -> Iterator[list[str]]:
    study, (common, factors) = load_study(name), GROUNDS[name]

    def ground(row: Row) -> str:
        levels = [UNITS.get(factor, "{}").format(row[factor]) for factor in factors]
        return ", ".join(filter(None, [common, *levels]))

    rows = study_results(name).table.to_pylist()
    for label in dict.fromkeys(map(ground, rows)):
        walks = [row for row in rows if ground(row) == label]
        scenarios = [study.scenario_at({column: row[column] for column in study.columns}) for row in walks]
        commands = [scenario.controller.command for scenario in scenarios]
        speeds = [point.forward for command in commands if command for point in command.points]
        duration = max(scenario.duration for scenario in scenarios)
        walked = [row["mean_speed_m_s"] for row in walks if row["survived"] and len(set(speeds)) == 1]
        yield [
            label,
            f"`{name}`",
            _range(speeds),
            f"{median(walked):.2f}" if walked else "-",
            f"{duration:.3g}",
            *survival_texts(walks),
        ]


def _range(values: Sequence[float]) -> str:
    least, most = min(values), max(values)
    return f"{least:.2g}" if least == most else f"{least:.2g} to {most:.2g}"
