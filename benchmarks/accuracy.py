"""Accuracy against cost: the thesis' walk and the balanced walk with every step, contact approximation and integrator.

    python benchmarks/accuracy.py            # measures, half an hour; writes benchmarks/results/accuracy.json
    python benchmarks/accuracy.py --draw     # draws docs/images/accuracy.svg of what is written there

Every variant is compared with a reference of its own contact model at a step of 0.125 ms. The forces of a stiff contact
at one instant say little: a heel strike that comes a millisecond later is another force at every instant of it, and
the same impulse. So ground forces are compared as impulses over windows of 20 ms, divided by 20 ms. Impulses of the
discrete plant are exact: a step's force times the step. Small changes of a balanced walk grow; so it is compared
until the end of its first stride only, and after that by speed and step time.
"""

import argparse
import json
import logging
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.ticker import LogLocator, NullLocator
from pydrake.systems.framework import EventStatus

from humanwalk.bench.cost import TimedWalk, in_turns
from humanwalk.bench.result import machine
from humanwalk.body.joint_map import JointMap
from humanwalk.files import write_text
from humanwalk.measures.ends import COMPLETED
from humanwalk.measures.events import foot_events
from humanwalk.quantity import ParameterError
from humanwalk.run.monitor import Monitor
from humanwalk.run.simulate import prepare
from humanwalk.scenario import load_scenario
from humanwalk.view.plots.drawing import TICK_SIZE, label, new_figure, save

Array = npt.NDArray[np.float64]

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results" / "accuracy.json"
PICTURE = ROOT / "docs" / "images" / "accuracy.svg"

REFERENCE_STEP = 0.000125
WINDOW = 0.02
"""Over which ground forces are averaged [s]."""
GRID = 0.01
"""Between two instants at which angles and center of mass are compared [s]."""

SIMULATED = {"thesis": 2.2, "walk": 5.0}
"""Simulated time [s]: three strides of the thesis' walk; of the balanced one, the start and four steps."""
COMPARED = {"thesis": 2.2, "walk": 3.0}
"""Time over which a walk is compared with its reference [s]."""
GAIT_FROM = {"thesis": 0.7, "walk": 3.0}
"""Time from which speed and step time are taken [s]."""
TIMED = {"thesis": 1.2, "walk": 2.4}
"""Time over which the cost is measured [s]."""

STEPS = {
    ("thesis", "point", "lagged"): (0.25, 0.5, 1.0, 2.0, 3.0, 5.0),
    ("thesis", "point", "similar"): (0.5, 1.0, 2.0),
    ("thesis", "point", "sap"): (0.5, 1.0, 2.0),
    ("thesis", "hydroelastic", "lagged"): (0.5, 1.0, 2.0),
    ("thesis", "point", "cenic"): (1e-1, 1e-2, 1e-3, 1e-4),
    ("walk", "point", "lagged"): (0.25, 0.5, 1.0, 2.0, 4.0, 5.0),
    ("walk", "point", "similar"): (0.5, 1.0, 2.0, 4.0, 5.0),
    ("walk", "point", "sap"): (0.5, 1.0, 2.0, 4.0, 5.0),
    ("walk", "hydroelastic", "lagged"): (0.5, 1.0, 2.0, 4.0),
}
"""Steps [ms], or accuracies asked of CENIC, by scenario, contact and method."""
FAMILY = {"lagged": "lagged", "similar": "lagged", "sap": "sap", "cenic": "lagged"}
"""Whose reference each is compared with: lagged and similar approximate one model, sap's damping is another's."""


@dataclass(frozen=True)
class Variant:
    """One way to advance a scenario."""

    scenario: str
    contact: str
    method: str
    setting: float
    """Step [ms], or the accuracy asked of CENIC."""

    @property
    def overrides(self) -> dict[str, str]:
        if self.method == "cenic":
            integration = {"integrator": "cenic", "time_step": "0", "accuracy": repr(self.setting)}
        else:
            integration = {"time_step": repr(1e-3 * self.setting), "contact_approximation": self.method}
        return {"contact": self.contact} | {f"simulation.{name}": value for name, value in integration.items()}

    @property
    def reference(self) -> "Variant":
        return Variant(self.scenario, self.contact, FAMILY[self.method], 1e3 * REFERENCE_STEP)


