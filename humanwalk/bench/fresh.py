"""One repeat of one scenario, in a process started for it: only there start-up and peak memory are a user's."""

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
    """Simulate a scenario five times: as a user does, profiled, then by turns in full, without record, as bare plant.

    Args:
        scenario: a scenario with a discrete plant.
        began: `time.perf_counter()` before anything of humanwalk was imported.

    Returns:
        startup_s: from then to the end of the first step; peak_memory_MB: of the first simulation;
        profile: exclusive processor time of our systems by class [s]; turns: by simulation ("full", "unrecorded",
        "bare") the wall and processor time of every turn [s]; the last of "full" makes the table of the record.

    Raises:
        ParameterError: the scenario cannot be simulated to its end, or its plant cannot be told from the rest.
    """
    walk = TimedWalk(scenario)
    walk.advance(scenario.simulation.time_step)
    startup = time.perf_counter() - began
    walk.advance(scenario.duration)
    peak_memory = peak_memory_MB()
    if walk.ended:
        raise ParameterError(
            f"duration: {scenario.duration:g} is too long, the simulation ended at {walk.time:.2f} s: {walk.ended}; "
            "allowed: a walk that lasts; shorten --duration"
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
    """The most memory that this process had in use since it began [MB]."""
    status = Path("/proc/self/status")
    if status.exists():
        # Linux's getrusage would count the memory of the process that started this one, too.
        (peak,) = (line for line in status.read_text(encoding="ascii").splitlines() if line.startswith("VmHWM:"))
        return int(peak.split()[1]) * 1024 / 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def main(began: float) -> None:
    """Read scenario and overrides as JSON from the command line, print the measures or the refusal as JSON."""
    logging.getLogger("drake").setLevel(logging.ERROR)
    name, overrides = json.loads(sys.argv[1])
    try:
        answer = measure_repeat(load_scenario(name, overrides), began)
    except ParameterError as error:
        answer = {"refusal": f"{name}: {error}"}
    print(json.dumps(answer))
