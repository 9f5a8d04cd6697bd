"""Values in the mapping of a dataclass of parameters, replaced by their dotted field names."""

import copy
import dataclasses
import functools
from itertools import pairwise
from typing import Any

import numpy as np

from humanwalk.parameter_file import fields_of, plain_value
from humanwalk.quantity import ParameterError, printable
from humanwalk.yaml_text import index_of, read_yaml, shown


@functools.cache
def _named_fields(kind: type[Any]) -> dict[str, dataclasses.Field[Any]]:
    return dict(fields_of(kind))


def override(kind: type[Any], data: dict[str, Any], field: str, text: Any) -> None:
    """Replace a value in the mapping of a dataclass of parameters by YAML text; see `replace_value`.

    Only strings are read as YAML. NumPy scalars and arrays are converted to Python numbers and lists; other values are
    used unchanged.

    Raises:
        ParameterError: the field is not text, the text is not YAML, or the field cannot be replaced.
    """
    if not isinstance(field, str):
        raise ParameterError(
            f"{shown(field)}: not the name of a field; allowed: text, like subject.mass; name the field"
        )
    if not isinstance(text, str):
        replace_value(kind, data, field, _without_numpy(text))
        return
    # Indented, so that no line of the text begins another field.
    indented = "\n ".join(text.splitlines())
    replace_value(kind, data, field, read_yaml(f"value: {indented}", f"--set {field}")["value"])


def _without_numpy(value: Any) -> Any:
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: _without_numpy(entry) for key, entry in value.items()}
    return [_without_numpy(entry) for entry in value] if isinstance(value, list | tuple) else value


def replace_value(kind: Any, data: dict[str, Any], field: str, value: Any) -> None:
    """Replace a value in the mapping of a dataclass of parameters by its dotted field name.

    Args:
        kind: the dataclass.
        data: the mapping; it is changed, its groups and lists are copied first. A choice may stand in it as its tag.
        field: `controller.balanced.planner.dcm_gain`, or with the index of a list's entry `pushes.given.0.direction`;
            the index after the last adds an entry.
        value: as YAML has it; it is copied.

    Raises:
        ParameterError: the name leads into a value, into another choice, or beyond a list.
    """
    fields, parts = _named_fields(kind), field.split(".")
    group: dict[str, Any] | list[Any] = data
    for depth, (part, below) in enumerate(pairwise(parts), 1):
        name = ".".join(parts[:depth])
        of_list = fields.get(".".join(parts[: depth - 1]))
        entry = of_list is not None and "choice_list" in of_list.metadata
        group = _group_in(group, part, below, name, fields.get(name), entry)
    if isinstance(group, list):
        group[_index(group, parts[-1], field)] = copy.deepcopy(value)
    else:
        group[parts[-1]] = copy.deepcopy(value)


def _group_in(
    group: Any, part: str, below: str, name: str, field: dataclasses.Field[Any] | None, of_choices: bool
) -> Any:
    """Return the mapping or list at `part` of a group; add it to the group if it is missing.

    Args:
        group: Mapping or list; it is changed.
        part: Part of the dotted name.
        below: The next part of the name.
        name: The dotted name up to `part`.
        field: The field of that name, if it is one.
        of_choices: Whether the group is a list of choices.
    """
    key: Any = _index(group, part, name) if isinstance(group, list) else part
    found = group[key] if isinstance(group, list) else group.get(key)
    chosen = of_choices or (field is not None and "choices" in field.metadata)
    if found is None or (chosen and found == below):
        found = _default_list(field) if below.isdecimal() else {}
    if isinstance(found, list) or (isinstance(found, dict) and not (chosen and next(iter(found), below) != below)):
        group[key] = found = copy.copy(found)
        return found
    tag = next(iter(found)) if isinstance(found, dict) else found
    raise ParameterError(
        f"{name}.{below}: {name} is {shown(tag)}; allowed: fields of {shown(tag)}; choose another with "
        f"--set {name}=... before"
    )


def _default_list(field: dataclasses.Field[Any] | None) -> list[Any]:
    """The entries that a list has where a file does not name it."""
    if field is None or field.default is dataclasses.MISSING:
        return []
    entries = plain_value(field.default)
    return entries if isinstance(entries, list) else []


def _index(entries: list[Any], part: str, name: str) -> int:
    """Index of an entry that a part of a dotted name stands for; the one after the last is made."""
    if (index := index_of(part)) is None or index > len(entries):
        raise ParameterError(
            f"{printable(name)}: no such entry; allowed: 0 to {len(entries)}; {len(entries)} adds an entry"
        )
    if index == len(entries):
        entries.append(None)
    return index
