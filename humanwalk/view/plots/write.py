"""Draws plots of a run, and writes them into its folder."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from humanwalk.files import make_folder, require_replaceable
from humanwalk.quantity import ParameterError, require_kind
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import require_format, save
from humanwalk.view.plots.gait_cycle import (
    gait_cycle_angles,
    gait_cycle_hip_and_foot,
    gait_cycle_moments,
    gait_cycle_pelvis,
    gait_cycle_powers,
)
from humanwalk.view.plots.ground import center_of_pressure, ground_reaction, support
from humanwalk.view.plots.joints import joint_torques, tracking_error
from humanwalk.view.plots.soles import cop_under_soles
from humanwalk.view.plots.thesis_figures import THESIS_PLOTS

PLOTS: dict[str, Callable[[Run], Figure | None]] = THESIS_PLOTS | {
    "support_force": partial(support, what="force"),
    "support_torque": partial(support, what="torque"),
    "gait_cycle_angles": gait_cycle_angles,
    "gait_cycle_pelvis": gait_cycle_pelvis,
    "gait_cycle_hip_and_foot": gait_cycle_hip_and_foot,
    "gait_cycle_moments": gait_cycle_moments,
    "gait_cycle_powers": gait_cycle_powers,
    "ground_reaction": ground_reaction,
    "center_of_pressure": center_of_pressure,
    "cop_under_soles": cop_under_soles,
    "joint_torques": joint_torques,
    "tracking_error": tracking_error,
}
"""Plots by name, which is also the file name; a function returns None if the run has no data for it."""


def plot(run: Run, name: str) -> Figure:
    """Draw a plot of a run by its name, one of `PLOTS`, as a matplotlib figure; a notebook shows it.

    Raises:
        ParameterError: no such plot, a run that has nothing to draw for it, or a run without physics.
    """
    require_kind(run, Run, "plot", 'Run.open("runs/thesis"), ...')
    run.require_physics()
    figure = PLOTS[name](run) if name in PLOTS else None
    if figure is None:
        allowed = ", ".join(PLOTS)
        raise ParameterError(f"{name}: no such plot, or nothing to draw; allowed: {allowed}; choose another")
    return figure


def write_plots(run: Run, only: Sequence[str] | None = None, format: str = "png") -> list[Path]:
    """Write plots of a run into `run.plots`, each file whole or not at all.

    Args:
        run: What is plotted.
        only: Names of plots, or their beginnings: "figure_5" is all of chapter 5. None or empty: every plot.
        format: One of `drawing.FORMATS`.

    Returns:
        The files; a plot for which the run has no data (no support, no stride yet) is omitted.

    Raises:
        ParameterError: An unknown name or format, a run without physics, or a file that cannot be written.
    """
    require_format("--format", format)
    names = select(only or ())
    run.require_physics()
    make_folder(run.plots)
    paths = {name: run.plots / f"{name}.{format}" for name in names}
    for path in paths.values():
        require_replaceable(path)
    figures = ((path, PLOTS[name](run)) for name, path in paths.items())
    return [save(figure, path) for path, figure in figures if figure is not None]


def select(only: Sequence[str]) -> list[str]:
    """Names of the plots that are, or begin with, one of `only`, in the order of `PLOTS`; all of them for none.

    Raises:
        ParameterError: one of `only` fits no plot.
    """
    for wanted in only:
        if not wanted or not any(name.startswith(wanted) for name in PLOTS):
            raise ParameterError(
                f"--only {wanted}: no such plot; allowed: {', '.join(PLOTS)}; give a name or its beginning"
            )
    return [name for name in PLOTS if not only or name.startswith(tuple(only))]
