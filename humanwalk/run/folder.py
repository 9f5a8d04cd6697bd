"""A run on disk: one folder with the scenario, the signals, the summary, the replay and the plots."""

import json
import logging
import math
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from operator import methodcaller
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from humanwalk.files import (
    READABLE,
    WRITABLE,
    file_errors,
    file_of,
    locked,
    make_folder,
    read_regular,
    require_empty,
    require_inside,
    write_set,
    write_text,
    write_whole,
)
from humanwalk.measures.signals import TIME, column_of, unit_of
from humanwalk.measures.summary import Summary
from humanwalk.measures.summary_rows import summary_rows, summary_title
from humanwalk.notebook import html_table
from humanwalk.numerics import Array
from humanwalk.parameter_file import MAX_KEPT_SIZE, read_fields
from humanwalk.quantity import ParameterError, file_paths, printable, replace_file_paths
from humanwalk.run.provenance import MAX_FOLLOWED_BYTES, provenance, scenario_hash
from humanwalk.run.stored import MAX_ROWS, RunSummary, read_signals, read_summary
from humanwalk.scenario import Scenario, dump_scenario, parse_scenario

logger = logging.getLogger(__name__)

RUNS = Path("runs")
"""Folder of the runs for which no other is named."""

SCENARIO = "scenario.yaml"
SIGNALS = "signals.parquet"
SUMMARY = "summary.json"
REPLAY = "replay.html"
PLOTS = "plots"
"""Names inside a run folder."""


MAX_SUFFIX = 16
"""Longest suffix of a file that its copy keeps [bytes]: with the field's name, a longer one makes no name of a file.
Formats that are told by their suffix have shorter ones."""

SIGNALS_BYTES_PER_ROW = 3000
REPLAY_BYTES_PER_FRAME = 11_000
OTHER_BYTES = 20_000_000
"""Upper bounds of the size of a run: 14 s of the balanced walk have 1401 rows in 3.2 MB, and a replay of 5.1 MB."""


@dataclass(frozen=True, repr=False)
class Run:
    """A run folder with scenario, signals and summary; each of them is read and checked on first use."""

    path: Path

    def __repr__(self) -> str:
        """Path, scenario, end and duration."""
        try:
            return f"Run({str(self.path)!r}, {summary_title(self.summary)})"
        except ParameterError as error:
            return f"Run({str(self.path)!r}, {error})"

    def _repr_html_(self) -> str:
        return html_table(f"{printable(self.path)}: {summary_title(self.summary)}", summary_rows(self.summary))

    @staticmethod
    def open(path: Path | str) -> "Run":
        """The run in a folder.

        Raises:
            ParameterError: the folder holds no run, or cannot be read.
        """
        path = Path(path)
        for name in (SCENARIO, SIGNALS, SUMMARY):
            file_of(path, name, "run", "humanwalk walk")
        return Run(path)

    @cached_property
    def scenario(self) -> Scenario:
        """What was simulated; a warning is logged if it is not what the summary is of.

        Raises:
            ParameterError: it is no scenario, reads a file outside the run folder, or the summary cannot be read.
        """
        path = self.path / SCENARIO
        scenario = parse_scenario(read_fields(path, MAX_KEPT_SIZE), name=printable(path), folder=self.path)
        for file in file_paths(scenario).values():
            require_inside(self.path, Path(file))
        if scenario_hash(scenario) != self.summary["provenance"]["scenario_sha256"]:
            logger.warning(
                "%s: %s was changed since the run, or this version reads its fields differently; restore it, or walk "
                "again",
                self.path,
                SCENARIO,
            )
        return scenario

    @cached_property
    def signals(self) -> pa.Table:
        """The record; see `humanwalk.measures.signals` and `humanwalk.run.stored.read_signals`."""
        return read_signals(self.path / SIGNALS, self.scenario, self.summary["provenance"]["signals_sha256"])

    @cached_property
    def summary(self) -> RunSummary:
        """The measures; see `humanwalk.measures.summary.Summary`."""
        return read_summary(self.path / SUMMARY)

    def require_physics(self) -> None:
        """Raise ParameterError unless there are torques and forces."""
        if not self.scenario.controller.physics:
            raise ParameterError(
                f"{printable(self.path)}: a kinematic run has no forces and no torques; allowed: one with physics; "
                "walk again without --kinematic"
            )

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal, "" for a pure number."""
        return {name: unit_of(name) for name in self.signals.column_names}

    @property
    def time(self) -> Array:
        """Times of the samples [s], shape (rows,)."""
        return self[TIME]

    def __getitem__(self, name: str) -> Array:
        """A signal, shape (rows,), by its column's name with or without the unit: run["com.x"].

        Raises:
            ParameterError: no signal has that name.
        """
        values: Array = self.signals[column_of(self.signals.column_names, name)].to_numpy()
        return values

    @property
    def replay(self) -> Path:
        """The replay page.

        Raises:
            ParameterError: the run was walked without it.
        """
        with file_errors(self.path, READABLE):
            page = require_inside(self.path, self.path / REPLAY)
            found = page.is_file()
        if not found:
            raise ParameterError(
                f"{printable(self.path)}: no {REPLAY}; allowed: a run with its replay; make it with: "
                f"humanwalk replay {printable(self.path)}"
            )
        return page

    @property
    def plots(self) -> Path:
        """The folder of plots."""
        return self.subfolder(PLOTS)

    def subfolder(self, name: str) -> Path:
        """A folder for results inside the run folder, which may not exist yet.

        Raises:
            ParameterError: it is a symbolic link that leads out of the run folder.
        """
        return require_inside(self.path, self.path / name)


def new_run_folder(wanted: Path | None, otherwise: Path) -> tuple[Path, list[Path]]:
    """Make the folder of a new run.

    Args:
        wanted: A new or empty folder; None for the first free one of runs/walk, runs/walk-2, and so on.
        otherwise: The first of those: runs/walk.

    Returns:
        The folder, and the folders that were made for it, innermost first.

    Raises:
        ParameterError: the wanted folder is not empty, or cannot be made.
    """
    if wanted is not None:
        made = make_folder(wanted)
        require_empty(wanted)
        return wanted, made
    number = 1
    while True:
        path = otherwise if number == 1 else otherwise.with_name(f"{otherwise.name}-{number}")
        parents = make_folder(path.parent)
        # Of two runs that start together only one makes the folder.
        with file_errors(path, WRITABLE), suppress(FileExistsError):
            str(path).encode()
            path.mkdir()
            return path, [path, *parents]
        number += 1


@contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Within the block, no other run writes into the folder; the claim ends with the process.

    Raises:
        ParameterError: another run has claimed it, or has written into it meanwhile.
    """
    refusal = f"-o {printable(folder)}: another run writes into it; allowed: a folder for every run; choose another"
    with locked(folder, refusal):
        with file_errors(folder, WRITABLE):
            if any(folder.iterdir()):
                raise ParameterError(refusal)
        yield


