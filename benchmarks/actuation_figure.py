"""The figure of the study `actuations`: tracking errors of the joints, for each actuation."""

import numpy as np
from matplotlib.figure import Figure

from humanwalk.body.anatomy import human
from humanwalk.body.limbs import group_of
from humanwalk.study.results import Results
from humanwalk.view.plots.drawing import DESIRED, SIDE, label, legend, new_figure

COLORS = {"pd": DESIRED, "pid": SIDE["Left"], "adaptive": SIDE["Right"]}


def tracking_by_group(results: Results) -> Figure:
    """Tracking error of each group of joints, for each actuation."""
    groups: dict[str, list[str]] = {}
    for joint in human().joints:
        groups.setdefault(group_of(joint.name), []).append(joint.name)
    figure = new_figure("Tracking error in the thesis' walk, rms over the joints of a group", 2.9)
    (axes,) = figure.axes
    width = 0.8 / results.table.num_rows
    for i, row in enumerate(results.table.to_pylist()):
        errors = [[row[f"tracking_error_rad.{joint}"] for joint in joints] for joints in groups.values()]
        rms = [np.degrees(np.sqrt(np.mean(np.square(each)))) for each in errors]
        axes.bar(
            np.arange(len(groups)) + (i - 1) * width, rms, width, color=COLORS[row["actuation"]], label=row["actuation"]
        )
    axes.set_xticks(range(len(groups)), [name.replace(" ", "\n") for name in groups])
    axes.grid(False, axis="x")
    axes.margins(x=0.02)
    label(axes, "", "error [deg]")
    legend(axes)
    return figure
