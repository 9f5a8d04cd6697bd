"""Three grounds under the same walks: what the contact models make of them, and what they cost.

    python benchmarks/contact.py evaluation    # time of one evaluation of the asperity law and of its step, both feet
    python benchmarks/contact.py compare       # thesis and balanced walk on all; JSON and plots of docs/contact.md

`compare` keeps every run under runs/contact and takes those that are there already; `--fresh` simulates all again.
"""

import argparse
import copy
import json
import logging
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pyarrow.parquet as pq
from pydrake.systems.analysis import Simulator

from humanwalk.body import SIDES, sole_patches
from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.contact.asperity import AsperityParameters, friction_bound, friction_force, normal_force
from humanwalk.contact.contact_step import Contacts, ContactStep
from humanwalk.diagrams.walker import make_diagram
from humanwalk.measures.ends import COMPLETED
from humanwalk.measures.events import CONTACT_ON_N, events_of
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.sides import Side
from humanwalk.systems import asperity_contact
from humanwalk.systems.signal import state_columns
from humanwalk.view.plots.drawing import curve, label, legend, level, new_figure, save

ROOT = Path(__file__).parent.parent
RUNS = ROOT / "runs" / "contact"
RESULTS = ROOT / "benchmarks" / "results" / "contact.json"
IMAGES = ROOT / "docs" / "images" / "contact"

MODELS = ("point", "hydroelastic", "asperity")
WALKS = ("thesis", "walk")
COLORS = dict(zip(MODELS, ("#4477aa", "#228833", "#cc3311"), strict=True))
LAST = 1.3
"""Stretch that is plotted [s]."""
SWING = 0.2
"""A foot that was longer off the ground has swung [s]: toes may touch as they leave, the heel twice as it lands."""
LONGEST_EVALUATION = 1500
"""Steps of the walk whose states are evaluated."""
STEP = {"simulation.time_step": "0.001"}
"""The longest that is accepted on asperity contact."""
REPEATS = 30


def spent(call: Callable[..., Any], *inputs: Any) -> float:
    """Processor time [us]: other work on the machine counts less."""
    began = time.thread_time()
    call(*inputs)
    return 1e6 * (time.thread_time() - began)


def evaluation() -> dict[str, Any]:
    """On the states of the thesis' walk, both feet: the law alone, the implicit step, and the system in its place.

    Law and step are repeated on the states of every fifth step of the walk, and the least of a state's times is what
    it takes undisturbed. The system's time is that of its forces for the next step: kinematics of the feet, step, and
    what Drake wants of it.
    """
    steps = []

    class Recorded(ContactStep):
        def __call__(self, *inputs: Any) -> Contacts:
            # Copied: the memory is shown where the simulation goes on writing.
            steps.append((super().__call__, copy.deepcopy(inputs)))
            return super().__call__(*inputs)

    with patch.object(asperity_contact, "ContactStep", Recorded):
        walker = make_diagram(load_scenario("thesis", {"contact": "asperity"} | STEP))
    simulator = Simulator(walker)
    contact = walker.GetSubsystemByName("foot_contact")
    of_contact = contact.GetMyContextFromRoot(simulator.get_context())
    system = []
    for place in range(LONGEST_EVALUATION):
        simulator.AdvanceTo(1.0 + 1e-3 * place)
        system.append(spent(contact.GetOutputPort("spatial_forces").Eval, of_contact))
    steps = steps[-LONGEST_EVALUATION::5]

    def law(contacts: Contacts) -> None:
        """As often as the step needs it where one pass does."""
        f_t, f_n = contacts.f_S[:, :2], contacts.f_S[:, 2]
        f_n = normal_force(parameters, f_n, -f_n)
        bound = friction_bound(parameters, 0.7, f_n, contacts.memory.load, np.ones_like(f_n), 0.0)
        friction_force(parameters, f_t, f_t, bound)

    parameters = AsperityParameters()
    results = [call(*inputs) for call, inputs in steps]
    laws = [[spent(law, result) for result in results] for _ in range(REPEATS)]
    times = [[spent(call, *inputs) for call, inputs in steps] for _ in range(REPEATS)]
    return {
        "points": len(results[0].f_S),
        "states": len(steps),
        "law": percentiles(np.min(laws, axis=0)),
        "step": percentiles(np.min(times, axis=0)),
        "step_on_this_machine": percentiles(np.ravel(times)),
        "system_in_place": percentiles(system),
    }


