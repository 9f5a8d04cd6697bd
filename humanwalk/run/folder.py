"""A run on disk: one folder with the scenario, the signals, the summary, the replay and the plots."""

import fcntl
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from humanwalk.files import make_folder, write_text, write_whole
from humanwalk.measures.signals import TIME, column_of, unit_of
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.provenance import provenance
from humanwalk.scenario import Scenario, dump_scenario, load_scenario

SCENARIO = "scenario.yaml"
SIGNALS = "signals.parquet"
SUMMARY = "summary.json"
REPLAY = "replay.html"
PLOTS = "plots"
RECORDING = "recording"
MAPPING = "mapping.yaml"
"""Copies of what the run followed; the recording has its own suffix."""

SIGNALS_BYTES_PER_ROW = 2600
REPLAY_BYTES_PER_FRAME = 11_000
OTHER_BYTES = 20_000_000
"""What a run needs on a disk, with a third to spare: 15 s have 3001 rows in 5.6 MB and 480 frames in 4.9 MB."""


@dataclass(frozen=True)
class Run:
    """A run folder that is complete enough to look at: scenario, signals and summary are there."""

    path: Path

    @staticmethod
    def open(path: Path | str) -> "Run":
        """The run in a folder.

        Raises:
            ParameterError: the folder holds no run.
        """
        path = Path(path)
        for name in (SCENARIO, SIGNALS, SUMMARY):
            if not (path / name).is_file():
                raise ParameterError(
                    f"{path}: no run, {name} is missing; allowed: a folder written by humanwalk walk; "
                    "give its path, or walk again"
                )
        return Run(path)

    @cached_property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return load_scenario(self.path / SCENARIO)

    @cached_property
    def signals(self) -> pa.Table:
        """The record; see `humanwalk.measures.signals`."""
        return pq.read_table(self.path / SIGNALS)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The measures; see `humanwalk.measures.summary.summarize`."""
        summary: dict[str, Any] = json.loads((self.path / SUMMARY).read_text(encoding="utf-8"))
        return summary

    def require_physics(self) -> None:
        """Raise ParameterError unless there are torques and forces."""
        if self.scenario.follow.kinematic:
            raise ParameterError(
                f"{self.path}: a kinematic run has no forces and no torques; allowed: one with physics; walk again "
                "without --kinematic"
            )

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal, "" for a pure number."""
        return {name: unit_of(name) for name in self.signals.column_names}

    @property
    def time(self) -> Array:
        """When the signals were sampled [s], shape (rows,)."""
        return self[TIME]

    def __getitem__(self, name: str) -> Array:
        """A signal, shape (rows,), by its column's name with or without the unit: run["com.x"].

        Raises:
            ParameterError: there is none of that name.
        """
        values: Array = self.signals[column_of(self.signals.column_names, name)].to_numpy()
        return values

    @property
    def replay(self) -> Path:
        """The replay page.

        Raises:
            ParameterError: the run was walked without.
        """
        page = self.path / REPLAY
        if not page.is_file():
            raise ParameterError(
                f"{self.path}: no {REPLAY}; allowed: a run that was walked with its replay; "
                "walk again without --no-replay"
            )
        return page

    @property
    def plots(self) -> Path:
        """The folder of plots."""
        return self.path / PLOTS


def new_run_folder(wanted: Path | None, scenario_name: str) -> tuple[Path, list[Path]]:
    """Make the folder of a new run: the wanted one, else runs/NAME, runs/NAME-2, and so on.

    Returns:
        The folder, and the folders that were made for it, innermost first.

    Raises:
        ParameterError: the wanted folder is not empty, or cannot be made.
    """
    if wanted is not None:
        if wanted.is_dir() and any(wanted.iterdir()):
            raise ParameterError(
                f"-o {wanted}: holds files already; allowed: a new or empty folder; choose another, or remove it first"
            )
        return wanted, make_folder(wanted)
    number = 1
    while True:
        path = Path("runs") / (scenario_name if number == 1 else f"{scenario_name}-{number}")
        parents = make_folder(path.parent)
        # Of two runs that start together only one makes the folder.
        with suppress(FileExistsError):
            path.mkdir()
            return path, [path, *parents]
        number += 1


@contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Within the block, no other run writes into the folder; the system ends the claim with the process.

    Raises:
        ParameterError: another run has claimed it, or has written into it meanwhile.
    """
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if any(folder.iterdir()):
            raise BlockingIOError
        yield
    except BlockingIOError:
        raise ParameterError(
            f"-o {folder}: another run writes into it; allowed: a folder for every run; choose another"
        ) from None
    finally:
        os.close(handle)


def require_room(folder: Path, scenario: Scenario) -> None:
    """Raise ParameterError unless the disk has room for the run: better now than when it is simulated."""
    rows = scenario.duration / scenario.recording.signal_period
    frames = scenario.duration * scenario.recording.frame_rate
    needed = SIGNALS_BYTES_PER_ROW * rows + REPLAY_BYTES_PER_FRAME * frames + OTHER_BYTES
    # What cannot be read is refused by who reads it, with the reason.
    with suppress(OSError, ValueError):
        needed += Path(scenario.follow.file).stat().st_size if scenario.follow.file else 0
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise ParameterError(
            f"-o {folder}: {free / 1e6:.0f} MB are free on that disk; allowed: from about {needed / 1e6:.0f} MB on for "
            f"{scenario.duration:g} s; make room, choose another folder, or record less (recording.signal_period)"
        )


def write_run(path: Path, scenario: Scenario, signals: pa.Table, summary: dict[str, Any]) -> Run:
    """Write a simulation into its folder, each file whole or not at all.

    The summary comes last: a folder that has one is a complete run. A followed recording and its mapping are copied
    into the folder, and the scenario in the folder follows the copies.

    Args:
        path: the folder.
        scenario: what was simulated.
        signals: the record.
        summary: its measures, see `humanwalk.measures.summary.summarize`; the provenance is added.
    """
    summary = summary | {"provenance": provenance(scenario, signals)}
    metadata = {b"humanwalk": json.dumps({"scenario": summary["scenario"]} | summary["provenance"]).encode()}
    signals = signals.replace_schema_metadata(metadata)
    write_text(path / SCENARIO, dump_scenario(_keep_followed(path, scenario)))
    write_whole(path / SIGNALS, lambda beside: pq.write_table(signals, beside, compression="zstd"))
    write_text(path / SUMMARY, json.dumps(summary, indent=2) + "\n")
    return Run(path)


def _keep_followed(path: Path, scenario: Scenario) -> Scenario:
    """Copy the recording and the mapping that a scenario follows; returns the scenario that follows the copies."""
    follow = scenario.follow
    kept: dict[str, Any] = {}
    names = {"file": RECORDING + Path(follow.file).suffix.lower(), "mapping": MAPPING}
    for field, name in names.items():
        followed = getattr(follow, field)
        # One that was moved while it was simulated stays where it was; a checkpoint has copied it before.
        if followed and Path(followed).is_file():
            if not (path / name).exists():
                write_whole(path / name, partial(shutil.copyfile, followed))
            kept[field] = name
    return replace(scenario, follow=replace(follow, **kept))
