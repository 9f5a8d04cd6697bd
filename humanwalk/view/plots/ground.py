"""Ground reaction forces and center of pressure at the end of a run."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from humanwalk.body import REFERENCE_STATURE, SIDES, Side
from humanwalk.body.contact import SOLE_PARTS
from humanwalk.measures.events import CONTACT_ON_N, events_of
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import GRAVITY
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import INK, SIDE, curve, label, legend, level, new_figure, true_proportions

LAST_SECONDS = 2.0
"""Stretch of `ground_reaction` [s]: three strides of the thesis' walk."""
LAST_SECONDS_ABOVE = 1.2
"""Stretch of `center_of_pressure` [s]: two strides, which at true proportions still shows the feet."""


def ground_reaction(run: Run) -> Figure | None:
    """Vertical and fore-aft force of the ground on each foot over the last seconds [N]; None for < 2 samples."""
    time, rows = _last(run, LAST_SECONDS)
    if time.size < 2:
        return None
    weight = run.scenario.subject.mass * GRAVITY
    figure = new_figure(
        f"Ground reaction on the feet, last {time[-1] - time[0]:.3g} s", height=4.0, rows=2, sharex=True
    )
    vertical, fore_aft = figure.axes
    for side in SIDES:
        for axes, axis in ((vertical, "z"), (fore_aft, "x")):
            force = run.signals[f"{side.lower()}_foot.force_{axis}_N"].to_numpy()[rows]
            curve(axes, time, force, color=SIDE[side], label=f"{side.lower()} foot")
    level(vertical, weight, f"body weight, {weight:.0f} N")
    level(fore_aft, 0.0)
    label(vertical, "", "vertical force [N]")
    label(fore_aft, "time [s]", "fore-aft force [N]\nforward positive")
    legend(vertical)
    figure.align_ylabels()
    return figure


def center_of_pressure(run: Run) -> Figure | None:
    """Center of mass, centers of pressure and footprints from above [m]; None if no foot was loaded."""
    time, rows = _last(run, LAST_SECONDS_ABOVE)
    loaded = {side: (run.signals[f"{side.lower()}_foot.force_z_N"].to_numpy() >= CONTACT_ON_N) & rows for side in SIDES}
    if time.size < 2 or not any(on.any() for on in loaded.values()):
        return None
    figure = new_figure(
        f"Center of mass and centers of pressure from above, last {time[-1] - time[0]:.3g} s", height=1.8
    )
    (axes,) = figure.axes
    for side in SIDES:
        _footprints(run, axes, side, rows)
        cop = {axis: run.signals[f"{side.lower()}_foot.cop_{axis}_m"].to_numpy()[loaded[side]] for axis in "xy"}
        axes.plot(
            cop["x"], cop["y"], ".", markersize=3.5, color=SIDE[side], label=f"center of pressure, {side.lower()}"
        )
    com = {axis: run.signals[f"com.{axis}_m"].to_numpy()[rows] for axis in "xy"}
    line = curve(axes, com["x"], com["y"], color=INK, label="center of mass")
    dots = [
        Line2D(
            [],
            [],
            marker="o",
            markersize=4,
            linestyle="",
            color=SIDE[side],
            label=f"center of pressure, {side.lower()}",
        )
        for side in SIDES
    ]
    axes.margins(x=0.02)
    true_proportions(figure)
    label(axes, "forward x [m]", "left y [m]")
    legend(axes, [line, *dots])
    return figure


def _last(run: Run, seconds: float) -> tuple[Array, Mask]:
    time = run.signals[TIME].to_numpy()
    rows = time >= time[-1] - seconds
    return time[rows], rows


def _footprints(run: Run, axes: Axes, side: Side, rows: Mask) -> None:
    """Draw the outline of the sole at the middle of each contact."""
    contact = events_of(run.signals, side).contact & rows
    edges = np.flatnonzero(np.diff(np.concatenate(([0], contact.astype(int), [0]))))
    x, y = (run.signals[f"{side.lower()}_sole.{axis}_m"].to_numpy() for axis in "xy")
    scale = run.scenario.subject.stature / REFERENCE_STATURE
    for begin, end in edges.reshape(-1, 2):
        middle = (begin + end) // 2
        for part in SOLE_PARTS:
            back, front = (scale * at for at in part.x)
            width = scale * part.width
            axes.add_patch(
                Rectangle(
                    (x[middle] + back, y[middle] - width / 2),
                    front - back,
                    width,
                    facecolor=(*SIDE[side], 0.13),
                    edgecolor="none",
                )
            )