def percentiles(times: Any) -> dict[str, float]:
    tenth, median, ninetieth = np.percentile(times, [10, 50, 90]).tolist()
    return {"tenth_us": tenth, "median_us": median, "ninetieth_us": ninetieth}


def signals_of(walk: str, model: str, fresh: bool) -> tuple[Scenario, Any, dict[str, Any]]:
    """Record and how it came about, simulated unless it is there."""
    scenario = load_scenario(walk, {"contact": model} | STEP)
    folder = RUNS / f"{walk}_{model}"
    if fresh or not (folder / "how.json").exists():
        folder.mkdir(parents=True, exist_ok=True)
        cpu = time.process_time()
        outcome = simulate(scenario)
        cpu = time.process_time() - cpu
        pq.write_table(outcome.signals, folder / "signals.parquet")
        simulated = outcome.signals[TIME][-1].as_py()
        how = {
            "end": outcome.end,
            "time_s": simulated,
            "realtime_factor_cpu": simulated / cpu,
            "realtime_factor": simulated / outcome.wall_time,
        }
        (folder / "how.json").write_text(json.dumps(how))
    return scenario, pq.read_table(folder / "signals.parquet"), json.loads((folder / "how.json").read_text())


def sole_motion(scenario: Scenario, signals: Any) -> dict[Side, tuple[Array, Array]]:
    """Of each foot, whatever the model: depth of its deepest point [m], mean speed of those below ground [m/s]."""
    plant = kinematics_plant(scenario.subject)
    context, world = plant.CreateDefaultContext(), plant.world_frame()
    states = matrix(signals, state_columns(JointMap.of(plant)))
    motion: dict[Side, tuple[Array, Array]] = {}
    for side in SIDES:
        patches = [(plant.GetBodyByName(p.body), p.p_BoQ_B.T) for p in sole_patches(scenario.subject.skeleton, side)]
        deepest, speed = np.zeros(len(states)), np.zeros(len(states))
        for row, state in enumerate(states):
            plant.SetPositionsAndVelocities(context, state)
            depth, speeds = [], []
            for body, points in patches:
                p_WQ = plant.CalcPointsPositions(context, body.body_frame(), points, world)
                V = plant.EvalBodySpatialVelocityInWorld(context, body)
                r = p_WQ - body.EvalPoseInWorld(context).translation()[:, None]
                v = V.translational()[:, None] + np.cross(V.rotational(), r, axisb=0, axisc=0)
                depth.append(-p_WQ[2])
                speeds.append(np.hypot(v[0], v[1]))
            below = np.concatenate(depth) > 0.0
            deepest[row] = np.concatenate(depth).max()
            speed[row] = np.concatenate(speeds)[below].mean() if below.any() else 0.0
        motion[side] = deepest, speed
    return motion


def measure(scenario: Scenario, signals: Any, how: dict[str, Any], motion: Any) -> dict[str, Any]:
    time_s = signals[TIME].to_numpy()
    steady = time_s >= scenario.controller.steady_from(scenario.subject)
    weight = scenario.subject.mass * GRAVITY

    def column(name: str) -> Array:
        values: Array = signals[name].to_numpy()[steady]
        return values

    vertical = np.sum([column(f"{side.lower()}_foot.force_z_N") for side in SIDES], axis=0)
    support = column("support.force_z_N") if "support.force_z_N" in signals.column_names else np.zeros(steady.sum())
    down = {side: events_of(signals, side).contact[steady] for side in SIDES}
    slips = {side: motion[side][1][steady] * down[side] for side in SIDES}
    steps = (
        sum((events_of(signals, side).touchdown_times >= time_s[steady][0]).sum() for side in SIDES)
        if steady.sum()
        else 0
    )
    loaded = {side: column(f"{side.lower()}_foot.force_z_N") >= CONTACT_ON_N for side in SIDES}
    use = np.concatenate([column(f"{side.lower()}_foot.friction_use")[loaded[side]] for side in SIDES])
    if how["end"] != COMPLETED or steady.sum() < 2 or not use.size:
        return how
    period = time_s[1] - time_s[0]
    depth = np.concatenate([motion[side][0][steady][down[side]] for side in SIDES])
    return how | {
        "mean_speed_m_s": float(np.polyfit(time_s[steady], column("com.x_m"), 1)[0]),
        "mean_vertical_force_weights": float(vertical.mean() / weight),
        "mean_with_support_weights": float((vertical + support).mean() / weight),
        "largest_vertical_force_weights": float(
            max(column(f"{side.lower()}_foot.force_z_N").max() for side in SIDES) / weight
        ),
        "friction_use_median": float(np.median(use)),
        "friction_use_95_percent": float(np.percentile(use, 95)),
        "slip_per_step_mm": float(1e3 * sum(slip.sum() for slip in slips.values()) * period / max(1, steps)),
        "penetration_median_mm": float(1e3 * np.median(depth)),
        "penetration_95_percent_mm": float(1e3 * np.percentile(depth, 95)),
    }


