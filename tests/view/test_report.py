"""What `humanwalk report` says of a run, and where it says no."""

import base64
import html
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from humanwalk.cli.main import app
from humanwalk.measures.curves import CURVES
from humanwalk.measures.signals import TIME
from humanwalk.measures.symmetry import MEASURES_OF_LEGS
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.run.outcome import Outcome
from humanwalk.run.stored import required_columns
from humanwalk.scenario import load_scenario
from humanwalk.view.report import (
    CURVE_HEADER,
    FIGURES,
    GROUPS,
    MEASURE_HEADER,
    REPORT,
    asymmetry_rows,
    compare_run,
    curve_rows,
    measure_rows,
    score_text,
    sources,
    to_json,
    write_report,
)


@pytest.fixture
def make_run(walk: Callable[..., Any], tmp_path: Path) -> Callable[..., Any]:
    """Writes the run of a walk of people's angles, by how it ended and what it is made of."""

    def make(end: str = "completed", **made: Any) -> Run:
        signals = walk(**made)
        for side in ("right", "left"):
            signals = signals.append_column(f"{side}_foot.force_x_N", signals[f"{side}_foot.force_z_N"])
        zero = np.zeros(signals.num_rows)
        for name in sorted(required_columns(physics=True).difference(signals.column_names)):
            signals = signals.append_column(name, [zero])
        period = str(signals[TIME][1].as_py())
        overrides = {"description": "A <b>walk</b>", "recording.signal_period": period}
        scenario = load_scenario("thesis", overrides)
        return Outcome(scenario, signals, end, wall_time=1.0).write(tmp_path, "walk")

    return make


def report(*arguments: Path | str) -> Any:
    return CliRunner().invoke(app, ["report", *map(str, arguments)], env={"COLUMNS": "120"})


def test_every_curve_and_measure_has_a_row(make_run: Callable[..., Any]) -> None:
    comparison = compare_run(make_run())
    curves = [row for group in GROUPS.values() for row in curve_rows(comparison, group)]
    measures = list(measure_rows(comparison))
    assert [row[0].split(",")[0] for row in curves] == list(CURVES)
    assert all(len(row) == 1 + len(CURVE_HEADER) for row in curves)
    assert [row[0].split(" [")[0] for row in measures] == [measure.name for measure in comparison.measures]
    assert all(len(row) == len(MEASURE_HEADER) for row in measures)


def test_rows_have_value_human_range_and_source(make_run: Callable[..., Any]) -> None:
    comparison = compare_run(make_run())
    rows = {row[0]: row[1:] for row in measure_rows(comparison)}
    assert rows["speed [m/s]"][:2] == ("1.30 ± 0.00", "1.28 to 1.43")
    assert rows["step width [m]"][:2] == ("0.120 ± 0.000", "0.102 to 0.159")
    assert rows["CoP backward [m]"][0] == "at most 0.000"
    assert "Schulz" in sources(comparison)[int(rows["step width [m]"][2]) - 1]
    # No value without a source, no source without a value.
    assert all((row[1] == "") == (row[2] == "") for row in rows.values())
    assert rows["moment, knee extension [N m/kg]"][1:] == ("", "")


def test_both_legs_and_their_symmetry_index_have_a_row(make_run: Callable[..., Any]) -> None:
    comparison = compare_run(make_run())
    rows = {name.partition(" [")[0]: row for name, *row in asymmetry_rows(comparison)}
    assert rows.keys() == MEASURES_OF_LEGS.keys()
    for name, (right, left, index) in rows.items():
        # Both legs of the made-up walk have the same motion.
        if "-" not in (right, left, index) and "step" not in name:
            assert abs(float(index)) < 10.0, name
    assert to_json(comparison)["asymmetries"]["step time"]["symmetry_index_percent"] == pytest.approx(0.0, abs=1.0)


def test_json_is_stride_by_stride(make_run: Callable[..., Any]) -> None:
    told = to_json(compare_run(make_run()))
    assert told["strides"] == {"right": 7, "left": 7}
    for curve in told["curves"].values():
        for side in ("right", "left"):
            assert {len(values) for values in curve[side].values()} == {7}
    assert told["people"] == "free"
    assert 0.0 < told["score"] < 1.0
    assert len(told["measures"]["step width"]["values"]) == 16
    assert told["measures"]["step width"]["people"]["source"]
    json.dumps(told, allow_nan=False)


def test_constant_angle_has_no_correlation(make_run: Callable[..., Any]) -> None:
    run = make_run()
    knee = "RightLegTibiaMotion.angle_rad"
    still = [np.full(run.signals.num_rows, 0.3)]
    signals = run.signals.set_column(run.signals.column_names.index(knee), knee, still)
    told = to_json(compare_run(Outcome(run.scenario, signals, "completed", 1.0).write(run.path)))
    assert told["curves"]["knee"]["right"]["correlation"] == [None] * 7
    assert None not in told["curves"]["knee"]["right"]["rms"]


