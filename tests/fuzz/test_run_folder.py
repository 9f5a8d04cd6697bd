"""Any run folder is read, reported and exported, or refused; nothing is written outside of it."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import strategies as st

from humanwalk.exchange import export_run
from humanwalk.run.folder import SCENARIO, SIGNALS, SUMMARY, Run
from humanwalk.run.provenance import signals_hash
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.report import compare_run, to_json

TOKENS = [
    b"NaN", b"Infinity", b"-1e308", b"1e999", b"9" * 5000, b"null", b"true", b"[]", b"{}", b'""', b'"x"', b"[" * 5000,
    b'{"a":' * 2000, b"\0", b"\xff", b"\xef\xbb\xbf", b'"\\u001b[2J"', b'"\\ud800"', b'"=cmd|x"', b'"provenance": "x",',
    b"controller: {recorded: {angles: /dev/zero}}\n", b"controller: {recorded: {angles: ../x.mot}}\n",
    b"duration: 1e-9\n",
    b"duration: 3600\n", b"PAR1", b"\xff\xff\xff\xff\x7f", b"\x00" * 64,
]  # fmt: skip

NUMBERS = [float("nan"), float("inf"), -1e308, 1e308, 1e9, -1e9, 1e-300, 0.0, 1.0]
NAMES = ["=cmd|' /C calc'!A0", "../../x", "\x1b[2J", "", "a" * 10_000, "time_s", "pelvis.x_m", "a.b/c", "x.y_m"]
TYPES = [pa.float32(), pa.int64(), pa.string(), pa.bool_(), pa.list_(pa.float64()), pa.null(), pa.decimal128(38, 3)]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run as the simulation leaves it."""
    return simulate(load_scenario("thesis", {"duration": "0.02"})).save(tmp_path_factory.mktemp("made") / "run").path


def use(folder: Path) -> None:
    run = Run.open(folder)
    assert run.scenario.duration > 0.0
    assert run.summary["duration_s"] >= 0.0
    assert run.signals.num_rows > 0
    to_json(compare_run(run))
    export_run(run, "csv")


def attempt(fuzzer: Any, folder: Path) -> None:
    """Use a folder once, and remove it."""
    try:
        fuzzer.attempt(lambda: use(folder))
        assert {path.name for path in fuzzer.place.iterdir()} == {"run"}
    finally:
        shutil.rmtree(folder)


def test_bytes(fuzzer: Any, made: Path) -> None:
    contents = {name: (made / name).read_bytes() for name in (SCENARIO, SIGNALS, SUMMARY)}
    folder = fuzzer.place / "run"

    def check(changed: tuple[str, bytes]) -> None:
        name, content = changed
        shutil.copytree(made, folder)
        (folder / name).write_bytes(content)
        attempt(fuzzer, folder)

    files = [
        st.tuples(st.just(name), fuzzer.mutated([content, *fuzzer.corpus("run")], TOKENS))
        for name, content in contents.items()
    ]
    first = [(name, content) for name in contents for content in fuzzer.corpus("run")]
    fuzzer.run(check, st.one_of(files), first, inputs=150)


def test_summary(fuzzer: Any, made: Path) -> None:
    """JSON of which values are replaced, taken away or added."""
    summary, folder = json.loads((made / SUMMARY).read_text()), fuzzer.place / "run"
    values = st.sampled_from([None, True, -1, 10**400, 1e308, float("nan"), "", "x" * 2000, "\x1b[2J", [], {}, [[{}]]])

    def check(changes: list[tuple[int, str, Any]]) -> None:
        changed = json.loads(json.dumps(summary))
        groups = [changed, *(value for value in changed.values() if isinstance(value, dict))]
        for place, action, value in changes:
            group = groups[place % len(groups)]
            keys = sorted(group)
            if action == "add" or not keys:
                group["\x1b]0;x"] = value
            elif action == "delete":
                del group[keys[place % len(keys)]]
            else:
                group[keys[place % len(keys)]] = value
        shutil.copytree(made, folder)
        (folder / SUMMARY).write_text(json.dumps(changed))
        attempt(fuzzer, folder)

    actions = st.sampled_from(["replace", "replace", "delete", "add"])
    changes = st.lists(st.tuples(st.integers(0, 1000), actions, values), min_size=1, max_size=3)
    fuzzer.run(check, changes, [], inputs=150)


def test_signals(fuzzer: Any, made: Path) -> None:
    """Tables with other columns, types, rows and values; the hash of the summary fits them, as an attacker's would."""
    signals, folder = pq.read_table(made / SIGNALS), fuzzer.place / "run"

    def change(table: pa.Table, column: int, action: str, which: int) -> pa.Table:
        i, rows = column % table.num_columns, table.num_rows
        name, number = table.column_names[i], NUMBERS[which % len(NUMBERS)]
        if action == "value":
            values = table[i].to_numpy().copy() if table[i].type == pa.float64() else np.zeros(rows)
            values[which % rows] = number
            return table.set_column(i, name, pa.array(values))
        if action == "constant":
            return table.set_column(i, name, pa.array(np.full(rows, number)))
        if action == "null":
            return table.set_column(i, name, pa.nulls(rows, pa.float64()))
        if action == "type":
            return table.set_column(i, name, pa.nulls(rows, TYPES[which % len(TYPES)]))
        if action == "rename":
            return table.set_column(i, NAMES[which % len(NAMES)], table[i])
        if action == "add":
            return table.append_column(NAMES[which % len(NAMES)], table[i])
        if action == "rows":
            return [table.slice(0, 0), pa.concat_tables([table] * 3), table.slice(1), table.slice(0, 1)][which % 4]
        return table.remove_column(i)

    def check(changes: list[tuple[int, str, int]]) -> None:
        table = signals
        for column, action, which in changes:
            if table.num_rows:
                table = change(table, column, action, which)
        shutil.copytree(made, folder)
        pq.write_table(table, folder / SIGNALS)
        summary = json.loads((folder / SUMMARY).read_text())
        names_once = len(set(table.column_names)) == table.num_columns
        if names_once and all(field.type == pa.float64() for field in table.schema):
            summary["provenance"]["signals_sha256"] = signals_hash(table)
        (folder / SUMMARY).write_text(json.dumps(summary))
        attempt(fuzzer, folder)

    actions = st.sampled_from(["value", "constant", "null", "type", "rename", "add", "rows", "remove"])
    changes = st.lists(st.tuples(st.integers(0, 400), actions, st.integers(0, 100)), min_size=1, max_size=3)
    fuzzer.run(check, changes, [[(0, "value", 0)], [(5, "constant", 3)]], inputs=150)


def test_links(fuzzer: Any, made: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Files and folders that lead out of the run are neither read nor written."""
    folder, outside = fuzzer.place / "run", tmp_path_factory.mktemp("outside")
    targets = [outside, outside / "new", "/dev/zero", "/dev/full", "/proc/kmsg", "/etc/passwd", "../run", ".", "loop"]

    def check(links: dict[str, Any]) -> None:
        shutil.copytree(made, folder)
        for name, target in links.items():
            (folder / name).unlink(missing_ok=True)
            (folder / name).symlink_to(target if target != "loop" else name)
        attempt(fuzzer, folder)
        assert list(outside.iterdir()) == []

    names = st.sampled_from([SCENARIO, SIGNALS, SUMMARY, "csv", "signals.csv", "plots", "replay.html"])
    fuzzer.run(check, st.dictionaries(names, st.sampled_from(targets), min_size=1, max_size=2), [], inputs=30)
