"""Files that are written whole or not at all."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from humanwalk.quantity import ParameterError


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` fill a file beside `path`, then put it in place; a failure leaves what was there before.

    Args:
        path: the file to appear.
        write: called with the path of the file to fill, with the same suffix.

    Raises:
        ParameterError: the file cannot be written, with the system's reason.
    """
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise ParameterError(_cannot_write(path, error)) from None
    beside = Path(name)
    try:
        write(beside)
        with beside.open("rb") as file:
            os.fsync(file.fileno())
        # mkstemp makes files private; a result is as readable as the umask lets any other file be.
        umask = os.umask(0)
        os.umask(umask)
        beside.chmod(0o666 & ~umask)
        beside.replace(path)
    except OSError as error:
        raise ParameterError(_cannot_write(path, error)) from None
    finally:
        beside.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text whole or not at all; see `write_whole`."""
    write_whole(path, lambda beside: beside.write_text(text, encoding="utf-8"))


def make_folder(path: Path) -> list[Path]:
    """Make a folder and its parents, unless it is there already, and return those that were made, innermost first.

    Raises:
        ParameterError: it cannot be made or written into.
    """
    made = [folder for folder in (path, *path.parents) if not folder.exists()]
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        raise ParameterError(_cannot_write(path, error)) from None
    return made


def _cannot_write(path: Path, error: OSError) -> str:
    return (
        f"{path}: {error.strerror or error}; allowed: a folder that you may write to, with room; choose another with -o"
    )
