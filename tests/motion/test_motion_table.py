"""Recordings are read strictly; one that cannot be used produces a one-line error, at bounded cost."""

import os
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from humanwalk.motion.motion_table import (
    MAX_BYTES,
    MAX_COLUMNS,
    MAX_LINE,
    MAX_NUMBER,
    MAX_ROWS,
    MIN_TIME_STEP,
    MotionTable,
    parse_motion_table,
    read_motion_table,
    storage_text,
)
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError

HEAD = "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees={flag}\nendheader\n"


def refusal(path: Path) -> str:
    with pytest.raises(ParameterError) as raised:
        read_motion_table(path)
    message = str(raised.value)
    assert len(message.splitlines()) == 1
    return message


def written(tmp_path: Path, text: str, name: str = "walk.csv") -> Path:
    path = tmp_path / name
    path.write_text(text)
    return path


numbers = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(arrays(float, (3, 4), elements=numbers), st.booleans())
def test_written_table_is_read_back(tmp_path_factory: pytest.TempPathFactory, data: Array, in_degrees: bool) -> None:
    table = MotionTable(("a", "b c", "d", "e"), np.array([0.0, 0.1, 0.3]), data, in_degrees)
    path = tmp_path_factory.mktemp("table") / "t.mot"
    path.write_text(storage_text("t", table))
    found = read_motion_table(path)
    assert (found.columns, found.in_degrees) == (table.columns, in_degrees)
    np.testing.assert_allclose(found.data, data, rtol=1e-11, atol=1e-300)
    np.testing.assert_allclose(found.time, table.time, rtol=1e-11)


@pytest.mark.parametrize("flag", ["true", "1", "", "Y"])
def test_another_flag_of_degrees_is_refused_instead_of_read_as_radians(tmp_path: Path, flag: str) -> None:
    path = written(tmp_path, HEAD.format(flag=flag) + "time\ta\tb\n0\t1\t2\n1\t3\t4\n", "t.mot")
    assert "line 5: inDegrees=" in refusal(path)
    assert "allowed: yes or no" in refusal(path)


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ("nRows=1000", "nRows=1000, but there are 2"),
        ("nRows=1_0", "nRows=1_0"),
        ("nColumns=4", "nColumns=4, but there are 3"),
    ],
)
def test_a_table_of_another_size_than_its_header_states_is_refused(tmp_path: Path, stated: str, said: str) -> None:
    text = f"walk\n{stated}\ninDegrees=yes\nendheader\ntime\ta\tb\n0\t1\t2\n1\t3\t4\n"
    assert said in refusal(written(tmp_path, text, "t.mot"))


@pytest.mark.parametrize("cell", ["1_5", "\u0661\u0662"])
def test_a_cell_is_a_number_in_digits_of_ascii(tmp_path: Path, cell: str) -> None:
    assert "is not a number" in refusal(written(tmp_path, f"time,a\n0,{cell}\n1,2\n"))


def test_a_storage_header_without_a_flag_leaves_the_unit_open(tmp_path: Path) -> None:
    path = written(tmp_path, "t\nversion=1\nendheader\ntime\ta\n0\t1\n1\t3\n", "t.mot")
    assert read_motion_table(path).in_degrees is None


@pytest.mark.parametrize("name", ["Time", "TIME", "Time_s"])
def test_time_is_found_in_any_column_and_case(tmp_path: Path, name: str) -> None:
    table = read_motion_table(written(tmp_path, f"Frame,{name},a\n1,0.00,5\n2,0.01,6\n"))
    assert table.columns == ("Frame", "a")
    np.testing.assert_array_equal(table.time, [0.0, 0.01])


def test_a_separator_at_the_end_of_every_line_is_no_column(tmp_path: Path) -> None:
    text = HEAD.format(flag="yes") + "time\ta\tb\t\n0\t1\t2\t\n1\t3\t4\t\n"
    assert read_motion_table(written(tmp_path, text, "t.mot")).columns == ("a", "b")


@pytest.mark.parametrize(("flag", "degrees"), [("yes", True), ("no", False), ("YES", True)])
def test_storage_header_specifies_degrees_or_radians(tmp_path: Path, flag: str, degrees: bool) -> None:
    path = written(tmp_path, HEAD.format(flag=flag) + "time a b\n 0 1 2\n 1  3 4\n", "t.sto")
    table = read_motion_table(path)
    assert table.in_degrees is degrees
    np.testing.assert_array_equal(table.data, [[1, 2], [3, 4]])


