"""Files are read within bounds and written whole or not at all; errors of the system are one line."""

import errno
import os
import stat
from operator import methodcaller
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.files import make_folder, read_regular, read_text, require_inside, write_set, write_text, write_whole
from humanwalk.quantity import ParameterError


def one_line(raised: Any) -> str:
    message = str(raised.value)
    assert len(message.splitlines()) == 1
    return message


def test_text_is_written_as_utf_8_and_nothing_else_is_left(tmp_path: Path) -> None:
    path = tmp_path / "walk.txt"
    write_text(path, "Schrittlänge\n")
    assert path.read_bytes() == "Schrittlänge\n".encode()
    assert list(tmp_path.iterdir()) == [path]


def test_old_file_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "walk.txt"
    path.write_text("old and longer")
    write_text(path, "new")
    assert path.read_text() == "new"


def test_the_writer_gets_a_file_of_the_same_kind_in_the_same_folder(tmp_path: Any) -> None:
    seen = []
    write_whole(tmp_path / "walk.png", lambda beside: (seen.append(beside), beside.write_bytes(b"x")))  # type: ignore[func-returns-value]
    assert seen[0].suffix == ".png"
    assert seen[0].parent == tmp_path
    assert not seen[0].exists()


def test_result_is_as_readable_as_any_other_file(tmp_path: Path) -> None:
    write_text(tmp_path / "result", "x")
    (tmp_path / "ordinary").write_text("x")
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("result", "ordinary")]
    assert modes[0] == modes[1]