@dataclass(frozen=True)
class Motion:
    """What came out of a variant."""

    force: Array
    """Mean ground force on each foot in every window that is compared, in W [N], shape (windows, 2, 3)."""
    angle: Array
    """Joint angles on the grid [rad], shape (instants, 42)."""
    com: Array
    """p_WC on the grid [m], shape (instants, 3)."""
    gait: dict[str, Any]
    """How the simulation ended, speed, step time and the greatest vertical force of a foot at an instant."""


def motion(variant: Variant, duration: float) -> Motion:
    """Simulate without recording and keep force, angles and center of mass of every step that is taken."""
    scenario = load_scenario(variant.scenario, variant.overrides)
    prepared = prepare(scenario, record=False)
    walker, plant = prepared.walker, prepared.plant
    assert plant is not None
    joints, monitor = JointMap.of(plant), Monitor(plant, scenario.terrain)
    ports = [walker.GetOutputPort(name) for name in ("foot_forces", "state", "com")]
    kept: list[tuple[float, Array, Array, Array]] = []

    def keep(root_context: Any) -> EventStatus:
        context = walker.GetMyContextFromRoot(root_context)
        forces, state, com = (port.Eval(context) for port in ports)
        kept.append((root_context.get_time(), np.r_[forces[:3], forces[8:11]], joints.positions(state), com[:3]))
        return monitor(root_context)

    prepared.simulator.set_monitor(keep)
    prepared.simulator.Initialize()
    prepared.simulator.AdvanceTo(duration)
    time, force, angle, com = (np.array(column) for column in zip(*kept, strict=True))
    # Of a discrete plant the force seen at an instant is that of the step that ends there.
    held = force[1:] if plant.time_step() > 0 else 0.5 * (force[1:] + force[:-1])
    impulse = np.vstack((np.zeros(6), np.cumsum(held * np.diff(time)[:, None], axis=0)))

    def at(instants: Array, values: Array) -> Array:
        return np.column_stack([np.interp(instants, time, column) for column in values.T])

    compared = COMPARED[variant.scenario] + 1e-9
    windows = np.diff(at(np.arange(0.0, compared, WINDOW), impulse), axis=0) / WINDOW
    grid = np.arange(0.0, compared, GRID)
    gait = {"end": monitor.reason or COMPLETED} | gait_of(time, force, com, GAIT_FROM[variant.scenario])
    return Motion(windows.reshape(-1, 2, 3), at(grid, angle), at(grid, com), gait)


def gait_of(time: Array, force: Array, com: Array, begin: float) -> dict[str, float | None]:
    """Speed, mean time between two touchdowns, and greatest vertical force, from `begin` [s] on."""
    steady = time >= begin
    steps = np.diff(np.sort(np.concatenate([foot_events(time, force[:, i], steady).touchdown_times for i in (2, 5)])))
    return {
        "speed_m_s": float(np.polyfit(time[steady], com[steady, 0], 1)[0]) if steady.sum() > 10 else None,
        "step_time_s": float(steps.mean()) if steps.size else None,
        "peak_force_N": float(force[:, (2, 5)].max()),
    }


def errors(found: Motion, reference: Motion) -> dict[str, float]:
    """Root mean squares over time of what a motion differs by: forces as vectors, angles over the joints, too."""

    def rms(difference: Array) -> float:
        return float(np.sqrt((difference**2).sum(axis=-1).mean()))

    joints = found.angle.shape[1]
    return {
        "force_rms_N": rms(found.force - reference.force),
        "angle_rms_rad": rms(found.angle - reference.angle) / joints**0.5,
        "com_rms_m": rms(found.com - reference.com),
    }


