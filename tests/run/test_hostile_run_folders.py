"""Damaged and malicious run folders: each is read, or refused in one printable line."""

import errno
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from humanwalk.exchange import export_run
from humanwalk.measures.signals import TIME
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import REPLAY, SCENARIO, SIGNALS, SUMMARY, Run
from humanwalk.run.outcome import Outcome
from humanwalk.run.provenance import signals_hash
from humanwalk.run.simulate import simulate
from humanwalk.run.stored import MAX_COLUMNS, MAX_ROWS, before_runaway, required_columns
from humanwalk.scenario import load_scenario
from humanwalk.view.plots import PLOTS, write_plots
from humanwalk.view.report import compare_run, to_json

DURATION = 0.05


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run as the simulation leaves it."""
    outcome = simulate(load_scenario("thesis", {"duration": str(DURATION)}))
    return outcome.save(tmp_path_factory.mktemp("made") / "run").path


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """A copy of it to change."""
    return shutil.copytree(made, tmp_path / "run")


def read(folder: Path) -> Any:
    """Everything that is read of a run."""
    run = Run.open(folder)
    return run.summary, run.scenario, run.signals


def refusal(use: Callable[..., Any], *arguments: Any) -> str:
    with pytest.raises(ParameterError) as raised:
        use(*arguments)
    message = str(raised.value)
    assert message.isprintable()
    assert len(message) < 2000
    return message


def is_read(folder: Path) -> bool:
    """Whether a run is read; otherwise it is refused in one line, and nothing else is raised."""
    try:
        read(folder)
    except ParameterError as error:
        assert str(error).isprintable()
        return False
    return True


def test_run_as_it_was_written_is_read(folder: Path) -> None:
    assert is_read(folder)


# The summary.


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"[]",
        b"{}",
        b"null",
        b"3",
        b'"x"',
        b"{" * 100_000,
        b"[" * 900_000,
        b'{"a":' * 100_000 + b"1" + b"}" * 100_000,
        b"\xff\xfe{}",
        b"{} {}",
        b"\0",
        b" " * 2_000_000,
    ],
    ids=lambda content: repr(content[:8]),
)
def test_invalid_summary_is_refused(folder: Path, content: bytes) -> None:
    (folder / SUMMARY).write_bytes(content)
    assert SUMMARY in refusal(read, folder)


@pytest.mark.parametrize("name", ["peak_torque_N_m", "saturated_share", "tracking_error_rad"])
def test_summary_without_joints_is_refused(folder: Path, name: str) -> None:
    summary = json.loads((folder / SUMMARY).read_text())
    (folder / SUMMARY).write_text(json.dumps(summary | {name: {}}))
    assert f"{name} does not have the joints" in refusal(read, folder)


def test_summary_with_a_byte_order_mark_is_read(folder: Path) -> None:
    (folder / SUMMARY).write_bytes(b"\xef\xbb\xbf" + (folder / SUMMARY).read_bytes())
    assert is_read(folder)


WRONG = ["x", -1.5, True, None, [], {}, {"right": 1}, float("nan"), float("inf"), 10**400, "\x1b[2J" * 300]


@pytest.mark.parametrize("value", WRONG, ids=lambda value: repr(value)[:12])
def test_field_of_another_type_is_refused_by_its_name(folder: Path, value: Any) -> None:
    summary = json.loads((folder / SUMMARY).read_text())
    refused = set()
    for key in summary:
        (folder / SUMMARY).write_text(json.dumps(summary | {key: value}))
        if not is_read(folder):
            refused.add(key)
            assert key in refusal(read, folder)
    assert {"provenance", "gait", "foot_lift_m", "peak_torque_N_m", "versions", "duration_s"} - refused <= (
        {"peak_torque_N_m", "versions"} if value == {} else {"gait"} if value is None else {"duration_s"}
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("duration: x\n", ", line 1: duration: 'x' is"),
        ("duration: [\n", ": not YAML"),
        ("", ": empty"),
    ],
)
def test_an_error_of_the_scenario_names_the_folder_of_the_run(folder: Path, text: str, said: str) -> None:
    """A comparison reads several."""
    (folder / SCENARIO).write_text(text)
    with pytest.raises(ParameterError, match=rf"^{folder / SCENARIO}{said}"):
        assert Run.open(folder).scenario


@pytest.mark.parametrize("field", ["signals_sha256", "versions", "seed"])
def test_provenance_without_a_field_is_refused(folder: Path, field: str) -> None:
    summary = json.loads((folder / SUMMARY).read_text())
    del summary["provenance"][field]
    (folder / SUMMARY).write_text(json.dumps(summary))
    assert f"provenance: {field} is missing" in refusal(read, folder)


def test_field_and_joint_that_are_unknown_are_refused_without_their_control_characters(folder: Path) -> None:
    summary = json.loads((folder / SUMMARY).read_text())
    (folder / SUMMARY).write_text(json.dumps(summary | {"\x1b]0;x\x07": 1}))
    assert r"\x1b]0;x\x07 is no field" in refusal(read, folder)
    (folder / SUMMARY).write_text(json.dumps(summary | {"tracking_error_rad": {"Tail": 1.0}}))
    assert "tracking_error_rad" in refusal(read, folder)


# The signals.


def rewrite(folder: Path, change: Callable[..., Any]) -> None:
    """Change the signals and update their hash, as an attacker would."""
    table = change(pq.read_table(folder / SIGNALS))
    pq.write_table(table, folder / SIGNALS)
    summary = json.loads((folder / SUMMARY).read_text())
    numbers = [field.name for field in table.schema if field.type == pa.float64()]
    if len(set(table.column_names)) == len(table.column_names):
        summary["provenance"]["signals_sha256"] = signals_hash(table.select(numbers))
    (folder / SUMMARY).write_text(json.dumps(summary))


def replaced(table: pa.Table, name: str, values: Any) -> pa.Table:
    return table.set_column(table.column_names.index(name), name, [values])


def with_value(name: str, row: int, value: float) -> Callable[..., Any]:
    def change(table: pa.Table) -> pa.Table:
        values = table[name].to_numpy().copy()
        values[row] = value
        return replaced(table, name, values)

    return change


def with_type(kind: pa.DataType | pa.ListType | pa.StructType) -> Callable[..., Any]:
    return lambda table: replaced(table, "com.x_m", pa.array([None] * table.num_rows, kind))


KNEE = "RightLegTibiaMotion.angle_rad"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda table: table.slice(0, 0), "0 rows"),
        (lambda table: table.drop_columns("com.z_m"), "1 columns are missing, first com.z_m"),
        (lambda table: table.select([TIME]), "columns are missing"),
        (lambda table: table.append_column("com.z_m", table["com.z_m"]), "com.z_m comes twice"),
        (lambda table: table.append_column("\x1b[2J", table["com.z_m"]), r"\x1b[2J is not named"),
        (lambda table: table.append_column("a." + "x" * 200, table["com.z_m"]), "is not named thing.quantity_unit"),
        (lambda table: table.append_column("=cmd|' /C calc'!A0", table["com.z_m"]), "is not named"),
        (lambda table: table.append_column("com", table["com.z_m"]), "column com is not named"),
        (lambda table: table.append_column(f"{TIME}.x", table["com.z_m"]), f"column {TIME}.x is not named"),
        (with_type(pa.string()), "com.x_m is of type string"),
        (with_type(pa.int64()), "com.x_m is of type int64"),
        (with_type(pa.float32()), "com.x_m is of type float"),
        (with_type(pa.list_(pa.float64())), "com.x_m is of type list"),
        (with_type(pa.struct({"a": pa.float64()})), "com.x_m is of type struct"),
        (with_type(pa.float64()), "com.x_m has a value that is not finite"),
        (with_value(KNEE, 3, np.nan), f"{KNEE} has a value that is not finite"),
        (with_value(KNEE, 3, -np.inf), f"{KNEE} has a value that is not finite"),
        (with_value(KNEE, 3, 1e10), "beyond 1e"),
        (with_value(TIME, 3, 1e-3), "not a multiple"),
        (lambda table: replaced(table, TIME, table[TIME].to_numpy()[::-1]), "not a multiple"),
        (lambda table: replaced(table, TIME, np.zeros(table.num_rows)), "not a multiple"),
    ],
)
def test_invalid_record_is_refused(folder: Path, change: Callable[..., Any], said: str) -> None:
    rewrite(folder, change)
    assert said in refusal(read, folder)


def test_zero_quaternion_is_refused(folder: Path) -> None:
    def zero(table: pa.Table) -> pa.Table:
        for axis in "wxyz":
            table = replaced(table, f"pelvis.quaternion_{axis}", np.zeros(table.num_rows))
        return table

    rewrite(folder, zero)
    assert "pelvis.quaternion is zero" in refusal(read, folder)


def test_record_of_too_many_rows_or_columns_is_refused_before_it_is_loaded(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pq.ParquetFile, "read", lambda *arguments, **more: pytest.fail("loaded"))
    pq.write_table(pa.table({TIME: np.zeros(2_000_000)}), folder / SIGNALS)
    assert f"2000000 rows; allowed: 1 to {MAX_ROWS}" in refusal(read, folder)
    pq.write_table(pa.table({f"column {i}": [0.0] for i in range(MAX_COLUMNS + 1)}), folder / SIGNALS)
    assert f"{MAX_COLUMNS + 1} columns" in refusal(read, folder)


def test_record_that_was_changed_is_refused(folder: Path) -> None:
    table = pq.read_table(folder / SIGNALS)
    pq.write_table(with_value(KNEE, 3, 0.1)(table), folder / SIGNALS)
    assert "changed since the run" in refusal(read, folder)


@pytest.mark.parametrize("content", [b"", b"PAR1", b"PAR1PAR1", b"not Parquet", b"PAR1" + b"\xff" * 100 + b"PAR1"])
def test_invalid_parquet_file_is_refused(folder: Path, content: bytes) -> None:
    (folder / SIGNALS).write_bytes(content)
    assert "not a Parquet file" in refusal(read, folder)


def test_record_ends_before_a_state_that_has_run_away() -> None:
    table = pa.table({TIME: np.arange(6.0), "a": [0.0, 1.0, 2.0, 1e12, np.nan, 0.0], "b": [0.0] * 6})
    assert before_runaway(table).to_pydict() == {TIME: [0.0, 1.0, 2.0], "a": [0.0, 1.0, 2.0], "b": [0.0] * 3}
    assert before_runaway(table.slice(0, 3)).equals(table.slice(0, 3))
    assert before_runaway(table.slice(4)).num_rows == 0


# Damage.


@pytest.mark.parametrize("name", [SUMMARY, SIGNALS, SCENARIO])
@pytest.mark.parametrize("seed", range(40))
def test_flipped_bits_are_read_or_refused(folder: Path, name: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    content = bytearray((folder / name).read_bytes())
    for place in random.integers(0, len(content), random.integers(1, 4)):
        content[place] ^= 1 << int(random.integers(8))
    (folder / name).write_bytes(content)
    is_read(folder)


@pytest.mark.parametrize("name", [SUMMARY, SIGNALS, SCENARIO])
@pytest.mark.parametrize("seed", range(20))
def test_truncated_file_is_read_or_refused(folder: Path, name: str, seed: int) -> None:
    content = (folder / name).read_bytes()
    length = int(np.random.default_rng(seed).integers(len(content)))
    (folder / name).write_bytes(content[:length])
    assert not is_read(folder) or name == SCENARIO


# What leads out of the folder.


@pytest.mark.parametrize("name", [SCENARIO, SIGNALS, SUMMARY])
def test_link_out_of_the_folder_is_refused(folder: Path, tmp_path: Path, name: str) -> None:
    (folder / name).rename(tmp_path / name)
    (folder / name).symlink_to(tmp_path / name)
    assert "leads out of" in refusal(read, folder)


@pytest.mark.parametrize("name", [SCENARIO, SIGNALS, SUMMARY])
def test_link_to_itself_is_refused(folder: Path, name: str) -> None:
    (folder / name).unlink()
    (folder / name).symlink_to(name)
    assert f"{name} is missing" in refusal(read, folder)


def test_folder_that_may_not_be_read_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As stat answers there to anybody but root."""

    def denied(path: Path) -> bool:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)

    monkeypatch.setattr(Path, "is_file", denied)
    assert "Permission denied; allowed: a folder that you may read" in refusal(read, folder)