def test_page_is_self_contained(make_run: Callable[..., Any]) -> None:
    run = make_run()
    page = write_report(run, compare_run(run)).read_text()
    assert "A &lt;b&gt;walk&lt;/b&gt;" in page
    assert "$" not in html.unescape(re.sub(r'src="[^"]*"', "", page))
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert len(links) == len(FIGURES)
    for link in links:
        kind, data = link.split(",")
        assert kind == "data:image/svg+xml;base64"
        assert b"</svg>" in base64.b64decode(data)


@pytest.mark.usefixtures("one_figure")
def test_page_is_reproducible(make_run: Callable[..., Any]) -> None:
    run = make_run()
    page = write_report(run, compare_run(run)).read_text()
    assert page == write_report(run, compare_run(run)).read_text()


@pytest.fixture
def one_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pages with one figure: drawing takes most of the time of a page."""
    monkeypatch.setattr("humanwalk.view.report.FIGURES", FIGURES[:1])


@pytest.mark.usefixtures("one_figure")
def test_command_writes_the_page_and_prints_the_tables(make_run: Callable[..., Any]) -> None:
    run = make_run()
    result = report(run.path)
    assert result.exit_code == 0
    assert "knee, flexion" in result.stdout
    assert "cadence [1/min]" in result.stdout
    assert "Schulz" in result.stdout
    assert re.search(r"Score \d+ %.*9 curves", " ".join(result.stdout.split()))
    assert str(run.path / REPORT) in result.stderr
    assert (run.path / REPORT).is_file()


def test_page_that_cannot_be_written_is_refused_before_the_comparison(
    make_run: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    run = make_run()
    (run.path / REPORT).mkdir()
    monkeypatch.setattr("humanwalk.view.report.compare_run", lambda run: pytest.fail("compared"))
    assert str(report(run.path).exception) == f"{run.path / REPORT}: a folder or device; allowed: a file; move it away"


def test_json_is_all_that_is_printed_and_nothing_is_written(make_run: Callable[..., Any]) -> None:
    run = make_run()
    result = report(run.path, "--json")
    assert json.loads(result.stdout) == to_json(compare_run(run))
    assert not (run.path / REPORT).exists()


@pytest.mark.parametrize("end", ["not a number", "solver failed: no"])
def test_failed_run_is_refused(make_run: Callable[..., Any], end: str) -> None:
    with pytest.raises(ParameterError, match=f"ended with '{end}' at 8.00 s; allowed"):
        compare_run(make_run(end))


def test_fallen_run_is_refused_with_when_where_and_why_it_fell(make_run: Callable[..., Any]) -> None:
    run = make_run("fell")
    with pytest.raises(
        ParameterError, match=r"the run fell at 8.00 s, pelvis at .*; likely cause: .*; allowed"
    ) as error:
        compare_run(run)
    assert run.summary["fall"]["description"] in str(error.value)


@pytest.mark.parametrize("end", ["interrupted", "unfinished"])
def test_interrupted_run_is_compared_up_to_its_end(make_run: Callable[..., Any], end: str) -> None:
    assert compare_run(make_run(end)).strides["Right"] == 7


@pytest.mark.parametrize(
    ("made", "said"), [({"standing": True}, "0 of the right leg"), ({"duration": 1.9}, "strides: ")]
)
def test_run_without_strides_is_refused(make_run: Callable[..., Any], made: dict[str, bool | float], said: str) -> None:
    run = make_run(**made)
    with pytest.raises(ParameterError, match=said) as error:
        compare_run(run)
    assert str(error.value).startswith(f"{run.path}: strides: ")
    assert "\n" not in str(error.value)


@pytest.mark.usefixtures("one_figure")
def test_failed_write_keeps_the_previous_page(make_run: Callable[..., Any], monkeypatch: pytest.MonkeyPatch) -> None:
    run = make_run()
    (run.path / REPORT).write_text("before")

    def full(self: Any, *arguments: str, **options: Any) -> None:
        raise OSError(28, "No space left on device")

    comparison = compare_run(run)
    monkeypatch.setattr(type(run.path), "write_text", full)
    with pytest.raises(ParameterError, match="No space left"):
        write_report(run, comparison)
    assert (run.path / REPORT).read_text() == "before"
    assert [path.name for path in run.path.iterdir() if path.name.startswith(".")] == []


@pytest.mark.parametrize(
    "style, note",
    [(None, None), ("none", "No style"), ("normative", "angles with which it is compared"), ("recorded", "recording")],
)
def test_a_score_names_the_style(make_run: Callable[..., Any], style: str | None, note: str | None) -> None:
    comparison = replace(compare_run(make_run()), style=style)
    assert to_json(comparison)["style"] == style
    assert ("style" in score_text(comparison).lower()) == (note is not None)
    assert note is None or note in score_text(comparison)
