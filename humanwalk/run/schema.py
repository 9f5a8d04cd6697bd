"""Checks JSON data of others against a type: TypedDict, dict, list of choices by `|`, and scalars."""

import math
import types
from typing import Any, get_args, get_origin, get_type_hints, is_typeddict

from humanwalk.quantity import ParameterError, printable

NAMES: dict[Any, str] = {str: "text", bool: "true or false", int: "a whole number", float: "a finite number"}
MAX_TEXT = 1000
"""Longest text [characters]."""


def conform(value: Any, kind: Any, name: str) -> None:
    """Raise ParameterError unless JSON data is of a type.

    Args:
        value: as `json.loads` returns it.
        kind: a TypedDict, all of its keys required; dict[str, X]; X | None; str, bool, int or float.
        name: of the value, for the message.
    """
    if is_typeddict(kind):
        hints = get_type_hints(kind)
        _require(isinstance(value, dict), name, "a group of fields")
        for key in sorted(hints.keys() ^ value.keys()):
            raise ParameterError(f"{name}.{printable(key)}: {'missing' if key in hints else 'no such field'}")
        for key, item in hints.items():
            conform(value[key], item, f"{name}.{key}")
    elif get_origin(kind) is dict:
        _require(isinstance(value, dict), name, "a group of fields")
        for key, item in value.items():
            conform(item, get_args(kind)[1], f"{name}.{printable(key)}")
    elif get_origin(kind) is types.UnionType:
        if value is not None:
            (kind,) = (option for option in get_args(kind) if option is not type(None))
            conform(value, kind, name)
    else:
        _require(_is_scalar(value, kind), name, NAMES[kind])


def _is_scalar(value: Any, kind: type) -> bool:
    if isinstance(value, bool) or kind is bool:
        return kind is bool and isinstance(value, bool)
    if isinstance(value, int):
        return kind in (int, float) and value.bit_length() <= 64
    if isinstance(value, str):
        return kind is str and len(value) <= MAX_TEXT
    return kind is float and isinstance(value, float) and math.isfinite(value)


def _require(fits: bool, name: str, allowed: str) -> None:
    if not fits:
        raise ParameterError(f"{name}: of another type; allowed: {allowed}")
