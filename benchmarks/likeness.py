"""How near the balanced walk is to human gait, beside the goals: python benchmarks/likeness.py [FOLDER]

Runs the shipped study `likeness` into the folder (runs/likeness), or resumes it, and prints the table. Robustness is
that of the kept results of the shipped balance studies.
"""

import argparse
import csv
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from humanwalk.measures.curves import JOINTS
from humanwalk.measures.human_ranges import Pace
from humanwalk.measures.walk_measures import MEASURES
from humanwalk.quantity import GRAVITY
from humanwalk.study.row import likeness_columns
from humanwalk.study.study import load_study

STUDY = "likeness"
RESULTS = Path(__file__).parent / "results"
CONTACT, FORWARD = "contact", "controller.balanced.command.points.0.forward"
GAIT, STYLED = "gait", "normative"
SCORE = "likeness.score"

COLUMNS = tuple(f"likeness.{name}" for name in likeness_columns())
"""Columns of the study's table that the goals need, besides the usual ones."""

Row = Mapping[str, Any]
Limits = tuple[float, float]


def is_compared(row: Row) -> bool:
    """Whether the walk of a row can be compared with people's; one that fell cannot."""
    return row[SCORE] is not None


@dataclass(frozen=True)
class Target:
    """What the values of a measure should be.

    Attributes:
        text: for the table.
        limits: of each value of a row.
    """

    text: str
    limits: Callable[[Row], Sequence[Limits]]


@dataclass(frozen=True)
class Goal:
    """A goal of human likeness.

    Attributes:
        name: what is measured.
        values: of a row of the study.
        without: target of a walk without a style.
        with_style: target of a walk that follows human curves; None: the same.
        form: of a value.
        speeds: at which the goal counts; empty for all.
    """

    name: str
    values: Callable[[Row], Sequence[float]]
    without: Target
    with_style: Target | None = None
    form: str = ".2f"
    speeds: tuple[float, ...] = ()

    def target(self, row: Row) -> Target:
        """The target of a row."""
        return self.with_style if self.with_style and row[GAIT] == STYLED else self.without

    def counts(self, row: Row) -> bool:
        """Whether the goal counts for a row: at its speed, if the walk can be compared."""
        return is_compared(row) and (not self.speeds or row[FORWARD] in self.speeds)

    def reached(self, row: Row) -> bool:
        """Whether the goal counts for a row, and the row reaches it."""
        if not self.counts(row):
            return False
        limits = self.target(row).limits(row)
        return all(low <= value <= high for value, (low, high) in zip(self.values(row), limits, strict=True))

    def shown(self, row: Row) -> str:
        """The values of a row as text."""
        return " ".join(format(value, self.form) for value in self.values(row))

    def cell(self, row: Row, mark: Callable[[str], str]) -> str:
        """The cell of a row in the table; `mark` marks values that reach the goal."""
        if not self.counts(row):
            return "-"
        return mark(self.shown(row)) if self.reached(row) else self.shown(row)


def _values(*columns: str, scale: float = 1.0) -> Callable[[Row], list[float]]:
    def of(row: Row) -> list[float]:
        values = (row[f"likeness.{column}"] for column in columns)
        return [np.nan if value is None else scale * value for value in values]

    return of


def _percent(quantity: str) -> Callable[[Row], list[float]]:
    """Within one standard deviation, by joint."""
    return _values(*(f"{joint}{quantity}.within_1_sd" for joint in JOINTS), scale=100.0)


def _of_joints(quantity: str, measure: str) -> Callable[[Row], list[float]]:
    return _values(*(f"{joint}{quantity}.{measure}" for joint in JOINTS))


def _mean(values: Callable[[Row], list[float]]) -> Callable[[Row], list[float]]:
    return lambda row: [float(np.mean(values(row)))]


def _from(*lows: float) -> Target:
    return Target(f">= {_texts(lows)}", lambda row: [(low, np.inf) for low in lows])


def _to(*highs: float) -> Target:
    return Target(f"<= {_texts(highs)}", lambda row: [(-np.inf, high) for high in highs])


def _between(*limits: Limits) -> Target:
    low, high = zip(*limits, strict=True)
    return Target(f"{_texts(low)} to {_texts(high)}", lambda row: list(limits))


def _texts(values: Sequence[float]) -> str:
    """The values; one, if all are the same."""
    return " ".join(f"{value:g}" for value in (values if len(set(values)) > 1 else values[:1]))


def _within_people(name: str, form: str) -> Goal:
    """A measure that has to be within the human range at the speed and for the leg length of the row."""
    (kind,) = (kind for kind in MEASURES if kind.name == name)

    def limits(row: Row) -> list[Limits]:
        speed = row["likeness.speed_m_s"]
        people = kind.people(Pace(speed, (speed / row["likeness.dimensionless_speed"]) ** 2 / GRAVITY))
        assert people is not None
        return [(people.low, people.high)]

    heading = f"{name} [{kind.unit}]" if kind.unit else name
    return Goal(heading, _values(kind.column), Target("human 1 SD", limits), form=form)


PEAKS = _values("vertical_GRF_first_peak_BW", "vertical_GRF_second_peak_BW")
TWO_PEAKS = _values("share_of_stances_with_two_peaks", scale=100.0)
LOST = _values("contact_lost_after_heel_strike_s", scale=1e3)
MOMENTS = "_moment"

