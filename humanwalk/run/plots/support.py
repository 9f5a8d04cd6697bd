"""What the assumed balance adds from outside: its force and torque on the pelvis over time."""

from matplotlib.figure import Figure

from humanwalk.run.folder import Run
from humanwalk.run.measures import GRAVITY
from humanwalk.run.plots.drawing import AXIS_COLORS, REFERENCE, curve, label, legend, new_figure
from humanwalk.run.signals import TIME

DIRECTIONS = {"x": "forward x", "y": "left y", "z": "up z"}


def support_force(run: Run) -> Figure | None:
    """Force of the support on the pelvis in the world [N]; None for a run without support."""
    weight = run.scenario.subject.mass * GRAVITY
    rms = run.summary["support_force_rms_N"]
    steady = "" if rms is None else f", rms {rms:.0f} N, {100 * rms / weight:.0f} % of the weight"
    return _wrench(run, "force", "N", f"External support force on the pelvis (assumed balance){steady}")


def support_torque(run: Run) -> Figure | None:
    """Torque of the support on the pelvis in the world [N m]; None for a run without support."""
    rms = run.summary["support_torque_rms_N_m"]
    steady = "" if rms is None else f", rms {rms:.0f} N m"
    return _wrench(run, "torque", "N_m", f"External support torque on the pelvis (assumed balance){steady}")


def _wrench(run: Run, quantity: str, unit: str, title: str) -> Figure | None:
    columns = {axis: f"support.{quantity}_{axis}_{unit}" for axis in "xyz"}
    recorded = set(columns.values()) <= set(run.signals.column_names)
    time = run.signals[TIME].to_numpy()
    if not (run.summary["external_support"] and recorded and time.size >= 2):
        return None
    figure = new_figure(title, height=4.4, rows=3, sharex=True)
    for axes, (axis, column) in zip(figure.axes, columns.items(), strict=True):
        axes.axhline(0.0, color=REFERENCE, linewidth=0.5)
        curve(
            axes, time, run.signals[column].to_numpy(), color=AXIS_COLORS[axis], label=DIRECTIONS[axis], linewidth=0.8
        )
        label(axes, "", f"{DIRECTIONS[axis]} [{unit.replace('_', ' ')}]")
    label(figure.axes[-1], "time [s]", figure.axes[-1].get_ylabel())
    return figure
