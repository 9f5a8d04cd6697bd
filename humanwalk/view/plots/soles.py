"""The center of pressure under each sole, stance by stance."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.limbs import LEGS
from humanwalk.body.shapes import Vector3
from humanwalk.measures.center_of_pressure import ROLL, backward_travel, cop_paths
from humanwalk.measures.walk_measures import Walk
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import INK, LABEL_SIZE, SIDE, STANCE, label, new_figure


def cop_under_soles(run: Run) -> Figure | None:
    """Center of pressure of every steady stride in the frame of its footprint [cm]; None without a stride.

    The path from 10 to 55 % of the gait cycle is drawn wide; people's goes forward from the heel to the toes. Below it,
    the same path over the gait cycle, where one that turns back is visible.
    """
    walk = Walk.of(run.signals, run.scenario)
    paths = {side: cop_paths(run.signals, side, foot) for side, foot in walk.feet.items()}
    if not all(paths.values()):
        return None
    figure = new_figure("Center of pressure under the soles, every stride in the frame of its footprint", 4.4, 2, 2)
    for column, side in enumerate(SIDES):
        under, over = figure.axes[column], figure.axes[2 + column]
        draw_sole(under, run.scenario.subject.skeleton.size(LEGS[side].hindfoot), side, scale=100.0)
        for path in filter(len, paths[side]):
            cycle, forward, left = path.T * np.array([[1.0], [100.0], [100.0]])
            rolling = (cycle >= ROLL[0]) & (cycle <= ROLL[1])
            for axes, x, y in ((under, forward, left), (over, cycle, forward)):
                axes.plot(x, y, color=SIDE[side], linewidth=0.6, alpha=0.5)
                axes.plot(x[rolling], y[rolling], color=SIDE[side], linewidth=1.4, alpha=0.7)
            for at, marker in zip(ROLL, "o>", strict=True):
                nearest = int(np.argmin(np.abs(cycle - at)))
                under.plot(forward[nearest], left[nearest], marker, markersize=3, color=INK)
        back = 100.0 * max(map(backward_travel, paths[side]))
        over.axvspan(*ROLL, color=STANCE, linewidth=0, zorder=0)
        over.set_xlim(0.0, 70.0)
        over.set_title(f"{side.lower()}: at most {back:.1f} cm backward", fontsize=LABEL_SIZE, pad=3)
        under.set_title(f"{side.lower()} sole; dot: 10 %, arrow: 55 %", fontsize=LABEL_SIZE, pad=3)
        under.set_aspect("equal", adjustable="datalim")
        label(under, "forward of the ankle [cm]", "left [cm]" if column == 0 else "")
        label(over, "gait cycle [%]", "forward of\nthe ankle [cm]" if column == 0 else "")
    return figure


def draw_sole(
    axes: Axes, size: Vector3, side: Side, place: complex = 0.0, direction: complex = 1.0, scale: float = 1.0
) -> None:
    """Draw the outline of a sole.

    Args:
        axes: Where it is drawn.
        size: Of the foot relative to the reference human's.
        side: Of the body.
        place: Of the point under the ankle [m].
        direction: Of the toes, of any length but 0.
        scale: Units of the axes per meter.
    """
    along, across, _ = size
    for part in SOLE_PARTS:
        back, front, half = along * part.x[0], along * part.x[1], 0.5 * across * part.width
        corners = np.array([back - 1j * half, front - 1j * half, front + 1j * half, back + 1j * half])
        outline = scale * (place + direction / abs(direction) * corners)
        axes.add_patch(
            Polygon(np.column_stack((outline.real, outline.imag)), facecolor=(*SIDE[side], 0.13), edgecolor="none")
        )
