"""YAML files as frozen dataclasses of parameters, read strictly and in bounded time; every error is one line.

pydrake's typed loader assigns to fields, so it cannot make frozen dataclasses, and its messages span lines.
"""

import dataclasses
import functools
import math
import typing
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

from humanwalk.files import read_text
from humanwalk.quantity import (
    ParameterError,
    check,
    did_you_mean,
    is_within,
    only_field,
    printable,
    range_text,
    tag_of,
)
from humanwalk.yaml_text import MAX_DEPTH, line_of, read_yaml, shown, yaml_text

MAX_FILE_SIZE = 100_000
"""Size of the largest file [bytes]; a complete scenario has five thousand, a parser may need far more than a file."""

MAX_KEPT_SIZE = 1_000_000
"""Size of the largest file in a folder of ours [bytes]: it has every field written out, the user's only some."""

MAX_ENTRIES = 1000
"""Length of the longest list."""


@contextmanager
def located(text: str, name: str, replaced: Collection[str] = ()) -> Iterator[None]:
    """Within the block, an error about a field of a YAML file begins with the file's name and the field's line.

    Args:
        text: the file's text.
        name: its name.
        replaced: dotted names of fields whose values do not come from the file.
    """
    try:
        yield
    except ParameterError as error:
        field = str(error).partition(":")[0]
        is_other = any(is_within(field, other) or is_within(other, field) for other in replaced)
        line = None if is_other else line_of(text, field)
        if line is None:
            raise
        raise ParameterError(f"{name}, line {line}: {error}") from None


def read_fields(path: Path, limit: int = MAX_FILE_SIZE) -> str:
    """The text of a file that somebody wrote to be used: a scenario, study or tuning, of up to `limit` bytes.

    Raises:
        ParameterError: it cannot be read, or has no line but comments.
    """
    text = read_text(path, limit)
    if all(line.partition("#")[0].strip() in ("", "---") for line in text.splitlines()):
        raise ParameterError(
            f"{printable(path)}: empty; allowed: one field or more, or {{}} for the defaults; write `field: value`"
        )
    return text


def load_as[T](kind: type[T], path: Path) -> T:
    """A YAML file as an instance of a dataclass of parameters.

    Raises:
        ParameterError: it cannot be read, or a value cannot be used.
    """
    text = read_text(path, MAX_FILE_SIZE)
    data = read_yaml(text, path.name)
    with located(text, str(path)):
        return build(kind, data)


def build[T](kind: type[T], data: Mapping[str, Any]) -> T:
    """An instance of a dataclass of parameters from a mapping, every number checked against its range.

    Raises:
        ParameterError: an unknown field, a value of another type or out of range.
    """
    parameters = _build(kind, data, _Place("", kind))
    check(parameters)
    assert isinstance(parameters, kind)
    return parameters


def rebuild[T](parameters: T, data: Mapping[str, Any]) -> T:
    """The parameters with those of their fields that a mapping has, built and checked as by `build`.

    Raises:
        ParameterError: as `build`.
    """
    kind: Any = type(parameters)
    place = _Place("", kind)
    rebuilt = _made(lambda **fields: dataclasses.replace(cast(Any, parameters), **fields), kind, data, place)
    check(rebuilt, fields=data)
    return cast(T, rebuilt)


def build_value(value: Any, name: str) -> Any:
    """A value for a field that another dataclass will check, or ParameterError; `name` is its place in the message."""
    return _build_any(value, _Place(name, object))


def require_valid(parameters: Any) -> None:
    """Raise ParameterError unless `build` accepts the parameters; Python does not check the fields of a dataclass."""
    build(type(parameters), plain(parameters))


def dump(parameters: Any) -> str:
    """A dataclass of parameters as YAML, every field written out; `build` makes an equal one of it."""
    return yaml_text(plain_value(parameters))


def plain(parameters: Any) -> dict[str, Any]:
    """A dataclass of parameters as a mapping, every field written out; `build` makes an equal one of it."""
    entries: dict[str, Any] = plain_value(parameters)
    return entries