def measure(todo: list[Variant], say: Callable[[str], None]) -> list[dict[str, Any]]:
    """Error, gait and cost of every variant; one that is refused has the reason instead.

    The reference of the other contact model is a row, too, compared with the first: the difference of the models.
    """
    references: dict[Variant, Motion] = {}
    rows = []
    for variant in todo:
        row: dict[str, Any] = asdict(variant)
        rows.append(row)
        try:
            found = motion(variant, SIMULATED[variant.scenario])
        except (ParameterError, RuntimeError) as error:
            row["refused"] = str(error)
            continue
        reference = variant.reference
        if reference not in references:
            references[reference] = motion(reference, COMPARED[reference.scenario])
        row |= errors(found, references[reference]) | found.gait
        say(f"{row}")
    for scenario in TIMED:
        add_cost([row for row in rows if row["scenario"] == scenario and "refused" not in row])
    for variant, found in references.items():
        lagged = replace(variant, contact="point", method="lagged")
        rows.append(asdict(variant) | errors(found, references[lagged]) | {"reference": True})
    return rows


def add_cost(rows: list[dict[str, Any]]) -> None:
    """Let all variants of a scenario walk by turns, as shipped and recorded, and add what that takes to the rows."""
    variants = [Variant(*(row[field.name] for field in fields(Variant))) for row in rows]
    walks = [TimedWalk(load_scenario(variant.scenario, variant.overrides)) for variant in variants]
    costs = in_turns({str(i): walk.advance for i, walk in enumerate(walks)}, TIMED[rows[0]["scenario"]])
    for row, walk, turns in zip(rows, walks, costs.values(), strict=True):
        row["cpu_s_per_s"] = sum(cost.cpu for cost in turns) / walk.time
        row["wall_s_per_s"] = sum(cost.wall for cost in turns) / walk.time


def draw(rows: list[dict[str, Any]]) -> None:
    """Error of the ground force over the cost, by method; every point has its step or accuracy."""
    figure = new_figure("Error of the ground force (20 ms means) over the cost of the walk", 4.0, columns=2)
    series = [(method, "point") for method in FAMILY] + [("lagged", "hydroelastic")]
    colors = ("#1b7837", "#762a83", "#c2620e", "#404040", "#2166ac")
    for axes, scenario in zip(figure.axes, TIMED, strict=True):
        measured = [row for row in rows if row["scenario"] == scenario and "cpu_s_per_s" in row]
        base = next(r for r in measured if (r["method"], r["contact"], r["setting"]) == ("lagged", "point", 1.0))
        for (method, contact), color in zip(series, colors, strict=True):
            line = [row for row in measured if (row["method"], row["contact"]) == (method, contact)]
            x, y = [r["cpu_s_per_s"] / base["cpu_s_per_s"] for r in line], [r["force_rms_N"] for r in line]
            axes.plot(x, y, "o-", color=color, markersize=3, linewidth=1.0, label=f"{contact}, {method}")
            for row, place in zip(line, zip(x, y, strict=True), strict=True):
                axes.annotate(f"{row['setting']:g}", place, fontsize=5.5, xytext=(3, 2), textcoords="offset points")
        axes.set(xscale="log", yscale="log")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_locator(NullLocator())
        axes.margins(x=0.08)
        label(axes, f"{scenario}: cost (point, lagged, 1 ms = 1)", "N")
    handles = figure.axes[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower left", ncols=3, frameon=False, fontsize=TICK_SIZE)
    save(figure, PICTURE)


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draw", action="store_true", help="measure nothing")
    if not parser.parse_args().draw:
        todo = [Variant(*which, setting) for which, settings in STEPS.items() for setting in settings]
        rows = measure(todo, lambda line: print(line, flush=True))
        write_text(RESULTS, json.dumps({"machine": machine(), "rows": rows}, indent=1) + "\n")
    draw(json.loads(RESULTS.read_text(encoding="utf-8"))["rows"])


if __name__ == "__main__":
    main()
