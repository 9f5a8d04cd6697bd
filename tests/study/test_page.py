"""What `study show` prints and writes: tables and figures agree with the rows, whatever texts are in them."""

import base64
import html
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from rich.table import Table

from humanwalk.quantity import ParameterError
from humanwalk.study.design import Point
from humanwalk.study.page import (
    PAGE,
    SPREAD_HEADER,
    SURVIVAL_HEADER,
    effect_rows,
    mean_rows,
    sections,
    spread_rows,
    survival_rows,
    terminal_tables,
    write_study_figures,
    write_study_page,
)
from humanwalk.study.results import SURVIVAL, Results
from humanwalk.study.row import Row
from humanwalk.view.plots.drawing import save

GRID = """
description: A <b>grid</b> & more
scenario: walk
set: {pushes.given: [{impulse: 30}]}
factors:
  pushes.given.0.time: [8.0, 8.5]
  pushes.given.0.direction: [0.0, 1.5, 3.0]
  seed: {seeds: {count: 4}}
"""
TIME, DIRECTION = "pushes.given.0.time", "pushes.given.0.direction"

SAMPLE = """
scenario: walk
set: {pushes.given: [{impulse: 30}]}
factors:
  pushes.given.0.time: {uniform: {low: 8.0, high: 9.0}}
  pushes.given.0.direction: {uniform: {low: -3.0, high: 3.0}}
  pushes.given.0.impulse: {uniform: {low: 20.0, high: 60.0}}
  body: {variants: {"<script>alert(1)</script>": {subject.mass: 60}, large: {subject.mass: 90}}}
design: {latin_hypercube: {number: 64}}
"""


def pushed(point: Point) -> Row:
    return {
        "survived": point[DIRECTION] < 2.0 or point["seed"] == 0,
        "cost_of_transport": 0.5 + 0.1 * point[DIRECTION] + 0.001 * point["seed"],
    }


def sampled(point: Point) -> Row:
    impulse = point["pushes.given.0.impulse"]
    return {"survived": impulse < 50.0, "cost_of_transport": 0.01 * impulse, "mean_speed_m_s": 1.0 + 0.1 * point[TIME]}


@pytest.fixture
def grid(make_results: Callable[..., Results]) -> Results:
    return make_results(GRID, pushed)


@pytest.fixture
def sample(make_results: Callable[..., Results]) -> Results:
    return make_results(SAMPLE, sampled)


def figures_of(results: Results, *measures: str) -> dict[str, Figure]:
    return {name: figure for section in sections(results, measures) for name, figure in section.figures.items()}


def test_survival_of_all_rows_and_of_each_level(grid: Results) -> None:
    rows = list(survival_rows(grid))
    assert all(len(row) == len(SURVIVAL_HEADER) for row in rows)
    assert [row[:4] for row in rows] == [
        ("all", "", "18 of 24", "75 %"),
        ("time [s]", "8", "9 of 12", "75 %"),
        ("", "8.5", "9 of 12", "75 %"),
        ("direction [rad]", "0", "8 of 8", "100 %"),
        ("", "1.5", "8 of 8", "100 %"),
        ("", "3", "2 of 8", "25 %"),
    ]
    assert rows[3][4] == "67.6 to 100.0 %"


def test_means_and_percentiles_of_the_survivors(grid: Results) -> None:
    direction_3 = list(mean_rows(grid, ["cost_of_transport"]))[-1]
    assert direction_3 == ("", "3", "0.8 ± 0")
    rows = list(spread_rows(grid, "cost_of_transport"))
    assert all(len(row) == len(SPREAD_HEADER) for row in rows)
    assert rows[3] == ("direction [rad]", "0", "8", "0.5015", "0.001195", "0.5", "0.5015", "0.503")
    assert all(row[2:] == ("0", "-", "-", "-", "-", "-") for row in spread_rows(grid, "mean_speed_m_s"))


def test_effects_are_ranked(sample: Results) -> None:
    rows = list(effect_rows(sample, [SURVIVAL, "cost_of_transport", "mean_speed_m_s"]))
    assert {row[0] for row in rows[:2]} == {"time [s]", "impulse [N s]"}
    shares = {row[0]: row[1:] for row in rows}
    assert all(re.fullmatch(r"\(\d+ %\)", share) for share in shares["direction [rad]"])
    assert float(shares["impulse [N s]"][1].removesuffix(" %")) > 90.0
    assert float(shares["time [s]"][2].removesuffix(" %")) > 90.0


def test_two_factors_have_a_map_and_every_measure_its_figures(grid: Results) -> None:
    assert list(figures_of(grid, "cost_of_transport")) == [
        "survived_over_factors",
        "survived_map",
        "effects",
        "cost_of_transport_over_factors",
        "cost_of_transport_map",
    ]
    figure = figures_of(grid, "cost_of_transport")["cost_of_transport_map"]
    cells = figure.axes[0].images[0].get_array()
    assert np.asarray(cells) == pytest.approx(np.array([[0.5015] * 2, [0.6515] * 2, [0.8] * 2]))
    assert figure.axes[0].get_xlabel() == "time [s]"
    assert figure.axes[0].get_ylabel() == "direction [rad]"


def test_error_bars_of_survival_are_the_intervals(grid: Results) -> None:
    panels = {each.get_xlabel(): each for each in figures_of(grid)["survived_over_factors"].axes}
    (bars,) = panels["direction [rad]"].collections
    assert isinstance(bars, LineCollection)
    assert np.array(bars.get_segments())[-1, :, 1] == pytest.approx([7.15, 59.07], abs=0.01)


