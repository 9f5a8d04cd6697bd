"""YAML files as frozen dataclasses of parameters, read strictly and in bounded time; every error is one line.

pydrake's typed loader assigns to fields, so it cannot make frozen dataclasses, and its messages span lines.
"""

import dataclasses
import re
import reprlib
import typing
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import yaml

from humanwalk.files import read_text
from humanwalk.quantity import ParameterError, check, did_you_mean, printable, tag_of

MAX_FILE_SIZE = 100_000
"""Size of the largest file [bytes]; a complete scenario has five thousand, a parser may need far more than a file."""

MAX_NODES = 20_000
"""Number of values in a file, with aliases and merge keys written out; a complete scenario has three hundred."""

MAX_ENTRIES = 1000
"""Length of the longest list."""

_BRIEF = reprlib.Repr(maxlevel=3, maxlist=4, maxdict=4, maxset=4, maxstring=60, maxlong=60, maxother=60)


class _Loader(yaml.SafeLoader):
    """YAML with the plain scalars of version 1.2: 1e-3 is a number, 1:30 and `no` are text."""


class _Dumper(yaml.SafeDumper):
    """Quotes what `_Loader` would not read as text; writes every value out."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Loader.yaml_implicit_resolvers = _Dumper.yaml_implicit_resolvers = {}
for _tag, _pattern, _first in (
    ("bool", r"true|false|True|False", "tfTF"),
    ("null", r"~|null|Null|", "~nN"),
    ("int", r"[-+]?[0-9]+", "-+0123456789"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf)|\.(nan|NaN)", "-+.0123456789"),
    ("merge", "<<", "<"),
):
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(rf"^(?:{_pattern})$"), [*_first, ""])


def _construct_number(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> int | float:
    # YAML writes .inf and .nan where Python writes inf and nan.
    number = re.sub(r"\.(?=[a-zA-Z])", "", node.value)
    return int(number) if re.fullmatch(r"[-+]?[0-9]+", number) else float(number)


for _tag in ("int", "float"):
    _Loader.add_constructor(f"tag:yaml.org,2002:{_tag}", _construct_number)


def read_yaml(text: str, name: str) -> dict[str, Any]:
    """The mapping that YAML text holds; `name` is the file's, for errors.

    Keys at the root that begin with an underscore hold anchors, as everywhere in Drake, and are left out.

    Raises:
        ParameterError: not YAML, not a mapping, a key twice, or too many values.
    """
    try:
        root = yaml.compose(text, Loader=_Loader)
        _require_sound(root, name)
        data = yaml.load(text, Loader=_Loader)
    except ParameterError:
        raise
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RecursionError) as e:
        # PyYAML's constructors let these out of scalars that do not fit their tag, like !!int "".
        mark = getattr(e, "problem_mark", None)
        where = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        problem = getattr(e, "problem", None) or "cannot be read"
        raise ParameterError(f"{name}: not YAML{where}: {shown(problem)}; correct that line") from None
    if data is None:
        return {}
    if not isinstance(data, dict):
        raise ParameterError(f"{name}: {shown(data)} is not a mapping of fields; write fields, like `duration: 15`")
    return {key: value for key, value in data.items() if not str(key).startswith("_")}


def _require_sound(root: yaml.Node | None, name: str) -> None:
    """Raise ParameterError where a mapping has a key twice, or a file stands for too many values."""
    sizes: dict[int, int] = {}

    def size(node: yaml.Node, inside: frozenset[int]) -> int:
        if not isinstance(node, yaml.CollectionNode):
            return 1
        if id(node) in inside:
            raise ParameterError(f"{name}: a value contains itself; write it out")
        if id(node) not in sizes:
            if isinstance(node, yaml.MappingNode):
                _require_keys_once(node, name)
                children = [child for pair in node.value for child in pair]
            else:
                children = node.value
            sizes[id(node)] = 1 + sum(size(child, inside | {id(node)}) for child in children)
        return sizes[id(node)]

    if root is not None and size(root, frozenset()) > MAX_NODES:
        raise ParameterError(f"{name}: stands for too many values; allowed: up to {MAX_NODES}; write fewer aliases")


def _require_keys_once(mapping: yaml.MappingNode, name: str) -> None:
    """Raise ParameterError where a key comes twice: YAML readers silently keep the last."""
    lines: dict[str, int] = {}
    for key, _ in mapping.value:
        if not isinstance(key, yaml.ScalarNode):
            continue
        line = key.start_mark.line + 1
        if key.value in lines:
            raise ParameterError(
                f"{name}: {shown(key.value)} comes twice, at lines {lines[key.value]} and {line}; allowed: every field "
                "once in its group; remove one"
            )
        lines[key.value] = line


def override(kind: type[Any], data: dict[str, Any], field: str, text: str) -> None:
    """Replace a value in the mapping of a dataclass of parameters by its dotted field name.

    Args:
        kind: the dataclass.
        data: the mapping, changed in place; a choice may stand in it as its tag.
        field: `controller.balanced.planner.dcm_gain`.
        text: the value as in YAML.

    Raises:
        ParameterError: the text is not YAML, or the name leads into a value or into another choice.
    """
    value = read_yaml(f"value: {text}", f"--set {field}")["value"]
    choices = {name for name, found in fields_of(kind) if "choices" in found.metadata}
    *parents, leaf = field.split(".")
    for depth, parent in enumerate(parents, 1):
        group, name, below = data.get(parent), ".".join(parents[:depth]), [*parents, leaf][depth]
        if group is None or (name in choices and group == below):
            group = data[parent] = {}
        tag = next(iter(group), below) if isinstance(group, dict) else group
        if not isinstance(group, dict) or (name in choices and tag != below):
            raise ParameterError(
                f"{field}: {name} is {shown(tag)}; allowed: fields of {shown(tag)}; choose another with "
                f"--set {name}=... before"
            )
        data = group
    data[leaf] = value


def load_as[T](kind: type[T], path: Path) -> T:
    """A YAML file as an instance of a dataclass of parameters.

    Raises:
        ParameterError: it cannot be read, or a value cannot be used.
    """
    data = read_yaml(read_text(path, MAX_FILE_SIZE), path.name)
    try:
        return build(kind, data)
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from None


def build[T](kind: type[T], data: Mapping[str, Any]) -> T:
    """An instance of a dataclass of parameters from a mapping, every number checked against its range.

    Raises:
        ParameterError: an unknown field, a value of another type or out of range.
    """
    parameters = _build(kind, data, _Place("", kind))
    check(parameters)
    assert isinstance(parameters, kind)
    return parameters


def dump(parameters: Any) -> str:
    """A dataclass of parameters as YAML, every field written out; `build` makes an equal one of it."""
    text: str = yaml.dump(_plain(parameters), Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=120)
    return text


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        entries = {}
        for field in dataclasses.fields(value):
            entry = _plain(getattr(value, field.name))
            if "choices" in field.metadata:
                entry = {tag_of(field.metadata["choices"], getattr(value, field.name)): entry}
            entries[field.name] = entry
        return entries
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    return [_plain(entry) for entry in value] if isinstance(value, tuple) else value


@dataclass(frozen=True)
class _Place:
    """Where a value stands: its dotted path, and the dataclass of the whole file, for hints."""

    path: str
    root: type[Any]

    def __truediv__(self, name: str) -> "_Place":
        return replace(self, path=f"{self.path}.{name}" if self.path else name)

    def __str__(self) -> str:
        return self.path


def _build(kind: Any, value: Any, place: _Place) -> Any:
    """`value` out of a YAML file as an instance of the annotated type `kind`."""
    origin = typing.get_origin(kind)
    if dataclasses.is_dataclass(kind):
        return _build_dataclass(kind, value, place)
    if origin is Literal:
        choices = typing.get_args(kind)
        if value not in choices:
            raise ParameterError(
                f"{place}: {shown(value)} is unknown; allowed: {', '.join(choices)}"
                f"{did_you_mean(shown(value), choices)}"
            )
        return value
    if origin is tuple:
        if not isinstance(value, list | tuple):
            raise ParameterError(f"{place}: {shown(value)} is not a list; write entries that begin with a dash")
        if len(value) > MAX_ENTRIES:
            raise ParameterError(f"{place}: {len(value)} entries; allowed: up to {MAX_ENTRIES}; write fewer")
        return tuple(_build(typing.get_args(kind)[0], entry, place / str(i)) for i, entry in enumerate(value))
    if origin in (dict, Mapping):
        if not isinstance(value, dict):
            raise ParameterError(f"{place}: {shown(value)} is not a mapping; write name: value pairs")
        for key in value:
            if not (isinstance(key, str) and key.isprintable()):
                raise ParameterError(f"{place}: {shown(key)} is not a name; write name: value pairs")
        return {key: _build(typing.get_args(kind)[1], entry, place / key) for key, entry in value.items()}
    return _build_scalar(kind, value, place)


def _build_dataclass(kind: Any, value: Any, place: _Place) -> Any:
    fields = {field.name: field for field in dataclasses.fields(kind)}
    if not isinstance(value, dict):
        raise ParameterError(f"{place}: {shown(value)} is not a group of fields; allowed: {', '.join(fields)}")
    hints = typing.get_type_hints(kind)
    arguments = {}
    for key, entry in value.items():
        name = key if isinstance(key, str) and key.isprintable() else shown(key)
        if key not in fields:
            raise ParameterError(
                f"{place / name}: no such field; allowed: {', '.join(fields)}{_hint(name, fields, place)}"
            )
        metadata = fields[key].metadata
        if "choices" in metadata:
            arguments[key] = _build_choice(metadata["choices"], entry, place / name)
        else:
            arguments[key] = _build(hints[key], entry, place / name)
    try:
        return kind(**arguments)
    except ParameterError as error:
        raise ParameterError(f"{place / str(error)}") from None


def _build_choice(choices: Mapping[str, type[Any]], value: Any, place: _Place) -> Any:
    """One of several dataclasses: its tag, or a mapping of its tag to its fields."""
    if isinstance(value, dict) and len(value) == 1:
        ((tag, entry),) = value.items()
    else:
        tag, entry = value, None
    if not isinstance(tag, str) or tag not in choices:
        raise ParameterError(
            f"{place}: {shown(tag)} is unknown; allowed: {', '.join(choices)}, alone or with fields"
            f"{did_you_mean(shown(tag), tuple(choices))}"
        )
    return _build(choices[tag], {} if entry is None else entry, place / tag)


def _hint(name: str, fields: Mapping[str, Any], place: _Place) -> str:
    """Where an unknown field belongs, or the field that may be meant."""
    homes = [path for path, _ in fields_of(place.root) if path.rsplit(".", 1)[-1] == name]
    if 0 < len(homes) <= 3:
        return f"; it belongs to {' or '.join(home.rpartition('.')[0] or 'the top of the file' for home in homes)}"
    return did_you_mean(name, tuple(fields))


def fields_of(kind: Any, path: str = "") -> Iterator[tuple[str, dataclasses.Field[Any]]]:
    """Dotted names and fields of a dataclass of parameters, with those of its groups and of every choice."""
    hints = typing.get_type_hints(kind)
    for field in dataclasses.fields(kind):
        name = f"{path}.{field.name}" if path else field.name
        yield name, field
        for tag, chosen in field.metadata.get("choices", {}).items():
            yield from fields_of(chosen, f"{name}.{tag}")
        if dataclasses.is_dataclass(hints[field.name]):
            yield from fields_of(hints[field.name], name)


def anchor_paths(kind: type[Any], data: dict[str, Any], folder: Path) -> None:
    """Let relative paths in the mapping of a dataclass of parameters count from a folder; changes `data`."""
    for name, field in fields_of(kind):
        *parents, leaf = name.split(".")
        group: Any = data
        for parent in parents:
            group = group.get(parent) if isinstance(group, dict) else None
        if field.metadata.get("path") and isinstance(group, dict) and isinstance(group.get(leaf), str) and group[leaf]:
            group[leaf] = str(folder / group[leaf])


def _build_scalar(kind: Any, value: Any, place: _Place) -> Any:
    wanted = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}[kind]
    if isinstance(value, int) and value.bit_length() > 64:
        raise ParameterError(f"{place}: {shown(value)} is out of range; write a smaller number")
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise ParameterError(f"{place}: {shown(value)} is not {wanted}; write {wanted}")
    return value


def shown(value: Any) -> str:
    """A value for an error message: short, on one line."""
    try:
        # Aliases of aliases may stand for more than memory holds: no more is looked at than is shown.
        return printable(_BRIEF.repr(value), 40)
    except ValueError:
        return "a number of too many digits"  # Python refuses to write it
