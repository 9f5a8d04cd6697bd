"""What `humanwalk study show` prints and writes of a study: tables for a terminal, a page with figures."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich import box
from rich.table import Table

from humanwalk.files import make_folder, require_inside
from humanwalk.study.figures import effects, greatest, measure_figures
from humanwalk.study.results import SURVIVAL, Results
from humanwalk.study.statistics import (
    CLASSES,
    CONFIDENCE,
    MAX_LEVELS,
    Effect,
    Level,
    Spread,
    Survival,
    levels_of,
    ranked_effects,
)
from humanwalk.view.page import heading, notes, paragraph, picture, table, write_page
from humanwalk.view.plots.drawing import require_format, save

PAGE = "study.html"
"""Name of the page in the folder of a study."""

PLOTS = "plots"
"""Folder of the figures in the folder of a study."""

NOTES = (
    f"Survived: completed its duration; the interval is Wilson's score interval at {100 * CONFIDENCE:.0f} %.",
    "Measures count the runs that survived.",
    "Effects: share of a measure's variance between the levels of a factor (correlation ratio, with Kelley's "
    "correction; the first-order Sobol index where factors are independent). Gray, or in parentheses: not greater than "
    "chance explains (F-test, 5 %). What the shares leave of 100 % is due to interactions of factors and to chance.",
    "Values of a factor that are many are put into classes of about equal size. Of many factors, those with the "
    "greatest effects are shown.",
)

Header = Sequence[str]
Rows = Iterable[Sequence[str]]

SURVIVAL_HEADER = ("factor", "level", "survived", "share", f"{100 * CONFIDENCE:.0f} % interval")
END_HEADER = ("end", "runs")
SPREAD_HEADER = ("factor", "level", "runs", "mean", "standard deviation", "5 %", "median", "95 %")


def survival_rows(results: Results) -> Iterator[tuple[str, ...]]:
    """Rows under SURVIVAL_HEADER: all runs, then those of each level of each factor."""
    for factor, level in _levels(results, SURVIVAL):
        survival = Survival.of(results.survived[level.rows])
        yield (
            factor,
            level.label,
            f"{survival.survived} of {survival.runs}",
            f"{100 * survival.share:.0f} %",
            f"{100 * survival.low:.1f} to {100 * survival.high:.1f} %",
        )


def end_rows(results: Results) -> Iterator[tuple[str, str]]:
    """Rows under END_HEADER."""
    yield from ((end, str(count)) for end, count in results.ends.items())


def spread_rows(results: Results, name: str) -> Iterator[tuple[str, ...]]:
    """Rows of a measure under SPREAD_HEADER: of all runs that survived, then of those of each level of each factor."""
    values = results.measure(name)
    for factor, level in _levels(results, name):
        spread = Spread.of(values[level.rows])
        if spread is None:
            yield factor, level.label, "0", *["-"] * 5
        else:
            yield factor, level.label, str(spread.count), *map(_number, spread.numbers)


def mean_header(results: Results, measures: Sequence[str]) -> tuple[str, ...]:
    """Header of `mean_rows`."""
    return ("factor", "level", *map(results.label, measures))


def mean_rows(results: Results, measures: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Mean ± standard deviation of measures: of all runs that survived, then of those of each level."""
    values = [results.measure(name) for name in measures]
    for factor, level in _levels(results, measures[0]):
        yield factor, level.label, *(_mean(Spread.of(value[level.rows])) for value in values)


def _mean(spread: Spread | None) -> str:
    if spread is None:
        return "-"
    return f"{spread.mean:.4g}" + (f" ± {spread.standard_deviation:.2g}" if spread.count > 1 else "")


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.4g}"


def _levels(results: Results, name: str) -> Iterator[tuple[str, Level]]:
    """All rows, then levels with the label of their factor, which stands at the first one."""
    yield "all", Level("", 0.0, np.arange(results.survived.size))
    shown = greatest(results, results.measure(name))
    for factor in (factor for factor in results.factors if factor in shown):
        found = levels_of(results.factors[factor], MAX_LEVELS if len(results.factors) == 1 else CLASSES)
        yield from ((results.label(factor) if place == 0 else "", level) for place, level in enumerate(found))


