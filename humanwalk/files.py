"""Files of others, read within bounds, and files of ours, written whole or not at all."""

import errno
import fcntl
import os
import stat
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from humanwalk.quantity import ParameterError, printable

READABLE = "a folder that you may read; check its permissions"
WRITABLE = "a folder that you may write to, with room; choose another with -o"
OUR_FOLDER = "a folder that you may write to, with room; change its permissions, or copy it"

TEMPORARY_NAME = 80
"""Length of file name that a folder has to take [bytes]: a file that is being written has a longer name for a while."""


def read_regular(path: Path, limit: int) -> bytes:
    """Read a file that somebody else may have made: the one way to read any input file.

    Opening neither waits for a FIFO nor touches a device, and no more is read than the file system declares.

    Args:
        path: the file, or a link to it.
        limit: largest size [bytes].

    Raises:
        ParameterError: there is no such file, it is no regular one, it is larger, or it cannot be read.
    """
    with (
        file_errors(path, "a readable file; check the path and its permissions"),
        open(path, "rb", buffering=0, opener=_open_without_waiting) as file,
    ):
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise ParameterError(f"{printable(path)}: a device or pipe; allowed: a regular file; give the path of one")
        if status.st_size > limit:
            raise ParameterError(
                f"{printable(path)}: {status.st_size} bytes; allowed: up to {limit}; give a smaller file"
            )
        content = bytearray()
        while len(content) < status.st_size and (more := file.read(status.st_size - len(content))):
            content += more
    return bytes(content)


def read_text(path: Path, limit: int) -> str:
    """Read a UTF-8 file, with or without a byte order mark; see `read_regular`."""
    try:
        return read_regular(path, limit).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ParameterError(
            f"{printable(path)}: byte {error.start} is not UTF-8; allowed: text in UTF-8; save it as that"
        ) from None


def require_inside(folder: Path, path: Path) -> Path:
    """Return `path`, which is used as a part of `folder`.

    Raises:
        ParameterError: it leads outside, by its name or by a symbolic link.
    """
    with file_errors(path, "a path inside the folder"):
        # Path.resolve raises RuntimeError for a link to itself.
        inside = Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))
    if not inside:
        raise ParameterError(
            f"{printable(path)}: leads out of {printable(folder)}; allowed: files of that folder; remove the link"
        )
    return path


def file_of(folder: Path, name: str, kind: str, command: str) -> Path:
    """Path of a file that every folder of a kind has.

    Args:
        folder: given by the user.
        name: of the file.
        kind: what the folder holds, for the error: "run".
        command: what writes such folders: "humanwalk walk".

    Raises:
        ParameterError: it is missing, leads out of the folder, or the folder cannot be read.
    """
    path = require_inside(folder, folder / name)
    with file_errors(path, READABLE):
        found = path.is_file()
    if not found:
        raise ParameterError(
            f"{printable(folder)}: no {kind}, {name} is missing; allowed: a folder written by {command}; give its path"
        )
    return path


def require_new(path: Path, overwrite: bool) -> None:
    """Raise ParameterError, before the work that fills it, for a file that cannot be written, and for one of the user
    that is there already, unless it may be replaced.
    """
    if _is_there(path, "-o ", "choose another name", WRITABLE) and not overwrite:
        raise ParameterError(
            f"-o {printable(path)}: is there already; allowed: a new file, or any with --overwrite; choose another name"
        )


def require_replaceable(path: Path) -> None:
    """Raise ParameterError, before the work that fills it, if a file whose name humanwalk chooses cannot be written."""
    _is_there(path, "", "move it away", OUR_FOLDER)


