"""Style of all plots: size, colors, labels and legend; matplotlib without pyplot has no global state."""

import base64
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

from humanwalk.body import Side
from humanwalk.body.visual import SIDE_COLORS
from humanwalk.files import write_whole
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import ParameterError

FORMATS = ("png", "svg", "pdf")

COLUMN_WIDTH = 5.6
"""Width of a figure in inches; at DPI it is 896 pixels."""
DPI = 160

SIDE = SIDE_COLORS
"""Right is blue, left is orange, as on the body."""
WIDTH: dict[Side, float] = {"Right": 2.2, "Left": 0.9}
"""Widths of curves: a walk is nearly symmetric, and the right one has to be visible behind the left one."""
AXIS_COLORS = {"x": "#1b7837", "y": "#762a83", "z": "#404040"}
"""Colors of x, y, z in W, distinct from those of the two sides."""
INK = "#202020"
DESIRED = "#bdbdbd"
REFERENCE = "#777777"
STANCE = "#e9edf2"
PEOPLE, PEOPLE_LINE = "#d9d9d9", "#808080"
"""Band and mean of human gait."""

TITLE_SIZE, LABEL_SIZE, TICK_SIZE = 9.5, 9.0, 8.0


def new_figure(title: str, height: float = 2.7, rows: int = 1, columns: int = 1, **subplots: Any) -> Figure:
    """A figure of column width and a height in inches, with rows x columns empty axes.

    Further arguments, such as sharex, are those of `Figure.subplots`.
    """
    figure = Figure(figsize=(COLUMN_WIDTH, height), layout="constrained")
    figure.suptitle(title, x=0.01, ha="left", fontsize=TITLE_SIZE)
    for axes in np.ravel(figure.subplots(rows, columns, **subplots)):
        axes.tick_params(labelsize=TICK_SIZE)
        axes.grid(True, color="#dddddd", linewidth=0.5)
        axes.set_axisbelow(True)
        axes.margins(x=0.0)
        axes.spines[["top", "right"]].set_visible(False)
    return figure


def label(axes: Axes, x: str, y: str) -> None:
    """Label both axes; an empty text is no label."""
    axes.set_xlabel(x, fontsize=LABEL_SIZE)
    axes.set_ylabel(y, fontsize=LABEL_SIZE)


def legend(axes: Axes, handles: Sequence[Any] | None = None) -> None:
    """Add a legend in one line above the axes, where it hides no curve."""
    entries = list(handles) if handles is not None else axes.get_legend_handles_labels()[0]
    style: dict[str, Any] = {"frameon": False, "fontsize": TICK_SIZE, "handlelength": 1.6, "columnspacing": 1.4}
    axes.legend(handles=entries, loc="lower left", bbox_to_anchor=(-0.01, 0.98), ncols=len(entries), **style)


def curve(axes: Axes, x: Array, y: Array, **style: Any) -> Line2D:
    """A line through samples."""
    (line,) = axes.plot(x, y, **{"linewidth": 1.2} | style)
    return line


def level(axes: Axes, y: float, text: str | None = None) -> None:
    """Add a dashed horizontal line with a label, or without text a thin solid line, as at zero."""
    style, width = ("--", 0.9) if text else ("-", 0.5)
    axes.axhline(y, color=REFERENCE, linestyle=style, linewidth=width, label=text)


def shade(axes: Axes, x: Array, where: Mask, text: str) -> None:
    """Gray bands over the stretches of x where `where` holds."""
    axes.fill_between(
        x, 0.0, 1.0, where=where.tolist(), transform=axes.get_xaxis_transform(), color=STANCE, linewidth=0, label=text
    )


def true_proportions(figure: Figure) -> None:
    """Set equal scales for x and y in a figure of one axes."""
    figure.axes[0].set_aspect("equal")
    figure.set_layout_engine("compressed")


def require_format(option: str, form: str) -> None:
    """Raise ParameterError for an unknown format of figures, which an option names."""
    if form not in FORMATS:
        raise ParameterError(f"{option} {form}: unknown; allowed: {', '.join(FORMATS)}; choose one of them")


def save(figure: Figure, path: Path, dpi: float = DPI) -> Path:
    """Write a figure in the format of the suffix, whole or not at all, without the date; returns the path.

    Raises:
        ParameterError: the file cannot be written.
    """
    write_whole(path, lambda beside: _draw(figure, beside, path.suffix.removeprefix("."), path.stem, dpi))
    return path


def svg_data(figure: Figure, name: str) -> str:
    """A figure as a data URL for a self-contained page; `name` makes the text reproducible."""
    drawn = io.BytesIO()
    _draw(figure, drawn, "svg", name, DPI)
    return f"data:image/svg+xml;base64,{base64.b64encode(drawn.getvalue()).decode()}"


def _draw(figure: Figure, target: Path | io.BytesIO, form: str, salt: str, dpi: float) -> None:
    # Names of runs, factors and variants are texts of others: no formula may be read into a pair of dollar signs.
    for text in figure.findobj(Text):
        text.set_parse_math(False)
    no_date = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(form, {})
    # A fixed salt instead of a random one makes the SVG reproducible.
    with rc_context({"svg.hashsalt": salt, "text.parse_math": False}):
        figure.savefig(target, format=form, dpi=dpi, metadata=no_date)
