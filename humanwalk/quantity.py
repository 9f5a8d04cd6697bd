"""Numbers with a unit and an allowed range, and the check that names what is wrong with one.

A parameter of a scenario is a dataclass field made by `quantity`; `check` walks any dataclass and raises
`ParameterError` on the first value that cannot be meant, with the field, the value, the range and a mend.
"""

import dataclasses
import difflib
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

GRAVITY = 9.81
"""Acceleration of gravity, Drake's default [m/s2]."""

UNIT_SLIPS = {
    "m": {100.0: "centimetres", 1000.0: "millimetres"},
    "rad": {180.0 / math.pi: "degrees"},
    "s": {1000.0: "milliseconds"},
    "m/s": {3.6: "km/h", 100.0: "cm/s"},
    "kg": {2.204623: "pounds", 1000.0: "grams"},
}
"""Factors by which people slip: a value given in the named unit is that many times too large."""


MESSAGE_LENGTH = 4000
"""Longest error message [characters]; the longest list of allowed fields fits."""


class ParameterError(ValueError):
    """An input that cannot be used. The message is one printable line: field, value, allowed range, fix."""

    def __init__(self, message: object) -> None:
        super().__init__(printable(message, MESSAGE_LENGTH))


def printable(text: object, limit: int = 120) -> str:
    """`str(text)` on one line, safe for a terminal, at most `limit` characters long.

    Names of files, columns and scenarios come from others: control characters, line ends, bidirectional marks and
    bytes that are no text are escaped, and the middle of a long text is left out.
    """
    raw = str(text)
    # Only the ends can be shown: a text of any length takes no longer.
    raw = raw if len(raw) <= 2 * limit else raw[:limit] + raw[-limit:]
    shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in raw)
    if len(shown) <= limit and len(raw) == len(str(text)):
        return shown
    tail = (limit - 3) // 2
    return shown[: limit - 3 - tail] + "..." + shown[-tail:]


def quantity(default: float, unit: str, low: float, high: float) -> Any:
    """Dataclass field for a number in [low, high], in the given unit ("" for a pure number)."""
    return dataclasses.field(default=default, metadata={"unit": unit, "low": low, "high": high})


def choice(choices: Mapping[str, type[Any]], default: Any) -> Any:
    """Dataclass field for one of several dataclasses, which a file names by its tag: `contact: point`.

    Args:
        choices: the dataclasses by tag.
        default: an instance of one of them.
    """
    return dataclasses.field(default=default, metadata={"choices": choices})


def tag_of(choices: Mapping[str, type[Any]], value: Any) -> str:
    """The tag of a choice: the key of its type."""
    return next(tag for tag, kind in choices.items() if type(value) is kind)


def did_you_mean(text: str, choices: Sequence[str]) -> str:
    """End of an error message that names the nearest of some choices; empty where none is near."""
    near = difflib.get_close_matches(text, choices, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


def check(parameters: Any, path: str = "") -> None:
    """Raise ParameterError for the first number in a dataclass tree that is outside its allowed range.

    Args:
        parameters: dataclass instance; nested dataclasses and dictionaries of them are entered.
        path: dotted name of `parameters` itself, for the message.
    """
    for name, value, metadata in _numbers(parameters, path):
        require_in_range(name, value, metadata["unit"], metadata["low"], metadata["high"])


def require_in_range(name: str, value: float, unit: str, low: float, high: float) -> None:
    """Raise ParameterError unless low <= value <= high; guesses a slip of the unit for the mend."""
    if math.isfinite(value) and low <= value <= high:
        return
    allowed = f"allowed: {low:g} to {high:g} {unit}".rstrip()
    raise ParameterError(f"{name}: {value:g} is out of range; {allowed}; {_mend(value, unit, low, high)}")


def _mend(value: float, unit: str, low: float, high: float) -> str:
    if not math.isfinite(value):
        return "give a finite number"
    for factor, meant in UNIT_SLIPS.get(unit, {}).items():
        if low <= value / factor <= high and value > high:
            return f"if it is in {meant}, write {value / factor:.4g} ({unit})"
    nearest = low if value < low else high
    return f"the nearest allowed value is {nearest:g}"


def _numbers(parameters: Any, path: str) -> Iterator[tuple[str, float, Mapping[str, Any]]]:
    for field in dataclasses.fields(parameters):
        value = getattr(parameters, field.name)
        name = f"{path}.{field.name}" if path else field.name
        if "unit" in field.metadata:
            yield name, value, field.metadata
        elif "choices" in field.metadata:
            yield from _numbers(value, f"{name}.{tag_of(field.metadata['choices'], value)}")
        elif dataclasses.is_dataclass(value):
            yield from _numbers(value, name)
        elif isinstance(value, tuple):
            for place, item in enumerate(value):
                if dataclasses.is_dataclass(item):
                    yield from _numbers(item, f"{name}.{place}")
        elif isinstance(value, Mapping):
            for key, item in value.items():
                if dataclasses.is_dataclass(item):
                    yield from _numbers(item, f"{name}.{key}")
