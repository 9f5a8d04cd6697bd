"""The table of a study on disk."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from humanwalk.parameter_file import MAX_FILE_SIZE
from humanwalk.quantity import ParameterError
from humanwalk.study.design import OneAtATime
from humanwalk.study.factors import Values
from humanwalk.study.study import Study, parse_study
from humanwalk.study.table import (
    PARQUET,
    POINTS,
    ROW,
    STUDY,
    TABLE,
    join,
    open_journal,
    read_study,
    read_table,
    same_study,
    table_columns,
)

SIX = parse_study("factors: {duration: [1, 2, 3], contact: [point, {hydroelastic: {}}]}")
ROWS: list[dict[str, Any]] = [
    {"end": 'fell, "badly"; x=1,2', "survived": False, "steps": 3, "mean_speed_m_s": 0.1 + 0.2},
    {"end": "completed", "survived": True, "steps": None, "mean_speed_m_s": -1e-300},
]


def fill(folder: Path, study: Study, indices: Any) -> None:
    with open_journal(folder, study) as journal:
        for index in indices:
            journal.append(index, ROWS[index % 2])


def test_rows_are_read_back_as_they_were_in_the_order_of_the_points(tmp_path: Path) -> None:
    fill(tmp_path, SIX, [4, 1])
    table = read_table(tmp_path)
    assert table.column_names == list(table_columns(SIX))
    first, second = table.to_pylist()
    assert (first[ROW], second[ROW]) == (1, 4)
    assert (first["duration"], first["contact"]) == (1, '{"hydroelastic": {}}')
    assert (second["duration"], second["contact"]) == (3, "point")
    for row, given_row in ((first, ROWS[1]), (second, ROWS[0])):
        assert {name: row[name] for name in given_row} == given_row
        assert row["cost_of_transport"] is None


def test_table_of_no_rows_has_the_columns(tmp_path: Path) -> None:
    fill(tmp_path, SIX, [])
    assert read_table(tmp_path).column_names == list(table_columns(SIX))


def test_journal_resumes_where_it_was_left(tmp_path: Path) -> None:
    fill(tmp_path, SIX, [5, 0])
    with open_journal(tmp_path, SIX) as journal:
        assert journal.done == {0, 5}
        journal.append(2, ROWS[0])
    assert read_table(tmp_path)[ROW].to_pylist() == [0, 2, 5]


@pytest.mark.parametrize("text", ["slow walk,\nbare foot", "a\rb", "\ud800", "\0"])
def test_a_row_is_one_line_whatever_its_texts_are(tmp_path: Path, text: str) -> None:
    scenario = replace(SIX.scenario, description=text)
    study = Study(scenario=scenario, factors={"description": Values(("x",))}, design=OneAtATime())
    with open_journal(tmp_path, study) as journal:
        for index in (1, 0):
            journal.append(index, ROWS[1])
        journal.finish()
    assert read_table(tmp_path)["description"].to_pylist() == [json.dumps(text), "x"]
    with open_journal(tmp_path, study) as journal:
        assert journal.done == {0, 1}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(lost=st.integers(1, 10_000))
def test_table_cut_anywhere_keeps_its_whole_lines(tmp_path: Path, lost: int) -> None:
    fill(tmp_path, SIX, set(range(4)) - open_done(tmp_path))
    table = tmp_path / TABLE
    content = table.read_bytes()
    table.write_bytes(content[: max(0, len(content) - lost)])
    whole = max(0, table.read_bytes().count(b"\n") - 1)
    with open_journal(tmp_path, SIX) as journal:
        assert len(journal.done) == whole
    fill(tmp_path, SIX, set(range(6)) - open_done(tmp_path))
    rows = read_table(tmp_path)
    assert rows[ROW].to_pylist() == list(range(6))
    assert rows["end"].to_pylist() == [ROWS[i % 2]["end"] for i in range(6)]
    table.unlink()


def open_done(folder: Path) -> set[int]:
    with open_journal(folder, SIX) as journal:
        return journal.done


def test_complete_table_is_in_order_in_both_files(tmp_path: Path) -> None:
    with open_journal(tmp_path, SIX) as journal:
        for index in (3, 5, 0, 1, 4, 2):
            journal.append(index, ROWS[0])
        journal.finish()
    lines = (tmp_path / TABLE).read_text().splitlines()
    assert [int(line.partition(",")[0]) for line in lines[1:]] == list(range(6))
    assert pq.read_table(tmp_path / PARQUET).equals(read_table(tmp_path))


def test_folder_of_another_study_or_of_something_else_is_refused(tmp_path: Path) -> None:
    fill(tmp_path / "a", SIX, [0])
    with pytest.raises(ParameterError, match="holds another study"):
        fill(tmp_path / "a", Study(), [])
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "mine").write_text("x")
    with pytest.raises(ParameterError, match="holds files already"):
        fill(tmp_path / "b", SIX, [])
    assert [entry.name for entry in (tmp_path / "b").iterdir()] == ["mine"]


def test_folder_in_use_is_refused(tmp_path: Path) -> None:
    with (
        open_journal(tmp_path, SIX),
        pytest.raises(ParameterError, match="another study writes into it"),
        open_journal(tmp_path, SIX),
    ):
        pass


def test_points_of_a_file_are_kept_with_the_table(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("duration\n1\n2\n")
    study = parse_study("design: {rows: {file: mine.csv}}", folder=tmp_path)
    fill(tmp_path / "out", study, [1])
    (tmp_path / "mine.csv").write_text("duration\n1\n3\n")
    changed = parse_study("design: {rows: {file: mine.csv}}", folder=tmp_path)
    with pytest.raises(ParameterError, match="holds another study"):
        fill(tmp_path / "out", changed, [])
    (tmp_path / "mine.csv").unlink()
    (tmp_path / "out").rename(tmp_path / "moved")
    assert read_table(tmp_path / "moved")["duration"].to_pylist() == [2]
    assert (tmp_path / "moved" / POINTS).read_text() == "duration\n1\n2\n"


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda text: text.replace("row,", "rows,", 1), "columns of another study or tuning"),
        (lambda text: text + text.splitlines(keepends=True)[1], "a row twice"),
        (lambda text: text.replace("\n1,", "\n6,"), "not in 0 to 5"),
        (lambda text: text.replace("\n1,", "\n-1,"), "not in 0 to 5"),
        (lambda text: text.replace("\n1,", "\n,"), "not in 0 to 5"),
        (lambda text: text.replace("\n1,", "\nx,"), "allowed: the file as humanwalk study or tune wrote it"),
        (lambda text: text.replace("\n1,", "\n1,,"), "allowed: the file as humanwalk study or tune wrote it"),
        (lambda text: text.replace("\n1,", '\n"1",'), "does not begin with the index"),
        (lambda text: text.replace("\n1,", "\n0x1,"), "does not begin with the index"),
        (lambda text: text.replace("\n1,", "\n\n1,"), "does not begin with the index"),
        (lambda text: text.replace("completed", '"comp\nleted"'), "does not begin with the index"),
        (lambda text: text.replace("true", "maybe"), "allowed: the file as humanwalk study or tune wrote it"),
        (lambda text: text + "0\n" * 7, "more than 6 rows"),
        (lambda text: text + "0\r" * 7 + "\n", "allowed: the file as humanwalk study or tune wrote it"),
        (lambda text: text + "\0\n", "allowed: the file as humanwalk study or tune wrote it"),
    ],
)
def test_table_that_was_changed_is_refused_in_one_line(tmp_path: Path, change: Any, match: str) -> None:
    fill(tmp_path, SIX, [1])
    (tmp_path / TABLE).write_text(change((tmp_path / TABLE).read_text()))
    for use in (lambda: read_table(tmp_path), lambda: fill(tmp_path, SIX, [])):
        with pytest.raises(ParameterError, match=match) as raised:
            use()
        assert str(raised.value).isprintable()


def test_parts_of_a_study_are_joined(tmp_path: Path) -> None:
    whole = tmp_path / "whole"
    fill(whole, SIX, range(6))
    for number, indices in enumerate(([5, 2], [0, 3, 2], [4, 1])):
        fill(tmp_path / str(number), SIX, indices)
    parts = [tmp_path / str(number) for number in range(3)]
    assert join(parts[:2], tmp_path / "out")[ROW].to_pylist() == [0, 2, 3, 5]
    assert join(parts, tmp_path / "out").equals(read_table(whole))
    fill(tmp_path / "other", Study(), [])
    with pytest.raises(ParameterError, match="holds another study"):
        join([*parts, tmp_path / "other"], tmp_path / "out")
    for bad in ("other", "missing"):
        with pytest.raises(ParameterError):
            join([*parts, tmp_path / bad], tmp_path / "new")
        assert not (tmp_path / "new").exists()


def test_a_study_with_every_field_written_out_may_be_larger_than_a_file_of_the_user(tmp_path: Path) -> None:
    pushes = ", ".join("{time: 1.25, direction: -1.2345}" for _ in range(1000))
    study = parse_study(f"scenario: {{pushes: {{given: [{pushes}]}}}}\nfactors: {{seed: [0, 1]}}\n")
    fill(tmp_path / "large", study, [0])
    assert (tmp_path / "large" / STUDY).stat().st_size > MAX_FILE_SIZE
    assert same_study(read_study(tmp_path / "large"), study)


def test_folder_that_is_no_study_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=f"{STUDY} is missing"):
        read_table(tmp_path)


@pytest.mark.parametrize("name", ["end", "row", "cost_of_transport", "seed"])
def test_factor_with_the_name_of_another_column_is_refused(name: str) -> None:
    study = parse_study(f"factors: {{{name}: {{variants: {{a: {{}}}}}}}}")
    with pytest.raises(ParameterError, match="another column of that name"):
        table_columns(study)


@pytest.mark.parametrize(
    ("values", "kind"), [("[1, 2]", int), ("[1, 2.5]", float), ("[true]", bool), ("[a, 1]", str), ("[{a: 1}]", str)]
)
def test_type_of_a_column_holds_its_values(values: str, kind: type) -> None:
    assert table_columns(parse_study(f"factors: {{x: {values}}}"))["x"] is kind
