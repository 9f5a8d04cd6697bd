"""Measures the thesis' walk against what it must reach, and writes benchmarks/results/thesis_walk.json.

python benchmarks/thesis_walk.py [--repeats 3] [--set controller.thesis.gait.path.step_height=0.12]

Every repeat is a process of its own on one core, so that memory and start-up are those of a user's run. The real-time
factor is the median; two repeats must give the same bits.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results" / "thesis_walk.json"

Measures = dict[str, Any]

REQUIRED: Mapping[str, tuple[Callable[[Measures], bool], str]] = {
    "survived": (lambda m: bool(m["survived"]) and m["duration_s"] >= 15, "15 s"),
    "mean_speed_m_s": (lambda m: abs(m["mean_speed_m_s"] - 1.4) <= 0.028, "1.4 within 2 %"),
    "foot_line_error_m": (lambda m: m["foot_line_error_m"] <= 0.005, "at most 0.005"),
    "pelvis_tracking_rms_m": (lambda m: m["pelvis_tracking_rms_m"] < 0.01, "below 0.01"),
    "realtime_factor": (lambda m: m["realtime_factor"] >= 2.0, "at least 2.0"),
    "peak_memory_MB": (lambda m: m["peak_memory_MB"] < 1000, "below 1000"),
    "bit_identical": (lambda m: bool(m["bit_identical"]), "true"),
}
"""What the walk has to reach, by measure: the test, and the same in words."""


def measure_once(overrides: dict[str, str]) -> Measures:
    """Simulate in this process and return its measures."""
    from humanwalk.bench.measure import peak_memory_MB
    from humanwalk.run.provenance import signals_hash
    from humanwalk.run.simulate import simulate
    from humanwalk.scenario import load_scenario

    outcome = simulate(load_scenario("thesis", overrides))
    summary: Measures = {**outcome.summary("thesis")}
    lift = summary["foot_lift_m"]
    return {
        "survived": summary["survived"],
        "duration_s": summary["duration_s"],
        "mean_speed_m_s": summary["mean_speed_m_s"],
        "distance_m": summary["distance_m"],
        "foot_line_error_m": max(summary["foot_line_error_m"].values()),
        "lateral_drift_m": summary["lateral_drift_m"],
        "foot_lift_m": lift,
        "pelvis_tracking_rms_m": summary["pelvis_tracking_rms_m"],
        "support_force_rms_N": summary["support_force_rms_N"],
        "peak_torque_N_m": max(summary["peak_torque_N_m"].values()),
        "cost_of_transport": summary["cost_of_transport"],
        "realtime_factor": summary["realtime_factor"],
        "peak_memory_MB": peak_memory_MB(),
        "signals_sha256": signals_hash(outcome.signals),
    }


def main() -> int:
    """Run the repeats, print the table, write the JSON; 1 if a requirement is missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--set", action="append", default=[], metavar="FIELD=VALUE")
    parser.add_argument("--once", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.once:
        print(json.dumps(measure_once(dict(pair.split("=", 1) for pair in arguments.set))))
        return 0

    command = [sys.executable, __file__, "--once", *(part for pair in arguments.set for part in ("--set", pair))]
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    runs = [
        json.loads(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)
        for _ in range(arguments.repeats)
    ]
    measures = runs[0] | {
        "realtime_factor": statistics.median(run["realtime_factor"] for run in runs),
        "realtime_factors": [run["realtime_factor"] for run in runs],
        "peak_memory_MB": statistics.median(run["peak_memory_MB"] for run in runs),
        "bit_identical": len({run["signals_sha256"] for run in runs}) == 1,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}",
        "overrides": arguments.set,
    }
    missed = 0
    for name, (reached, wanted) in REQUIRED.items():
        ok = reached(measures)
        missed += not ok
        value = measures[name]
        print(f"{'ok    ' if ok else 'MISSED'} {name:24s} {value:<10.4g} {wanted}")
    for name, value in measures.items():
        if name not in REQUIRED:
            print(f"       {name:24s} {value}")
    if not arguments.set:
        RESULTS.parent.mkdir(exist_ok=True)
        RESULTS.write_text(json.dumps(measures, indent=2) + "\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
