"""One run of a study as one row: what a worker does."""

import logging
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np

from humanwalk.body.anatomy import human
from humanwalk.files import make_folder
from humanwalk.measures.curves import CURVES
from humanwalk.measures.human_likeness import Comparison, compare
from humanwalk.measures.signals import ENDINGS
from humanwalk.measures.summary import PACKAGES, Summary
from humanwalk.measures.walk_measures import MEASURES
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.outcome import Outcome
from humanwalk.run.provenance import versions
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario

Row = dict[str, Any]
"""Values by column: numbers, truth values and text on one line; None is a value that the run does not have."""

NOT_MEASURES = ("scenario", "description", "versions")
"""Parts of a summary that all rows of a study have in common, or that have a column of another name."""

LIKENESS = {
    "correlation": "correlation",
    "inside": "within_1_sd",
    "inside_2": "within_2_sd",
    "distance": "distance_sd",
    "peak_ratio": "peak_ratio",
}
"""Columns of the likeness of a curve, by attribute of `Likeness`; its rms has a unit in its name."""

VERSIONS = (*PACKAGES, "python", "machine")


@dataclass(frozen=True)
class Job:
    """A run of a study.

    Attributes:
        index: of its point and its row.
        scenario: what to simulate.
        folder: run folder to write; None for none.
    """

    index: int
    scenario: Scenario
    folder: Path | None = None


def simulate_row(job: Job) -> Row:
    """Build, simulate and measure a run; the columns are those of `run_columns`.

    Raises:
        ParameterError: the scenario cannot be simulated.
    """
    # Drake's notices would mix with the progress bar.
    logging.getLogger("drake").setLevel(logging.ERROR)
    outcome = simulate(job.scenario)
    if job.folder is not None:
        make_folder(job.folder)
        outcome.write(job.folder, job.folder.name)
    return measured(outcome) | origin()


def measured(outcome: Outcome) -> Row:
    """The measures of a run by dotted name: those of the summary, and likeness of angles, moments and powers."""
    summary = outcome.summary()
    row = _flat({name: value for name, value in summary.items() if name not in NOT_MEASURES})
    return row | _flat({"likeness": _likeness(outcome)})


def origin() -> Row:
    """Where and with which versions a row was made."""
    return {"host": printable(platform.node())} | {f"versions.{name}": value for name, value in versions().items()}


@cache
def run_columns() -> Mapping[str, type]:
    """Columns that a run fills, with their types: bool, int, float or str."""
    columns = dict(_columns(Summary, ""))
    likeness = {f"likeness.{name}": kind for name, kind in likeness_columns().items()}
    return columns | likeness | {"host": str} | {f"versions.{name}": str for name in VERSIONS}


def likeness_columns() -> dict[str, type]:
    """Columns of the comparison with human gait, without `likeness.`, with their types."""
    curves = {f"{_key(curve)}.{name}": float for curve in CURVES for name in (*LIKENESS.values(), _rms(curve))}
    overall = {"score": float, "distance_sd": float, "dimensionless_speed": float, "people": str}
    return overall | curves | {kind.column: float for kind in MEASURES}


def _likeness(outcome: Outcome) -> Row:
    """Means over the strides of both legs; empty for a walk that cannot be compared."""
    try:
        comparison = compare(outcome.signals, outcome.scenario)
    except ParameterError:
        return {}
    return {
        "score": comparison.score,
        "distance_sd": comparison.distance,
        "dimensionless_speed": comparison.dimensionless_speed,
        "people": comparison.group,
        **{_key(curve): _of_curve(comparison, curve) for curve in CURVES},
        **{kind.column: measure.value for kind, measure in zip(MEASURES, comparison.measures, strict=True)},
    }


def _of_curve(comparison: Comparison, curve: str) -> dict[str, float]:
    values = {name: comparison.mean(curve, attribute) for attribute, name in LIKENESS.items()}
    return values | {_rms(curve): comparison.mean(curve, "rms")}


def _rms(curve: str) -> str:
    """Name of the rms with the unit of a curve: rms_deg, rms_N_m_kg or rms_W_kg."""
    return "rms_" + ENDINGS[CURVES[curve].unit]


def _key(curve: str) -> str:
    return curve.replace(" ", "_")


def _flat(value: Any, name: str = "") -> Row:
    """Nested mappings with dotted names; text on one line."""
    if isinstance(value, Mapping):
        return {
            key: leaf for part, item in value.items() for key, leaf in _flat(item, f"{name}.{part}".strip(".")).items()
        }
    if isinstance(value, float) and not np.isfinite(value):
        return {name: None}
    return {name: printable(value, 1000) if isinstance(value, str) else value}


def _columns(kind: Any, name: str) -> list[tuple[str, type]]:
    """Dotted names and types of what `_flat` makes of a type of the summary."""
    options = [option for option in get_args(kind) if option is not type(None)]
    if is_typeddict(kind):
        parts = [(part, hint) for part, hint in get_type_hints(kind).items() if name or part not in NOT_MEASURES]
    elif get_origin(kind) is dict:
        parts = [(joint.name, options[1]) for joint in human().joints]
    else:
        return _columns(options[0], name) if options else [(name, kind)]
    return [column for part, hint in parts for column in _columns(hint, f"{name}.{part}".strip("."))]


REFUSED, ERROR, KILLED = "refused: ", "error: ", "killed its worker "
"""Beginnings of the ends of rows without a result."""


def failed(end: str) -> Row:
    """The row of a run that has no measures."""
    return {"end": printable(end, 1000), "survived": False}


def has_result(end: str) -> bool:
    """Whether a run with this end was simulated; a point that was refused is no fall."""
    return not end.startswith((REFUSED, ERROR, KILLED))