@pytest.mark.parametrize("name", [SCENARIO, SIGNALS, SUMMARY])
@pytest.mark.parametrize("kind", ["fifo", "folder", "device"])
def test_device_or_pipe_or_folder_is_refused_without_waiting(
    folder: Path, name: str, kind: pa.DataType | pa.ListType | pa.StructType
) -> None:
    (folder / name).unlink()
    if kind == "fifo":
        os.mkfifo(folder / name)
    elif kind == "folder":
        (folder / name).mkdir()
    else:
        (folder / name).symlink_to("/dev/zero")
    refusal(read, folder)


@pytest.mark.parametrize("file", ["/dev/zero", "/etc/passwd", "../outside.mot", "linked.mot"])
@pytest.mark.parametrize("field", ["angles", "mapping"])
def test_recording_is_followed_inside_the_folder_only(folder: Path, tmp_path: Path, file: str, field: str) -> None:
    (tmp_path / "outside.mot").write_text("")
    (folder / "linked.mot").symlink_to(tmp_path / "outside.mot")
    recorded = json.dumps({"angles": "own.mot"} | {field: file})
    (folder / SCENARIO).write_text(f"controller: {{recorded: {recorded}}}")
    assert "leads out of" in refusal(read, folder)


def test_results_are_written_inside_the_folder_only(folder: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for name in ("plots", "csv"):
        (folder / name).symlink_to(elsewhere)
    run = Run.open(folder)
    assert "leads out of" in refusal(write_plots, run)
    assert "leads out of" in refusal(export_run, run, "csv")
    assert list(elsewhere.iterdir()) == []


def test_replay_is_read_from_the_folder_only(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text("x")
    (folder / REPLAY).symlink_to(tmp_path / "page.html")
    assert "leads out of" in refusal(lambda: Run.open(folder).replay)


# Values that are allowed and absurd.


@pytest.fixture
def walk_of(walk: Callable[..., Any], tmp_path: Path) -> Callable[..., Any]:
    """A run of several strides, whose signals are changed."""

    def make(change: Callable[..., Any]) -> Run:
        signals = walk()
        zero = np.zeros(signals.num_rows)
        for name in sorted(required_columns(physics=True).difference(signals.column_names)):
            signals = signals.append_column(name, [zero])
        scenario = load_scenario("thesis", {"controller.thesis.balance.support.enabled": "false"})
        return Outcome(scenario, change(signals), "completed", wall_time=1.0).write(tmp_path, "walk")

    return make


def absurd(seed: int) -> Callable[..., Any]:
    """Replace random columns by constants, noise or spikes up to the largest value."""

    def change(signals: pa.Table) -> pa.Table:
        random = np.random.default_rng(seed)
        names = [name for name in signals.column_names if name != TIME and "quaternion" not in name]
        for name in random.choice(names, random.integers(1, 40), replace=False):
            size = 10.0 ** random.integers(-300, 10)
            noise = random.uniform(-1, 1, signals.num_rows)
            values = [noise, np.ones(signals.num_rows), np.where(noise > 0.99, 1.0, 0.0), -np.abs(noise)]
            signals = replaced(signals, str(name), 0.99 * size * values[random.integers(4)])
        return signals

    return change


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_absurd_values_are_reported_drawn_and_exported_or_refused(walk_of: Callable[..., Any], seed: int) -> None:
    run = walk_of(absurd(seed))
    plot = list(PLOTS)[seed % len(PLOTS)]
    uses = [lambda: to_json(compare_run(run)), lambda: write_plots(run, [plot])]
    uses += [lambda form=form: export_run(run, form) for form in ("csv", "mat", "opensim")]  # type: ignore[misc]
    for use in uses:
        try:
            use()  # type: ignore[no-untyped-call]
        except ParameterError as error:
            assert str(error).isprintable()
