"""Draws the figures of shipped studies for the book: python docs/study_figures.py [STUDY ...].

The studies are read from runs/studies; `humanwalk study actuations -o runs/studies/actuations` simulates one.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure

from humanwalk.body.anatomy import human
from humanwalk.body.limbs import group_of
from humanwalk.files import make_folder
from humanwalk.study.table import read_table
from humanwalk.view.plots.drawing import AXIS_COLORS, DESIRED, SIDE, curve, label, legend, new_figure, save

STUDIES, IMAGES = Path("runs/studies"), Path(__file__).parent / "images" / "studies"

FIGURE_DPI = 120

COLORS = {"pd": DESIRED, "pid": SIDE["Left"], "adaptive": SIDE["Right"]}


def actuations(table: pa.Table) -> Figure:
    """Tracking error of each group of joints for each actuation."""
    groups: dict[str, list[str]] = {}
    for joint in human().joints:
        groups.setdefault(group_of(joint.name), []).append(joint.name)
    figure = new_figure("Tracking error in the thesis' walk, rms over the joints of a group", 2.9)
    (axes,) = figure.axes
    width = 0.8 / table.num_rows
    for i, row in enumerate(table.to_pylist()):
        errors = [[row[f"tracking_error_rad.{joint}"] for joint in joints] for joints in groups.values()]
        rms = [np.degrees(np.sqrt(np.mean(np.square(each)))) for each in errors]
        name = row["actuation"]
        axes.bar(np.arange(len(groups)) + (i - 1) * width, rms, width, color=COLORS[name], label=name)
    axes.set_xticks(range(len(groups)), [name.replace(" ", "\n") for name in groups])
    axes.grid(False, axis="x")
    axes.margins(x=0.02)
    label(axes, "", "error [deg]")
    legend(axes)
    return figure


def thesis_step_height(table: pa.Table) -> Figure:
    """Force and torque of the support over the step height."""
    height = 100.0 * table["controller.thesis.gait.path.step_height"].to_numpy()
    figure = new_figure("External support of the thesis' walk at 1.4 m/s, rms of the steady walk", 2.9, 1, 2)
    for axes, column, unit in zip(
        figure.axes, ("support_force_rms_N", "support_torque_rms_N_m"), ("force [N]", "torque [N m]"), strict=True
    ):
        curve(axes, height, table[column].to_numpy(), color=AXIS_COLORS["z"], marker="o", markersize=3.5)
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.05)
        label(axes, "step height [cm]", unit)
    return figure


FIGURES: dict[str, Callable[[pa.Table], Figure]] = {"actuations": actuations, "thesis_step_height": thesis_step_height}


def main(*names: str) -> None:
    """Draw the figures of the named studies, or of all."""
    make_folder(IMAGES)
    for name in names or FIGURES:
        print(save(FIGURES[name](read_table(STUDIES / name)), IMAGES / f"{name}.png", FIGURE_DPI))


if __name__ == "__main__":
    main(*sys.argv[1:])
