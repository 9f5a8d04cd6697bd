"""Plots of a run, under the thesis' figure numbers where it has them, and the thesis' figures of the foot paths."""

from humanwalk.run.plots.gait_figures import write_gait_figures
from humanwalk.run.plots.write import PLOTS, write_plots

__all__ = ["PLOTS", "write_gait_figures", "write_plots"]