def test_csv_has_time_by_name_and_no_angle_unit(tmp_path: Path) -> None:
    table = read_motion_table(written(tmp_path, "a,time_s,b\n1,0,2\n3,0.5,4\n"))
    assert table.columns == ("a", "b")
    assert table.in_degrees is None
    np.testing.assert_array_equal(table.time, [0, 0.5])
    np.testing.assert_array_equal(table.column("b"), [2, 4])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "fewer than two rows"),
        ("time,a\n0,1\n", "fewer than two rows"),
        ("time,a\n0,1\n1,x\n", "line 3, column a: 'x' is not a number"),
        ("time,a\n0,1\n1,\n", "line 3, column a: '' is not a number"),
        ("time,a\n0,1\n1,nan\n", "fill the gap"),
        ("time,a\n0,1\n1,inf\n", "finite"),
        ("time,a\n0,1\n1\n", "line 3 has 1 numbers; allowed: 2"),
        ("time,a\n0,1\n0,2\n", "line 3: time 0 is not after 0"),
        ("time,a\n1,1\n0,2\n", "increasing"),
        ("time,a,a\n0,1,1\n1,2,2\n", "occurs twice"),
        ("time,a\n0,1\n1e-17,1\n1,1\n", "line 3: time 1e-17 is less than 0.0001 s after 0"),
        ("time,a\n0,1\n1e308,1\n", "up to 1e+10"),
        ("time,a\n0,1\n1,-2e10\n", "up to 1e+10"),
        ("time,a\x1b[31m\n0,1\n1,x\n", r"column a\x1b[31m: 'x'"),
    ],
)
def test_error_of_an_invalid_table_has_the_line(tmp_path: Path, text: str, message: str) -> None:
    assert message in refusal(written(tmp_path, text))


def test_unreadable_file_produces_a_one_line_error(tmp_path: Path) -> None:
    assert "No such file" in refusal(tmp_path / "none.mot")
    assert "allowed: .mot, .sto, .csv" in refusal(written(tmp_path, "", "walk.xlsx"))
    assert "endheader" in refusal(written(tmp_path, "time,a\n0,1\n1,2\n", "walk.mot"))
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00")
    assert "not UTF-8" in refusal(tmp_path / "b.csv")
    (tmp_path / "folder.csv").mkdir()
    refusal(tmp_path / "folder.csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"time,a\n0,{'1' * 200_000}\n1,1\n", f"line 2 has over {MAX_LINE} characters"),
        (f"time,{'a' * 200_000}\n0,1\n1,1\n", f"line 1 has over {MAX_LINE} characters"),
        (",".join(f"c{i}" for i in range(MAX_COLUMNS + 1)) + "\n", f"allowed: up to {MAX_COLUMNS}"),
        ("," * (MAX_LINE // 2), f"allowed: up to {MAX_COLUMNS}"),
        ("time,a\n" + "".join(f"{i},0\n" for i in range(MAX_ROWS + 1)), f"more than {MAX_ROWS} rows"),
        ("time," + "x" * 1000 + "\n0,bad\n", "..."),
    ],
    ids=["cell", "name", "columns", "empty columns", "rows", "long name"],
)
def test_oversized_table_produces_a_short_error(tmp_path: Path, text: str, message: str) -> None:
    error = refusal(written(tmp_path, text))
    assert message in error
    assert len(error) < 500


@pytest.mark.parametrize("separator", [";", "\t"])
def test_another_separator_is_named_as_the_problem(tmp_path: Path, separator: str) -> None:
    rows = (("time", "hip_flexion_r_deg"), ("0,00", "1,5"), ("0,01", "1,6"))
    error = refusal(written(tmp_path, "".join(separator.join(row) + "\n" for row in rows)))
    assert "separate columns by commas, and write decimals with a point" in error


def test_oversized_file_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "sparse.csv"
    with path.open("wb") as file:
        file.truncate(MAX_BYTES + 1)
    assert f"allowed: up to {MAX_BYTES}" in refusal(path)


@pytest.mark.parametrize(
    "content",
    [b"0\n" * 200_000, b"0" * 400_000, b"0," * 200_000, b"time,a\n" + b"".join(b"%d,0\n" % i for i in range(50_000))],
    ids=["zero rows", "one cell", "zero columns", "valid"],
)
def test_memory_is_bounded_by_the_size_of_the_input(content: bytes) -> None:
    tracemalloc.start()
    try:
        parse_motion_table(content, "t.csv", is_csv=True)
    except ParameterError:
        pass
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert peak < 10 * len(content) + 1_000_000


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no device files")
def test_device_or_pipe_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.mot")
    assert "allowed: a regular file" in refusal(tmp_path / "pipe.mot")
    for endless in ("/dev/zero", "/proc/kmsg"):
        (tmp_path / "link.mot").unlink(missing_ok=True)
        (tmp_path / "link.mot").symlink_to(endless)
        refusal(tmp_path / "link.mot")


lines = st.lists(
    st.lists(
        st.one_of(
            st.floats(width=64).map(repr),
            st.integers(-5, 5).map(str),
            st.sampled_from(["time", "inDegrees=yes", "endheader", '"', "'", "1_0", "\x00", "\u2028", "\r", ""]),
            st.text(max_size=5),
        ),
        max_size=4,
    ).flatmap(lambda cells: st.sampled_from([",", "\t", " "]).map(lambda delimiter: delimiter.join(cells))),
    max_size=8,
).map("\n".join)


@given(st.one_of(st.binary(max_size=200), lines.map(lambda text: text.encode("utf-8", "replace"))), st.booleans())
def test_any_content_is_a_table_or_a_one_line_error(content: bytes, is_csv: bool) -> None:
    try:
        table = parse_motion_table(content, "name", is_csv=is_csv)
    except (ParameterError, UnicodeDecodeError) as error:
        if isinstance(error, ParameterError):
            assert str(error).isprintable()
        return
    assert table.data.shape == (table.time.size, len(table.columns))
    assert np.abs(table.data).max(initial=0.0) <= MAX_NUMBER
    assert np.diff(table.time).min() >= MIN_TIME_STEP
