"""Numbers with a unit and an allowed range, and the check that names what is wrong with one.

A parameter of a scenario is a dataclass field made by `quantity`; `check` walks any dataclass and raises
`ParameterError` on the first value that cannot be meant, with the field, the value, the range and a mend.
"""

import dataclasses
import math
from collections.abc import Iterator, Mapping
from typing import Any

UNIT_SLIPS = {
    "m": {100.0: "centimetres", 1000.0: "millimetres"},
    "rad": {180.0 / math.pi: "degrees"},
    "s": {1000.0: "milliseconds"},
    "m/s": {3.6: "km/h", 100.0: "cm/s"},
    "kg": {2.204623: "pounds", 1000.0: "grams"},
}
"""Factors by which people slip: a value given in the named unit is that many times too large."""


class ParameterError(ValueError):
    """A parameter's value cannot be used; the message is one line: field, value, allowed range, mend."""


def quantity(default: float, unit: str, low: float, high: float) -> Any:
    """Dataclass field for a number in [low, high], in the given unit ("" for a pure number)."""
    return dataclasses.field(default=default, metadata={"unit": unit, "low": low, "high": high})


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
