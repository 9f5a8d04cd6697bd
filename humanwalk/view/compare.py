"""Comparison of runs: measures side by side, what differs between their scenarios, and overlaid curves."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from humanwalk.measures.summary import Summary
from humanwalk.measures.symmetry import symmetry_index
from humanwalk.parameter_file import plain
from humanwalk.quantity import ParameterError, printable
from humanwalk.run.folder import Run
from humanwalk.view.page import heading, paragraph, picture, table, write_page
from humanwalk.view.plots.overlays import OVERLAYS, RUN_COLORS

MAX_RUNS = len(RUN_COLORS)

TITLE = "Comparison of runs"

ABSENT = "-"


def _mean(of_feet: Mapping[str, float | None] | None) -> float | None:
    values = [value for value in (of_feet or {}).values() if value is not None]
    return float(np.mean(values)) if values else None


def _gait(summary: Summary, name: str) -> Any:
    return None if summary["gait"] is None else summary["gait"].get(name)


def _index(of_feet: Mapping[str, float | None] | None) -> float | None:
    """Symmetry index of a measure of both feet [%]."""
    return symmetry_index(of_feet["right"], of_feet["left"]) if of_feet else None


def _greatest(by_joint: Mapping[str, float | None]) -> float | None:
    return max((value for value in by_joint.values() if value is not None), default=None)


MEASURES: dict[str, tuple[str, Callable[[Summary], float | None]]] = {
    "duration [s]": (".2f", lambda s: s["duration_s"]),
    "commanded speed [m/s]": (".2f", lambda s: s["commanded_speed_m_s"]),
    "mean speed [m/s]": (".3f", lambda s: s["mean_speed_m_s"]),
    "distance [m]": (".2f", lambda s: s["distance_m"]),
    "lateral drift [m]": (".3f", lambda s: s["lateral_drift_m"]),
    "steps": (".0f", lambda s: s["steps"]),
    "cadence [1/min]": (".1f", lambda s: _gait(s, "cadence_1_min")),
    "step length [m]": (".3f", lambda s: _mean(_gait(s, "step_length_m"))),
    "step width [m]": (".3f", lambda s: _mean(_gait(s, "step_width_m"))),
    "stance, share of the stride": (".3f", lambda s: _mean(_gait(s, "stance_share"))),
    "symmetry index of step length [%]": (".1f", lambda s: _index(_gait(s, "step_length_m"))),
    "symmetry index of step time [%]": (".1f", lambda s: _index(_gait(s, "step_time_s"))),
    "symmetry index of stance [%]": (".1f", lambda s: _index(_gait(s, "stance_share"))),
    "foot lift [m]": (".3f", lambda s: _mean(s["foot_lift_m"])),  # type: ignore[arg-type]
    "peak torque [N m]": (".0f", lambda s: _greatest(s["peak_torque_N_m"])),
    "cost of transport": (".3f", lambda s: s["cost_of_transport"]),
    "EXTERNAL SUPPORT force, rms [N]": (".0f", lambda s: s["support_force_rms_N"] if s["external_support"] else None),
    "EXTERNAL SUPPORT torque, rms [N m]": (
        ".0f",
        lambda s: s["support_torque_rms_N_m"] if s["external_support"] else None,
    ),
    "QP failures": (".0f", lambda s: s["qp_failures"]),
    "real-time factor": (".2f", lambda s: s["realtime_factor"]),
}
"""Format and value of each measure; means over both feet, and the greatest torque of all joints."""


def names_of(runs: Sequence[Run]) -> list[str]:
    """Names of the runs: of their folders, or their paths where these are the same.

    Raises:
        ParameterError: fewer than two runs, or more than MAX_RUNS.
    """
    if not 2 <= len(runs) <= MAX_RUNS:
        raise ParameterError(f"runs: {len(runs)} of them; allowed: 2 to {MAX_RUNS}; name other folders")
    names = [printable(run.path.resolve().name) for run in runs]
    return names if len(set(names)) == len(names) else [printable(run.path) for run in runs]


def measure_rows(runs: Sequence[Run]) -> Iterator[tuple[str, ...]]:
    """Measures side by side: name, then one text for each run; measures that no run has are omitted."""
    yield "end", *(run.summary["end"] for run in runs)
    for name, (form, value_of) in MEASURES.items():
        values = [value_of(run.summary) for run in runs]
        if any(value is not None for value in values):
            yield name, *(ABSENT if value is None else format(value, form) for value in values)


def difference_rows(runs: Sequence[Run]) -> Iterator[tuple[str, ...]]:
    """Fields of the scenarios that are not the same in all runs: dotted name, then the value in each run."""
    flat = [dict(_flat(plain(run.scenario))) for run in runs]
    for name in dict.fromkeys(name for fields in flat for name in fields):
        values = [fields.get(name, ABSENT) for fields in flat]
        if len(set(values)) > 1:
            yield name, *values


def falls(runs: Sequence[Run], names: Sequence[str]) -> list[str]:
    """One line for each run that ended with a fall."""
    reports = ((name, run.summary["fall"]) for name, run in zip(names, runs, strict=True))
    return [f"{name} {fall['description']}" for name, fall in reports if fall is not None]


def write_comparison(path: Path, runs: Sequence[Run]) -> None:
    """Write the page of a comparison, figures inside, whole or not at all.

    Raises:
        ParameterError: it cannot be written, or a run cannot be read.
    """
    names = names_of(runs)
    differences = list(difference_rows(runs))
    figures = ((name, draw(runs, names)) for name, draw in OVERLAYS.items())
    parts = [
        table(("measure", *names), measure_rows(runs)),
        *(paragraph(line) for line in falls(runs, names)),
        heading("Curves"),
        *(picture(figure, name) for name, figure in figures if figure is not None),
        heading("What differs between the scenarios"),
        table(("field", *names), differences) if differences else paragraph("Nothing."),
    ]
    write_page(path, TITLE, parts)


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Dotted names and texts of the values in nested mappings and lists."""
    if isinstance(value, Mapping) and value:
        for key, entry in value.items():
            yield from _flat(entry, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list) and value:
        for i, entry in enumerate(value):
            yield from _flat(entry, f"{name}.{i}")
    else:
        yield name, printable(value)
