"""Tables of the book from shipped studies: their rows as Markdown.

`humanwalk study balance_speeds -o runs/balance_speeds`, then `python benchmarks/pages.py runs/balance_speeds`.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path

import likeness as human_likeness
import numpy as np
from actuation_figure import tracking_by_group
from likeness import CONTACT, GAIT, Row
from matplotlib.figure import Figure

from humanwalk.files import make_folder
from humanwalk.study import journal
from humanwalk.study.figures import measure_figures
from humanwalk.study.results import SURVIVAL, Results
from humanwalk.study.statistics import Level, Survival, factor_array, levels_of
from humanwalk.study.study import Study, load_study
from humanwalk.study.table import ROW, table_columns
from humanwalk.view.plots.drawing import save

RESULTS = Path(__file__).parent / "results"
IMAGES = Path(__file__).parents[1] / "docs" / "images" / "studies"

KEPT = (
    SURVIVAL,
    "end",
    "duration_s",
    "mean_speed_m_s",
    "path_deviation_m",
    "cost_of_transport",
    "steps",
    "qp_failures",
    "gait.step_time_s.right",
    "gait.step_time_s.left",
    "support_force_rms_N",
    "support_torque_rms_N_m",
    "foot_lift_m.right",
    "foot_lift_m.left",
)
"""Columns of a study's table that are kept beside its factors: those of the pages."""

KEPT_OF = {
    "actuations": (
        "tracking_error_rms_rad",
        "torque_rms_N_m",
        "pelvis_tracking_rms_m",
        "peak_torque_N_m.RightLegFemurMotion",
    ),
    human_likeness.STUDY: human_likeness.COLUMNS,
    "likeness_bodies": human_likeness.COLUMNS,
    "likeness_speeds": human_likeness.COLUMNS,
}
"""Further columns of single studies."""

PICTURES = {
    "push_random": (SURVIVAL,),
    "thesis_step_height": ("support_force_rms_N", "support_torque_rms_N_m"),
}
"""Measures of studies of which the book has pictures."""

DRAWN: dict[str, Callable[[Results], Figure]] = {"actuations": tracking_by_group}
"""Pictures of their own."""

