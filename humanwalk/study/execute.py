"""Runs of a study on Dask workers.

Guarantees of `run_jobs`: each job gives one row, in the order in which they finish. A worker that dies costs only the
runs that it was at, which are repeated; a run whose worker dies again and again becomes a row that tells so, and so
does a run that raises an exception. The number of futures that are alive at a time does not grow with that of jobs.
The process that holds the client decides alone which rows are written.
"""

import re
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Protocol

import pyarrow as pa

from humanwalk.extras import missing_package
from humanwalk.files import require_inside
from humanwalk.quantity import ParameterError, printable, require_kind
from humanwalk.study.row import ERROR, KILLED, REFUSED, Job, Row, failed, simulate_row
from humanwalk.study.study import Study
from humanwalk.study.table import RUNS, Journal, open_journal, read_table

try:
    from dask.task_spec import Task
    from distributed import Client, Future
    from distributed.protocol.pickle import dumps, loads
    from distributed.scheduler import KilledWorker
except ImportError:
    raise missing_package("dask", "study") from None

POLL_PERIOD = 0.2
"""Time between two looks at whether to stop [s]."""

UNFINISHED = ("pending", "lost")
"""States of a future whose result is not there, or no longer."""

MIN_ROOM = 32
"""Jobs that are at the cluster at a time, beyond four for each worker: short ones are handled in batches."""

THREADS_PERIOD = 2.0
"""Time between two counts of the workers [s]: they may join and leave at any time."""


class Indexed(Protocol):
    """A job: any value that can be pickled and has an index."""

    @property
    def index(self) -> int:
        """Of the job, different for each."""


def never() -> bool:
    """No reason to stop."""
    return False


def run_jobs[J: Indexed](
    client: Client,
    function: Callable[[J], Row],
    jobs: Iterable[J],
    on_row: Callable[[J, Row], None],
    should_stop: Callable[[], bool] = never,
) -> None:
    """Apply a function to jobs on the workers of a client, and hand on each row as it is finished.

    Args:
        client: of the Dask cluster.
        function: importable on the workers; an exception that it raises becomes a row, see `failed`.
        jobs: with different indices; they are taken one by one as there is room for them.
        on_row: called in this thread with a job and its row.
        should_stop: asked several times a second; true ends the work, and drops the unfinished jobs.

    Raises:
        ParameterError: the scheduler is gone. Rows that were handed on are unaffected.
    """
    prefix = f"{function.__name__}-{uuid.uuid4().hex}"
    waiting: dict[str, J] = {}
    futures: dict[str, Future[Any]] = {}
    finished = threading.Event()
    remaining = iter(jobs)
    room, counted = 0, -THREADS_PERIOD
    try:
        while not should_stop():
            if time.monotonic() - counted >= THREADS_PERIOD:
                room, counted = _room(client), time.monotonic()
            if len(waiting) <= room // 2:
                batch = {f"{prefix}-{job.index}": job for job in islice(remaining, room - len(waiting))}
                waiting |= batch
                for future in _submit(client, function, batch):
                    futures[str(future.key)] = future
                    future.add_done_callback(lambda _: finished.set())
            if not waiting:
                return
            # Dask calls back once, even for a result that is lost after that and computed again; so the event only
            # ends the wait, and the states tell which results are there.
            finished.wait(POLL_PERIOD)
            finished.clear()
            done = [future for future in futures.values() if future.status not in UNFINISHED]
            rows = _rows_of(client, done)
            for future in done:
                # The scheduler forgets a result that nobody holds.
                futures.pop(str(future.key)).release()
            for key, row in rows.items():
                on_row(waiting.pop(key), row)
    except OSError as error:
        raise _lost(client, error) from None
    finally:
        for future in futures.values():
            future.release()


def _room(client: Client) -> int:
    """Number of jobs that may be at the cluster: each worker has one, and the next ones are at the scheduler."""
    if client.status != "running":
        raise OSError("the connection is closed")
    threads: dict[str, int] = client.nthreads()
    return 4 * sum(threads.values()) + MIN_ROOM


def _submit[J](client: Client, function: Callable[[J], Row], jobs: Mapping[str, J]) -> list[Future[Any]]:
    """Futures of jobs by key."""
    # As data producers, tasks wait at the scheduler and not at a worker, where the death of the worker would count
    # against them; see worker-saturation in Dask's documentation. Dask hashes what it is given: bytes are quick.
    graph = {key: Task(key, _apply, function, dumps(job), _data_producer=True) for key, job in jobs.items()}
    futures: list[Future[Any]] = client.get(graph, list(graph), sync=False) if graph else []
    return futures


