"""What is left of walks that are ended at random times by kill -9, SIGTERM, SIGHUP and Ctrl-C.

    python benchmarks/kills.py 200

Two walks run at a time. Every file has to be whole or absent; a run that had begun to walk has to be saved unless it
was ended by kill -9, and after kill -9 its last checkpoint has to be readable (docs/reliability.md).
"""

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pyarrow.parquet as pq

from humanwalk.measures.ends import UNFINISHED
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import PLOTS, REPLAY, SCENARIO, SIGNALS, SUMMARY, Run
from humanwalk.scenario import load_scenario

SIGNALS_IN_TURN = (signal.SIGKILL, signal.SIGTERM, signal.SIGHUP, signal.SIGINT)
WALK = "from humanwalk.cli.main import main; main()"

LATEST = 4.0
"""Latest time of a kill [s], in three of four walks after the folder was made, else after the start of the process."""
PATIENCE = 120.0
"""Time for a process to end after a signal [s]."""

KINDS = (
    # Begins, writes checkpoints all the time, does not end.
    ["--duration", "600", "--checkpoint", "0.2", "--no-replay", "--no-plots"],
    # Is often killed while it writes.
    ["--duration", "0.3", "--checkpoint", "0.1"],
)


def whole(path: Path) -> bool:
    """Whether a file of a run folder is complete."""
    if path.name == SIGNALS:
        return bool(pq.read_table(path).num_rows > 0)
    if path.name == SUMMARY:
        return "provenance" in json.loads(path.read_text())
    if path.name == SCENARIO:
        return bool(load_scenario(path).duration > 0.0)
    ends = {".html": b"</html>", ".svg": b"</svg>", ".png": b"IEND\xaeB`\x82", ".pdf": b"%%EOF"}
    return path.read_bytes().rstrip().endswith(ends[path.suffix])


def complaints(folder: Path, number: int, errors: str) -> list[str]:
    """What is wrong with the rest of a walk."""
    # Python itself answers Ctrl-C while it imports, before the program begins.
    while_importing = not folder.exists() and errors.rstrip().endswith("KeyboardInterrupt")
    found = ["a traceback"] if "Traceback" in errors and not while_importing else []
    files = [path for path in folder.rglob("*") if path.is_file()] if folder.exists() else []
    hidden = [path for path in files if path.name.startswith(".")]
    if hidden and number != signal.SIGKILL:
        found.append(f"temporary files: {', '.join(path.name for path in hidden)}")
    for path in sorted(set(files) - set(hidden)):
        try:
            if path.name not in (SCENARIO, SIGNALS, SUMMARY, REPLAY) and path.parent.name != PLOTS:
                found.append(f"{path.name} is unknown")
            elif not whole(path):
                found.append(f"{path.name} is not whole")
        except Exception as error:
            found.append(f"{path.name}: {error}")
    has_summary = (folder / SUMMARY).exists()
    if has_summary:
        try:
            run = Run.open(folder)
            assert run.scenario.duration > 0.0
            assert run.signals.num_rows > 0
        except ParameterError as error:
            found.append(str(error))
    walked = ": walking" in errors
    if walked and number != signal.SIGKILL:
        if not has_summary:
            found.append("the run is not saved")
        elif Run.open(folder).summary["end"] == UNFINISHED:
            found.append("only a checkpoint is saved")
    return found


def kill(place: Path, index: int, seed: int) -> tuple[str, list[str]]:
    """Phase in which a walk was ended, and what is wrong with what it left."""
    draw = random.Random(f"{seed} {index}")
    number, kind = SIGNALS_IN_TURN[index % len(SIGNALS_IN_TURN)], KINDS[draw.randrange(len(KINDS))]
    folder = place / f"run{index}"
    process = subprocess.Popen(
        [sys.executable, "-c", WALK, "walk", "thesis", *kind, "-o", str(folder)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONFAULTHANDLER": "1"},
    )
    wait_for_folder = draw.random() < 0.75
    while wait_for_folder and not folder.exists() and process.poll() is None:
        time.sleep(0.01)
    time.sleep(draw.uniform(0.0, LATEST))
    process.send_signal(number)
    try:
        _, errors = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        # Python prints where it is.
        process.send_signal(signal.SIGABRT)
        _, errors = process.communicate()
        return f"{number.name} ignored", [f"did not end in {PATIENCE:g} s: {errors}"]
    phase = "while walking or writing" if ": walking" in errors else "before it walked"
    phase = "after its end" if process.returncode == 0 else phase
    return f"{number.name} {phase}", complaints(folder, number, errors)


def main() -> None:
    """Kill as many walks as asked for; exit code 1 if one left something that is wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kills", type=int, nargs="?", default=200)
    parser.add_argument("--seed", type=int, default=18)
    arguments = parser.parse_args()
    # A shell's background job ignores some signals, and would pass that on to the walks.
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)
    with tempfile.TemporaryDirectory() as place, ThreadPoolExecutor(2) as pair:
        jobs = range(arguments.kills)
        results = list(pair.map(lambda index: kill(Path(place), index, arguments.seed), jobs))
    for index, (phase, found) in enumerate(results):
        for complaint in found:
            print(f"walk {index}, {phase}: {complaint}")
    for phase, count in sorted(Counter(phase for phase, _ in results).items()):
        print(f"{count:4d} {phase}")
    good = sum(not found for _, found in results)
    print(f"{good} of {arguments.kills}")
    sys.exit(good < arguments.kills)


if __name__ == "__main__":
    main()