FORWARD = "controller.balanced.command.points.0.forward"
PUSH_TIME, PUSH_DIRECTION, PUSH_IMPULSE = (f"pushes.given.0.{field}" for field in ("time", "direction", "impulse"))
TITLES = {
    "default": "The defaults, no style",
    "normative": "The scenario `normative`, with people's angles as a style",
}
"""Of the gaits of the study of likeness."""
WALKED = ("end", "speed m/s", "off the path cm", "cost of transport")


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [headings, ["---", *["---:"] * (len(headings) - 1)], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def balance_speeds() -> str:
    return study_table(
        "balance_speeds",
        ["commanded", *WALKED, "steps", "failed programs"],
        lambda row: [f"{row[FORWARD]:g} m/s", *_walked(row), str(row["steps"]), str(row["qp_failures"])],
    )


def balance_fast() -> str:
    return study_table(
        "balance_fast",
        ["contact", "commanded", *WALKED, "steps"],
        lambda row: [row[CONTACT], f"{row[FORWARD]:g} m/s", *_walked(row), str(row["steps"])],
    )


def balance_paths() -> str:
    return study_table(
        "balance_paths",
        ["scenario", "end", "off the path cm"],
        lambda row: [f"`{row['path']}`", _end(row), f"{100 * row['path_deviation_m']:.1f}"],
    )


def balance_bodies() -> str:
    return study_table(
        "balance_bodies",
        ["body", "commanded", *WALKED, "failed programs"],
        lambda row: [row["body"], f"{row[FORWARD]:g} m/s", *_walked(row), str(row["qp_failures"])],
    )


def balance_invariance() -> str:
    def line(row: Row) -> list[str]:
        step = (row["gait.step_time_s.right"] + row["gait.step_time_s.left"]) / 2.0
        return [row["settings"], *_walked(row), str(row["steps"]), f"{step:.3f}"]

    return study_table("balance_invariance", ["", *WALKED, "steps", "step s"], line)


def balance_seeds() -> str:
    return _seeds("balance_seeds")


def normative_seeds() -> str:
    return _seeds("normative_seeds")


def _seeds(name: str) -> str:
    """Survival and ranges of the walks of each speed."""
    study = load_study(name)

    def lines(rows: list[Row]) -> Iterator[list[str]]:
        for speed, walks in groupby(rows, key=lambda row: study.value_at(row, FORWARD)):
            runs = list(walks)
            up = [row for row in runs if row["survived"]]
            yield [f"{speed:g} m/s", *survival_texts(runs)] + [
                f"{min(values):.{digits}f} to {max(values):.{digits}f}"
                for values, digits in (
                    ([row["mean_speed_m_s"] for row in up], 3),
                    ([100.0 * row["path_deviation_m"] for row in up], 1),
                    ([row["cost_of_transport"] for row in up], 2),
                )
            ]

    headings = ["commanded", "survived", "95 % interval", "speed m/s", "off the path cm", "cost of transport"]
    return study_section(name, lambda rows: table(headings, lines(rows)))


def balance_turns() -> str:
    def lines(rows: list[Row]) -> Iterator[list[str]]:
        for turn, walks in groupby(rows, key=lambda row: row["turn"]):
            runs = list(walks)
            off = [100.0 * row["path_deviation_m"] for row in runs if row["survived"]]
            yield [turn, *survival_texts(runs), f"{min(off):.0f} to {max(off):.0f}" if off else "-"]

    headings = ["turn", "survived", "95 % interval", "off the path cm"]
    return study_section("balance_turns", lambda rows: table(headings, lines(rows)))


def balance_commands() -> str:
    def section(rows: list[Row]) -> str:
        survived, interval = survival_texts(rows)
        off = [100.0 * row["path_deviation_m"] for row in rows if row["survived"]]
        median, most = np.median(off), max(off)
        return f"{survived} survived ({interval}). Off the path: {median:.0f} cm (median), at most {most:.0f} cm."

    return study_section("balance_commands", section)


def balance_pushes() -> str:
    return study_section("balance_pushes", _pushes_by_time)


def balance_pushes_60() -> str:
    return study_section("balance_pushes_60", _pushes_by_time)


def balance_pushes_sideways() -> str:
    def section(rows: list[Row]) -> str:
        survived, interval = survival_texts(rows)
        fell = [f"{row[PUSH_TIME]:.2f}" for row in rows if not row["survived"]]
        return f"{survived} survived ({interval})." + (f" Not survived: at {', '.join(fell)} s." if fell else "")

    return study_section("balance_pushes_sideways", section)


def balance_fast_pushes() -> str:
    def pushed(row: Row) -> str:
        return f"{row[FORWARD]:g} m/s, {row[PUSH_TIME]:.1f} s"

    return study_section("balance_fast_pushes", lambda rows: _pushes(rows, "speed, push at", pushed, _up_or_end))


def _pushes_by_time(rows: list[Row]) -> str:
    def end(row: Row) -> str:
        return "up" if row["survived"] else f"{row['end']} after {row['duration_s'] - row[PUSH_TIME]:.1f} s"

    return _pushes(rows, "push at", lambda row: f"{row[PUSH_TIME]:.2f} s", end)


def balance_standing() -> str:
    return study_section(
        "balance_standing", lambda rows: _pushes(rows, "push", lambda row: f"{row[PUSH_IMPULSE]:g} N s", _up_or_end)
    )


def balance_weight_shift() -> str:
    def pushed(row: Row) -> str:
        return f"{row[PUSH_IMPULSE]:g} N s at {row[PUSH_TIME]:.1f} s"

    return study_section("balance_weight_shift", lambda rows: _pushes(rows, "push", pushed, _up_or_end))


def subjects_pushes() -> str:
    return study_section("subjects_pushes", lambda rows: _pushes(rows, "body", lambda row: row["body"], _up_or_end))


def _up_or_end(row: Row) -> str:
    return "up" if row["survived"] else row["end"]


def _pushes(rows: list[Row], heading: str, group: Callable[[Row], str], end: Callable[[Row], str]) -> str:
    """How each push ended, a line for each group of rows and a column for each direction."""
    ends = {(group(row), row[PUSH_DIRECTION]): end(row) for row in rows}
    names, directions = dict.fromkeys(map(group, rows)), sorted({row[PUSH_DIRECTION] for row in rows})
    lines = [[name, *(ends[name, direction] for direction in directions)] for name in names]
    headings = [heading, *(f"{math.degrees(direction):.0f}°" for direction in directions)]
    survived, interval = survival_texts(rows)
    return f"{survived} survived ({interval}):\n\n" + table(headings, lines)


def push_random() -> str:
    def section(rows: list[Row]) -> str:
        def line(level: Level) -> list[str]:
            inside = [rows[index] for index in level.rows]
            ends = [math.degrees(choose(row[PUSH_DIRECTION] for row in inside)) for choose in (min, max)]
            return [f"{ends[0]:.0f}° to {ends[1]:.0f}°", *survival_texts(inside)]

        survived, interval = survival_texts(rows)
        levels = levels_of(factor_array([row[PUSH_DIRECTION] for row in rows]), 8)
        return (
            f"{survived} survived ({interval}):\n\n"
            + table(["direction", "survived", "95 % interval"], [line(level) for level in levels])
            + "\n\n![Directions and times of pushes that were survived](images/studies/push_random_survived_map.png)"
        )

    return study_section("push_random", section)


def subjects_adults() -> str:
    return _subjects("subjects_adults", lambda row: {"female": "women", "male": "men"}[row["subject.sex"]])


def subjects_children() -> str:
    return _subjects("subjects_children", lambda row: {"female": "girls", "male": "boys"}[row["subject.sex"]])


def subjects_loads() -> str:
    return _subjects("subjects_loads", lambda row: row["load"])


def impairments() -> str:
    return _subjects("impairments", lambda row: row["subject"])


def terrain_impairments() -> str:
    def section(rows: list[Row]) -> str:
        subjects, grounds = (list(dict.fromkeys(row[factor] for row in rows)) for factor in ("subject", "ground"))

        def completed(subject: str, ground: str) -> str:
            survived, _ = survival_texts([row for row in rows if (row["subject"], row["ground"]) == (subject, ground)])
            return survived

        lines = [[subject, *(completed(subject, ground) for ground in grounds)] for subject in subjects]
        return table(["completed", *grounds], lines)

    return study_section("terrain_impairments", section)


def _subjects(name: str, group: Callable[[Row], str]) -> str:
    """Table of survival, speed and cost of transport, a line for each group of subjects."""
    study = load_study(name)

    def line(label: str, runs: list[Row]) -> list[str]:
        up = [row for row in runs if row["survived"]]
        if not up:
            return [label, *survival_texts(runs), "-", "-"]
        commanded = [study.value_at(row, FORWARD) for row in up]
        ratios = [row["mean_speed_m_s"] / speed - 1.0 for row, speed in zip(up, commanded, strict=True)]
        costs = [row["cost_of_transport"] for row in up]
        return [
            label,
            *survival_texts(runs),
            f"{100 * min(ratios):+.1f} to {100 * max(ratios):+.1f} %",
            f"{min(costs):.2f} to {max(costs):.2f}",
        ]

    def section(rows: list[Row]) -> str:
        groups = dict.fromkeys(map(group, rows))
        headings = ["subject", "survived", "95 % interval", "speed deviates by", "cost of transport"]
        return table(headings, [line(label, [row for row in rows if group(row) == label]) for label in groups])

    return study_section(name, section)


def thesis_step_height() -> str:
    def line(row: Row) -> list[str]:
        lift = 50.0 * (row["foot_lift_m.right"] + row["foot_lift_m.left"])
        support = [f"{row['support_force_rms_N']:.0f}", f"{row['support_torque_rms_N_m']:.0f}"]
        height = row["controller.thesis.gait.path.step_height"]
        return [f"{100 * height:g}", f"{lift:.1f}", *support, f"{row['cost_of_transport']:.2f}", _end(row)]

    headings = ["H cm", "foot lift cm", "support force N", "support torque N m", "cost of transport", "end"]
    return study_table("thesis_step_height", headings, line)


def actuations() -> str:
    def line(row: Row) -> list[str]:
        return [
            f"`{row['actuation']}`",
            f"{1e3 * row['tracking_error_rms_rad']:.2f}",
            f"{row['torque_rms_N_m']:.1f}",
            f"{row['peak_torque_N_m.RightLegFemurMotion']:.0f}",
            f"{row['support_force_rms_N']:.0f}",
            f"{row['support_torque_rms_N_m']:.0f}",
            f"{1e3 * row['pelvis_tracking_rms_m']:.2f}",
            f"{row['cost_of_transport']:.2f}",
        ]

    headings = ["actuation", "tracking error mrad", "torque N m", "peak torque, right hip N m"]
    headings += ["support force N", "support torque N m", "pelvis error mm", "cost of transport"]
    return study_table("actuations", headings, line)


def likeness() -> str:
    def section(rows: list[Row]) -> str:
        return "\n\n".join(
            f"{TITLES[gait]}\n\n{table(human_likeness.headings(walks), human_likeness.lines(walks, '**{}**'.format))}"
            for gait, walks in human_likeness.by_gait(rows).items()
        )

    return study_section(human_likeness.STUDY, section)


def likeness_bodies() -> str:
    """Goals of the walk without a style, and its score, a line for each body."""
    speeds = load_study(human_likeness.STUDY).factors[FORWARD].levels()

    def line(body: str, walks: Iterable[Row]) -> list[str]:
        compared = ({**row, GAIT: "default", FORWARD: speed} for row, speed in zip(walks, speeds, strict=True))
        return [body, *map(_goals_and_score, compared)]

    def lines(rows: list[Row]) -> Iterator[list[str]]:
        of_the_man = study_results(human_likeness.STUDY).table.to_pylist()
        yield line("the default man", (row for row in of_the_man if (row[GAIT], row[CONTACT]) == ("default", "point")))
        for body, walks in groupby(rows, key=itemgetter("body")):
            yield line(body, walks)

    headings = ["body", *(f"{speed:g} m/s" for speed in speeds)]
    return study_section("likeness_bodies", lambda rows: table(headings, lines(rows)))


def likeness_speeds() -> str:
    """Goals of the walk, and its score, a line without a style and one with it."""

    def lines(rows: list[Row]) -> Iterator[list[str]]:
        for gait, walks in human_likeness.by_gait(rows).items():
            yield [TITLES[gait], *map(_goals_and_score, walks)]

    speeds = load_study("likeness_speeds").factors[FORWARD].levels()
    headings = ["", *(f"{speed:g} m/s" for speed in speeds)]
    return study_section("likeness_speeds", lambda rows: table(headings, lines(rows)))


def _goals_and_score(row: Row) -> str:
    return f"{human_likeness.goals_text(row)}; {human_likeness.score_text(row)} %"


def study_table(name: str, headings: Sequence[str], line: Callable[[Row], list[str]]) -> str:
    """Table of the rows of a study, a line for each."""
    return study_section(name, lambda rows: table(headings, map(line, rows)))


def study_section(name: str, section: Callable[[list[Row]], str]) -> str:
    """What `section` makes of the rows of a study, or that the study was not simulated yet."""
    if not (RESULTS / f"{name}.csv").exists():
        return f"Not simulated yet: `humanwalk study {name} -o runs/{name}`; `python benchmarks/pages.py runs/{name}`."
    return section(study_results(name).table.to_pylist())


def study_results(name: str) -> Results:
    """The kept columns of a shipped study's table.

    Raises:
        ValueError: the study was changed since.
    """
    study = load_study(name)
    table = journal.read(RESULTS / f"{name}.csv", kept_columns(study, name), len(study.points))
    points = [{column: study.value_at(point, column) for column in study.columns} for point in study.points]
    if table.select(list(study.columns)).to_pylist() != points:
        raise ValueError(f"{name}.csv: rows of another study; run `humanwalk study {name}` and keep its rows")
    return Results(name, study, table)


def keep(folder: Path) -> None:
    """Copy what the pages need of a finished shipped study into the results, and draw its pictures."""
    results, name = Results.read(folder), folder.resolve().name
    study = load_study(name)
    if results.study.points != study.points or results.table.num_rows < len(study.points):
        raise ValueError(f"{folder}: not the finished study {name}; run `humanwalk study {name} -o {folder}`")
    path, columns = RESULTS / f"{name}.csv", kept_columns(study, name)
    path.unlink(missing_ok=True)
    journal.start(path, columns, len(study.points))
    for row in results.table.to_pylist():
        journal.append(path, columns, row)
    make_folder(IMAGES)
    for measure in PICTURES.get(name, ()):
        for which, figure in measure_figures(results, measure).items():
            save(figure, IMAGES / f"{name}_{which}.png")
    if name in DRAWN:
        save(DRAWN[name](results), IMAGES / f"{name}.png")


def kept_columns(study: Study, name: str) -> dict[str, type]:
    """Types of the columns of the results of a named study: index, factors, KEPT, KEPT_OF."""
    kept = (ROW, *study.columns, *KEPT, *KEPT_OF.get(name, ()))
    return {column: kind for column, kind in table_columns(study).items() if column in kept}


def _walked(row: Row) -> list[str]:
    numbers = (("mean_speed_m_s", 1.0, ".3f"), ("path_deviation_m", 100.0, ".1f"), ("cost_of_transport", 1.0, ".2f"))
    return [
        _end(row),
        *("-" if row[name] is None else format(row[name] * scale, form) for name, scale, form in numbers),
    ]


def _end(row: Row) -> str:
    return f"{row['end']} at {row['duration_s']:g} s"


def survival_texts(rows: Sequence[Row]) -> tuple[str, str]:
    """Number of rows that survived, and the interval of their share."""
    found = Survival.of(np.array([row["survived"] for row in rows]))
    return f"**{found.survived} of {found.runs}**", f"{100 * found.low:.0f} to {100 * found.high:.0f} %"


STUDIES: dict[str, tuple[Callable[[], str], ...]] = {
    "robustness.md": (
        balance_speeds,
        balance_fast,
        balance_fast_pushes,
        balance_paths,
        balance_turns,
        balance_commands,
        balance_bodies,
        balance_pushes,
        balance_pushes_60,
        balance_pushes_sideways,
        push_random,
        balance_standing,
        balance_weight_shift,
        balance_seeds,
        balance_invariance,
    ),
    "howto/subjects.md": (
        subjects_adults,
        subjects_children,
        subjects_loads,
        impairments,
        terrain_impairments,
        subjects_pushes,
    ),
    "likeness.md": (likeness, likeness_speeds, likeness_bodies, normative_seeds),
    "claims.md": (thesis_step_height,),
    "actuation.md": (actuations,),
}
"""Sections from studies, by page of the book."""
