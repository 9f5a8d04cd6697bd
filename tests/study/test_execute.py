"""Jobs on worker processes: nothing is lost, nothing comes twice.

Each test starts real worker processes, which takes some seconds; cheap functions stand for the simulation.
"""

import importlib.util
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.scenario import Scenario
from humanwalk.study.cluster import KILLS_ALLOWED, local_client, remote_client
from humanwalk.study.execute import Shard, list_jobs, run_jobs, run_study
from humanwalk.study.row import Job, Row, run_columns
from humanwalk.study.study import parse_study
from humanwalk.study.table import ROW, TABLE, open_journal, read_table, table_columns

ROOT = Path(__file__).parents[2]
COMMAND = "from humanwalk.cli.main import main; main()"


def jobs(number: int) -> list[Job]:
    return [Job(index, Scenario()) for index in range(number)]


def collected(client: Any, function: Callable[[Job], Row], wanted: list[Job]) -> dict[int, Row]:
    rows: dict[int, Row] = {}

    def add(job: Job, row: Row) -> None:
        assert job.index not in rows
        rows[job.index] = row

    run_jobs(client, function, wanted, add)
    return rows


def test_every_job_gives_a_row_whatever_happens_to_its_worker() -> None:
    def eventful(job: Job) -> Row:
        if job.index == 2:
            raise ValueError("two\nlines")
        if job.index == 3:
            raise ParameterError("duration: too long")
        if job.index == 5:
            os._exit(1)
        if job.index == 8:
            hog = bytearray(700_000_000)
            time.sleep(60.0)
            del hog
        return {"end": "completed", "threads": os.environ["OMP_NUM_THREADS"]}

    with local_client(2, memory_limit="600MB") as client:
        rows = collected(client, eventful, jobs(40))
    killed = f"killed its worker {KILLS_ALLOWED} times"
    ends = {2: r"error: ValueError: two\nlines", 3: "refused: duration: too long", 5: killed, 8: killed}
    assert len(rows) == 40
    for index, row in rows.items():
        if index in ends:
            assert row == {"end": ends[index], "survived": False}
        else:
            assert row == {"end": "completed", "threads": "1"}


def test_jobs_are_taken_as_there_is_room_and_dropped_when_stopped() -> None:
    taken = []

    def endless() -> Any:
        for job in jobs(100_000):
            taken.append(job.index)
            yield job

    rows: list[Row] = []
    with local_client(1) as client:
        run_jobs(
            client, lambda job: {"end": "completed"}, endless(), lambda _, row: rows.append(row), lambda: len(rows) > 50
        )
    assert 50 < len(rows) <= len(taken) < 500


def test_study_writes_rows_and_run_folders(tmp_path: Path) -> None:
    study = parse_study("set: {duration: 0.02}\nfactors: {seed: [4, 7]}\nkeep: runs")
    with local_client(1) as client:
        table = run_study(study, tmp_path / "out", client)
        again = run_study(study, tmp_path / "out", client, function=never_called)
    assert again.equals(table)
    for index, row in enumerate(table.to_pylist()):
        run = Run.open(tmp_path / "out" / "runs" / f"{index:06d}")
        assert (row["end"], row["survived"], row["seed"]) == ("completed", True, run.scenario.seed)
        assert row["peak_torque_N_m.RightLegTibiaMotion"] == run.summary["peak_torque_N_m"]["RightLegTibiaMotion"]
        assert row["versions.drake"] == run.summary["versions"]["drake"]
    assert table.column_names[1:] == list(dict.fromkeys(["seed", *run_columns()]))


@pytest.mark.parametrize("link", ["runs", "runs/000000"])
def test_no_run_folder_is_outside_the_folder_of_the_study(tmp_path: Path, link: str) -> None:
    study = parse_study("keep: runs")
    outside, path = tmp_path / "outside", tmp_path / "out" / link
    outside.mkdir()
    with open_journal(tmp_path / "out", study) as journal:
        path.parent.mkdir(exist_ok=True)
        path.symlink_to(outside)
        with pytest.raises(ParameterError, match=r"runs/000000: leads out of .*remove the link"):
            list(list_jobs(study, journal))


@given(count=st.integers(1, 50), points=st.integers(1, 200))
def test_shards_have_every_point_once(count: int, points: int) -> None:
    study = parse_study(f"factors: {{seed: {{seeds: {{count: {points}}}}}}}")
    shards = [Shard.parse(f"{number}/{count}") for number in range(1, count + 1)]
    assert all(sum(shard.has(index) for shard in shards) == 1 for index in range(points))
    for shard in shards:
        assert shard.size(study) == sum(shard.has(index) for index in range(points))


