"""Comparison of a run with human gait: tables for a terminal, a page with figures, numbers as JSON."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich import box
from rich.table import Column, Table

from humanwalk.gait.normative import SPEED_GROUPS, is_measured
from humanwalk.measures.curves import ANGLES, CURVES, MOMENTS, POWERS, Curve
from humanwalk.measures.ends import UP_AT_ITS_END
from humanwalk.measures.human_likeness import MIN_STRIDES, SCORED, Comparison, compare, pooled
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.view.page import notes, numbered_notes, paragraph, picture, table, write_page
from humanwalk.view.plots import PLOTS

REPORT = "report.html"
FIGURES = (
    "gait_cycle_angles",
    "gait_cycle_moments",
    "gait_cycle_powers",
    "gait_cycle_pelvis",
    "gait_cycle_hip_and_foot",
    "cop_under_soles",
    "ground_reaction",
)

SPREAD = " ± "
"""Between a mean and a standard deviation."""

GROUPS: dict[str, Mapping[str, Curve]] = {
    "angle [deg]": ANGLES,
    "internal moment [N m/kg]": MOMENTS,
    "power [W/kg]": POWERS,
}
"""Curves by the heading of their table."""
CURVE_HEADER = ("corr.", "diff.", "rms", "1 SD [%]", "2 SD [%]", "peak")
MEASURE_HEADER = ("measure", "run", "human", "source")
ASYMMETRY_HEADER = ("measure of a leg", "right", "left", "SI [%]")

DECIMALS = {"m/s": 2, "m": 3, "1/min": 0, "": 2, "BW": 2, "deg": 1, "N m/kg": 2, "W/kg": 2, "s": 3}
"""Decimals in a table, by unit."""

NOTES = (
    "Run: mean ± standard deviation over the steps, strides or stances of both legs in steady walking; 'at most' is "
    "the greatest of them.",
    "Corr.: correlation with the human mean over the cycle. Diff., rms: the run's curve minus the human mean. 1 SD, "
    "2 SD: fraction of the cycle within them of the human mean, 68 and 95 % for humans. Peak: greatest magnitude over "
    "that of the human mean. The score is the mean of the nine fractions within 1 SD of hip, knee and ankle: angles, "
    "moments, powers.",
    "Human curves: Schwartz, Rozumalski, Trost (2008), children, whose curves have the shape of adults' at the same "
    "dimensionless speed, by which their group is chosen.",
    "Hip flexion and pelvic tilt are those of the plane through the iliac spines, which tilts 11 degrees forward in "
    "upright standing. Moments are internal: the actuators' torques per body mass; powers are these times the joint's "
    "rate. Springs, dampers, locked joints and devices are not part of them.",
    "SI: symmetry index, 2 (right - left) / (right + left), of Robinson, Herzog and Nigg (1987); 0 for equal legs.",
    "CoP backward: greatest distance by which the center of pressure falls back under the foot from 10 to 55 % of the "
    "gait cycle.",
    "Cost of transport is the integral of all joints' |torque x rate| per weight and distance, which is not the "
    "metabolic cost. No human value is given where no source is known for the same measure.",
)


STYLE_NOTE = "The walker follows the joint angles of a recording (style)."
STYLE_NOTES = {
    "none": "No style: the walker follows no joint angles.",
    "normative": "With a style: the walker follows the joint angles with which it is compared.",
}
"""What a score is worth, by the style of the walker."""


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
            f"{run.path}: the run {ended}; allowed: a run that did not fall, with {MIN_STRIDES} strides of each leg; "
            "choose another run, or end it before the fall with --duration"
        )
    try:
        return compare(run.signals, run.scenario)
    except ParameterError as error:
        raise ParameterError(f"{run.path}: {error}") from None


def to_json(comparison: Comparison) -> dict[str, Any]:
    """A comparison stride by stride, ready for JSON; null for undefined values."""
    return {
        "strides": {side.lower(): count for side, count in comparison.strides.items()},
        "dimensionless_speed": comparison.dimensionless_speed,
        "people": comparison.group,
        "style": comparison.style,
        "score": comparison.score,
        "distance_sd": comparison.distance,
        "curves": {
            name: {"unit": CURVES[name].unit}
            | {
                side.lower(): {key: _numbers(values) for key, values in vars(likeness).items()}
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
        "asymmetries": {
            name: {"unit": legs.unit, "right": legs.right, "left": legs.left, "symmetry_index_percent": legs.index}
            for name, legs in comparison.asymmetries.items()
        },
    }


def terminal_tables(comparison: Comparison) -> list[Table]:
    """Tables for a terminal: score and curves, then measures with their sources."""
    tables = []
    for heading, curves in GROUPS.items():
        tables.append(Table(Column(heading, min_width=29), *CURVE_HEADER, box=box.SIMPLE, padding=(0, 0, 0, 1)))
        for row in curve_rows(comparison, curves):
            # Without the spread between strides, a terminal of 80 columns has room for the row.
            tables[-1].add_row(*(cell.split(SPREAD)[0] for cell in row))
    tables[0].title = score_text(comparison)
    tables[0].title_justify = "left"
    caption = "\n".join((*(f"{number} {cited}" for number, cited in enumerate(sources(comparison), 1)), "", *NOTES))
    measures = Table(*MEASURE_HEADER, box=box.SIMPLE, caption=caption, caption_justify="left")
    for row in measure_rows(comparison):
        measures.add_row(*row)
    legs = Table(*ASYMMETRY_HEADER, box=box.SIMPLE)
    for row in asymmetry_rows(comparison):
        legs.add_row(*row)
    return [*tables, legs, measures]


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
            paragraph(score_text(comparison)),
            *(table((heading, *CURVE_HEADER), curve_rows(comparison, curves)) for heading, curves in GROUPS.items()),
            table(ASYMMETRY_HEADER, asymmetry_rows(comparison)),
            table(MEASURE_HEADER, measure_rows(comparison)),
            numbered_notes(sources(comparison)),
            *(picture(figure, name) for name, figure in figures if figure is not None),
            notes(NOTES),
        ),
    )
    return path


def score_text(comparison: Comparison) -> str:
    """The overall score in one line, and with whom the walk is compared."""
    low, high = SPEED_GROUPS[comparison.group]
    speed, group = comparison.dimensionless_speed, f"{comparison.group} speed, {low:g} to {high:g}"
    if not is_measured(speed):
        group += ": the nearest group that was measured"
    style = "" if comparison.style is None else f" {STYLE_NOTES.get(comparison.style, STYLE_NOTE)}"
    return (
        f"Score {100.0 * comparison.score:.0f} %: share of the cycle within 1 SD of people's mean, averaged over "
        f"{len(SCORED)} curves; {comparison.distance:.1f} SD off on average. Dimensionless speed {speed:.2f}; compared "
        f"with people at {group}.{style}"
    )


def curve_rows(comparison: Comparison, curves: Mapping[str, Curve]) -> Iterator[tuple[str, ...]]:
    """Rows under a heading of GROUPS and CURVE_HEADER, both legs' strides together."""
    for name, curve in curves.items():
        sides, form = comparison.curves[name], f".{DECIMALS[curve.unit]}f"
        yield (
            f"{name}, {curve.positive}",
            _spread(pooled(sides, "correlation"), ".2f"),
            _spread(pooled(sides, "difference"), form),
            _spread(pooled(sides, "rms"), form),
            _spread(100.0 * pooled(sides, "inside"), ".0f"),
            _spread(100.0 * pooled(sides, "inside_2"), ".0f"),
            _spread(pooled(sides, "peak_ratio"), ".2f"),
        )


