"""How robust the balanced walk is: speeds, seeds and pushes, counted and never asserted on.

    python benchmarks/balance.py speeds --duration 60
    python benchmarks/balance.py seeds --duration 30 --speeds 1.0 1.4 --seeds 20
    python benchmarks/balance.py pushes --impulses 30 60
    python benchmarks/balance.py paths

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

from humanwalk.run.measures import cost_of_transport, steady_from
from humanwalk.run.signals import TIME
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario

JOINT_NOISE = 0.01
"""Standard deviation of the initial posture in the rows with seeds [rad]."""

PUSH_TIMES = [8.0 + 1.04 * share for share in (0.0, 0.2, 0.4, 0.6, 0.8)]
"""Five timings over a stride, in the steady walk [s]."""


def walk(speed: float, duration: float, **overrides: str) -> Scenario:
    points = f"[{{time: 1.0, forward: {speed}}}]"
    return load_scenario("walk", {"balanced.command.points": points, "duration": str(duration)} | overrides)


def measure(label: str, scenario: Scenario) -> dict[str, Any]:
    outcome = simulate(scenario)
    signals = outcome.signals
    time, x, y = (signals[name].to_numpy() for name in (TIME, "com.x_m", "com.y_m"))
    steady = time >= steady_from(scenario)
    several = steady.sum() > 1
    row = {
        "run": label,
        "end": outcome.end,
        "time_s": round(float(time[-1]), 2),
        "speed_m_s": float(np.polyfit(time[steady], x[steady], 1)[0]) if several else None,
        "largest_y_m": float(np.abs(y[steady]).max()) if several else None,
        "final_y_m": float(y[-1]),
        "cost_of_transport": cost_of_transport(signals, steady, scenario.subject.mass),
        "qp_failures": int(signals["qp.failures"].to_numpy().max()),
        "realtime_factor": float(time[-1]) / outcome.wall_time,
    }
    print(
        "  ".join(f"{key} {value:.3f}" if isinstance(value, float) else f"{value}" for key, value in row.items()),
        flush=True,
    )
    return row


def speeds(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for speed in args.speeds:
        yield measure(f"speed {speed:g}", walk(speed, args.duration))


def seeds(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for speed in args.speeds:
        for seed in range(args.seeds):
            scenario = walk(speed, args.duration, **{"seed": str(seed), "start.joint_noise": str(JOINT_NOISE)})
            yield measure(f"speed {speed:g} seed {seed}", scenario)


def pushes(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for impulse in args.impulses:
        for eighth in range(8):
            for time in PUSH_TIMES:
                push = f"[{{time: {time}, impulse: {impulse}, direction: {eighth * math.pi / 4}}}]"
                scenario = walk(1.0, time + 6.0, **{"pushes.pushes": push})
                yield measure(f"push {impulse:g} N s towards {45 * eighth} deg at {time:.2f} s", scenario)


def paths(args: argparse.Namespace) -> Iterator[dict[str, Any]]:
    for name in ("stand", "start_stop", "turn", "sideways", "backward"):
        yield measure(name, load_scenario(name))


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["speeds", "seeds", "pushes", "paths"])
    parser.add_argument("--speeds", type=float, nargs="+", default=[0.3, 0.7, 1.0, 1.2, 1.4])
    parser.add_argument("--impulses", type=float, nargs="+", default=[30.0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--duration", type=float, default=60.0, help="simulated time of a run [s]")
    parser.add_argument("--json", type=Path, help="file for the rows")
    args = parser.parse_args()
    rows = list({"speeds": speeds, "seeds": seeds, "pushes": pushes, "paths": paths}[args.what](args))
    survived = sum(row["end"] == "completed" for row in rows)
    print(f"{survived} of {len(rows)} survived")
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
