"""Figures of a study: survival and measures over each factor, a map of two factors, ranked effects."""

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from humanwalk.numerics import Array
from humanwalk.study.results import SURVIVAL, Results
from humanwalk.study.statistics import (
    CLASSES,
    CONFIDENCE,
    MAX_LEVELS,
    FactorArray,
    Level,
    Spread,
    Survival,
    is_numeric,
    levels_of,
    ranked_effects,
)
from humanwalk.view.plots.drawing import DESIRED, INK, LABEL_SIZE, REFERENCE, SIDE, TICK_SIZE, label, new_figure

MARK = SIDE["Right"]
"""Color of means and bars."""

MAX_PANELS = 6
"""Factors in a figure: those with the greatest effects."""

MAX_BARS = 15

MAX_WRITTEN_CELLS = 150
"""Cells of a map up to which their values are written into them."""

MAX_DRAWN = 2000
"""Points of a figure that are drawn one by one; more are drawn as a picture, which does not grow with them."""

COLORS = "viridis"

Draw = Callable[[Axes, list[Level], str], None]
"""Draws levels into axes with a format of matplotlib."""


def measure_figures(results: Results, name: str) -> dict[str, Figure]:
    """Figures of a measure, or of SURVIVAL, by name: over each factor, and the map of two factors.

    There are none without factors that vary, or without a run that has the measure.
    """
    figures: dict[str, Figure] = {}
    if not results.factors or not np.isfinite(results.measure(name)).any():
        return figures
    figures[f"{name}_over_factors"] = over_factors(results, name)
    if len(results.factors) == 2:
        figures[f"{name}_map"] = map_of_two(results, name)
    return figures


