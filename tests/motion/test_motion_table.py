"""Recordings are read strictly, and answered in one line when they cannot be used."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from humanwalk.motion.motion_table import MotionTable, read_motion_table, storage_text
from humanwalk.quantity import ParameterError

HEAD = "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees={flag}\nendheader\n"


def refusal(path):
    with pytest.raises(ParameterError) as raised:
        read_motion_table(path)
    message = str(raised.value)
    assert len(message.splitlines()) == 1
    return message


def written(tmp_path, text, name="walk.csv"):
    path = tmp_path / name
    path.write_text(text)
    return path


numbers = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(arrays(float, (3, 4), elements=numbers), st.booleans())
def test_what_is_written_is_read(tmp_path_factory, data, in_degrees):
    table = MotionTable(("a", "b c", "d", "e"), np.array([0.0, 0.1, 0.3]), data, in_degrees)
    path = tmp_path_factory.mktemp("table") / "t.mot"
    path.write_text(storage_text("t", table))
    found = read_motion_table(path)
    assert (found.columns, found.in_degrees) == (table.columns, in_degrees)
    np.testing.assert_allclose(found.data, data, rtol=1e-11, atol=1e-300)
    np.testing.assert_allclose(found.time, table.time, rtol=1e-11)


@pytest.mark.parametrize(("flag", "degrees"), [("yes", True), ("no", False), ("YES", True)])
def test_storage_says_whether_it_is_in_degrees(tmp_path, flag, degrees):
    path = written(tmp_path, HEAD.format(flag=flag) + "time a b\n 0 1 2\n 1  3 4\n", "t.sto")
    table = read_motion_table(path)
    assert table.in_degrees is degrees
    np.testing.assert_array_equal(table.data, [[1, 2], [3, 4]])


def test_csv_finds_its_time_by_name_and_does_not_say_its_unit(tmp_path):
    table = read_motion_table(written(tmp_path, "a,time_s,b\n1,0,2\n3,0.5,4\n"))
    assert table.columns == ("a", "b")
    assert table.in_degrees is None
    np.testing.assert_array_equal(table.time, [0, 0.5])
    np.testing.assert_array_equal(table.column("b"), [2, 4])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "fewer than two rows"),
        ("time,a\n0,1\n", "fewer than two rows"),
        ("time,a\n0,1\n1,x\n", "line 3, column a: 'x' is no number"),
        ("time,a\n0,1\n1,\n", "line 3, column a: '' is no number"),
        ("time,a\n0,1\n1,nan\n", "fill the gap"),
        ("time,a\n0,1\n1,inf\n", "finite"),
        ("time,a\n0,1\n1\n", "line 3 has 1 numbers; allowed: 2"),
        ("time,a\n0,1\n0,2\n", "line 3: time 0 does not come after 0"),
        ("time,a\n1,1\n0,2\n", "increasing"),
        ("time,a,a\n0,1,1\n1,2,2\n", "comes twice"),
    ],
)
def test_table_that_cannot_be_used_is_refused_with_the_line(tmp_path, text, said):
    assert said in refusal(written(tmp_path, text))


def test_file_that_cannot_be_read_is_refused(tmp_path):
    assert "No such file" in refusal(tmp_path / "none.mot")
    assert "allowed: .mot, .sto, .csv" in refusal(written(tmp_path, "", "walk.xlsx"))
    assert "endheader" in refusal(written(tmp_path, "time,a\n0,1\n1,2\n", "walk.mot"))
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00")
    assert "not text" in refusal(tmp_path / "b.csv")
    (tmp_path / "folder.csv").mkdir()
    refusal(tmp_path / "folder.csv")
