"""Figures of a tuning: measures over the trials, parameters, importance, Pareto front."""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from humanwalk.numerics import Array, Mask
from humanwalk.study.objectives import NO_LIMIT
from humanwalk.study.row import Row
from humanwalk.study.trials import TRIAL, walked
from humanwalk.study.tuning import Tuning
from humanwalk.view.plots.drawing import DESIRED, INK, REFERENCE, SIDE, TICK_SIZE, label, level, new_figure

WITHIN, BEYOND, BEST = SIDE["Right"], DESIRED, SIDE["Left"]
"""Colors of trials within all bounds, of others, and of the best one."""

COLUMNS = 3

CLIPPED = 97.0
"""Percentile of the values of a figure at its upper end."""


def history(tuning: Tuning, rows: Sequence[Row], best: Row) -> Figure:
    """Every objective and bound over the trials, with the limits; for one goal also the cost."""
    single = tuning.sampler == "cma_es"
    names = [*(["cost"] if single else []), *(f"values.{name}" for name in tuning.measured)]
    title = "Trials: blue within all bounds, gray not, orange the best; crosses fell"
    figure = new_figure(title, 0.5 + 1.5 * len(names), len(names), sharex=True, squeeze=False)
    trials = _column(rows, TRIAL)
    for axes, name in zip(figure.axes, names, strict=True):
        _draw_trials(axes, trials, _walking(tuning, rows, name), rows, best, name)
        axes.margins(x=0.02)
        bound = tuning.bounds.get(name.removeprefix("values."))
        for limit in (bound.low, bound.high) if bound else ():
            if abs(limit) < NO_LIMIT:
                level(axes, limit, "bound")
        label(axes, "", name.removeprefix("values.").replace("_", " "))
    fallen = [row[TRIAL] for row in rows if not walked(tuning, row)]
    top = figure.axes[0].get_xaxis_transform()
    figure.axes[0].plot(fallen, [0.97] * len(fallen), "x", transform=top, color=INK, markersize=4.0)
    if single:
        costs = _walking(tuning, rows, "cost")
        figure.axes[0].plot(trials, np.fmin.accumulate(costs), color=INK, linewidth=0.9)
    label(figure.axes[-1], "trial", figure.axes[-1].get_ylabel())
    return figure


def parameters(tuning: Tuning, rows: Sequence[Row], best: Row, starts: Mapping[str, float]) -> Figure:
    """The cost over each parameter; the dashed line is the start."""
    names = list(tuning.parameters)
    lines = -(-len(names) // COLUMNS)
    title = "Cost over the parameters; dashed: the scenario's own value"
    figure = new_figure(title, 0.4 + 1.5 * lines, lines, COLUMNS, sharey=True, squeeze=False)
    costs = _walking(tuning, rows, "cost")
    for place, (axes, name) in enumerate(zip(figure.axes, names, strict=False)):
        limits = tuning.parameters[name]
        column = f"parameters.{name}"
        _draw_trials(axes, _column(rows, column), costs, rows, best, "cost", best[column])
        axes.axvline(starts[name], color=REFERENCE, linestyle="--", linewidth=0.9)
        if limits.log:
            axes.set_xscale("log")
            # Figures have no formulas, which the usual one writes.
            axes.xaxis.set_major_formatter(LogFormatter())
            axes.xaxis.set_minor_formatter(LogFormatter())
            axes.tick_params(axis="x", which="minor", labelsize=TICK_SIZE)
        axes.set_xlim(limits.low, limits.high)
        label(axes, ".".join(name.split(".")[-2:]), "cost" if place % COLUMNS == 0 else "")
    for axes in figure.axes[len(names) :]:
        axes.set_visible(False)
    return figure


def importance(shares: Mapping[str, float]) -> Figure:
    """Bars of the importance of the parameters, the greatest on top."""
    figure = new_figure("Importance of the parameters for a low cost (PED-ANOVA)", 0.7 + 0.2 * len(shares))
    (axes,) = figure.axes
    axes.barh(range(len(shares)), [100.0 * share for share in shares.values()], height=0.7, color=WITHIN)
    axes.set_yticks(range(len(shares)), [".".join(name.split(".")[-2:]) for name in shares])
    axes.set_ylim(len(shares) - 0.4, -0.6)
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", length=0, labelsize=TICK_SIZE)
    label(axes, "share [%]", "")
    return figure


def pareto(tuning: Tuning, rows: Sequence[Row], front: Sequence[Row], best: Row) -> Figure:
    """Every pair of objectives: all trials, and the Pareto front as a line."""
    pairs = list(combinations(tuning.objectives, 2))
    figure = new_figure("Pareto front", 0.4 + 2.6 * len(pairs), len(pairs), squeeze=False)
    for axes, (first, second) in zip(figure.axes, pairs, strict=True):
        x, y = f"values.{first}", f"values.{second}"
        _draw_trials(axes, _column(rows, x), _walking(tuning, rows, y), rows, best, y, best[x])
        points = sorted((row[x], row[y]) for row in front)
        axes.plot(*zip(*points, strict=True), color=INK, linewidth=0.9, marker="o", markersize=3.5)
        axes.margins(x=0.05)
        label(axes, first.replace("_", " "), second.replace("_", " "))
    return figure


def _draw_trials(
    axes: Axes, x: Array, y: Array, rows: Sequence[Row], best: Row, column: str, best_x: float | None = None
) -> None:
    """Points of all trials, and the best one in front of them; one without y does not appear."""
    within: Mask = np.array([bool(row["feasible"]) for row in rows])
    for which, color in ((~within, BEYOND), (within, WITHIN)):
        axes.plot(x[which], y[which], "o", markersize=2.8, color=color)
    axes.plot([best[TRIAL] if best_x is None else best_x], [best[column]], "o", markersize=5.5, color=BEST)
    low, high = np.nanmin(y), np.nanpercentile(y, CLIPPED)
    if high > low:
        # A few bad trials would hide the differences between the good ones.
        axes.set_ylim(low - 0.08 * (high - low), high + 0.08 * (high - low))


def _column(rows: Sequence[Row], name: str) -> Array:
    return np.array([np.nan if row[name] is None else row[name] for row in rows], dtype=float)


def _walking(tuning: Tuning, rows: Sequence[Row], name: str) -> Array:
    """A column; NaN for trials without all values, whose cost is only that of a fall."""
    return np.where([walked(tuning, row) for row in rows], _column(rows, name), np.nan)