def compare(fresh: bool) -> dict[str, Any]:
    results: dict[str, Any] = {}
    for walk in WALKS:
        shown = {}
        for model in MODELS:
            scenario, signals, how = signals_of(walk, model, fresh)
            motion = sole_motion(scenario, signals)
            results.setdefault(walk, {})[model] = measure(scenario, signals, how, motion)
            print(walk, model, json.dumps(results[walk][model]), flush=True)
            if how["end"] == COMPLETED:
                shown[model] = (scenario, signals, motion)
        end = min(signals[TIME][-1].as_py() for _, signals, _ in shown.values())
        draw(walk, shown, end)
    return results


def plotted_from(walk: str, signals: Any, end: float) -> float:
    """The thesis' feet go by the clock; the balanced walker's strides differ, so they are shown from a landing on."""
    if walk == "thesis":
        return end - LAST
    down = signals[TIME].to_numpy()[events_of(signals, "Right").contact]
    landings = down[1:][np.diff(down) > SWING]
    return float(landings[landings <= end - LAST][-1])


def draw(walk: str, shown: dict[str, Any], end: float) -> None:
    forces = new_figure(f"{walk}: force of the ground on the right foot", height=5.2, rows=3, sharex=True)
    soles = new_figure(f"{walk}: the right foot on the ground", height=5.2, rows=3, sharex=True)
    for name, (_, signals, motion) in shown.items():
        time_s = signals[TIME].to_numpy() - plotted_from(walk, signals, end)
        rows = (time_s >= 0.0) & (time_s <= LAST)
        force = {axis: signals[f"right_foot.force_{axis}_N"].to_numpy()[rows] for axis in "xz"}
        on = force["z"] >= CONTACT_ON_N
        ahead = signals["right_foot.cop_x_m"].to_numpy()[rows] - signals["right_sole.x_m"].to_numpy()[rows]
        deepest, speed = (values[rows] for values in motion["Right"])
        style = {"color": COLORS[name], "label": name, "linewidth": 1.0}
        curve(forces.axes[0], time_s[rows], force["z"], **style)
        curve(forces.axes[1], time_s[rows], force["x"], **style)
        curve(
            forces.axes[2],
            time_s[rows],
            np.where(on, signals["right_foot.friction_use"].to_numpy()[rows], np.nan),
            **style,
        )
        curve(soles.axes[0], time_s[rows], np.where(on, 100 * ahead, np.nan), **style)
        curve(soles.axes[1], time_s[rows], np.where(on, 1e3 * speed, np.nan), **style)
        curve(soles.axes[2], time_s[rows], np.where(on, 1e3 * deepest, np.nan), **style)
    since = f"{end - LAST:g} s" if walk == "thesis" else "a landing of the foot"
    level(forces.axes[0], shown[MODELS[0]][0].subject.mass * GRAVITY, "body weight")
    soles.axes[1].set_yscale("symlog", linthresh=1.0)
    soles.axes[1].yaxis.set_major_formatter("{x:g}")
    forces.axes[2].set_ylim(0.0, 1.1)
    for figure, names in (
        (forces, ("vertical [N]", "fore-aft [N]", "friction use")),
        (soles, ("center of pressure\nahead of ankle [cm]", "slip [mm/s]", "penetration [mm]")),
    ):
        for axes, text in zip(figure.axes, names, strict=True):
            label(axes, "", text)
        label(figure.axes[-1], f"time from {since} on [s]", names[-1])
        legend(figure.axes[0])
        figure.align_ylabels()
    IMAGES.mkdir(parents=True, exist_ok=True)
    save(forces, IMAGES / f"{walk}_forces.png")
    save(soles, IMAGES / f"{walk}_soles.png")


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["evaluation", "compare"])
    parser.add_argument("--fresh", action="store_true", help="simulate what has been simulated already")
    args = parser.parse_args()
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    if args.what == "evaluation":
        results["evaluation"] = evaluation()
        print(json.dumps(results["evaluation"]))
    else:
        results |= compare(args.fresh)
    RESULTS.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