def over_factors(results: Results, name: str) -> Figure:
    """A measure over each factor: rows that survived, and mean and standard deviation of each level.

    Of SURVIVAL the share of each level with its Wilson interval. Of many factors, those with the greatest effects.
    """
    values = results.measure(name)
    factors = greatest(results, values)
    columns = min(len(factors), 3)
    rows = -(-len(factors) // columns)
    draw: Draw = _survival(results) if name == SURVIVAL else _spreads(values)
    figure = new_figure(_title(results, name, values), 0.4 + 2.3 * rows, rows, columns, sharey=True, squeeze=False)
    for place, (axes, factor) in enumerate(zip(figure.axes, factors, strict=False)):
        levels = levels_of(results.factors[factor], MAX_LEVELS if len(factors) == 1 else 2 * CLASSES)
        axes.margins(x=0.05)
        draw(axes, levels, "o-" if is_numeric(results.factors[factor]) else "o")
        _ticks(axes, levels, np.unique(results.factors[factor]).size, columns)
        label(axes, results.label(factor), results.label(name) if place % columns == 0 else "")
    for axes in figure.axes[len(factors) :]:
        axes.set_visible(False)
    return figure


def map_of_two(results: Results, name: str) -> Figure:
    """A measure over two factors: means of the cells of a grid, or a point for each row of a sample."""
    (x_name, x), (y_name, y) = results.factors.items()
    values = results.measure(name)
    x_levels, y_levels = levels_of(x), levels_of(y)
    sampled = np.unique(x).size > len(x_levels) or np.unique(y).size > len(y_levels)
    if sampled or len(x_levels) * len(y_levels) > 2 * x.size:
        figure = _points_of_two(results, name, values)
    else:
        figure = new_figure(results.label(name), 0.9 + 0.32 * max(len(y_levels), 4))
        (axes,) = figure.axes
        axes.grid(False)
        cells = _cell_means(values, y_levels, x_levels)
        image = axes.imshow(cells, cmap=COLORS, aspect="auto", origin="lower", norm=Normalize(*_limits(name)))
        axes.set_xticks(range(len(x_levels)), [level.label for level in x_levels])
        axes.set_yticks(range(len(y_levels)), [level.label for level in y_levels])
        _write_cells(axes, cells, name)
        figure.colorbar(image).set_label(results.label(name), fontsize=LABEL_SIZE)
    label(figure.axes[0], results.label(x_name), results.label(y_name))
    return figure


def effects(results: Results, names: Sequence[str]) -> Figure:
    """Ranked effects of the factors on measures: shares of variance; gray where chance explains them."""
    ranked = {name: ranked_effects(results.factors, results.measure(name)) for name in names}
    bars = min(max(map(len, ranked.values())), MAX_BARS)
    columns = 1 if max(len(results.label(factor)) for factor in results.factors) > 25 or len(names) == 1 else 2
    rows = -(-len(names) // columns)
    title = "Share of the variance that each factor explains; gray: no more than chance"
    height = 0.4 + rows * (0.7 + 0.2 * max(bars, 2))
    figure = new_figure(title, height, rows, columns, squeeze=False)
    for place, (axes, (name, found)) in enumerate(zip(figure.axes, ranked.items(), strict=False)):
        shares = [100.0 * effect.share for effect in found[:bars]]
        colors = [MARK if effect.significant else DESIRED for effect in found[:bars]]
        axes.barh(range(len(shares)), shares, height=0.7, color=colors)
        axes.set_yticks(range(len(shares)), [results.label(effect.factor) for effect in found[:bars]])
        axes.tick_params(axis="y", length=0)
        axes.set_title(results.label(name), fontsize=LABEL_SIZE, pad=3, loc="left")
        axes.set_xlim(0.0, 100.0)
        axes.set_ylim(bars - 0.4, -0.6)
        axes.grid(False, axis="y")
        label(axes, "share of variance [%]" if place >= len(names) - columns else "", "")
    for axes in figure.axes[len(names) :]:
        axes.set_visible(False)
    return figure


def greatest(results: Results, values: Array) -> list[str]:
    """The factors with the greatest effects on a measure, shape (rows,), at most MAX_PANELS."""
    ranked = [effect.factor for effect in ranked_effects(results.factors, values)]
    return list(dict.fromkeys([*ranked, *results.factors]))[:MAX_PANELS]


def _survival(results: Results) -> Draw:
    def draw(axes: Axes, levels: list[Level], form: str) -> None:
        found = [Survival.of(results.survived[level.rows]) for level in levels]
        share = np.array([100.0 * each.share for each in found])
        below = share - [100.0 * each.low for each in found]
        above = [100.0 * each.high for each in found] - share
        # Rounding may put the end of an interval on the wrong side of its share.
        _means(axes, levels, share, np.maximum([below, above], 0.0), form)
        axes.set_ylim(-5.0, 105.0)

    return draw


def _spreads(values: Array) -> Draw:
    def draw(axes: Axes, levels: list[Level], form: str) -> None:
        found = [(level, spread) for level in levels if (spread := Spread.of(values[level.rows])) is not None]
        for level in levels:
            at = np.full(level.rows.size, level.position)
            axes.plot(at, values[level.rows], ".", color=DESIRED, markersize=3, rasterized=values.size > MAX_DRAWN)
        means = np.array([spread.mean for _, spread in found])
        deviations = np.array([spread.standard_deviation for _, spread in found])
        _means(axes, [level for level, _ in found], means, deviations, form)

    return draw


def _means(axes: Axes, levels: list[Level], values: Array, errors: Array, form: str) -> None:
    positions = [level.position for level in levels]
    axes.errorbar(positions, values, errors, fmt=form, markersize=3, lw=0.6, elinewidth=1.0, capsize=2, color=MARK)


def _ticks(axes: Axes, levels: list[Level], distinct: int, columns: int) -> None:
    """Write the levels below the axis where they are single values and not many, slanted where they are long."""
    labels = [level.label for level in levels]
    if distinct == len(levels) <= 24 // columns:
        axes.set_xticks([level.position for level in levels], labels)
        if sum(map(len, labels)) > 60 // columns:
            axes.tick_params(axis="x", rotation=40)
            for tick in axes.get_xticklabels():
                tick.set(horizontalalignment="right", rotation_mode="anchor")


def _points_of_two(results: Results, name: str, values: Array) -> Figure:
    x, y = results.factors.values()
    figure = new_figure("Runs that survived" if name == SURVIVAL else results.label(name), 3.4)
    (axes,) = figure.axes
    axes.margins(0.03)
    axes.set_rasterization_zorder(2.5 if values.size > MAX_DRAWN else None)
    positions = [_positions(factor) for factor in (x, y)]
    if name == SURVIVAL:
        for survived, mark, color, text in ((True, "o", MARK, "survived"), (False, "X", SIDE["Left"], "did not")):
            rows = results.survived == survived
            axes.plot(positions[0][rows], positions[1][rows], mark, color=color, markersize=5, label=text)
        figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=TICK_SIZE)
    else:
        axes.plot(*(place[~results.survived] for place in positions), "x", color=REFERENCE, markersize=4)
        points = axes.scatter(positions[0], positions[1], c=values, cmap=COLORS, s=22)
        figure.colorbar(points).set_label(results.label(name), fontsize=LABEL_SIZE)
    return figure


def _positions(factor: FactorArray) -> Array:
    """Places of the rows on an axis, shape (rows,): their numbers, or the place of their text."""
    if is_numeric(factor):
        return factor
    places = np.empty(factor.size)
    for level in levels_of(factor):
        places[level.rows] = level.position
    return places


def _cell_means(values: Array, rows: list[Level], columns: list[Level]) -> Array:
    """Means of the finite values of the cells, shape (len(rows), len(columns)); not a number in empty cells."""
    cells = np.full((len(rows), len(columns)), np.nan)
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            spread = Spread.of(values[np.intersect1d(row.rows, column.rows)])
            cells[i, j] = np.nan if spread is None else spread.mean
    return cells


def _write_cells(axes: Axes, cells: Array, name: str) -> None:
    if cells.size > MAX_WRITTEN_CELLS:
        return
    middle = 50.0 if name == SURVIVAL else (np.nanmin(cells) + np.nanmax(cells)) / 2.0
    for (i, j), value in np.ndenumerate(cells):
        text = "-" if np.isnan(value) else f"{value:.3g}"
        color = INK if np.isnan(value) or value > middle else "white"
        axes.text(j, i, text, ha="center", va="center", fontsize=TICK_SIZE - 1, color=color)


def _limits(name: str) -> tuple[float, float] | tuple[None, None]:
    return (0.0, 100.0) if name == SURVIVAL else (None, None)


def _title(results: Results, name: str, values: Array) -> str:
    if name == SURVIVAL:
        return f"Runs that survived; bars: {100 * CONFIDENCE:.0f} % Wilson intervals"
    return f"{results.label(name)} of {np.isfinite(values).sum()} runs that survived; bars: ± 1 standard deviation"
