"""External forces: ground reaction and center of pressure at the end of a run, support of the pelvis over time."""

from collections.abc import Sequence
from functools import partial
from typing import Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import LEGS
from humanwalk.measures.events import CONTACT_ON_N, events_of, stretches
from humanwalk.measures.orientation import sole_rotation
from humanwalk.measures.path import fore_aft_force, horizontal, path_directions
from humanwalk.measures.signals import ENDINGS
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import GRAVITY
from humanwalk.run.folder import Run
from humanwalk.terrain import Face
from humanwalk.terrain.solids import shown_color
from humanwalk.view.plots.drawing import (
    AXIS_COLORS,
    DESIRED,
    INK,
    SIDE,
    curve,
    label,
    legend,
    level,
    new_figure,
    true_proportions,
)
from humanwalk.view.plots.soles import draw_sole

TOES = (1.0, 0.0, 0.0)
"""Direction from heel to toes in the frame of a sole."""

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
    facing = path_directions(run.signals, run.scenario.controller.command).facing
    figure = new_figure(
        f"Ground reaction on the feet, last {time[-1] - time[0]:.3g} s", height=4.0, rows=2, sharex=True
    )
    vertical, fore_aft = figure.axes
    for side in SIDES:
        forces = (run[f"{side.lower()}_foot.force_z"], fore_aft_force(run.signals, side, facing))
        for axes, force in zip((vertical, fore_aft), forces, strict=True):
            curve(axes, time, force[rows], color=SIDE[side], label=f"{side.lower()} foot")
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
    loaded = {side: (run[f"{side.lower()}_foot.force_z"] >= CONTACT_ON_N) & rows for side in SIDES}
    if time.size < 2 or not any(on.any() for on in loaded.values()):
        return None
    figure = new_figure(
        f"Center of mass and centers of pressure from above, last {time[-1] - time[0]:.3g} s", height=1.8
    )
    (axes,) = figure.axes
    for side in SIDES:
        _footprints(run, axes, side, rows)
        x, y = (run[f"{side.lower()}_foot.cop_{axis}"][loaded[side]] for axis in "xy")
        axes.plot(x, y, ".", markersize=3.5, color=SIDE[side], label=f"center of pressure, {side.lower()}")
    line = curve(axes, run["com.x"][rows], run["com.y"][rows], color=INK, label="center of mass")
    dot = partial(Line2D, [], [], marker="o", markersize=4, linestyle="")
    dots = [dot(color=SIDE[side], label=f"center of pressure, {side.lower()}") for side in SIDES]
    axes.margins(x=0.02)
    draw_faces(axes, run.scenario.terrain.faces)
    true_proportions(figure)
    label(axes, "forward x [m]", "left y [m]")
    legend(axes, [line, *dots])
    return figure


def support(run: Run, what: Literal["force", "torque"]) -> Figure | None:
    """Force [N] or torque [N m] of the support on the pelvis in the world; None for a run without support."""
    unit, names = {"force": ("N", ("forward", "left", "up")), "torque": ("N m", ("roll", "pitch", "yaw"))}[what]
    ending = ENDINGS[unit]
    rms: float | None = run.summary[f"support_{what}_rms_{ending}"]  # type: ignore[literal-required]
    columns = [f"support.{what}_{axis}_{ending}" for axis in "xyz"]
    recorded = set(columns) <= set(run.signals.column_names)
    if not (run.summary["external_support"] and recorded and run.time.size >= 2):
        return None
    title = f"External support (the assumed balance): {what} on the pelvis"
    if rms is not None:
        title += f"\nrms {rms:.0f} {unit} in steady walking"
    if rms is not None and what == "force":
        title += f", {100 * rms / (run.scenario.subject.mass * GRAVITY):.0f} % of body weight"
    figure = new_figure(title, height=4.4, rows=3, sharex=True)
    for axes, axis, name, column in zip(figure.axes, "xyz", names, columns, strict=True):
        level(axes, 0.0)
        curve(axes, run.time, run[column], color=AXIS_COLORS[axis], linewidth=0.8)
        label(axes, "time [s]" if axis == "z" else "", f"{name} {axis} [{unit}]")
    figure.align_ylabels()
    return figure


def _last(run: Run, seconds: float) -> tuple[Array, Mask]:
    rows = run.time >= run.time[-1] - seconds
    return run.time[rows], rows


def draw_faces(axes: Axes, faces: Sequence[Face]) -> None:
    """Draw the faces of the ground in view behind everything else."""
    (left, right), (low, high) = view = axes.get_xlim(), axes.get_ylim()
    for face in faces:
        (x0, y0), (x1, y1) = face.lower, face.upper
        x0, x1, y0, y1 = max(x0, left), min(x1, right), max(y0, low), min(y1, high)
        if x0 < x1 and y0 < y1:
            color = (*shown_color(face), 0.6)
            axes.add_patch(
                Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=color, edgecolor=DESIRED, linewidth=0.5, zorder=0)
            )
    axes.set(xlim=view[0], ylim=view[1])


def _footprints(run: Run, axes: Axes, side: Side, rows: Mask) -> None:
    """Draw the outline of the sole at the middle of each contact."""
    place, toes = horizontal(run.signals, f"{side.lower()}_sole"), sole_rotation(run.signals, side).apply(TOES)
    size = run.scenario.subject.skeleton.size(LEGS[side].hindfoot)
    for begin, end in stretches(events_of(run.signals, side).contact & rows):
        middle = (begin + end) // 2
        draw_sole(axes, size, side, place[middle], complex(*toes[middle, :2]))
