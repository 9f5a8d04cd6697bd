"""Parameters with a unit and an allowed range, and errors of one line.

A parameter of a scenario is a dataclass field made by `quantity`. `check` visits a tree of dataclasses and raises
`ParameterError` for the first value out of range, with field, value, range and fix.
"""

import dataclasses
import difflib
import math
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, cast

GRAVITY = 9.81
"""Acceleration of gravity, Drake's default [m/s2]."""

UNIT_MISTAKES = {
    "m": {100.0: "centimeters", 1000.0: "millimeters"},
    "rad": {180.0 / math.pi: "degrees"},
    "s": {1000.0: "milliseconds"},
    "m/s": {3.6: "km/h", 100.0: "cm/s"},
    "kg": {2.204623: "pounds", 1000.0: "grams"},
}
"""By required unit: factor by which a value is too large if given in the named unit."""

FAR = 1.5
"""Ratio to the largest allowed value above which a value is probably in another unit."""

MESSAGE_LENGTH = 4000
"""Longest error message [characters]; the longest list of allowed fields fits."""


Metadata = Mapping[str, Any]
NONE: Metadata = MappingProxyType({})
"""Metadata of a field that has none."""


REQUIRED: Any = dataclasses.MISSING
"""Instead of the default of a quantity that a file has to give."""


class ParameterError(ValueError):
    """An input that cannot be used. The message is one printable line: field, value, allowed range, fix."""

    def __init__(self, message: object) -> None:
        super().__init__(printable(message, MESSAGE_LENGTH))


def printable(text: object, limit: int = 120) -> str:
    """`str(text)` on one line, safe for a terminal, at most `limit` characters long.

    Names of files, columns and scenarios are untrusted. Control characters, line ends, bidirectional marks and bytes
    that do not decode are escaped; the middle of a long text is omitted.
    """
    raw = str(text)
    # Bounds the time: no more than the two ends is shown.
    raw = raw if len(raw) <= 2 * limit else raw[:limit] + raw[-limit:]
    shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in raw)
    if len(shown) <= limit and len(raw) == len(str(text)):
        return shown
    tail = (limit - 3) // 2
    return shown[: limit - 3 - tail] + "..." + shown[-tail:]


def number_of(text: str) -> float:
    """The number that text of a file or option is, in digits of ASCII.

    Raises:
        ValueError: it is none. Python's `float` alone also reads 1_5, as 15, and digits of other scripts.
    """
    if "_" in text or not text.isascii():
        raise ValueError(f"{printable(text)} is not a number")
    return float(text)


def require_kind(value: object, kind: type[Any], function: str, example: str) -> None:
    """Raise ParameterError unless a function was called with a value of a kind; `example` makes its arguments."""
    if not isinstance(value, kind):
        raise ParameterError(
            f"{function}: {printable(repr(value), 60)} is no {kind.__name__}; allowed: what "
            f"{example.partition('(')[0]} returns; write {function}({example})"
        )


def quantity(default: Any, unit: str, low: float, high: float) -> Any:
    """Dataclass field for a number in [low, high], in the given unit ("" for a pure number); see `REQUIRED`."""
    return dataclasses.field(default=default, metadata={"unit": unit, "low": low, "high": high})


def choice(choices: Mapping[str, type[Any]], default: Any) -> Any:
    """Dataclass field that holds one of several dataclasses; a file names it by its tag: `contact: point`.

    Args:
        choices: Dataclasses by tag.
        default: Instance of one of them.
    """
    return dataclasses.field(default=default, metadata={"choices": choices})


def choices_by_name(choices: Mapping[str, type[Any]]) -> Any:
    """Dataclass field that holds a mapping of names to choices, each as in `choice`; empty by default."""
    return dataclasses.field(default_factory=dict, metadata={"choices_by_name": choices})


def only() -> Any:
    """The only field of a choice, which a file writes without the field's name: `values: [1, 2]`."""
    return dataclasses.field(metadata={"only": True})


def only_field(kind: type[Any]) -> str | None:
    """Name of the field of a dataclass that was made by `only`; None without one."""
    return next((field.name for field in dataclasses.fields(kind) if "only" in field.metadata), None)


def choice_list(choices: Mapping[str, type[Any]]) -> Any:
    """Dataclass field that holds a tuple of choices, each as in `choice`; empty by default."""
    return dataclasses.field(default=(), metadata={"choice_list": choices})


def file_path() -> Any:
    """Dataclass field for the path of a file; a relative one in a parameter file counts from that file's folder."""
    return dataclasses.field(default="", metadata={"path": True})


def file_paths(parameters: Any) -> dict[str, str]:
    """Paths of the files that a tree of dataclasses names, by dotted field name; those that are empty are left out."""
    return {name: value for name, value, metadata in _leaves(parameters, "", {}) if metadata.get("path") and value}


def replace_file_paths[T](parameters: T, paths: Mapping[str, str]) -> T:
    """A tree of dataclasses with other paths of files, by dotted field name as in `file_paths`."""
    return changed(parameters, lambda name, value, of: paths.get(name, value) if of.get("path") else value)


def changed[T](
    parameters: T, change: Callable[[str, Any, Metadata], Any], path: str = "", metadata: Metadata = NONE
) -> T:
    """A tree of dataclasses, and of tuples and mappings of them, in which a function replaces each field's value.

    Args:
        parameters: The tree.
        change: Returns the new value from dotted name, value and metadata of a field that holds no dataclass.
        path: Dotted name of the tree.
        metadata: Of the field that holds the tree.
    """
    parts = {key: changed(item, change, name, of) for key, item, name, of in _parts(parameters, path, metadata)}
    new: Any
    if not parts:
        new = change(path, parameters, metadata)
    elif isinstance(parameters, Mapping):
        new = {**parameters, **parts}
    elif isinstance(parameters, tuple):
        new = tuple(parts.get(i, item) for i, item in enumerate(parameters))
    else:
        new = dataclasses.replace(cast(Any, parameters), **parts)
    return cast(T, new)


