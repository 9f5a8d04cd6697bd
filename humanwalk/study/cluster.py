"""Dask clusters for studies: processes of this machine, a running scheduler, or SLURM jobs."""

import gc
import logging
import os
import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from humanwalk.extras import missing_package
from humanwalk.parameter_file import load_as
from humanwalk.quantity import ParameterError, printable, quantity

try:
    import dask
    from dask.utils import parse_bytes
    from distributed import Client, LocalCluster
except ImportError:
    raise missing_package("dask", "study") from None

KILLS_ALLOWED = 3
"""A run that kills its worker so many times is not repeated."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""Environment of workers: the processes share the cores."""

SETTINGS: dict[str, Any] = {
    # One task per worker: the death of a worker counts against the run that it was at, and no other.
    "distributed.scheduler.worker-saturation": 1.0,
    "distributed.scheduler.allowed-failures": KILLS_ALLOWED - 1,
    "distributed.scheduler.work-stealing": False,
    # No pages are served; the ports remain, on the loopback interface.
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
    "distributed.worker.profile.enabled": False,
    # A worker near its limit would take no further run but stay.
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.nanny.pre-spawn-environ": ONE_THREAD | {"MALLOC_TRIM_THRESHOLD_": "65536"},
    # After this time a worker that is not back is given up, and its core idle: a busy machine starts one slowly.
    "distributed.deploy.lost-worker-timeout": "1 day",
    "distributed.admin.log-length": 100,
}
"""Dask's settings for studies."""


def usable_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def local_client(workers: int | None = None, memory_limit: str | int = "auto") -> Iterator[Client]:
    """Client of worker processes on this machine, each with one thread; they end with the block, or with this process.

    Args:
        workers: their number; None for one per core.
        memory_limit: of each worker [bytes]; a worker above 95 % of it is killed. Default: its share of the machine's.

    Raises:
        ParameterError: no workers are asked for.
    """
    if workers is not None and workers < 1:
        raise ParameterError(f"workers: {workers}; allowed: 1 or more, None for one per core; write one of these")
    with _quiet(), dask.config.set(SETTINGS), ExitStack() as stack:
        with _interrupts_ignored():
            cluster = stack.enter_context(
                LocalCluster(
                    n_workers=workers or usable_cores(),
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    dashboard_address=None,
                    # Without an address it would be the fixed port 8787.
                    scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                    memory_limit=memory_limit,
                    silence_logs=logging.CRITICAL,
                )
            )
        yield stack.enter_context(Client(cluster, set_as_default=False))


@contextmanager
def remote_client(address: str) -> Iterator[Client]:
    """Client of a running Dask scheduler.

    Args:
        address: "tcp://127.0.0.1:8786".

    Raises:
        ParameterError: there is none.
    """
    with _quiet():
        try:
            client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
        # A protocol that this machine is not set up for, like tls without keys, is a TypeError of Dask.
        except (OSError, ValueError, TypeError) as error:
            problem = printable(error) or type(error).__name__
        else:
            problem = ""
        if problem:
            # Dask closes a client that did not connect when it is collected, and locks up if that is while another
            # one starts.
            gc.collect()
            raise ParameterError(
                f"--scheduler {printable(address)}: {problem}; allowed: the address of a running Dask scheduler, like "
                "tcp://127.0.0.1:8786; start one with: dask scheduler --host 127.0.0.1"
            )
        with client:
            yield client


MIN_MEMORY = 500_000_000
"""Least memory of a worker [bytes]: with Drake it starts with 300 MB."""


@dataclass(frozen=True)
class SlurmParameters:
    """SLURM jobs whose processes are the workers; see dask_jobqueue.SLURMCluster."""

    jobs: int = quantity(1, "", 1, 10_000)
    """Number of jobs."""

    cores: int = quantity(1, "", 1, 1024)
    """Cores of a job, and its number of worker processes."""

    memory: str = "4GB"
    """Memory of a job; its workers share it equally, and each needs at least 500 MB."""

    walltime: str = "01:00:00"
    """Time limit of a job; a run that it ends is repeated by another job."""

    queue: str = ""
    """Partition; empty for the default one."""

    account: str = ""
    """Account that is charged; empty for the default one."""

    interface: str = ""
    """Network interface of scheduler and workers, like ib0; empty for the default one."""

    directives: tuple[str, ...] = ()
    """Further options of sbatch, like `--exclude=node7`."""

    prologue: tuple[str, ...] = ()
    """Lines of shell before the workers start, like `source ~/humanwalk/.venv/bin/activate`."""

    def __post_init__(self) -> None:
        """Raise ParameterError if `memory` is not an amount of memory, or is too small for the workers."""
        try:
            enough = parse_bytes(self.memory) >= self.cores * MIN_MEMORY
        except (ValueError, OverflowError):
            enough = False
        if not enough:
            raise ParameterError(
                f"memory: {printable(self.memory, 40)} is not enough for cores: {self.cores}; allowed: 500MB for each, "
                f"here from {self.cores * MIN_MEMORY // 10**6}MB; write it like 4GB, or fewer cores"
            )


@contextmanager
def slurm_client(file: Path) -> Iterator[Client]:
    """Client of workers in SLURM jobs, which are submitted here and end with the block.

    The scheduler is in this process, and listens on the network: it is for a machine that the compute nodes reach.

    Args:
        file: YAML file of `SlurmParameters`.

    Raises:
        ParameterError: the file cannot be used, or SLURM refuses the jobs.
    """
    try:
        from dask_jobqueue.slurm import SLURMCluster
    except ImportError:
        raise missing_package("dask-jobqueue", "slurm") from None
    slurm = load_as(SlurmParameters, file)
    environment = [f"export {name}={value}" for name, value in ONE_THREAD.items()]
    with _quiet(), dask.config.set(SETTINGS), ExitStack() as stack:
        try:
            cluster = stack.enter_context(
                SLURMCluster(
                    queue=slurm.queue or None,
                    account=slurm.account or None,
                    cores=slurm.cores,
                    processes=slurm.cores,
                    memory=slurm.memory,
                    walltime=slurm.walltime,
                    interface=slurm.interface or None,
                    job_extra_directives=list(slurm.directives),
                    job_script_prologue=[*environment, *slurm.prologue],
                    scheduler_options={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
                    silence_logs=logging.CRITICAL,
                )
            )
            cluster.scale(jobs=slurm.jobs)
            client = stack.enter_context(Client(cluster, set_as_default=False))
        except (OSError, ValueError, RuntimeError) as error:
            raise ParameterError(
                f"--slurm {printable(file)}: {printable(error, 500)}; allowed: options that sbatch of this machine "
                "takes; correct the file"
            ) from None
        yield client


CONNECT_TIMEOUT = 10.0
"""Time for a scheduler to answer [s]."""


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Within the block, processes are started that Ctrl-C of the terminal does not reach: the command ends them."""
    try:
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    except ValueError:
        # Not the main thread, which alone may handle signals.
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


LOGGERS = ("distributed", "distributed.client", "distributed.worker", "distributed.nanny", "tornado", "asyncio")


@contextmanager
def _quiet() -> Iterator[None]:
    """Within the block, Dask prints nothing: what matters is an error or a row."""
    levels = {name: logging.getLogger(name).level for name in LOGGERS}
    for name in LOGGERS:
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for name, level in levels.items():
            logging.getLogger(name).setLevel(level)