def require_room(folder: Path, scenario: Scenario) -> None:
    """Raise ParameterError, before the simulation, unless the disk has room for the run."""
    rows = scenario.duration / scenario.recording.signal_period
    if rows + 1 > MAX_ROWS:
        least = math.ceil(1e4 * scenario.duration / (MAX_ROWS - 1)) / 1e4
        raise ParameterError(
            f"recording.signal_period: {rows:.0f} rows in {scenario.duration:g} s; allowed: up to {MAX_ROWS}; "
            f"set it to {least:g} s or more, or walk shorter"
        )
    frames = scenario.duration * scenario.recording.frame_rate
    needed = SIGNALS_BYTES_PER_ROW * rows + REPLAY_BYTES_PER_FRAME * frames + OTHER_BYTES
    # A recording that cannot be read is refused by its reader.
    with suppress(OSError, ValueError):
        needed += sum(Path(file).stat().st_size for file in file_paths(scenario).values())
    with file_errors(folder, WRITABLE):
        free = shutil.disk_usage(folder).free
    if free < needed:
        raise ParameterError(
            f"-o {printable(folder)}: {free / 1e6:.0f} MB are free on that disk; allowed: from about "
            f"{needed / 1e6:.0f} MB for {scenario.duration:g} s; make room, choose another folder, or record less "
            "(recording.signal_period)"
        )


def write_run(path: Path, scenario: Scenario, signals: pa.Table, summary: Summary) -> Run:
    """Write a simulation into its folder, each file whole or not at all.

    A folder that has a summary is a complete run: a checkpoint replaces signals and summary together. The files that
    the scenario reads are copied into the folder, and the scenario in the folder reads the copies. The provenance is
    added to the summary.
    """
    origin = provenance(scenario, signals)
    metadata = {b"humanwalk": json.dumps({"scenario": summary["scenario"], **origin}).encode()}
    signals = signals.replace_schema_metadata(metadata)
    write_text(path / SCENARIO, dump_scenario(_keep_files(path, scenario)))
    text = json.dumps({**summary, "provenance": origin}, indent=2) + "\n"
    write_set(
        {
            path / SIGNALS: lambda beside: pq.write_table(signals, beside, compression="zstd"),
            path / SUMMARY: lambda beside: beside.write_text(text, encoding="utf-8"),
        }
    )
    return Run(path)


def _keep_files(path: Path, scenario: Scenario) -> Scenario:
    """Copy the files that a scenario reads; returns the scenario that reads the copies."""
    files = file_paths(scenario)
    names = {field: kept_name(field, file) for field, file in files.items()}
    for field, name in names.items():
        with file_errors(path, WRITABLE):
            kept = (path / name).exists()
        if not kept:
            # One that was moved during the simulation is missing in the run folder, unless a checkpoint has copied it.
            with suppress(ParameterError):
                content = read_regular(Path(files[field]), MAX_FOLLOWED_BYTES)
                write_whole(path / name, methodcaller("write_bytes", content))
    return replace_file_paths(scenario, names)


def kept_name(field: str, file: str) -> str:
    """Name in a run folder of the copy of a file that a field of the scenario names; see `MAX_SUFFIX`."""
    suffix = Path(file).suffix.lower()
    return f"{field}{suffix if len(os.fsencode(suffix)) <= MAX_SUFFIX else ''}"
