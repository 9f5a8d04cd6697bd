"""Angles, moments and powers of the legs over the gait cycle, over those of people at the same dimensionless speed."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from humanwalk.body import SIDES, Side
from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import ANGLES, CURVES, JOINTS
from humanwalk.measures.walk_measures import Walk
from humanwalk.run.folder import Run
from humanwalk.view.plots.drawing import (
    LABEL_SIZE,
    PEOPLE,
    PEOPLE_LINE,
    SIDE,
    TICK_SIZE,
    WIDTH,
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


def gait_cycle_hip_and_foot(run: Run) -> Figure | None:
    """Hip adduction and rotation, foot progression over the gait cycle [deg], drawn as `gait_cycle_angles` are."""
    return _over_people(run, "Hip and foot, other planes", ("hip adduction", "hip rotation", "foot progression"))


def gait_cycle_moments(run: Run) -> Figure | None:
    """Internal moments of hip, knee and ankle per body mass [N m/kg], drawn as `gait_cycle_angles` are."""
    return _over_people(run, "Internal moments", [f"{joint} moment" for joint in JOINTS])


def gait_cycle_powers(run: Run) -> Figure | None:
    """Powers of hip, knee and ankle per body mass [W/kg], drawn as `gait_cycle_angles` are.

    Power is torque times rate of the sagittal joint: positive where the actuator drives, negative where it brakes.
    """
    return _over_people(run, "Powers", [f"{joint} power" for joint in JOINTS])


def _over_people(run: Run, what: str, names: Sequence[str]) -> Figure | None:
    walk = Walk.of(run.signals, run.scenario)
    if not all(foot.strides for foot in walk.feet.values()):
        return None
    title = f"{what} over the gait cycle; bands: mean ± 1 standard deviation"
    figure = new_figure(title, height=2.7, columns=3, sharex=True)
    for axes, name in zip(figure.axes, names, strict=True):
        shown = CURVES[name]
        band = shown.people(walk.pace.group, walk.pace.leg)
        text = f"human, {walk.pace.group} speed"
        axes.fill_between(CYCLE, band.mean - band.sd, band.mean + band.sd, color=PEOPLE, linewidth=0, label=text)
        curve(axes, CYCLE, band.mean, color=PEOPLE_LINE, linewidth=0.9, linestyle="--")
        level(axes, 0.0)
        for side in SIDES:
            _mean_and_band(axes, walk, side, name)
        axes.set_title(name, fontsize=LABEL_SIZE, pad=3)
        axes.set_xticks([0, 50, 100])
        kind = "angle " if name in ANGLES else ""
        label(axes, "gait cycle [%]", f"{name} {kind}[{shown.unit}]\n{shown.positive} positive")
    handles, _ = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=TICK_SIZE)
    return figure


def _mean_and_band(axes: Axes, walk: Walk, side: Side, name: str) -> None:
    """Draw one of CURVES over the strides of a leg."""
    strides = walk.strides_of(name, side)
    mean, sd = strides.mean(axis=0), strides.std(axis=0)
    axes.fill_between(CYCLE, mean - sd, mean + sd, color=SIDE[side], alpha=0.2, linewidth=0)
    text = f"{side.lower()}, {len(strides)} stride{'s' if len(strides) > 1 else ''}"
    curve(axes, CYCLE, mean, color=SIDE[side], label=text, linewidth=WIDTH[side])