def test_many_factors_have_no_map(sample: Results) -> None:
    names = list(figures_of(sample, "cost_of_transport"))
    assert names == ["survived_over_factors", "effects", "cost_of_transport_over_factors"]


def test_a_sample_of_two_factors_is_a_map_of_points(make_results: Callable[..., Results]) -> None:
    text = SAMPLE.replace("  pushes.given.0.impulse", "  duration").replace("low: 20.0, high: 60.0", "low: 9, high: 15")
    text = "\n".join(line for line in text.splitlines() if "body" not in line and "duration" not in line)
    made = make_results(text, lambda point: {"survived": point[TIME] < 8.75, "cost_of_transport": point[DIRECTION]})
    figures = figures_of(made, "cost_of_transport")
    survived, fallen = figures["survived_map"].axes[0].get_lines()
    assert (np.size(survived.get_xdata()), np.size(fallen.get_xdata())) == (48, 16)
    (points,) = figures["cost_of_transport_map"].axes[0].collections
    assert points.get_offsets().shape == (64, 2)


def test_a_study_without_factors_has_survival_and_measures(
    make_results: Callable[..., Results], tmp_path: Path
) -> None:
    made = make_results("factors: {seed: {seeds: {count: 5}}}", lambda point: {"cost_of_transport": 0.5})
    assert made.measures() == []
    assert figures_of(made, "cost_of_transport") == {}
    assert list(survival_rows(made)) == [("all", "", "5 of 5", "100 %", "56.6 to 100.0 %")]
    assert write_study_page(tmp_path, made, ["cost_of_transport"]).is_file()


def test_a_measure_that_no_run_has_has_no_figure(grid: Results, tmp_path: Path) -> None:
    assert list(figures_of(grid, "support_force_rms_N")) == list(figures_of(grid))
    assert "support force rms [N]" in write_study_page(tmp_path, grid, ["support_force_rms_N"]).read_text()


def test_nobody_survived(make_results: Callable[..., Results], tmp_path: Path) -> None:
    made = make_results(GRID, lambda point: {"survived": False, "cost_of_transport": 1.0})
    assert made.measures() == []
    assert next(survival_rows(made))[2:] == ("0 of 24", "0 %", "0.0 to 13.8 %")
    assert write_study_page(tmp_path, made, ["cost_of_transport"]).is_file()


def test_the_page_is_self_contained_and_escapes_texts(sample: Results, grid: Results, tmp_path: Path) -> None:
    page = write_study_page(tmp_path, sample, sample.measures()).read_text(encoding="utf-8")
    assert tmp_path / PAGE == tmp_path / "study.html"
    assert "<script" not in page
    assert "&lt;script&gt;alert(1)" in page
    assert "default-src 'none'" in page
    assert "$" not in html.unescape(re.sub(r'src="[^"]*"', "", page))
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert len(links) == len(figures_of(sample, *sample.measures()))
    for link in links:
        kind, data = link.split(",")
        assert kind == "data:image/svg+xml;base64"
        assert b"</svg>" in base64.b64decode(data)
    described = write_study_page(tmp_path, grid, grid.measures()).read_text(encoding="utf-8")
    assert "A &lt;b&gt;grid&lt;/b&gt; &amp; more" in described


def test_texts_are_no_formulas(make_results: Callable[..., Results], tmp_path: Path) -> None:
    text = SAMPLE.replace('"<script>alert(1)</script>"', r"'$\frac{a$'").replace("large", "$large$")
    made = make_results(text, sampled)
    assert write_study_page(tmp_path, made, made.measures()).is_file()
    figure = figures_of(made)["survived_over_factors"]
    save(figure, tmp_path / "survived.png")
    labels = [tick for axes in figure.axes for tick in axes.get_xticklabels() if "$" in tick.get_text()]
    assert [tick.get_text() for tick in labels] == [r"$\frac{a$", "$large$"]
    assert not any(tick.get_parse_math() for tick in labels)


def test_a_study_that_runs_still_is_so_described(grid: Results, tmp_path: Path) -> None:
    part = Results(grid.name, grid.study, grid.table.slice(0, 7))
    assert "made up: 7 of 24 runs so far" in write_study_page(tmp_path, part, part.measures()).read_text()


def test_terminal_tables(grid: Results, make_results: Callable[..., Results]) -> None:
    tables = terminal_tables(grid, grid.measures())
    assert [table.columns[0].header for table in tables] == ["factor", "end", "factor", "factor"]
    assert all(isinstance(table, Table) and table.row_count for table in tables)
    one = make_results("factors: {duration: [1.0, 2.0]}", lambda point: {})
    assert len(terminal_tables(one, one.measures())) == 1


def test_figures_are_written_as_files(grid: Results, tmp_path: Path) -> None:
    paths = write_study_figures(tmp_path, grid, [], "png")
    assert [path.name for path in paths] == ["survived_over_factors.png", "survived_map.png", "effects.png"]
    assert all(path.stat().st_size > 1000 for path in paths)
    with pytest.raises(ParameterError, match="--figures tiff: unknown; allowed: png, svg, pdf"):
        write_study_figures(tmp_path, grid, [], "tiff")


def test_no_figure_is_written_outside_the_folder_of_the_study(grid: Results, tmp_path: Path) -> None:
    for name in ("study", "outside"):
        (tmp_path / name).mkdir()
    (tmp_path / "study" / "plots").symlink_to(tmp_path / "outside")
    with pytest.raises(ParameterError, match=r"plots: leads out of .*remove the link"):
        write_study_figures(tmp_path / "study", grid, [], "png")
    assert list((tmp_path / "outside").iterdir()) == []