def test_a_set_is_never_old_and_new_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program that is killed at any replacement leaves one generation, or no last file."""
    paths, seen = [tmp_path / "signals", tmp_path / "summary"], []
    replace = Path.replace

    def watched(beside: Path, path: Path) -> None:
        seen.append([p.read_text() for p in paths if p.exists()])
        replace(beside, path)

    monkeypatch.setattr(Path, "replace", watched)
    for text in (b"old", b"new"):
        write_set(dict.fromkeys(paths, methodcaller("write_bytes", text)))
    assert seen == [[], ["old"], ["old"], ["new"]]
    assert [path.read_text() for path in paths] == ["new", "new"]


def test_a_failing_writer_of_a_set_leaves_the_old_set(tmp_path: Path) -> None:
    paths = [tmp_path / "signals", tmp_path / "summary"]
    write_set({path: lambda beside: beside.write_text("old") for path in paths})
    with pytest.raises(ZeroDivisionError):
        write_set({paths[0]: lambda beside: beside.write_text("new"), paths[1]: lambda beside: 1 / 0})
    assert [path.read_text() for path in paths] == ["old", "old"]
    assert sorted(tmp_path.iterdir()) == paths


def test_a_name_may_be_as_long_as_the_system_allows(tmp_path: Path) -> None:
    path = tmp_path / f"{'a' * 250}.json"
    write_whole(path, lambda beside: beside.write_text("x"))
    assert path.read_text() == "x"


@pytest.mark.parametrize("error", [RuntimeError("no"), KeyboardInterrupt(), ValueError("no")])
def test_failing_writer_leaves_the_old_file_and_no_other(tmp_path: Path, error: Any) -> None:
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
def test_full_disk_leaves_the_old_file_with_a_one_line_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    path = tmp_path / "walk.txt"
    path.write_text("old")

    def full(*args: int | Path, **kwargs: Any) -> None:
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


def test_full_device_is_a_one_line_error(tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full on this system")

    def write(beside: Path) -> None:
        with open("/dev/full", "w") as device:
            device.write("x")

    with pytest.raises(ParameterError, match="No space left"):
        write_whole(tmp_path / "walk.txt", write)
    assert list(tmp_path.iterdir()) == []


def test_missing_folder_is_a_one_line_error(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="No such file or directory") as raised:
        write_text(tmp_path / "none" / "walk.txt", "x")
    one_line(raised)


def test_file_in_place_of_a_folder_is_a_one_line_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(ParameterError, match="Not a directory") as raised:
        write_text(tmp_path / "file" / "walk.txt", "x")
    one_line(raised)


def test_folder_in_place_of_the_file_is_a_one_line_error(tmp_path: Path) -> None:
    (tmp_path / "walk.txt").mkdir()
    with pytest.raises(ParameterError, match="directory") as raised:
        write_text(tmp_path / "walk.txt", "x")
    one_line(raised)
    assert [path.name for path in tmp_path.iterdir()] == ["walk.txt"]


def test_folder_is_made_with_its_parents_and_may_be_there(tmp_path: Path) -> None:
    for _ in range(2):
        make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()
    assert list((tmp_path / "a" / "b").iterdir()) == []


def test_make_folder_in_place_of_a_file_is_a_one_line_error(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("x")
    for path in (tmp_path / "a", tmp_path / "a" / "b"):
        with pytest.raises(ParameterError) as raised:
            make_folder(path)
        assert str(path) in one_line(raised)


def test_folder_without_write_permission_is_a_one_line_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: int | Path, **kwargs: Any) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr("tempfile.NamedTemporaryFile", refuse)
    with pytest.raises(ParameterError, match="Permission denied"):
        make_folder(tmp_path)


# Reading.


def refusal(path: Path, limit: int = 100) -> str:
    with pytest.raises(ParameterError) as raised:
        read_regular(path, limit)
    return one_line(raised)


@given(content=st.binary(max_size=200))
def test_a_file_up_to_the_limit_is_read_and_a_larger_one_refused(
    tmp_path_factory: pytest.TempPathFactory, content: bytes
) -> None:
    path = tmp_path_factory.mktemp("read") / "file"
    path.write_bytes(content)
    assert read_regular(path, len(content)) == content
    if content:
        assert f"allowed: up to {len(content) - 1}" in refusal(path, len(content) - 1)


def test_fifo_is_refused_without_waiting_for_a_writer(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    assert "regular file" in refusal(tmp_path / "fifo")


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/null", "/dev/stdin"])
def test_device_is_refused(device: str) -> None:
    assert "regular file" in refusal(Path(device))


def test_file_of_the_kernel_that_declares_no_size_is_empty() -> None:
    assert read_regular(Path("/proc/self/status"), 100) == b""


def test_folder_and_missing_file_are_refused(tmp_path: Path) -> None:
    assert "Is a directory" in refusal(tmp_path)
    assert "No such file" in refusal(tmp_path / "none")


@pytest.mark.parametrize("name", ["x" * 300, "a\0b", "\udcff\n"], ids=["too long", "NUL", "not UTF-8"])
def test_name_that_no_file_has_is_one_line(tmp_path: Path, name: str) -> None:
    for use in (lambda: read_regular(tmp_path / name, 1), lambda: make_folder(tmp_path / name / "run")):
        with pytest.raises(ParameterError) as raised:
            use()
        assert one_line(raised).isprintable()


def test_folder_so_deep_that_its_files_have_no_name_is_refused(tmp_path: Path) -> None:
    """The folder itself can be made; files in it could not be."""
    deep = tmp_path
    while len(str(deep)) < 4096 - 110:
        deep = deep / ("x" * min(100, 4096 - 60 - len(str(deep))))
    with pytest.raises(ParameterError, match="File name too long"):
        make_folder(deep / ("y" * max(1, 4095 - 40 - len(str(deep)))))


def test_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"\xef\xbb\xbf{}")
    assert read_text(tmp_path / "a", 10) == "{}"


def test_bytes_that_are_no_text_are_refused_by_their_place(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"ab\xff")
    with pytest.raises(ParameterError, match="byte 2 is not UTF-8"):
        read_text(tmp_path / "a", 10)


# Links.


def test_what_leads_out_of_a_folder_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "plots").symlink_to(tmp_path)
    (folder / "own").symlink_to(folder / "other")
    for path in (folder / "plots", folder / "plots" / "a.png", folder / ".." / "other"):
        with pytest.raises(ParameterError, match="leads out of"):
            require_inside(folder, path)
    for path in (folder / "plots.d" / "a.png", folder / "own"):
        assert require_inside(folder, path) == path


def test_link_in_place_of_a_result_is_replaced_and_not_followed(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    (tmp_path / "result").symlink_to(tmp_path / "mine")
    write_text(tmp_path / "result", "new")
    assert (tmp_path / "mine").read_text() == "mine"
    assert (tmp_path / "result").read_text() == "new"