def tag_of(choices: Mapping[str, type[Any]], value: Any) -> str:
    """Tag of a choice: the key of its type."""
    return next(tag for tag, kind in choices.items() if type(value) is kind)


def did_you_mean(text: str, choices: Sequence[str]) -> str:
    """End of an error message: the most similar choice, or nothing if none is similar."""
    near = difflib.get_close_matches(text, choices, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


def is_within(field: str, group: str) -> bool:
    """Whether a dotted name is that of a group or of a field in it."""
    return f"{field}.".startswith(f"{group}.")


def near_names(text: str, choices: Sequence[str]) -> str:
    """End of an error message: up to three choices that have the text in them, else similar ones, else nothing."""
    containing = [choice for choice in choices if text and text in choice]
    near = containing[:3] or difflib.get_close_matches(text, choices, cutoff=0.5)
    return f"; near: {', '.join(near)}" if near else ""


def near_or_all(text: str, choices: Sequence[str]) -> str:
    """End of an error message that counts many choices: the most similar one, else all of them."""
    return did_you_mean(text, choices) or f": {', '.join(choices)}"


def check(parameters: Any, path: str = "", fields: Container[str] | None = None) -> None:
    """Check every quantity of a tree of dataclasses.

    Args:
        parameters: Dataclass instance; nested dataclasses, and tuples and mappings of them, are visited.
        path: Dotted name of `parameters`, for the message.
        fields: Fields of `parameters` that are checked; by default all.

    Raises:
        ParameterError: A number is out of its range.
    """
    for field, item, place, of_item in _parts(parameters, path, {}):
        if fields is None or field in fields:
            for name, value, metadata in _quantities(item, place, of_item):
                require_in_range(name, value, metadata["unit"], metadata["low"], metadata["high"])


def require_in_range(name: str, value: float, unit: str, low: float, high: float, *, other_units: bool = True) -> None:
    """Raise ParameterError unless low <= value <= high.

    The message suggests a fix; with `other_units` that may be a value in the unit that it was probably meant in.
    """

    def refused(number: float) -> bool:
        return not (math.isfinite(number) and low <= number <= high)

    if not refused(value):
        return
    fix = _fix(value, unit if other_units else "", low, high)
    shown = _digits(value, refused)
    raise ParameterError(f"{name}: {shown} is out of range; allowed: {range_text(unit, low, high)}; {fix}")


def range_text(unit: str, low: float, high: float) -> str:
    """A range with its unit, for messages; both ends are allowed as they are written."""
    first, last = (_digits(end, lambda rounded: low <= rounded <= high) for end in (low, high))
    return f"{first} to {last} {unit}".rstrip()


def _digits(value: float, holds: Callable[[float], bool], digits: int = 6) -> str:
    """A number rounded to so many digits, or to more until something holds for it that holds for the number."""
    if isinstance(value, int):
        return str(value)
    texts = (f"{value:.{more}g}" for more in range(digits, 18))
    return next(text for text in texts if holds(float(text)))


def _fix(value: float, unit: str, low: float, high: float) -> str:
    if not math.isfinite(value):
        return "give a finite number"
    for factor, other_unit in UNIT_MISTAKES.get(unit, {}).items():
        # No one gives less than 1 of a smaller unit.
        if low <= value / factor <= high and value > FAR * high and value >= 1.0:
            converted = _digits(value / factor, lambda rounded: low <= rounded <= high, 4)
            return f"if it is in {other_unit}, write {converted} ({unit})"
    nearest = _digits(low if value < low else high, lambda rounded: low <= rounded <= high)
    return f"the nearest allowed value is {nearest}"


def numbers_of(parameters: Any) -> Iterator[tuple[str, float, Metadata]]:
    """Dotted name, value and metadata (unit, low, high) of every quantity in a tree of dataclasses; see `check`."""
    return _quantities(parameters, "", {})


def _quantities(value: Any, path: str, metadata: Metadata) -> Iterator[tuple[str, float, Metadata]]:
    return (leaf for leaf in _leaves(value, path, metadata) if "unit" in leaf[2])


def _leaves(value: Any, path: str, metadata: Mapping[str, Any]) -> Iterator[tuple[str, Any, Mapping[str, Any]]]:
    """Dotted names, values and metadata of all fields of a tree of dataclasses that hold none themselves."""
    parts = list(_parts(value, path, metadata))
    for _, item, name, of_item in parts:
        yield from _leaves(item, name, of_item)
    if not parts:
        yield path, value, metadata


def _parts(value: Any, path: str, metadata: Mapping[str, Any]) -> Iterator[tuple[Any, Any, str, Mapping[str, Any]]]:
    """Fields of a dataclass, or those entries of a tuple or mapping that are dataclasses.

    Args:
        value: at the end of `path`, in a field with `metadata`.

    Yields:
        Name of the field or key of the entry, its value, dotted name and metadata.
    """
    if dataclasses.is_dataclass(value):
        prefix = f"{path}.{tag_of(metadata['choices'], value)}" if "choices" in metadata else path
        for field in dataclasses.fields(value):
            name = f"{prefix}.{field.name}" if prefix else field.name
            yield field.name, getattr(value, field.name), name, field.metadata
    elif isinstance(value, Mapping | tuple):
        of_entry = {"choices": metadata["choice_list"]} if "choice_list" in metadata else {}
        for key, item in value.items() if isinstance(value, Mapping) else enumerate(value):
            if dataclasses.is_dataclass(item):
                yield key, item, f"{path}.{key}", of_entry