def plain_value(value: Any) -> Any:
    """A value of parameters as YAML has it: mappings, lists and scalars, every field written out."""
    if dataclasses.is_dataclass(value):
        return {field.name: _plain_field(field, getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {key: plain_value(entry) for key, entry in value.items()}
    return [plain_value(entry) for entry in value] if isinstance(value, tuple | list) else value


def _plain_field(field: dataclasses.Field[Any], value: Any) -> Any:
    metadata = field.metadata
    if "choices" in metadata:
        return _tagged(field.name, metadata["choices"], value)
    if "choices_by_name" in metadata:
        return {name: _tagged(field.name, metadata["choices_by_name"], chosen) for name, chosen in value.items()}
    if "choice_list" in metadata:
        return [_tagged(field.name, metadata["choice_list"], chosen) for chosen in value]
    return plain_value(value)


def _tagged(field: str, choices: Mapping[str, type[Any]], value: Any) -> dict[str, Any]:
    if type(value) not in choices.values():
        kinds = ", ".join(kind.__name__ for kind in choices.values())
        raise ParameterError(f"{field}: {shown(value)} is no choice; allowed: {kinds}; give an instance of one")
    entry, only = plain_value(value), only_field(type(value))
    return {tag_of(choices, value): entry[only] if only else entry}


@dataclass(frozen=True)
class _Place:
    """Where a value stands: its dotted path, the dataclass of the whole file, for hints, and the groups around it."""

    path: str
    root: type[Any]
    depth: int = 0

    def __truediv__(self, name: str) -> "_Place":
        return _Place(f"{self.path}.{name}" if self.path else name, self.root, self.depth + 1)

    def __str__(self) -> str:
        return self.path


@functools.cache
def _hints(kind: type[Any]) -> dict[str, Any]:
    """Types of the fields of a dataclass; a study builds a hundred thousand scenarios."""
    return typing.get_type_hints(kind)


def _build(kind: Any, value: Any, place: _Place, default: Any = None) -> Any:
    """`value` out of a YAML file as an instance of the annotated type `kind`.

    Fields that a group does not have are those of `default`, if that is such a group, else the defaults of its type.
    """
    origin = typing.get_origin(kind)
    if kind is Any:
        return _build_any(value, place)
    if dataclasses.is_dataclass(kind):
        has_default = dataclasses.is_dataclass(default)
        make: Any = functools.partial(dataclasses.replace, default) if has_default else kind
        return _made(make, kind, value, place, default if has_default else None)
    if origin is Literal:
        choices = typing.get_args(kind)
        if value not in choices:
            raise ParameterError(
                f"{place}: {shown(value)} is unknown; allowed: {', '.join(choices)}"
                f"{did_you_mean(shown(value), choices)}"
            )
        return value
    if origin is tuple:
        of = typing.get_args(kind)[0]
        fields = dataclasses.fields(of) if dataclasses.is_dataclass(of) else ()
        allowed = f"groups with {', '.join(field.name for field in fields)}" if fields else "values"
        return tuple(_build(of, entry, at) for entry, at in _entries(value, place, allowed))
    if origin in (dict, Mapping):
        if not isinstance(value, dict):
            raise ParameterError(f"{place}: {shown(value)} is not a mapping; write name: value pairs")
        for key in value:
            if not (isinstance(key, str) and key.isprintable()):
                raise ParameterError(f"{place}: {shown(key)} is not a name; write name: value pairs")
        return {key: _build(typing.get_args(kind)[1], entry, place / key) for key, entry in value.items()}
    return _build_scalar(kind, value, place)


def _entries(value: Any, place: _Place, allowed: str) -> list[tuple[Any, _Place]]:
    """Entries of a list and their places; `allowed` says in an error what they are."""
    if not isinstance(value, list | tuple):
        raise ParameterError(
            f"{place}: {shown(value)} is not a list; allowed: a list of {allowed}; begin each entry with a dash"
        )
    if len(value) > MAX_ENTRIES:
        raise ParameterError(f"{place}: {len(value)} entries; allowed: up to {MAX_ENTRIES}; write fewer")
    return [(entry, place / str(i)) for i, entry in enumerate(value)]


def _made(make: Callable[..., Any], kind: Any, value: Any, place: _Place, default: Any = None) -> Any:
    """What `make` returns for the fields of a dataclass that a mapping has; see `_build` for `default`."""
    fields = {field.name: field for field in dataclasses.fields(kind)}
    allowed = f"allowed: {', '.join(fields) or 'none, it has no fields'}"
    if not isinstance(value, dict):
        raise ParameterError(f"{place}: {shown(value)} is not a group of fields; {allowed}")
    hints = _hints(kind)
    arguments: dict[str, Any] = {}
    for key, entry in value.items():
        name = key if isinstance(key, str) and key.isprintable() else shown(key)
        if key not in fields:
            raise ParameterError(f"{place / name}: no such field; {allowed}{_hint(name, fields, place)}")
        inherited = fields[key].default if default is None else getattr(default, key)
        arguments[key] = _build_field(fields[key], hints[key], entry, place / name, inherited)
    needed = required_fields(kind) if make is kind else []
    if missing := " and ".join(name for name in needed if name not in arguments):
        raise ParameterError(
            f"{place}: {missing} missing; allowed: a group with {' and '.join(needed)}; write {missing}"
        )
    try:
        return make(**arguments)
    except ParameterError as error:
        raise ParameterError(f"{place / str(error)}") from None


@functools.cache
def required_fields(kind: Any) -> list[str]:
    """Names of the fields of a dataclass that have no default."""
    return [of.name for of in dataclasses.fields(kind) if of.default is of.default_factory is dataclasses.MISSING]


def _build_field(field: dataclasses.Field[Any], kind: Any, value: Any, place: _Place, default: Any) -> Any:
    """The value of a field of the annotated type `kind`; see `_build` for `default`."""
    metadata = field.metadata
    if "choices" in metadata:
        return _build_choice(metadata["choices"], value, place)
    if "choices_by_name" in metadata:
        named, choices = _build(Mapping[str, Any], value, place), metadata["choices_by_name"]
        return {name: _build_choice(choices, entry, place / name) for name, entry in named.items()}
    if "choice_list" in metadata:
        choices = metadata["choice_list"]
        return tuple(_build_choice(choices, entry, at) for entry, at in _entries(value, place, ", ".join(choices)))
    if "unit" in metadata:
        return _build_scalar(kind, value, place, f"allowed: {range_text(**metadata)}; ")
    return _build(kind, value, place, default)


def _build_choice(choices: Mapping[str, type[Any]], value: Any, place: _Place) -> Any:
    """One of several dataclasses: its tag, or a mapping of its tag to its fields."""
    if isinstance(value, dict) and len(value) == 1:
        ((tag, entry),) = value.items()
    else:
        tag, entry = value, None
    if not isinstance(tag, str) or tag not in choices:
        raise ParameterError(
            f"{place}: {shown(tag)} is unknown; allowed: {', '.join(choices)}, alone or with fields"
            f"{_lists_with(tag, place) or did_you_mean(shown(tag), tuple(choices))}"
        )
    chosen: Any = choices[tag]
    only = only_field(chosen)
    if only is None:
        return _build(chosen, {} if entry is None else entry, place / tag)
    try:
        return chosen(_build(_hints(chosen)[only], entry, place / tag))
    except ParameterError as error:
        raise ParameterError(str(error) if str(error).startswith(str(place)) else f"{place / tag}: {error}") from None


def _hint(name: str, fields: Mapping[str, Any], place: _Place) -> str:
    """Where an unknown field belongs; if only to entries, also the field that may be meant."""
    of_entries = fields_of(place.root, entries=True)
    return _homes(name, fields_of(place.root)) or _homes(name, of_entries) + did_you_mean(name, tuple(fields))


def _lists_with(tag: Any, place: _Place) -> str:
    """The lists of choices that have a tag; nothing if there are none: stairs are a piece of a course."""
    fields = fields_of(place.root, entries=True)
    lists = [path for path, field in fields if isinstance(tag, str) and tag in field.metadata.get("choice_list", {})]
    return f"; it belongs to the list {' or '.join(lists)}" if lists else ""


def _homes(name: str, fields: Iterable[tuple[str, dataclasses.Field[Any]]]) -> str:
    """The groups with a field of a name, out of fields with dotted names; nothing if there are many."""
    homes = [path.rpartition(".")[0] for path, _ in fields if path.rpartition(".")[-1] == name]
    if not 0 < len(homes) <= 3:
        return ""
    return f"; it belongs to {' or '.join(home or 'the top of the file' for home in homes)}"


def fields_of(kind: Any, path: str = "", entries: bool = False) -> Iterator[tuple[str, dataclasses.Field[Any]]]:
    """Dotted names and fields of a dataclass of parameters, with those of its groups and of every choice.

    Args:
        kind: The dataclass.
        path: Its own dotted name.
        entries: Whether the fields of entries are among them: of lists with the index 0, of mappings under NAME.
    """
    hints = _hints(kind)
    for field in dataclasses.fields(kind):
        name, hint = f"{path}.{field.name}" if path else field.name, hints[field.name]
        yield name, field
        groups = _tagged_kinds(field, "choices", name)
        if entries:
            of_list = typing.get_args(hint)[:1] if typing.get_origin(hint) is tuple else ()
            groups += _tagged_kinds(field, "choice_list", f"{name}.0") or [(f"{name}.0", of) for of in of_list]
            groups += _tagged_kinds(field, "choices_by_name", f"{name}.NAME")
        for group, inside in (*groups, (name, hint)):
            if dataclasses.is_dataclass(inside):
                yield from fields_of(inside, group, entries)


def _tagged_kinds(field: dataclasses.Field[Any], metadata: str, path: str) -> list[tuple[str, Any]]:
    """Dotted names of the kinds that metadata of a field list by their tags, and these kinds."""
    return [(f"{path}.{tag}", kind) for tag, kind in field.metadata.get(metadata, {}).items()]


def anchor_paths(kind: Any, data: Any, folder: Path) -> None:
    """Let relative paths in the mapping of a dataclass of parameters count from a folder; changes `data`."""
    if not isinstance(data, dict):
        return
    hints = _hints(kind)
    for field in dataclasses.fields(kind):
        value, metadata = data.get(field.name), field.metadata
        if metadata.get("path") and isinstance(value, str) and value:
            data[field.name] = str(folder / value)
        for tag, chosen in metadata.get("choices", {}).items():
            anchor_paths(chosen, value.get(tag) if isinstance(value, dict) else None, folder)
        for entry in value if "choice_list" in metadata and isinstance(value, list) else ():
            for tag, chosen in metadata["choice_list"].items():
                anchor_paths(chosen, entry.get(tag) if isinstance(entry, dict) else None, folder)
        if dataclasses.is_dataclass(hints[field.name]):
            anchor_paths(hints[field.name], value, folder)


def _build_any(value: Any, place: _Place) -> Any:
    """A value that another dataclass will check: finite numbers, printable text, lists and mappings of them."""
    if isinstance(value, dict) and place.depth < MAX_DEPTH:
        return _build(Mapping[str, Any], value, place)
    if isinstance(value, list | tuple) and place.depth < MAX_DEPTH:
        return list(_build(tuple[Any, ...], value, place))
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, int) and value.bit_length() < 64:
        return value
    if (isinstance(value, float) and math.isfinite(value)) or (isinstance(value, str) and value.isprintable()):
        return value
    raise ParameterError(
        f"{place}: {shown(value)} cannot be a value; allowed: finite numbers, text on one line, true, false, lists and "
        f"groups of them, at most {MAX_DEPTH} inside each other; write one of these"
    )


def _build_scalar(kind: Any, value: Any, place: _Place, allowed: str = "") -> Any:
    """A number, true, false or text; `allowed` is the part of an error that says which values are."""
    wanted = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}[kind]
    if isinstance(value, int) and value.bit_length() > 64:
        raise ParameterError(f"{place}: {shown(value)} is out of range; {allowed}write a smaller number")
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise ParameterError(f"{place}: {shown(value)} is not {wanted}; {allowed}write {wanted}")
    return value
