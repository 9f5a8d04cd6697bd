"""JSON files of others: read within bounds, and checked against a type before anything is used."""

import dataclasses
import json
import math
import types
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints, is_typeddict

from humanwalk.files import read_text
from humanwalk.quantity import ParameterError, printable

SCALARS: dict[Any, str] = {
    str: "one line of text",
    bool: "true or false",
    int: "a whole number",
    float: "a finite number",
    Any: "text, true, false or a number",
}

MAX_TEXT = 1000
"""Longest text [characters]."""


def read_json(path: Path, limit: int, kind: Any) -> Any:
    """Read a JSON file of at most `limit` bytes, whose data are of a type; see `conform`.

    Raises:
        ParameterError: it cannot be read, is not JSON, or of another type.
    """
    text = read_text(path, limit)
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise ParameterError(
            f"{printable(path)}: not JSON; allowed: the file as humanwalk wrote it; restore it"
        ) from None
    conform(data, kind, printable(path))
    return data


def conform(value: Any, kind: Any, name: str) -> None:
    """Raise ParameterError unless JSON data is of a type.

    Args:
        value: as `json.loads` returns it.
        kind: a TypedDict or dataclass, all of its keys required; dict[str, X]; X | None; str, bool, int, float; or Any
            of these four.
        name: of the value, for the message.
    """
    if is_typeddict(kind) or dataclasses.is_dataclass(kind):
        hints = get_type_hints(kind)
        _require(isinstance(value, dict), name, "a group of fields")
        for key in sorted(hints.keys() ^ value.keys()):
            raise ParameterError(
                f"{name}: {printable(key)} is {'missing' if key in hints else 'no field of it'}; allowed: the file as "
                "humanwalk wrote it; restore it"
            )
        for key, item in hints.items():
            conform(value[key], item, f"{name}: {key}")
    elif get_origin(kind) is dict:
        _require(isinstance(value, dict), name, "a group of fields")
        for key, item in value.items():
            _require(_is_scalar(key, str), f"{name}: {printable(key)}", SCALARS[str])
            conform(item, get_args(kind)[1], f"{name}.{key}")
    elif get_origin(kind) is types.UnionType:
        if value is not None:
            (kind,) = (option for option in get_args(kind) if option is not type(None))
            conform(value, kind, name)
    else:
        kinds = (str, bool, int, float) if kind is Any else (kind,)
        _require(any(_is_scalar(value, each) for each in kinds), name, SCALARS[kind])


def _is_scalar(value: Any, kind: type) -> bool:
    if isinstance(value, bool) or kind is bool:
        return kind is bool and isinstance(value, bool)
    if isinstance(value, int):
        return kind in (int, float) and value.bit_length() <= 64
    if isinstance(value, str):
        return kind is str and len(value) <= MAX_TEXT and value.isprintable()
    return kind is float and isinstance(value, float) and math.isfinite(value)


def _require(fits: bool, name: str, allowed: str) -> None:
    if not fits:
        raise ParameterError(f"{name} is of another type; allowed: {allowed}; restore the file as humanwalk wrote it")
