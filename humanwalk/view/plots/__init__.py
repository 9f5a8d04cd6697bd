"""Plots of a run, under the thesis' figure numbers where it has them, and the thesis' figures of the foot paths."""

from humanwalk.view.plots.gait_figures import write_gait_figures
from humanwalk.view.plots.write import PLOTS, plot, write_plots

__all__ = ["PLOTS", "plot", "write_gait_figures", "write_plots"]
