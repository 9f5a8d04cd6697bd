"""How robust the balanced walk is: speeds, seeds and pushes, counted and never asserted on.

    python benchmarks/balance.py speeds --duration 60
    python benchmarks/balance.py seeds --duration 30 --speeds 1.0 1.4 --seeds 20
    python benchmarks/balance.py pushes --impulses 30 60
    python benchmarks/balance.py pushes --later 0.1
    python benchmarks/balance.py paths
    python benchmarks/balance.py invariance --duration 12
    python benchmarks/balance.py bodies --duration 12 --speeds 1.0 1.4

Every run is printed as it ends; `--json FILE` keeps the rows.
"""

import argparse
import json
import logging
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import InitializeParams, Simulator
from pydrake.systems.framework import Context, Diagram

from humanwalk.body import SIDES
from humanwalk.diagrams.walker import make_diagram
from humanwalk.measures.effort import cost_of_transport
from humanwalk.measures.events import events_of
from humanwalk.measures.signals import TIME
from humanwalk.run.monitor import Monitor
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.systems.push_source import PushSource
from humanwalk.terrain import Plane
from humanwalk.walking.command import CommandProfile
from humanwalk.walking.commanded_path import Place
from humanwalk.walking.push import Push

Array = npt.NDArray[np.float64]

NOISE = {"start.joint_noise": "0.01", "start.rate_noise": "0.1", "start.gain_noise": "0.05"}
"""Of the rows with seeds: the foot of a straight leg stands 1 cm elsewhere for each joint that errs by its standard
deviation, and the body starts with about 0.1 m/s; gains are known to a twentieth."""

PUSH_TIMES = [8.0 + 1.04 * share for share in (0.0, 0.2, 0.4, 0.6, 0.8)]
"""Five timings over a stride, in the steady walk [s]."""

BODIES = ((50, 1.50), (60, 1.65), (90, 1.80), (110, 1.95))
"""Body mass [kg] and stature [m]; the reference has 70 kg and 1.75 m."""

AFTER_PUSH = 4.0
"""Who is up this long after a push has survived it [s]: seven steps."""


def walk(speed: float, duration: float, **overrides: str) -> Scenario:
    points = f"[{{time: 1.0, forward: {speed}}}]"
    return load_scenario("walk", {"controller.balanced.command.points": points, "duration": str(duration)} | overrides)


def measure(label: str, scenario: Scenario) -> dict[str, Any]:
    outcome = simulate(scenario)
    signals = outcome.signals
    time, x, y = (signals[name].to_numpy() for name in (TIME, "com.x_m", "com.y_m"))
    steady = time >= scenario.controller.steady_from(scenario.subject)
    several = steady.sum() > 1
    landings = np.sort(np.concatenate([events_of(signals, side).touchdown_times for side in SIDES]))
    steps = np.diff(landings[landings >= scenario.controller.steady_from(scenario.subject)])
    row = {
        "run": label,
        "end": outcome.end,
        "time_s": round(float(time[-1]), 2),
        "speed_m_s": float(np.polyfit(time[steady], x[steady], 1)[0]) if several else None,
        "largest_y_m": float(np.abs(y[steady]).max()) if several else None,
        "final_y_m": float(y[-1]),
        "off_path_m": off_path(scenario, x[::10], y[::10]),
        "cost_of_transport": cost_of_transport(signals, steady, scenario.subject.mass),
        "steps": len(landings),
        "step_s": float(steps.mean()) if steps.size else None,
        "qp_failures": int(signals["qp.failures"].to_numpy().max()),
        "realtime_factor": float(time[-1]) / outcome.wall_time,
    }
    show(row)
    return row


def show(row: dict[str, Any]) -> None:
    print(
        "  ".join(f"{key} {value:.3f}" if isinstance(value, float) else f"{value}" for key, value in row.items()),
        flush=True,
    )


