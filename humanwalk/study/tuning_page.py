"""The page of a tuning: the best trial, history, importance of the parameters, Pareto front."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from humanwalk.study.row import Row
from humanwalk.study.search import importance
from humanwalk.study.trials import TRIAL, best, number, pareto_front
from humanwalk.study.tuning import Tuning, start_values
from humanwalk.study.tuning_figures import history, parameters, pareto
from humanwalk.study.tuning_figures import importance as importance_figure
from humanwalk.view.page import heading, paragraph, picture, table, write_page

PAGE = "tuning.html"
"""Name inside the folder of a tuning."""

MIN_TRIALS = 20
"""Fewest trials for an importance: PED-ANOVA compares the best tenth with the others."""

MAX_FRONT = 30
"""Rows of the table of the Pareto front."""


def write_tuning_page(folder: Path, tuning: Tuning, rows: Sequence[Row]) -> Path:
    """Write the page of a tuning into its folder.

    Raises:
        ParameterError: it cannot be written.
    """
    path = folder / PAGE
    write_page(path, tuning.description or f"Tuning {folder.name}", _parts(tuning, rows))
    return path


def parameter_rows(tuning: Tuning, found: Row) -> list[tuple[str, ...]]:
    """Name, low, start, best and high of every parameter."""
    return [
        (name, *(number(value) for value in (limits.low, start, found[f"parameters.{name}"], limits.high)))
        for (name, start), limits in zip(start_values(tuning).items(), tuning.parameters.values(), strict=True)
    ]


def value_rows(tuning: Tuning, first: Row, found: Row) -> list[tuple[str, ...]]:
    """Name, value at the start, value of a trial and allowed range of every objective and bound."""
    rows: list[tuple[str, ...]] = []
    for name in tuning.measured:
        bound = tuning.bounds.get(name)
        allowed = bound.allowed if bound else tuning.objectives[name].goal
        rows.append((name, number(first[f"values.{name}"]), number(found[f"values.{name}"]), allowed))
    return rows


def _parts(tuning: Tuning, rows: Sequence[Row]) -> Iterator[str]:
    found = best(tuning, rows)
    fallen = sum(row["falls"] > 0 for row in rows)
    seconds = sum(row["wall_time_s"] for row in rows)
    yield paragraph(
        f"{len(rows)} of {tuning.trials} trials of {len(tuning.runs.points)} runs with {tuning.sampler}, population "
        f"{tuning.population}, seed {tuning.seed}; {fallen} with a fall; {seconds / 3600.0:.2f} hours of simulation."
    )
    if found is None:
        yield paragraph("No trial has walked yet.")
        return
    yield heading(f"Best: trial {found[TRIAL]}" + ("" if found["feasible"] else ", which is not within all bounds"))
    yield table(("measure", "start", "best", "goal"), value_rows(tuning, rows[0], found))
    yield table(("parameter", "low", "start", "best", "high"), parameter_rows(tuning, found))
    yield heading("History")
    yield picture(history(tuning, rows, found), "history")
    if len(tuning.objectives) > 1:
        front = pareto_front(tuning, rows)
        yield heading("Pareto front")
        yield picture(pareto(tuning, rows, front, found), "pareto_front")
        columns = [f"values.{name}" for name in tuning.objectives]
        lines = [(str(row[TRIAL]), *(number(row[column]) for column in columns)) for row in front[:MAX_FRONT]]
        yield table(("trial", *tuning.objectives), lines)
    yield heading("Parameters")
    if len(rows) >= MIN_TRIALS and len(tuning.parameters) > 1:
        trials = [({name: row[f"parameters.{name}"] for name in tuning.parameters}, row["cost"]) for row in rows]
        yield picture(importance_figure(importance(tuning.parameters, trials)), "importance")
    yield picture(parameters(tuning, rows, found, start_values(tuning)), "parameters")
