"""Measures scenarios in processes of their own and puts the repeats together.

One repeat of one scenario has a process of its own, where start-up and peak memory are those of a user.
"""

import json
import logging
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from humanwalk.bench.bare_plant import BarePlant, record_plant
from humanwalk.bench.cost import Cost, TimedWalk, in_turns
from humanwalk.bench.profile import UPSTREAM, profiled
from humanwalk.bench.result import BenchResult, ScenarioCost, machine
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import prepare
from humanwalk.scenario import Scenario, load_scenario

SOLVERS = ("InverseKinematicsSolver", "WholeBodyController")
"""Systems whose work is a mathematical program."""

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
"""Environment of a process on one core."""

_FRESH = "import time; began = time.perf_counter(); from humanwalk.bench.measure import main; main(began)"


def bench(
    scenarios: Sequence[str],
    overrides: Mapping[str, str],
    repeats: int,
    on_progress: Callable[[str, int, int], None] = lambda name, done, all_: None,
    on_result: Callable[[BenchResult], None] = lambda result: None,
) -> BenchResult:
    """Measure scenarios, each repeat in its own process on one core, repeats of all scenarios interleaved.

    Args:
        scenarios: Names of shipped scenarios, or paths.
        overrides: See `load_scenario`; includes the duration.
        repeats: Number of repeats of each scenario.
        on_progress: Called before each repeat with the scenario, the number of repeats done, and of all repeats.
        on_result: Called after each repeat with the result so far.

    Raises:
        ParameterError: A scenario cannot be simulated for this duration.
    """
    durations = {scenario: load_scenario(scenario, overrides).duration for scenario in scenarios}
    found: dict[str, list[dict[str, Any]]] = {scenario: [] for scenario in durations}
    todo = len(found) * repeats
    result = BenchResult({}, repeats, dict.fromkeys(found, 0), dict(overrides), machine())
    for repeat in range(repeats):
        for place, scenario in enumerate(found):
            on_progress(scenario, repeat * len(found) + place, todo)
            found[scenario].append(_repeat(scenario, overrides))
            cost = put_together(found[scenario], durations[scenario])
            result = replace(
                result,
                scenarios=result.scenarios | {scenario: cost},
                done=result.done | {scenario: repeat + 1},
                machine=machine(),
            )
            on_result(result)
    return result


def _repeat(scenario: str, overrides: Mapping[str, str]) -> dict[str, Any]:
    command = [sys.executable, "-c", _FRESH, json.dumps([scenario, overrides])]
    done = subprocess.run(command, env=os.environ | ONE_THREAD, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        reason = (done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1]
        raise ParameterError(f"{scenario}: could not be measured: {reason}; does `humanwalk walk {scenario}` run?")
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    if "refusal" in answer:
        raise ParameterError(answer["refusal"])
    return answer


def put_together(repeats: Sequence[Mapping[str, Any]], duration: float) -> ScenarioCost:
    """Cost of one scenario from the measures of its repeats, see `measure_repeat`.

    Every repeat does the same work turn by turn. The cost is the sum over turns of the median over repeats, so that a
    disturbance of one turn of one repeat does not count.
    """

    def of_turns(simulation: str, clock: int) -> float:
        turns = np.array([repeat["turns"][simulation] for repeat in repeats])[:, :, clock]
        return float(np.median(turns, axis=0).sum()) / duration

    def median(measure: Callable[[Mapping[str, Any]], float]) -> float:
        return float(np.median([measure(repeat) for repeat in repeats]))

    names = sorted(set(repeats[0]["profile"]) - {UPSTREAM})
    by_system = {name: median(lambda repeat, name=name: repeat["profile"][name]) / duration for name in names}  # type: ignore[misc]
    wall, cpu = of_turns("full", 0), of_turns("full", 1)
    unrecorded, plant = of_turns("unrecorded", 1), of_turns("bare", 1)
    solvers = sum(by_system.get(name, 0.0) for name in SOLVERS)
    return ScenarioCost(
        wall=wall,
        cpu=cpu,
        plant=plant,
        solvers=solvers,
        systems=unrecorded - plant - solvers,
        logging=cpu - unrecorded,
        by_system=dict(sorted(by_system.items(), key=lambda item: -item[1])),
        startup_s=median(lambda repeat: repeat["startup_s"]),
        peak_memory_MB=median(lambda repeat: repeat["peak_memory_MB"]),
        duration_s=duration,
    )


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
