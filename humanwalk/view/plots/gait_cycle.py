"""Joint angles and powers of the legs over a gait cycle, from touchdown to touchdown, with those of human gait."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import SIDES, Side
from humanwalk.measures.events import events_of
from humanwalk.measures.human_likeness import ANGLES, CYCLE, JOINTS, joint_signal, over_strides, people
from humanwalk.numerics import Array
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import (
    LABEL_SIZE,
    PEOPLE,
    PEOPLE_LINE,
    SIDE,
    TICK_SIZE,
    curve,
    label,
    level,
    new_figure,
)


def gait_cycle_angles(run: Run) -> Figure | None:
    """Hip, knee and ankle over the gait cycle [deg]: the run's strides over human gait; None without a stride.

    Lines are means, bands one standard deviation to both sides.
    """
    return _over_people(run, "Hip, knee and ankle", ("hip", "knee", "ankle"))


def gait_cycle_pelvis(run: Run) -> Figure | None:
    """Tilt, obliquity and rotation of the pelvis over the gait cycle [deg], drawn as `gait_cycle_angles` are."""
    return _over_people(run, "Pelvis", ("pelvis tilt", "pelvis obliquity", "pelvis rotation"))


def _over_people(run: Run, what: str, names: Sequence[str]) -> Figure | None:
    figure = _three(f"{what} over the gait cycle; bands: mean ± 1 standard deviation")
    for axes, name in zip(figure.axes, names, strict=True):
        angle = ANGLES[name]
        cycle, mean, sd = people(angle.people)
        axes.fill_between(cycle, mean - sd, mean + sd, color=PEOPLE, linewidth=0, label="human, free speed")
        curve(axes, cycle, mean, color=PEOPLE_LINE, linewidth=0.9, linestyle="--")
        level(axes, 0.0)
        for side in SIDES:
            if not _mean_and_band(axes, run, side, angle.of(run.signals, side)):
                return None
        _finish(axes, f"{name} angle [deg]\n{angle.positive} positive", name)
    _legend(figure)
    return figure


def joint_power(run: Run) -> Figure | None:
    """Power of hip, knee and ankle per body mass over the gait cycle [W/kg]; None without a stride.

    Power is torque times rate of the sagittal joint: positive where the actuator drives, negative where it brakes.
    """
    mass = run.scenario.subject.mass
    figure = _three("Power of hip, knee and ankle over the gait cycle; bands: ± 1 standard deviation")
    for axes, name in zip(figure.axes, JOINTS, strict=True):
        level(axes, 0.0)
        for side in SIDES:
            torque, rate = (joint_signal(run.signals, name, side, what) for what in ("torque_N_m", "velocity_rad_s"))
            if not _mean_and_band(axes, run, side, torque * rate / mass):
                return None
        _finish(axes, f"{name} power [W/kg]\ndriving positive", name)
    _legend(figure)
    return figure


def _three(title: str) -> Figure:
    return new_figure(title, height=2.7, columns=3, sharex=True)


def _mean_and_band(axes: Axes, run: Run, side: Side, values: Array) -> bool:
    """Draw a signal over the strides of a leg in steady walking; False if there is none."""
    strides = over_strides(
        events_of(run.signals, side, run.scenario.controller.steady_from(run.scenario.subject)), values
    )
    if not len(strides):
        return False
    mean, sd = strides.mean(axis=0), strides.std(axis=0)
    axes.fill_between(CYCLE, mean - sd, mean + sd, color=SIDE[side], alpha=0.2, linewidth=0)
    text = f"{side.lower()}, {len(strides)} stride{'s' if len(strides) > 1 else ''}"
    # The walk is nearly symmetric: the right curve is wide enough to be visible behind the left one.
    curve(axes, CYCLE, mean, color=SIDE[side], label=text, linewidth=2.2 if side == "Right" else 0.9)
    return True


def _finish(axes: Axes, y_label: str, name: str) -> None:
    axes.set_title(name, fontsize=LABEL_SIZE, pad=3)
    axes.set_xticks([0, 50, 100])
    label(axes, "gait cycle [%]", y_label)


def _legend(figure: Figure) -> None:
    handles, _ = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=TICK_SIZE)
