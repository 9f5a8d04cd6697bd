"""One repeat of one scenario in a process of its own, where start-up and peak memory are those of a user."""

import json
import logging
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from humanwalk.bench.bare_plant import BarePlant, record_plant
from humanwalk.bench.cost import Cost, in_turns
from humanwalk.bench.profile import profiled
from humanwalk.bench.timed_walk import TimedWalk
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import prepare
from humanwalk.scenario import Scenario, load_scenario


def measure_repeat(scenario: Scenario, began: float) -> dict[str, Any]:
    """Simulate a scenario five times: as a user does, profiled, then by turns in full, unrecorded, as bare plant.

    Args:
        scenario: A scenario with a discrete plant.
        began: `time.perf_counter()` before the import of humanwalk.

    Returns:
        startup_s: from then to the end of the first step; peak_memory_MB: of the first simulation;
        profile: exclusive processor time of our systems by class [s]; turns: wall and processor time of every turn
        [s] by simulation ("full", "unrecorded", "bare"); the last of "full" makes the table of signals.

    Raises:
        ParameterError: The scenario cannot be simulated to its end, or its plant cannot be simulated separately.
    """
    walk = TimedWalk(scenario)
    walk.advance(scenario.simulation.time_step)
    startup = time.perf_counter() - began
    walk.advance(scenario.duration)
    peak_memory = peak_memory_MB()
    if walk.ended:
        raise ParameterError(
            f"duration: {scenario.duration:g} is too long, the simulation ended at {walk.time:.2f} s: {walk.ended}; "
            "allowed: a walk without a fall; shorten --duration"
        )
    with profiled() as clock:
        prepared = prepare(scenario, record=False)
        record = record_plant(prepared)
        prepared.simulator.Initialize()
        prepared.simulator.AdvanceTo(scenario.duration)
    full = TimedWalk(scenario)
    advance: dict[str, Callable[[float], Cost]] = {
        "full": full.advance,
        "unrecorded": TimedWalk(scenario, record=False).advance,
        "bare": BarePlant(scenario, record).advance,
    }
    turns = in_turns(advance, scenario.duration)
    turns["full"].append(full.make_table())
    return {
        "startup_s": startup,
        "peak_memory_MB": peak_memory,
        "profile": dict(clock.seconds),
        "turns": {name: [(cost.wall, cost.cpu) for cost in costs] for name, costs in turns.items()},
    }


def peak_memory_MB() -> float:
    """Peak resident memory of this process [MB]."""
    status = Path("/proc/self/status")
    if status.exists():
        # On Linux, getrusage includes the memory of the parent process.
        (peak,) = (line for line in status.read_text(encoding="ascii").splitlines() if line.startswith("VmHWM:"))
        return int(peak.split()[1]) * 1024 / 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def main(began: float) -> None:
    """Read scenario and overrides as JSON from the command line, print the measures or the error as JSON."""
    logging.getLogger("drake").setLevel(logging.ERROR)
    name, overrides = json.loads(sys.argv[1])
    try:
        answer = measure_repeat(load_scenario(name, overrides), began)
    except ParameterError as error:
        answer = {"refusal": f"{name}: {error}"}
    print(json.dumps(answer))
