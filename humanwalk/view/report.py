"""Comparison of a run with human gait: tables for a terminal, a page with figures, numbers as JSON."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich import box
from rich.table import Table

from humanwalk.measures.human_likeness import ANGLES, MIN_STRIDES, Comparison, Likeness, compare
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.view.page import notes, numbered_notes, paragraph, picture, table, write_page
from humanwalk.view.plots import PLOTS

REPORT = "report.html"
FIGURES = ("gait_cycle_angles", "gait_cycle_pelvis", "ground_reaction")

UP_AT_ITS_END = ("completed", "interrupted", "unfinished")

CURVE_HEADER = ("angle [deg]", "correlation", "difference", "rms", "within 1 SD [%]")
MEASURE_HEADER = ("measure", "run", "human", "source")

DECIMALS = {"m/s": 2, "m": 3, "1/min": 0, "": 2, "BW": 2, "deg": 1, "N m/kg": 2}
"""Decimals of a measure in a table, by its unit."""

NOTES = (
    "Run: mean ± standard deviation over the steps, strides or stances of both legs in steady walking.",
    "Difference, rms: the run's angle minus the human mean; within 1 SD: fraction of the cycle, 68 % for humans.",
    "Human angles: Schwartz, Rozumalski, Trost (2008), children at self-selected speed, whose curves have the shape of "
    "adults' at the same dimensionless speed.",
    "The human pelvic plane is tilted forward by about 10 degrees in upright standing, this model's is not: that part "
    "of the difference in pelvis tilt and hip angle is an offset of the zero.",
    "Cost of transport is the integral of all joints' |torque x rate| per weight and distance, which is not the "
    "metabolic cost. No human value is given where no source is known for the same measure.",
)


def compare_run(run: Run) -> Comparison:
    """Compare a run with human gait.

    Raises:
        ParameterError: The run fell, has no physics, or has no straight walk of enough strides.
    """
    run.require_physics()
    end = run.summary["end"]
    if end not in UP_AT_ITS_END:
        fall = run.summary["fall"]
        ended = f"ended with '{end}' at {run.summary['duration_s']:.2f} s" if fall is None else fall["description"]
        raise ParameterError(
            f"{run.path}: the run {ended}; allowed: a "
            f"run that did not fall, with {MIN_STRIDES} strides of each leg; re-run with a shorter --duration"
        )
    try:
        return compare(run.signals, run.scenario)
    except ParameterError as error:
        raise ParameterError(f"{run.path}: {error}") from None


def to_json(comparison: Comparison) -> dict[str, Any]:
    """A comparison stride by stride, ready for JSON; null for undefined values."""
    return {
        "strides": {side.lower(): count for side, count in comparison.strides.items()},
        "angles": {
            name: {
                side.lower(): {
                    "correlation": _numbers(likeness.correlation),
                    "difference_deg": _numbers(likeness.difference),
                    "rms_deg": _numbers(likeness.rms),
                    "within_1_sd": _numbers(likeness.inside),
                }
                for side, likeness in sides.items()
            }
            for name, sides in comparison.curves.items()
        },
        "measures": {
            measure.name: {
                "unit": measure.unit,
                "values": _numbers(measure.values),
                "people": asdict(measure.people) if measure.people else None,
            }
            for measure in comparison.measures
        },
    }


def terminal_tables(comparison: Comparison) -> list[Table]:
    """Tables for a terminal: angles, then measures with their sources."""
    angles = Table(*CURVE_HEADER, box=box.SIMPLE)
    for row in curve_rows(comparison):
        angles.add_row(*row)
    caption = "\n".join((*(f"{number} {cited}" for number, cited in enumerate(sources(comparison), 1)), "", *NOTES))
    measures = Table(*MEASURE_HEADER, box=box.SIMPLE, caption=caption, caption_justify="left")
    for row in measure_rows(comparison):
        measures.add_row(*row)
    return [angles, measures]


def write_report(run: Run, comparison: Comparison) -> Path:
    """Write the page of a comparison, figures inside, into the run's folder, whole or not at all; returns its path.

    Raises:
        ParameterError: it cannot be written.
    """
    figures = ((name, PLOTS[name](run)) for name in FIGURES)
    strides = ", ".join(f"{count} of the {side.lower()} leg" for side, count in comparison.strides.items())
    path = run.path / REPORT
    write_page(
        path,
        f"{run.path.resolve().name}: comparison with human gait",
        (
            paragraph(f"{run.scenario.description}. Compared strides: {strides}."),
            table(CURVE_HEADER, curve_rows(comparison)),
            table(MEASURE_HEADER, measure_rows(comparison)),
            numbered_notes(sources(comparison)),
            *(picture(figure, name) for name, figure in figures if figure is not None),
            notes(NOTES),
        ),
    )
    return path


def curve_rows(comparison: Comparison) -> Iterator[tuple[str, ...]]:
    """Rows under CURVE_HEADER, both legs' strides together."""
    for name, sides in comparison.curves.items():

        def both(of: str, sides: Sequence[Likeness] = tuple(sides.values())) -> Array:
            return np.concatenate([getattr(likeness, of) for likeness in sides])

        yield (
            f"{name}, {ANGLES[name].positive}",
            _spread(both("correlation"), ".2f"),
            _spread(both("difference"), ".1f"),
            _spread(both("rms"), ".1f"),
            _spread(100.0 * both("inside"), ".0f"),
        )


def measure_rows(comparison: Comparison) -> Iterator[tuple[str, ...]]:
    """Rows under MEASURE_HEADER; a source by its number among `sources`."""
    cited = sources(comparison)
    for measure in comparison.measures:
        form, people = f".{DECIMALS[measure.unit]}f", measure.people
        name = f"{measure.name} [{measure.unit}]" if measure.unit else measure.name
        row = (name, _spread(measure.values, form))
        if people is None:
            yield *row, "", ""
        else:
            low, high = format(people.low, form), format(people.high, form)
            yield *row, low if low == high else f"{low} to {high}", f"{cited.index(people.source) + 1}"


def sources(comparison: Comparison) -> list[str]:
    """Sources of the human values, each once, in the order of the measures."""
    return list(dict.fromkeys(measure.people.source for measure in comparison.measures if measure.people))


def _spread(values: Array, form: str) -> str:
    values = values[np.isfinite(values)]
    if not values.size:
        return "-"
    mean = format(values.mean(), form)
    return mean if values.size == 1 else f"{mean} ± {format(values.std(), form)}"


def _numbers(values: Array) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