def speeds(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for speed in args.speeds:
        yield measure(f"speed {speed:g}", walk(speed, args.duration))


def seeds(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for speed in args.speeds:
        for seed in range(args.seeds):
            scenario = walk(speed, args.duration, **{"seed": str(seed)} | NOISE)
            yield measure(f"speed {speed:g} seed {seed}", scenario)


def pushes(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Walks once to the time of each push, and from there again for every impulse and direction."""
    times = [time + args.later for time in PUSH_TIMES]
    walker = make_diagram(walk(1.0, times[-1], **{"pushes.given": "[{impulse: 0.0}]"}))
    before = Simulator(walker)
    for time in times:
        before.AdvanceTo(time)
        for impulse in args.impulses:
            for eighth in args.eighths:
                push = Push(time=time, impulse=impulse, direction=eighth * math.pi / 4)
                row = {"run": f"push {impulse:g} N s towards {45 * eighth} deg at {time:.2f} s"}
                row |= pushed(walker, before.get_context().Clone(), push)
                show(row)
                yield row


def pushed(walker: Diagram, context: Context, push: Push) -> dict[str, Any]:
    """How the walk in a context goes on after a push."""
    source, plant = walker.GetSubsystemByName("pushes"), walker.GetSubsystemByName("plant")
    assert isinstance(source, PushSource)
    assert isinstance(plant, MultibodyPlant)
    source.set_pushes(source.GetMyMutableContextFromRoot(context), [push])
    simulator = Simulator(walker, context)
    monitor = Monitor(plant, Plane())
    simulator.set_monitor(monitor)
    try:
        simulator.Initialize(InitializeParams(suppress_initialization_events=True))
        simulator.AdvanceTo(push.time + AFTER_PUSH)
        end = monitor.reason or "completed"
    except RuntimeError as error:
        end = monitor.reason or f"solver failed: {str(error).splitlines()[0]}"
    after = simulator.get_context()
    return {
        "end": end,
        "time_s": round(after.get_time(), 2),
        "final_y_m": float(walker.GetOutputPort("com").Eval(after)[1]),
        "qp_failures": int(walker.GetOutputPort("qp_status").Eval(after)[1]),
    }


def invariance(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """The same walk with finer physics, finer control and another contact: steps and speed should not change."""
    for contact in ("point", "hydroelastic"):
        for time_step, period in ((0.002, 0.006), (0.001, 0.006), (0.002, 0.002)):
            label = f"{contact}, physics {1e3 * time_step:g} ms, control {1e3 * period:g} ms"
            overrides = {
                "contact": contact,
                "simulation.time_step": str(time_step),
                "controller.balanced.control_period": str(period),
            }
            yield measure(label, walk(1.0, args.duration, **overrides))


def bodies(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Other bodies at every speed, with the gains of the reference body."""
    for mass, stature in BODIES:
        for speed in args.speeds:
            subject = {"subject.mass": str(mass), "subject.stature": str(stature)}
            yield measure(f"{mass} kg, {stature} m, {speed:g} m/s", walk(speed, args.duration, **subject))


def paths(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for name in args.scenarios:
        yield measure(name, load_scenario(name))


def off_path(scenario: Scenario, x: Array, y: Array) -> float:
    """Greatest distance [m] of the centre of mass from the curve that the command describes, whatever the time."""
    profile = CommandProfile(scenario.controller.command)
    path, curve, dt = Place(complex(x[0], y[0]), 0.0), [], 0.01
    for tick in range(round(scenario.duration / dt)):
        curve.append(path.position)
        path = path.advanced(profile.at(tick * dt), dt)
    if curve[-1] != curve[-2]:
        # The walker may be ahead of the command.
        curve.extend(curve[-1] + step * (curve[-1] - curve[-2]) for step in range(1, 100))
    return max(float(np.abs(np.array(curve) - complex(*point)).min()) for point in zip(x, y, strict=True))


COMMANDS = {
    "speeds": speeds,
    "seeds": seeds,
    "pushes": pushes,
    "paths": paths,
    "invariance": invariance,
    "bodies": bodies,
}


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=list(COMMANDS))
    parser.add_argument("--speeds", type=float, nargs="+", default=[0.3, 0.7, 1.0, 1.2, 1.4])
    parser.add_argument("--impulses", type=float, nargs="+", default=[30.0])
    parser.add_argument("--eighths", type=int, nargs="+", default=list(range(8)), help="directions of pushes [45 deg]")
    parser.add_argument("--later", type=float, default=0.0, help="all pushes by this much later [s]")
    parser.add_argument(
        "--scenarios", nargs="+", default=["stand", "start_stop", "turn", "corner", "sideways", "backward"]
    )
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--duration", type=float, default=60.0, help="simulated time of a run [s]")
    parser.add_argument("--json", type=Path, help="file for the rows")
    args = parser.parse_args()
    rows = []
    for row in COMMANDS[args.what](args):
        rows.append(row)
        if args.json:
            # After every run: a table that is not finished is of use too.
            args.json.write_text(json.dumps(rows, indent=1) + "\n")
    print(f"{sum(row['end'] == 'completed' for row in rows)} of {len(rows)} survived")


if __name__ == "__main__":
    main()
