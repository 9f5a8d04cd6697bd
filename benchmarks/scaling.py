"""How cost grows: with simulated time, with the number of contact points, with worker processes.

    python benchmarks/scaling.py time [--minutes 10] [--scenario comfortable]
    python benchmarks/scaling.py contacts
    python benchmarks/scaling.py workers

Each writes benchmarks/results/scaling_<what>.json.
"""

import argparse
import json
import logging
import os
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

from humanwalk.bench.cost import TimedWalk, in_turns
from humanwalk.bench.measure import ONE_THREAD
from humanwalk.bench.result import machine
from humanwalk.body import contact_spheres, sdf
from humanwalk.body.contact import ContactSphere
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.diagrams import world
from humanwalk.files import write_text
from humanwalk.measures.ends import COMPLETED
from humanwalk.scenario import load_scenario

RESULTS = Path(__file__).parent / "results"
PAGE = os.sysconf("SC_PAGE_SIZE")


def resident_MB() -> float:
    """Memory of this process that is in use now [MB] (Linux)."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * PAGE / 1e6


def with_time(scenario: str, minutes: int) -> dict[str, Any]:
    """Processor time and memory, minute by minute of simulated walking, recording off: what grows then is a leak."""
    walk = TimedWalk(load_scenario(scenario, {"duration": str(60 * minutes)}), record=False)
    rows = []
    for minute in range(minutes):
        cost = walk.advance(60.0 * (minute + 1))
        rows.append({"minute": minute + 1, "cpu_s_per_s": cost.cpu / 60, "resident_MB": resident_MB()})
        print(rows[-1], walk.ended, flush=True)
        if walk.ended:
            break
    grown = np.polyfit([row["minute"] for row in rows[1:]], [row["resident_MB"] for row in rows[1:]], 1)[0]
    return {
        "scenario": scenario,
        "end": walk.ended or COMPLETED,
        "record_MB_per_minute": record_MB_per_minute(scenario),
        "growth_MB_per_minute": float(grown),
        "rows": rows,
    }


def record_MB_per_minute(scenario: str) -> float:
    """What the record takes by design: eight bytes for each number."""
    loaded = load_scenario(scenario)
    recorder = TimedWalk(loaded).prepared.recorder
    assert recorder is not None
    # Times are kept, too.
    numbers = 1 + len(recorder.columns)
    return 8e-6 * numbers * 60.0 / loaded.recording.signal_period


def with_contact_points(across: tuple[int, ...] = (2, 4, 8, 16)) -> list[dict[str, Any]]:
    """The thesis' walk with more spheres under each part of a sole, side by side, of the same stiffness together."""
    walks = {}
    for n in across:
        with patch.object(world, "add_human", lambda plant, subject, n=n: add_human(plant, subject, n)):
            walks[6 * n] = TimedWalk(load_scenario("thesis", {"duration": "2"}), record=False)
    costs = in_turns({str(points): walk.advance for points, walk in walks.items()}, 2.0)
    first = np.array([cost.cpu for cost in costs[str(6 * across[0])]])
    return [
        {
            "contact_points": points,
            "cpu_s_per_s": sum(cost.cpu for cost in costs[str(points)]) / 2.0,
            "ratio": float(np.median(np.array([cost.cpu for cost in costs[str(points)]]) / first)),
            "end": walk.ended or COMPLETED,
        }
        for points, walk in walks.items()
    ]


def add_human(plant: MultibodyPlant, subject: Subject, across: int) -> ModelInstanceIndex:
    """As `humanwalk.body.plant.add_human`, with `across` spheres where two are."""

    def denser(skeleton: Skeleton) -> tuple[ContactSphere, ...]:
        spheres = contact_spheres(skeleton)
        found = []
        for medial, lateral in zip(spheres[::2], spheres[1::2], strict=True):
            for i, share in enumerate(np.linspace(0.0, 1.0, across)):
                center = (1 - share) * np.array(medial.center) + share * np.array(lateral.center)
                found.append(replace(medial, name=f"{medial.name}_{i}", center=tuple(center)))
        return tuple(found)

    body = subject.skeleton
    softer = replace(body.flesh, sole_stiffness=2 * body.flesh.sole_stiffness / across)
    with patch.object(sdf, "contact_spheres", denser):
        text = sdf.to_sdf(replace(body, flesh=softer))
    (instance,) = Parser(plant).AddModelsFromString(text, "sdf")
    return instance


_WORKER = """
import logging, sys
logging.getLogger("drake").setLevel(logging.ERROR)
from humanwalk.bench.cost import TimedWalk
from humanwalk.scenario import load_scenario
walk = TimedWalk(load_scenario("thesis", {"duration": "10"}))
print("ready", flush=True)
sys.stdin.readline()
walk.advance(float(sys.argv[1]))
"""


def with_workers(counts: tuple[int, ...] = (1, 2, 4), duration: float = 3.0, repeats: int = 3) -> list[dict[str, Any]]:
    """Simulated seconds of the thesis' walk per second on the clock of several processes at once; medians."""
    command, pipe = [sys.executable, "-c", _WORKER, repr(duration)], subprocess.PIPE
    start_worker = partial(subprocess.Popen, command, env=os.environ | ONE_THREAD, stdin=pipe, stdout=pipe, text=True)
    found: dict[int, list[float]] = {count: [] for count in counts}
    for _ in range(repeats):
        for count in counts:
            with ExitStack() as stack:
                workers = [stack.enter_context(start_worker()) for _ in range(count)]
                pipes = [(worker.stdin, worker.stdout) for worker in workers]
                for _, answer in pipes:
                    assert answer
                    answer.readline()
                began = time.perf_counter()
                for start, _ in pipes:
                    assert start
                    start.write("\n")
                    start.flush()
                if any([worker.wait() for worker in workers]):
                    raise RuntimeError("a worker failed")
                found[count].append(count * duration / (time.perf_counter() - began))
    medians = {count: float(np.median(rates)) for count, rates in found.items()}
    return [
        {"workers": n, "simulated_s_per_s": rate, "ratio": rate / medians[counts[0]]} for n, rate in medians.items()
    ]


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("time", "contacts", "workers"))
    parser.add_argument("--minutes", type=int, default=10)
    parser.add_argument("--scenario", default="comfortable")
    arguments = parser.parse_args()
    if arguments.what == "time":
        found: Any = with_time(arguments.scenario, arguments.minutes)
    else:
        found = with_contact_points() if arguments.what == "contacts" else with_workers()
        for row in found:
            print(row)
    text = json.dumps({"machine": machine(), "found": found}, indent=1) + "\n"
    write_text(RESULTS / f"scaling_{arguments.what}.json", text)


if __name__ == "__main__":
    main()
