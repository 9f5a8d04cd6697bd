"""YAML files that come with humanwalk, which are found by name as others are by path."""

import os
from collections.abc import Mapping
from importlib import resources
from pathlib import Path

from humanwalk.quantity import ParameterError, did_you_mean, printable


def shipped_files(folder: str) -> dict[str, Path]:
    """YAML files in a folder of humanwalk/models, by name without suffix."""
    models = Path(str(resources.files("humanwalk"))) / "models"
    return {path.stem: path for path in sorted((models / folder).glob("*.yaml"))}


def named_file(kind: str, name_or_path: str | Path, shipped: Mapping[str, Path]) -> Path:
    """The shipped file of a name, else the file at a path.

    Args:
        kind: what the file holds, for the error: "scenario".
        name_or_path: name or path.
        shipped: see `shipped_files`.

    Raises:
        ParameterError: there is none.
    """
    if not isinstance(name_or_path, str | Path):
        raise ParameterError(f"{kind}: {name_or_path!r}: no name; allowed: a name or the path of a file; write one")
    path = shipped.get(str(name_or_path), Path(name_or_path))
    # Path.exists raises for names that are too long.
    if not os.path.exists(path):
        raise ParameterError(
            f"{kind}: {printable(name_or_path)}: no such {kind} or file; allowed: {', '.join([*shipped, ''])}the path "
            f"of a YAML file{did_you_mean(Path(name_or_path).name, tuple(shipped))}"
        )
    return path
