"""Files appear whole or not at all, and the system's reason is told in one line."""

import errno
import os
import stat
from pathlib import Path

import pytest

from humanwalk.files import make_folder, write_text, write_whole
from humanwalk.quantity import ParameterError


def one_line(raised) -> str:
    message = str(raised.value)
    assert len(message.splitlines()) == 1
    return message


def test_text_is_written_as_utf_8_and_nothing_else_is_left(tmp_path):
    path = tmp_path / "walk.txt"
    write_text(path, "Schrittlänge\n")
    assert path.read_bytes() == "Schrittlänge\n".encode()
    assert list(tmp_path.iterdir()) == [path]


def test_old_file_is_replaced(tmp_path):
    path = tmp_path / "walk.txt"
    path.write_text("old and longer")
    write_text(path, "new")
    assert path.read_text() == "new"


def test_the_writer_gets_a_file_of_the_same_kind_in_the_same_folder(tmp_path):
    seen = []
    write_whole(tmp_path / "walk.png", lambda beside: (seen.append(beside), beside.write_bytes(b"x")))
    assert seen[0].suffix == ".png"
    assert seen[0].parent == tmp_path
    assert not seen[0].exists()


def test_result_is_as_readable_as_any_other_file(tmp_path):
    write_text(tmp_path / "result", "x")
    (tmp_path / "ordinary").write_text("x")
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("result", "ordinary")]
    assert modes[0] == modes[1]


@pytest.mark.parametrize("error", [RuntimeError("no"), KeyboardInterrupt(), ValueError("no")])
def test_failing_writer_leaves_the_old_file_and_no_other(tmp_path, error):
    path = tmp_path / "walk.txt"
    path.write_text("old")

    def fail(beside: Path) -> None:
        beside.write_text("half of the n")
        raise error

    with pytest.raises(type(error)):
        write_whole(path, fail)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("step", ["replace", "fsync"])
def test_full_disk_leaves_the_old_file_and_is_told(tmp_path, monkeypatch, step):
    path = tmp_path / "walk.txt"
    path.write_text("old")

    def full(*args, **kwargs):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    if step == "replace":
        monkeypatch.setattr(Path, "replace", full)
    else:
        monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ParameterError) as raised:
        write_text(path, "new")
    assert str(path) in one_line(raised)
    assert "No space left" in one_line(raised)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_really_full_disk_is_told(tmp_path):
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full on this system")

    def write(beside: Path) -> None:
        with open("/dev/full", "w") as device:
            device.write("x")

    with pytest.raises(ParameterError, match="No space left"):
        write_whole(tmp_path / "walk.txt", write)
    assert list(tmp_path.iterdir()) == []


def test_missing_folder_is_told(tmp_path):
    with pytest.raises(ParameterError, match="No such file or directory") as raised:
        write_text(tmp_path / "none" / "walk.txt", "x")
    one_line(raised)


def test_file_in_place_of_a_folder_is_told(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ParameterError, match="Not a directory") as raised:
        write_text(tmp_path / "file" / "walk.txt", "x")
    one_line(raised)


def test_folder_in_place_of_the_file_is_told(tmp_path):
    (tmp_path / "walk.txt").mkdir()
    with pytest.raises(ParameterError, match="directory") as raised:
        write_text(tmp_path / "walk.txt", "x")
    one_line(raised)
    assert [path.name for path in tmp_path.iterdir()] == ["walk.txt"]


def test_folder_is_made_with_its_parents_and_may_be_there(tmp_path):
    for _ in range(2):
        make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()
    assert list((tmp_path / "a" / "b").iterdir()) == []


def test_folder_in_place_of_which_a_file_is_is_told(tmp_path):
    (tmp_path / "a").write_text("x")
    for path in (tmp_path / "a", tmp_path / "a" / "b"):
        with pytest.raises(ParameterError) as raised:
            make_folder(path)
        assert str(path) in one_line(raised)


def test_folder_that_takes_no_files_is_told(tmp_path, monkeypatch):
    def refuse(*args, **kwargs):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    with pytest.raises(ParameterError, match="Permission denied"):
        make_folder(tmp_path)
