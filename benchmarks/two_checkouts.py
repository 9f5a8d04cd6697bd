"""Which of several checkouts, or settings, is quicker, on a machine that does other things, too.

    python benchmarks/two_checkouts.py thesis . ../other
    python benchmarks/two_checkouts.py walk . .,actuation.pd.law=implicit --chunks 50

Each checkout simulates in a process of its own and waits for its turn after every 0.1 s of simulated time. What the
machine does otherwise hits all of them alike: medians of the ratios of paired turns repeat to 2 or 3 %.
"""

import argparse
import os
import statistics
import subprocess
import sys
from pathlib import Path

from humanwalk.bench.cost import CHUNK
from humanwalk.bench.measure import ONE_THREAD

# Needs of a checkout only what has long been there.
_WORKER = """
import logging, sys, time
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
logging.getLogger("drake").setLevel(logging.ERROR)
name, chunk, turns, skip, *overrides = sys.argv[1:]
chunk, turns, stop, began = float(chunk), int(turns), float(skip), None
def look(now):
    global stop, began
    if now < stop - 1e-9:
        return
    print(-1.0 if began is None else time.thread_time() - began, flush=True)
    sys.stdin.readline()
    stop += chunk
    began = time.thread_time()
overrides = dict(pair.split("=", 1) for pair in overrides) | {"duration": repr(stop + chunk * (turns + 1))}
simulate(load_scenario(name, overrides), on_progress=look)
"""


class Worker:
    """One checkout that simulates by turns."""

    def __init__(self, which: str, scenario: str, turns: int, skip: float) -> None:
        tree, *overrides = which.split(",")
        self.name = which
        self.costs: list[float] = []
        path = Path(tree).resolve()
        if not (path / "humanwalk").is_dir():
            sys.exit(f"{tree}: is no checkout; allowed: folders that hold the package humanwalk")
        command = [sys.executable, "-c", _WORKER, scenario, repr(CHUNK), str(turns), repr(skip), *overrides]
        pipe = subprocess.PIPE
        environment = os.environ | ONE_THREAD | {"PYTHONPATH": str(path)}
        self.process = subprocess.Popen(command, cwd=path, env=environment, stdin=pipe, stdout=pipe, text=True)
        assert self.process.stdin
        assert self.process.stdout
        self.input, self.output = self.process.stdin, self.process.stdout
        self.read()

    def read(self) -> float:
        line = self.output.readline()
        if not line:
            sys.exit(f"{self.name}: ended before its turn, exit code {self.process.wait()}")
        return float(line)

    def turn(self) -> None:
        self.input.write("\n")
        self.input.flush()
        self.costs.append(self.read())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario")
    parser.add_argument("checkouts", nargs="+", metavar="FOLDER[,FIELD=VALUE]...", help="the first is compared with")
    parser.add_argument("--chunks", type=int, default=30, help="number of turns of 0.1 s")
    parser.add_argument("--skip", type=float, default=2.0, help="simulated time before the first turn [s]")
    arguments = parser.parse_args()
    workers = [Worker(which, arguments.scenario, arguments.chunks, arguments.skip) for which in arguments.checkouts]
    for turn in range(arguments.chunks):
        for worker in workers[:: -1 if turn % 2 else 1]:
            worker.turn()
    for worker in workers:
        worker.process.kill()
        ratio = statistics.median(b / a for a, b in zip(workers[0].costs, worker.costs, strict=True))
        print(f"{worker.name:50s} {1e3 * statistics.median(worker.costs) / CHUNK:7.0f} ms/s   ratio {ratio:.3f}")


if __name__ == "__main__":
    main()
