"""Origin of a run: what is needed to repeat it and to detect later changes."""

import hashlib
import platform
from importlib.metadata import version
from pathlib import Path
from typing import TypedDict

import numpy as np
import pyarrow as pa

from humanwalk.files import read_regular
from humanwalk.measures.summary import PACKAGES
from humanwalk.quantity import ParameterError, file_paths, replace_file_paths
from humanwalk.scenario import Scenario, dump_scenario

MAX_FOLLOWED_BYTES = 200_000_000
"""Largest file of a scenario that is hashed and copied into a run folder."""


class Provenance(TypedDict):
    """Origin of a run; hashes are SHA-256."""

    seed: int
    scenario_sha256: str
    signals_sha256: str
    files_sha256: dict[str, str | None]
    versions: dict[str, str]


def provenance(scenario: Scenario, signals: pa.Table) -> Provenance:
    """Seed, versions and SHA-256 of scenario, signals and the files that it reads, for JSON."""
    return {
        "seed": scenario.seed,
        "scenario_sha256": scenario_hash(scenario),
        "signals_sha256": signals_hash(signals),
        "files_sha256": {field: file_hash(path) for field, path in file_paths(scenario).items()},
        "versions": versions(),
    }


def versions() -> dict[str, str]:
    """Versions of packages, Python and machine: whatever can change the last bit."""
    packages = {name: version(name) for name in PACKAGES}
    return packages | {"python": platform.python_version(), "machine": f"{platform.system()} {platform.machine()}"}


def scenario_hash(scenario: Scenario) -> str:
    """SHA-256 of the complete scenario as text, without the paths of the files that it reads."""
    without = replace_file_paths(scenario, {field: field for field in file_paths(scenario)})
    return hashlib.sha256(dump_scenario(without).encode()).hexdigest()


def signals_hash(signals: pa.Table) -> str:
    """SHA-256 of names and bits of all columns in alphabetical order, independent of file format and compression."""
    digest = hashlib.sha256()
    for name in sorted(signals.column_names):
        digest.update(name.encode() + b"\0")
        digest.update(np.ascontiguousarray(signals[name].to_numpy(), dtype=np.float64).tobytes())
    return digest.hexdigest()


def file_hash(path: str) -> str | None:
    """SHA-256 of a file's bytes; None if it cannot be read."""
    try:
        return hashlib.sha256(read_regular(Path(path), MAX_FOLLOWED_BYTES)).hexdigest()
    except ParameterError:
        return None