def effect_header(results: Results, measures: Sequence[str]) -> tuple[str, ...]:
    """Header of `effect_rows`."""
    return ("factor", *map(results.label, measures))


def effect_rows(results: Results, measures: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Shares of the variance of measures for each factor, that with the greatest share first."""
    ranked = [ranked_effects(results.factors, results.measure(name)) for name in measures]
    shares = [{effect.factor: effect for effect in found} for found in ranked]
    rows = {factor: [each.get(factor) for each in shares] for factor in results.factors}

    def greatest_share(factor: str) -> float:
        return max((effect.share for effect in rows[factor] if effect), default=0.0)

    for factor in sorted(rows, key=greatest_share, reverse=True):
        yield results.label(factor), *map(_share, rows[factor])


def _share(effect: Effect | None) -> str:
    if effect is None:
        return "-"
    return f"{100 * effect.share:.0f} %" if effect.significant else f"({100 * effect.share:.0f} %)"


def terminal_tables(results: Results, measures: Sequence[str]) -> list[Table]:
    """Tables for a terminal: survival, how runs ended, means of measures, and effects of several factors."""
    tables = [_terminal(SURVIVAL_HEADER, survival_rows(results))]
    if len(results.ends) > 1:
        tables.append(_terminal(END_HEADER, end_rows(results)))
    if measures:
        tables.append(_terminal(mean_header(results, measures), mean_rows(results, measures)))
    if len(results.factors) > 1:
        varied = _varied(results, measures)
        tables.append(_terminal(effect_header(results, varied), effect_rows(results, varied)))
    return tables


def _terminal(header: Header, rows: Rows) -> Table:
    made = Table(*header, box=box.SIMPLE)
    for row in rows:
        made.add_row(*row)
    return made


@dataclass(frozen=True)
class Section:
    """A part of the page of a study."""

    title: str
    tables: Sequence[tuple[Header, Rows]] = ()
    figures: dict[str, Figure] = field(default_factory=dict)


def sections(results: Results, measures: Sequence[str]) -> Iterator[Section]:
    """Survival, effects of several factors, and each measure."""
    varied = _varied(results, measures)
    figures = measure_figures(results, SURVIVAL) if SURVIVAL in varied else {}
    yield Section("Survival", [(SURVIVAL_HEADER, survival_rows(results)), (END_HEADER, end_rows(results))], figures)
    if len(results.factors) > 1 and varied:
        table_of_effects = (effect_header(results, varied), effect_rows(results, varied))
        yield Section("Effects", [table_of_effects], {"effects": effects(results, varied)})
    for name in measures:
        yield Section(
            results.label(name), [(SPREAD_HEADER, spread_rows(results, name))], measure_figures(results, name)
        )


def _varied(results: Results, measures: Sequence[str]) -> list[str]:
    return [name for name in (SURVIVAL, *measures) if results.varies(name)]


def write_study_page(folder: Path, results: Results, measures: Sequence[str]) -> Path:
    """Write the page of a study into its folder, whole or not at all; returns its path.

    Raises:
        ParameterError: it cannot be written.
    """
    path, points = folder / PAGE, len(results.study.points)
    done = f"{points} runs" if results.table.num_rows == points else f"{results.table.num_rows} of {points} runs so far"
    parts = [paragraph(results.study.description or results.study.scenario.description)]
    for section in sections(results, measures):
        parts.append(heading(section.title))
        parts += [picture(figure, name) for name, figure in section.figures.items()]
        parts += [table(header, rows) for header, rows in section.tables]
    write_page(path, f"{results.name}: {done}", [*parts, notes(NOTES)])
    return path


def write_study_figures(folder: Path, results: Results, measures: Sequence[str], form: str) -> list[Path]:
    """Write the figures of a study's page as files of a format into `plots` in its folder; returns their paths.

    Raises:
        ParameterError: they cannot be written, `plots` leads out of the folder, or the format is unknown.
    """
    require_format("--figures", form)
    plots = require_inside(folder, folder / PLOTS)
    make_folder(plots)
    return [
        save(figure, plots / f"{name}.{form}")
        for section in sections(results, measures)
        for name, figure in section.figures.items()
    ]
