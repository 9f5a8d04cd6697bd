"""Clusters that are not worker processes of this one."""

import os
from pathlib import Path
from typing import Any

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.study.cluster import local_client, slurm_client
from humanwalk.study.execute import run_jobs
from humanwalk.study.row import Job, Row

SBATCH = """#!/bin/sh
cp "$1" {folder}/job.sh
setsid sh {folder}/job.sh >{folder}/log 2>&1 &
echo "Submitted batch job $!"
"""
SCANCEL = '#!/bin/sh\nkill -- "-$1"\n'


def test_slurm_jobs_are_the_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A script that starts the job on this machine stands for SLURM."""
    for name, text in (("sbatch", SBATCH.format(folder=tmp_path)), ("scancel", SCANCEL)):
        (tmp_path / name).write_text(text)
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    file = tmp_path / "slurm.yaml"
    file.write_text(
        "cores: 2\nmemory: 4GB\nqueue: short\ninterface: lo\n"
        f"directives: [--exclude=node7]\nprologue: [export PYTHONPATH={Path.cwd()}, export PLACE=node]\n"
    )
    rows: list[Row] = []

    def place(job: Job) -> Row:
        return {name: os.environ[name] for name in ("PLACE", "OMP_NUM_THREADS")}

    with slurm_client(file) as client:
        run_jobs(client, place, [Job(index, Scenario()) for index in range(4)], lambda job, row: rows.append(row))
    assert rows == [{"PLACE": "node", "OMP_NUM_THREADS": "1"}] * 4
    script = (tmp_path / "job.sh").read_text()
    for option in ("-p short", "--cpus-per-task=2", "-t 01:00:00", "--exclude=node7"):
        assert f"#SBATCH {option}\n" in script


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("cores: 0", "cores: 0 is out of range"),
        ("core: 1", "did you mean cores"),
        ("memory: much", "memory: much is not enough"),
        ("cores: 64\nmemory: 4GB", "memory: 4GB is not enough for cores: 64; allowed: .* from 32000MB"),
        ("memory: 1e999GB", "memory: 1e999GB is not enough"),
    ],
)
def test_slurm_files_that_cannot_be_used_are_refused_in_one_line(tmp_path: Path, text: str, match: Any) -> None:
    file = tmp_path / "slurm.yaml"
    file.write_text(text)
    with pytest.raises(ParameterError, match=match) as raised, slurm_client(file):
        pass
    assert str(raised.value).isprintable()


@pytest.mark.parametrize("workers", [0, -1])
def test_no_workers_are_refused(workers: int) -> None:
    refusal = rf"^workers: {workers}; allowed: 1 or more, None for one per core; "
    with pytest.raises(ParameterError, match=refusal), local_client(workers):
        pass
