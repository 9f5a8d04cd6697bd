"""Runs side by side: measures, differences and overlaid curves."""

import html
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import load_scenario
from humanwalk.view.compare import (
    ABSENT,
    MAX_RUNS,
    difference_rows,
    falls,
    measure_rows,
    names_of,
    write_comparison,
)
from humanwalk.view.plots.drawing import svg_data
from humanwalk.view.plots.overlays import OVERLAYS


@pytest.fixture(scope="module")
def runs(walk: Callable[..., Any], columns: tuple[str, ...], tmp_path_factory: pytest.TempPathFactory) -> list[Run]:
    """A whole walk, and a heavier walker's that fell."""

    def run(name: str, end: str, overrides: dict[str, str]) -> Run:
        signals = walk()
        zero = 0.0 * signals["time_s"].to_numpy()
        for column in columns:
            if column not in signals.column_names and not column.startswith("support."):
                signals = signals.append_column(column, [zero])
        scenario = load_scenario("walk", {"recording.signal_period": "0.005"} | overrides)
        return Outcome(scenario, signals, end, wall_time=1.0).save(tmp_path_factory.mktemp("runs") / name, name)

    pushed = {"subject.mass": "80.0", "pushes.given": "[{time: 3, impulse: 9}]"}
    return [run("a", "completed", {}), run("b", "fell", pushed)]


def test_measures_stand_side_by_side(runs: list[Run]) -> None:
    rows = {row[0]: row[1:] for row in measure_rows(runs)}
    assert rows["end"] == ("completed", "fell")
    assert rows["duration [s]"] == ("8.00", "8.00")
    assert rows["commanded speed [m/s]"] == ("1.00", "1.00")
    assert rows["mean speed [m/s]"] == (f"{runs[0].summary['mean_speed_m_s']:.3f}",) * 2
    assert "EXTERNAL SUPPORT force, rms [N]" not in rows
    assert all(len(values) == 2 for values in rows.values())


def test_only_fields_that_differ_are_listed(runs: list[Run]) -> None:
    rows = {row[0]: row[1:] for row in difference_rows(runs)}
    assert rows["subject.mass"] == ("70.0", "80.0")
    assert rows["pushes.given.0.impulse"] == (ABSENT, "9.0")
    assert {name.split(".")[0] for name in rows} == {"subject", "pushes"}
    assert list(difference_rows([runs[0], runs[0]])) == []


def test_a_fall_is_told(runs: list[Run]) -> None:
    (line,) = falls(runs, ["a", "b"])
    assert line.startswith("b fell at 8.00 s")


@pytest.mark.parametrize("name", OVERLAYS)
def test_an_overlay_has_a_curve_for_every_run_and_axes_with_units(runs: list[Run], name: str) -> None:
    figure = OVERLAYS[name](runs, ["a", "b"])
    assert figure is not None
    for axes in figure.axes:
        assert [line.get_label() for line in axes.get_lines() if not str(line.get_label()).startswith("_")] == [
            "a",
            "b",
        ]
        assert "[" in axes.get_xlabel()
        assert "[" in axes.get_ylabel()


@pytest.mark.parametrize("name", OVERLAYS)
def test_names_of_runs_stand_in_the_legend_as_they_are(runs: list[Run], name: str) -> None:
    figure = OVERLAYS[name](runs, [r"a$\frac{$", "_b"])
    assert figure is not None
    assert svg_data(figure, name)
    (legend,) = figure.legends
    assert [text.get_text().strip() for text in legend.get_texts()] == [r"a$\frac{$", "_b"]


def test_the_page_is_self_contained_and_has_everything(runs: list[Run], tmp_path: Path) -> None:
    write_comparison(tmp_path / "c.html", runs)
    page = (tmp_path / "c.html").read_text()
    text = html.unescape(re.sub(r'src="[^"]*"', "", page))
    assert page.count("data:image/svg+xml") == len(OVERLAYS)
    assert "://" not in text
    for expected in ("cost of transport", "subject.mass", "b fell at 8.00 s"):
        assert expected in text


def test_runs_of_the_same_folder_name_are_told_apart(runs: list[Run], tmp_path: Path) -> None:
    assert names_of(runs) == ["a", "b"]
    same = [Run(tmp_path / "x" / "run"), Run(tmp_path / "y" / "run")]
    assert names_of(same) == [str(run.path) for run in same]


@pytest.mark.parametrize("number", [0, 1, MAX_RUNS + 1])
def test_a_number_of_runs_that_cannot_be_compared_is_refused(runs: list[Run], number: int) -> None:
    with pytest.raises(ParameterError, match=rf"runs: {number} of them; allowed: 2 to {MAX_RUNS}"):
        names_of(runs[:1] * number)