def measure_rows(comparison: Comparison) -> Iterator[tuple[str, ...]]:
    """Rows under MEASURE_HEADER; a source by its number among `sources`."""
    cited = sources(comparison)
    for measure in comparison.measures:
        form, people = f".{DECIMALS[measure.unit]}f", measure.people
        name = f"{measure.name} [{measure.unit}]" if measure.unit else measure.name
        row = (name, f"at most {measure.value:{form}}" if measure.worst else _spread(measure.values, form))
        if people is None:
            yield *row, "", ""
        else:
            low, high = format(people.low, form), format(people.high, form)
            yield *row, low if low == high else f"{low} to {high}", f"{cited.index(people.source) + 1}"


def asymmetry_rows(comparison: Comparison) -> Iterator[tuple[str, ...]]:
    """Rows under ASYMMETRY_HEADER."""
    for name, legs in comparison.asymmetries.items():
        form = f".{DECIMALS[legs.unit]}f"
        right, left = (format(value, form) if np.isfinite(value) else "-" for value in (legs.right, legs.left))
        label = f"{name} [{legs.unit}]" if legs.unit else name
        yield label, right, left, "-" if legs.index is None else f"{legs.index:.1f}"


def sources(comparison: Comparison) -> list[str]:
    """Sources of the human values, each once, in the order of the measures."""
    return list(dict.fromkeys(measure.people.source for measure in comparison.measures if measure.people))


def _spread(values: Array, form: str) -> str:
    values = values[np.isfinite(values)]
    if not values.size:
        return "-"
    mean = format(values.mean(), form)
    return mean if values.size == 1 else f"{mean}{SPREAD}{format(values.std(), form)}"


def _numbers(values: Array) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