def _is_there(path: Path, option: str, fix: str, folder: str) -> bool:
    """Whether a file is there; raises ParameterError where none can be written.

    Args:
        path: of the file.
        option: that names it, for the error.
        fix: of a folder or device in its place.
        folder: what its folder has to be, and the fix.
    """
    with file_errors(path, folder):
        found = path.exists()
        if found and not path.is_file():
            raise ParameterError(f"{option}{printable(path)}: a folder or device; allowed: a file; {fix}")
        _require_writable(path.parent)
    return found


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` fill a file beside `path`, then put it in place; a failure leaves what was there before.

    Args:
        path: the file to appear. A symbolic link of that name is replaced, not followed.
        write: called with the path of the file to fill, with the same suffix.

    Raises:
        ParameterError: the file cannot be written, with the system's reason.
    """
    write_set({path: write})


def write_set(files: Mapping[Path, Callable[[Path], object]]) -> None:
    """Write files that belong together, each as `write_whole` does; all are filled before the first is put in place.

    The last file is missing while the others are replaced: a program that is killed never leaves it beside files of
    another set.

    Args:
        files: what to call for each file.

    Raises:
        ParameterError: a file cannot be written, with the system's reason.
    """
    *others, last = files
    with ExitStack() as prepared:
        filled = {path: prepared.enter_context(_filled(path, write)) for path, write in files.items()}
        if others:
            with file_errors(last, WRITABLE):
                last.unlink(missing_ok=True)
        for path, beside in filled.items():
            with file_errors(path, WRITABLE):
                beside.replace(path)


@contextmanager
def _filled(path: Path, write: Callable[[Path], object]) -> Iterator[Path]:
    """A file beside `path` that `write` has filled; removed at the end unless it was moved."""
    with file_errors(path, WRITABLE):
        handle, name = tempfile.mkstemp(prefix=".humanwalk-", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    beside = Path(name)
    try:
        with file_errors(path, WRITABLE):
            write(beside)
            with beside.open("rb") as file:
                os.fsync(file.fileno())
            # mkstemp makes files private; a result is as readable as the umask lets any other file be.
            umask = os.umask(0)
            os.umask(umask)
            beside.chmod(0o666 & ~umask)
        yield beside
    finally:
        beside.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text whole or not at all; see `write_whole`."""
    write_whole(path, lambda beside: beside.write_text(text, encoding="utf-8"))


def make_folder(path: Path) -> list[Path]:
    """Make a folder and its parents, unless it is there already, and return those that were made, innermost first.

    Raises:
        ParameterError: it cannot be made or written into, or its name is no text that other programs can read.
    """
    with file_errors(path, WRITABLE):
        str(path).encode()
        made = [folder for folder in (path, *path.parents) if not folder.exists()]
        path.mkdir(parents=True, exist_ok=True)
        _require_writable(path)
    return made


def require_empty(
    folder: Path, allowed: str = "a new or empty folder", is_ours: Callable[[str], bool] = lambda name: False
) -> None:
    """Raise ParameterError for a folder that holds files.

    Args:
        folder: chosen with -o.
        allowed: what it may be.
        is_ours: whether it may hold a file of this name.
    """
    with file_errors(folder, WRITABLE):
        if not all(is_ours(entry.name) for entry in folder.iterdir()):
            raise ParameterError(
                f"-o {printable(folder)}: holds files already; allowed: {allowed}; choose another, or remove it first"
            )


def _require_writable(folder: Path) -> None:
    """Raise OSError unless files can be made in a folder."""
    with tempfile.NamedTemporaryFile(dir=folder, prefix="." + "x" * TEMPORARY_NAME):
        pass


@contextmanager
def locked(folder: Path, refusal: str) -> Iterator[None]:
    """Within the block, no other process has the lock of the folder; the lock ends with the process.

    Raises:
        ParameterError: another process has it; the message is `refusal`.
    """
    with file_errors(folder, WRITABLE):
        handle = os.open(folder, os.O_RDONLY)
    try:
        with file_errors(folder, WRITABLE):
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ParameterError(refusal) from None
        yield
    finally:
        os.close(handle)


def _open_without_waiting(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_NONBLOCK)


@contextmanager
def file_errors(path: Path, allowed: str) -> Iterator[None]:
    """Turn an error of the file system in the block, or a name that no file can have, into a one-line ParameterError.

    Args:
        path: what the block reads or writes.
        allowed: what it has to be, and the fix.
    """
    try:
        if "\0" in str(path):
            raise OSError(errno.EINVAL, "a NUL character in a name")
        yield
    except OSError as error:
        raise ParameterError(f"{printable(path)}: {error.strerror or error}; allowed: {allowed}") from None
    except UnicodeEncodeError:
        raise ParameterError(f"{printable(path)}: not UTF-8 text; allowed: {allowed}") from None