def _apply(function: Callable[[Any], Row], job: bytes) -> Row:
    return function(loads(job))


def _rows_of(client: Client, futures: list[Future[Any]]) -> dict[str, Row]:
    """Rows by key of futures that are done."""
    if any(future.status == "cancelled" for future in futures):
        raise OSError("the connection was lost")
    good = [future for future in futures if future.status != "error"]
    rows = dict(zip((str(future.key) for future in good), client.gather(good), strict=True)) if good else {}
    return {
        key: rows[key] if key in rows else _failure(future.exception())
        for future in futures
        if (key := str(future.key))
    }


def _failure(error: BaseException) -> Row:
    if isinstance(error, KilledWorker):
        return failed(f"{KILLED}{error.allowed_failures + 1} times")
    if isinstance(error, ParameterError):
        return failed(f"{REFUSED}{error}")
    return failed(f"{ERROR}{type(error).__name__}: {error}")


def _lost(client: Client, error: Exception) -> ParameterError:
    address = client.scheduler.address if client.scheduler else ""
    return ParameterError(
        f"scheduler {printable(address)}: {printable(error)}; allowed: one that is reachable until the end; finished "
        "rows are kept; start it, and give the same command again"
    )


@dataclass(frozen=True)
class Shard:
    """Every `count`-th point of a study, from the `number`-th one on: a part for a machine of its own."""

    number: int = 1
    count: int = 1

    @staticmethod
    def parse(text: str) -> "Shard":
        """The shard that text like "2/10" names.

        Raises:
            ParameterError: it names none.
        """
        found = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", text)
        if found is None or not 1 <= int(found[1]) <= int(found[2]):
            raise ParameterError(
                f"--shard {printable(text)}: not a part of a study; allowed: 1/10 to 10/10, or of another number; "
                "write the part and the number of parts"
            )
        return Shard(int(found[1]), int(found[2]))

    def has(self, index: int) -> bool:
        """Whether a point is in the shard."""
        return index % self.count == self.number - 1

    def size(self, study: Study) -> int:
        """Number of points of a study that are in the shard."""
        return len(study.points[self.number - 1 :: self.count])


WHOLE = Shard()
"""All points."""


def run_study(
    study: Study,
    folder: Path | str,
    client: Client,
    on_progress: Callable[[int, int, Row], None] = lambda done, all_rows, row: None,
    should_stop: Callable[[], bool] = never,
    function: Callable[[Job], Row] = simulate_row,
    shard: Shard = WHOLE,
) -> pa.Table:
    """Simulate the points of a study that its folder has no rows of, and return the table.

    Args:
        study: what to simulate.
        folder: of the table; a new one, or that of the same study, which resumes.
        client: of the Dask cluster; see `humanwalk.study.cluster`.
        on_progress: called with the number of finished rows of the shard, of all its rows, and each new row.
        should_stop: asked several times a second; true ends the study, which can be resumed.
        function: what a worker does with a job.
        shard: the part of the study to simulate; see `humanwalk.study.table.join`.

    Raises:
        ParameterError: a point or the folder cannot be used, or the scheduler is gone; finished rows are kept.
    """
    require_kind(study, Study, "run_study", 'load_study("balance_pushes"), ...')
    folder = Path(folder)
    study.require_valid()
    with open_journal(folder, study) as journal:

        def add(job: Job, row: Row) -> None:
            journal.append(job.index, row)
            on_progress(sum(map(shard.has, journal.done)), shard.size(study), row)

        try:
            run_jobs(client, function, list_jobs(study, journal, shard), add, should_stop)
        except BaseException:
            with suppress(ParameterError):
                journal.finish()
            raise
        journal.finish()
    return read_table(folder)


def list_jobs(study: Study, journal: Journal, shard: Shard = WHOLE) -> Iterator[Job]:
    """Jobs of the points of a shard that have no row, in order.

    Raises:
        ParameterError: a run folder leads out of the folder of the study.
    """
    within = journal.folder.absolute()
    for index, point in enumerate(study.points):
        if index not in journal.done and shard.has(index):
            kept = study.keep == "runs"
            folder = require_inside(within, within / RUNS / f"{index:06d}") if kept else None
            yield Job(index, study.scenario_at(point), folder)