def test_progress_of_a_shard_counts_its_own_rows(tmp_path: Path) -> None:
    study = parse_study("factors: {seed: {seeds: {count: 5}}}")
    counts: list[tuple[int, int]] = []
    with local_client(1) as client:
        for shard in (Shard(1, 2), Shard(2, 2)):
            run_study(
                study,
                tmp_path,
                client,
                lambda done, total, row: counts.append((done, total)),
                function=lambda job: {"end": "failed"},
                shard=shard,
            )
    assert counts == [(1, 3), (2, 3), (3, 3), (1, 2), (2, 2)]


@pytest.mark.parametrize("text", ["", "2", "0/3", "4/3", "1/0", "-1/3", "1/3/3", "1.0/3", "1/" + "9" * 5000])
def test_text_that_is_no_shard_is_refused(text: str) -> None:
    with pytest.raises(ParameterError, match="not a part of a study"):
        Shard.parse(text)


def never_called(job: Job) -> Row:
    raise AssertionError(job)


def test_study_with_a_point_that_cannot_be_simulated_makes_no_folder(tmp_path: Path) -> None:
    study = parse_study("factors: {duration: [1, -1]}")
    with pytest.raises(ParameterError, match=r"point \(duration: -1\)"):
        run_study(study, tmp_path / "out", None)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_scheduler_that_does_not_answer_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("humanwalk.study.cluster.CONNECT_TIMEOUT", 0.5)
    for address in ("tcp://127.0.0.1:9", "nonsense", "tcp://", "tls://127.0.0.1:9", "ucx://127.0.0.1:9"):
        with pytest.raises(ParameterError, match="start one with: dask scheduler") as raised, remote_client(address):
            pass
        assert str(raised.value).isprintable()


# kill -9.


@pytest.fixture(scope="module")
def kills() -> Any:
    """benchmarks/study_kills.py, which has the disturbances."""
    spec = importlib.util.spec_from_file_location("study_kills", ROOT / "benchmarks" / "study_kills.py")
    module = importlib.util.module_from_spec(spec)  # type: ignore[arg-type]
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("kind", ["worker", "command", "scheduler"])
def test_study_whose_process_is_killed_ends_with_the_undisturbed_table(kills: Any, tmp_path: Path, kind: str) -> None:
    expected = kills.undisturbed(tmp_path / "expected")
    kills.disturb(kind, tmp_path, expected, random.SystemRandom().randrange(2**32))


# The command.


def start(folder: Path, *arguments: str, before: str = "") -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", before + COMMAND, "study", "study.yaml", "-o", "out", "--workers", "1", *arguments],
        cwd=folder,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )


def lines(folder: Path) -> int:
    table = folder / "out" / TABLE
    return table.read_bytes().count(b"\n") if table.exists() else 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_to_command_and_workers_ends_the_study_which_resumes(tmp_path: Path, number: int) -> None:
    """As Ctrl-C in a terminal, which reaches all processes of the command."""
    (tmp_path / "study.yaml").write_text("set: {duration: 0.02}\nfactors: {seed: {seeds: {count: 1000}}}")
    process = start(tmp_path)
    try:
        while lines(tmp_path) < 3:
            assert process.poll() is None, process.stderr.read()
            time.sleep(0.02)
        os.killpg(process.pid, number)
        _, errors = process.communicate(timeout=120)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 130, errors
    assert errors.splitlines()[-1] == "interrupted; the same command resumes"
    assert "Traceback" not in errors
    table = read_table(tmp_path / "out")
    assert 2 <= table.num_rows == lines(tmp_path) - 1
    assert table["end"].to_pylist() == ["completed"] * table.num_rows


FULL = (
    "import resource, signal;"
    "signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
    "resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}));"
)


def test_full_disk_keeps_the_rows_that_it_has_room_for(tmp_path: Path) -> None:
    """A limit of the size of files stands for the full disk."""
    study = "set: {duration: 0.02}\nfactors: {seed: {seeds: {count: 6}}}"
    (tmp_path / "study.yaml").write_text(study)
    header = len(",".join(table_columns(parse_study(study))))
    process = start(tmp_path, before=FULL.format(limit=header + 4000))
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 2, errors
    assert errors.splitlines()[-1].startswith("humanwalk: out/table.csv: File too large")
    assert "Traceback" not in errors
    kept = read_table(tmp_path / "out")[ROW].to_pylist()
    assert 0 < len(kept) < 6
    resumed = start(tmp_path)
    _, errors = resumed.communicate(timeout=120)
    assert resumed.returncode == 0, errors
    assert read_table(tmp_path / "out")[ROW].to_pylist() == list(range(6))
