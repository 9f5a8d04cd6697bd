"""What is left of a study whose worker, scheduler or command is ended by kill -9 at a random time.

    python benchmarks/study_kills.py 20

Each study of cheap runs is disturbed once; where that ends the command, the same command resumes it. In the end the
table has to equal the undisturbed one row for row, but for time and host, and no process may be left.
"""

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

import psutil
import pyarrow as pa

from humanwalk.quantity import ParameterError
from humanwalk.study.cluster import local_client, remote_client
from humanwalk.study.execute import list_jobs, run_study
from humanwalk.study.row import Job, Row, origin
from humanwalk.study.study import parse_study
from humanwalk.study.table import NOT_REPRODUCED, TABLE, open_journal, read_table

STUDY = parse_study("factors: {seed: {seeds: {count: 25}}, duration: [1, 2, 3, 4]}")
LATEST = 3.0
"""Latest time of a kill after the table appears [s]; the rows take a second or two, and workers two to start."""
PATIENCE = 120.0
"""Time for a process to end or to begin [s]."""


def cheap_row(job: Job) -> Row:
    """A row that depends on the job alone, and takes some 20 ms."""
    time.sleep(0.02)
    row = {"end": "completed", "survived": True, "seed": job.scenario.seed, "duration_s": job.scenario.duration}
    return row | {"mean_speed_m_s": job.scenario.seed / 7.0, "wall_time_s": time.time()} | origin()


def reproduced(folder: Path) -> pa.Table:
    """The table of a folder without what differs when a run is repeated."""
    return read_table(folder).drop_columns(list(NOT_REPRODUCED))


def run(folder: Path, scheduler: str | None) -> None:
    """The command whose end is tested: run or resume the study; one line for an error."""
    try:
        with remote_client(scheduler) if scheduler else local_client(2) as client:
            run_study(STUDY, folder, client, function=cheap_row)
    except ParameterError as error:
        sys.exit(f"humanwalk: {error}")


def start(folder: Path, scheduler: str | None = None) -> subprocess.Popen[str]:
    """The command in a process of its own."""
    command = [sys.executable, __file__, "--run", str(folder), *(["--scheduler", scheduler] if scheduler else [])]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def finish(process: subprocess.Popen[str]) -> str:
    """What a command printed; it has to succeed."""
    printed, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, printed
    return printed


def wait_until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def workers_of(process: subprocess.Popen[str]) -> list[psutil.Process]:
    """Worker processes of a command that have not ended."""
    workers = []
    # The command, or a child, may end at any time.
    with suppress(psutil.NoSuchProcess):
        for child in psutil.Process(process.pid).children(recursive=True):
            with suppress(psutil.NoSuchProcess):
                if "spawn_main" in " ".join(child.cmdline()):
                    workers.append(child)
    return workers


def kill_worker(folder: Path, draw: random.Random) -> None:
    process = start(folder)
    wait_until((folder / TABLE).exists)
    time.sleep(draw.uniform(0.0, LATEST))
    if process.poll() is None and (workers := workers_of(process)):
        with suppress(psutil.NoSuchProcess):
            draw.choice(workers).kill()
    assert "Traceback" not in finish(process)


def kill_command(folder: Path, draw: random.Random) -> None:
    process = start(folder)
    wait_until((folder / TABLE).exists)
    time.sleep(draw.uniform(0.0, LATEST))
    workers = workers_of(process) if process.poll() is None else []
    process.kill()
    process.communicate()
    wait_until(lambda: not any(worker.is_running() for worker in workers))
    finish(start(folder))


@contextmanager
def cluster(place: Path) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """Address and process of a scheduler with two workers, as a user starts them."""
    file = place / "scheduler.json"
    file.unlink(missing_ok=True)
    dask = [sys.executable, "-m", "dask"]
    here = ["--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file)]
    options = ["--nworkers", "2", "--nthreads", "1", "--local-directory", str(place)]
    quiet = partial(subprocess.Popen, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    scheduler = quiet([*dask, "scheduler", *here, "--port", "0", "--dashboard-address", "127.0.0.1:0"])
    started = [scheduler]
    try:
        wait_until(file.exists)
        started.append(quiet([*dask, "worker", *here, *options]))
        yield json.loads(file.read_text())["address"], scheduler
    finally:
        for process in started:
            # The nanny ends its workers when it is asked to end.
            process.terminate()
            process.wait(PATIENCE)


def kill_scheduler(folder: Path, draw: random.Random) -> None:
    with cluster(folder.parent) as (address, scheduler):
        process = start(folder, address)
        wait_until((folder / TABLE).exists)
        time.sleep(draw.uniform(0.0, LATEST))
        done = process.poll() is not None
        scheduler.kill()
        printed, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == (0 if done else 1) or len(read_table(folder)) == len(STUDY.points), printed
    assert process.returncode == 0 or printed.startswith("humanwalk: scheduler tcp://"), printed
    assert len(printed.splitlines()) == (process.returncode != 0), printed
    with cluster(folder.parent) as (address, _):
        finish(start(folder, address))


KINDS: dict[str, Callable[[Path, random.Random], None]] = {
    "worker": kill_worker,
    "command": kill_command,
    "scheduler": kill_scheduler,
}


def undisturbed(place: Path) -> pa.Table:
    """The table of the study, made in this process without a cluster."""
    with open_journal(place, STUDY) as journal:
        for job in list_jobs(STUDY, journal):
            journal.append(job.index, cheap_row(job))
    return reproduced(place)


def disturb(kind: str, place: Path, expected: pa.Table, seed: int) -> None:
    """Run the study, kill a process, resume, and compare; raises AssertionError."""
    folder = place / "study"
    KINDS[kind](folder, random.Random(seed))
    assert reproduced(folder).equals(expected), "the tables differ"
    lines = (folder / TABLE).read_text().splitlines()
    assert [int(line.partition(",")[0]) for line in lines[1:]] == list(range(len(STUDY.points)))


def main() -> None:
    """Disturb as many studies as asked for; exit code 1 if a table differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kills", type=int, nargs="?", default=20)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--run", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--scheduler", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.run:
        return run(arguments.run, arguments.scheduler)
    good = 0
    with tempfile.TemporaryDirectory() as place:
        expected = undisturbed(Path(place) / "expected")
        for number in range(arguments.kills):
            kind, folder = arguments.kinds[number % len(arguments.kinds)], Path(place) / str(number)
            folder.mkdir()
            try:
                disturb(kind, folder, expected, arguments.seed + number)
                good += 1
                print(f"{number}: {kind}: equal", flush=True)
            except (AssertionError, subprocess.TimeoutExpired) as error:
                print(f"{number}: {kind}: {error}", flush=True)
    print(f"{good} of {arguments.kills}")
    sys.exit(good < arguments.kills)


if __name__ == "__main__":
    main()
