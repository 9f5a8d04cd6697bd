"""Force and torque of the external support (the assumed balance) on the pelvis over time."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from humanwalk.measures.signals import TIME
from humanwalk.quantity import GRAVITY
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import AXIS_COLORS, curve, label, level, new_figure

TITLE = "External support (the assumed balance): {what} on the pelvis"


def support_force(run: Run) -> Figure | None:
    """Force of the support on the pelvis in the world [N]; None for a run without support."""
    weight = run.scenario.subject.mass * GRAVITY
    rms = run.summary["support_force_rms_N"]
    steady = "" if rms is None else f"\nrms {rms:.0f} N in steady walking, {100 * rms / weight:.0f} % of body weight"
    labels = {"x": "forward x [N]", "y": "left y [N]", "z": "up z [N]"}
    columns = {axis: f"support.force_{axis}_N" for axis in "xyz"}
    return _components(run, TITLE.format(what="force") + steady, labels, columns)


def support_torque(run: Run) -> Figure | None:
    """Torque of the support on the pelvis in the world [N m]; None for a run without support."""
    rms = run.summary["support_torque_rms_N_m"]
    steady = "" if rms is None else f"\nrms {rms:.0f} N m in steady walking"
    labels = {"x": "roll x [N m]", "y": "pitch y [N m]", "z": "yaw z [N m]"}
    columns = {axis: f"support.torque_{axis}_N_m" for axis in "xyz"}
    return _components(run, TITLE.format(what="torque") + steady, labels, columns)


def _components(run: Run, title: str, labels: Mapping[str, str], columns: Mapping[str, str]) -> Figure | None:
    recorded = set(columns.values()) <= set(run.signals.column_names)
    time = run.signals[TIME].to_numpy()
    if not (run.summary["external_support"] and recorded and time.size >= 2):
        return None
    figure = new_figure(title, height=4.4, rows=3, sharex=True)
    for axes, axis in zip(figure.axes, "xyz", strict=True):
        level(axes, 0.0)
        curve(axes, time, run.signals[columns[axis]].to_numpy(), color=AXIS_COLORS[axis], linewidth=0.8)
        label(axes, "time [s]" if axis == "z" else "", labels[axis])
    figure.align_ylabels()
    return figure