GOALS = (
    Goal("angles within 1 SD, mean [%]", _mean(_percent("")), _from(75), _from(88), ".0f"),
    Goal("angles within 1 SD: hip, knee, ankle [%]", _percent(""), _from(60, 60, 60), _from(80, 80, 80), ".0f"),
    Goal("angles, correlation", _of_joints("", "correlation"), _from(0.97, 0.95, 0.9), _from(0.98, 0.98, 0.95)),
    Goal("moments within 1 SD, mean [%]", _mean(_percent(MOMENTS)), _from(65), _from(75), ".0f"),
    Goal("moments, correlation", _of_joints(MOMENTS, "correlation"), _from(0.9, 0.7, 0.95), _from(0.9, 0.75, 0.95)),
    Goal("moments, peak / human", _of_joints(MOMENTS, "peak_ratio"), _to(1.4, 1.4, 1.4), _to(1.3, 1.3, 1.3)),
    Goal("powers within 1 SD, mean [%]", _mean(_percent("_power")), _from(60), _from(65), ".0f"),
    Goal("vertical GRF, peaks [BW]", PEAKS, _between((1.05, 1.25), (1.05, 1.25))),
    Goal("vertical GRF, dip [BW]", _values("vertical_GRF_dip_BW"), _between((0.7, 0.9))),
    Goal("stances with two peaks [%]", TWO_PEAKS, _from(100), form=".0f"),
    Goal("contact lost after heel strike, at most [ms]", LOST, _to(0), form=".0f"),
    Goal("CoP backward, at most [cm]", _values("CoP_backward_m", scale=100.0), _to(1), form=".1f"),
    _within_people("share of stance", ".3f"),
    _within_people("share of double support", ".3f"),
    _within_people("cadence", ".0f"),
    _within_people("step length", ".3f"),
    _within_people("step width", ".3f"),
    Goal("cost of transport", _values("cost_of_transport"), _to(0.42), _to(0.45), speeds=(1.2,)),
)
"""The goals, in the order of the table."""

ROBUSTNESS = {
    "balance_speeds": ("five speeds, 60 s", "5 of 5"),
    "balance_seeds": ("seeds", "20 of 20 at each speed"),
    "normative_seeds": ("seeds with the style normative", "19 of 20"),
    "balance_pushes": ("pushes of 30 N s", "40 of 40"),
    "balance_pushes_60": ("pushes of 60 N s", "10 of 10"),
    "balance_bodies": ("bodies of 50 to 110 kg", "8 of 8"),
}
"""Shipped studies: what they are, and the goal."""


def by_gait(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """The rows of each set of gains, by its name."""
    return {gait: [row for row in rows if row[GAIT] == gait] for gait in dict.fromkeys(row[GAIT] for row in rows)}


def headings(rows: Sequence[Row]) -> list[str]:
    """Of the table of the rows of one gait: what is measured, the goal, each run."""
    return ["", "goal", *(f"{row[CONTACT]} {row[FORWARD]:g} m/s" for row in rows)]


def lines(rows: Sequence[Row], mark: Callable[[str], str]) -> Iterator[list[str]]:
    """Lines of the table of the rows of one gait; `mark` marks values that reach the goal.

    A run that fell, or whose strides cannot be compared, has no values.
    """
    for goal in GOALS:
        yield [goal.name, goal.target(rows[0]).text, *(goal.cell(row, mark) for row in rows)]
    yield ["score [%]", "", *map(score_text, rows)]
    yield ["goals reached", "", *map(goals_text, rows)]


def goals_text(row: Row) -> str:
    """Number of goals that a row reaches, and of those that count."""
    return f"{sum(goal.reached(row) for goal in GOALS)} of {sum(goal.counts(row) for goal in GOALS)}"


def score_text(row: Row) -> str:
    """Score of a row [%]."""
    return f"{100.0 * row[SCORE]:.0f}" if is_compared(row) else "-"


def robustness() -> Iterator[tuple[str, str, str]]:
    """Name, goal and survived runs of the kept results of the balance studies."""
    for study, (name, goal) in ROBUSTNESS.items():
        with (RESULTS / f"{study}.csv").open(encoding="utf-8", newline="") as file:
            survived = [row["survived"].lower() == "true" for row in csv.DictReader(file)]
        yield f"{name} ({study})", goal, f"{sum(survived)} of {len(survived)}"


def main(folder: Path) -> None:
    """Run or resume the study, and print the table."""
    from humanwalk.cli.common import counted_progress
    from humanwalk.study.cluster import local_client
    from humanwalk.study.execute import run_study

    study = load_study(STUDY)
    with local_client(None) as client, counted_progress("runs", estimate_period=600.0) as progress:
        task = progress.add_task(STUDY, total=len(study.points))
        done = run_study(study, folder, client, lambda count, total, row: progress.update(task, completed=count))
    rows = done.to_pylist()
    console = Console(width=200 if not sys.stdout.isatty() else None)
    for gait, walks in by_gait(rows).items():
        shown = Table(*headings(walks), box=box.SIMPLE, title=f"{gait}; ✓: reaches the goal")
        for line in lines(walks, "{} ✓".format):
            shown.add_row(*map(escape, line))
        console.print(shown)
    kept = Table("robustness", "goal", "survived", box=box.SIMPLE)
    for row in robustness():
        kept.add_row(*row)
    console.print(kept)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("runs") / STUDY)
    main(parser.parse_args().folder)
