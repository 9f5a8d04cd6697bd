"""YAML text read strictly and in bounded time; every error is one line."""

import re
import reprlib
from typing import Any

import yaml
from yaml.reader import ReaderError

from humanwalk.quantity import ParameterError, printable

MAX_NODES = 20_000
"""Number of values in a file, with aliases and merge keys written out; a complete scenario has three hundred."""

MAX_DEPTH = 50
"""Lists and groups inside each other; a tuning with a complete scenario has ten. What visits them is recursive."""

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
        ParameterError: not YAML, not a mapping, a key twice, too many values, or too deep ones.
    """
    try:
        root = yaml.compose(text, Loader=_Loader)
        _require_sound(root, name)
        data = yaml.load(text, Loader=_Loader)
    except ParameterError:
        raise
    except ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        raise ParameterError(
            f"{name}: not YAML at line {line}: the character {chr(error.character)!a}; allowed: printable text; remove "
            "it, or restore the file"
        ) from None
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


def line_of(text: str, field: str) -> int | None:
    """Line of YAML text, from 1, that names a field by its dotted name, else the last of its groups that is named.

    Args:
        text: YAML that `read_yaml` reads.
        field: `controller.balanced.command.points.0.forward`; lists by index.
    """
    node, line = yaml.compose(text, Loader=_Loader), None
    for part in field.split("."):
        below = _entry(node, part)
        if below is None:
            return line
        node, line = below[0], below[1] + 1
    return line


def index_of(part: str) -> int | None:
    """Index of a list's entry that a part of a dotted name stands for; None if it stands for none."""
    # No list is so long, and Python refuses to read numbers of thousands of digits.
    return int(part) if part.isascii() and part.isdecimal() and len(part) < 6 else None


def _entry(node: yaml.Node | None, part: str) -> tuple[yaml.Node, int] | None:
    """Node of an entry of a mapping or list, and its line from 0; None if there is none."""
    if isinstance(node, yaml.MappingNode):
        return next(((value, key.start_mark.line) for key, value in node.value if key.value == part), None)
    if isinstance(node, yaml.SequenceNode) and (index := index_of(part)) is not None and index < len(node.value):
        return node.value[index], node.value[index].start_mark.line
    return None


def _require_sound(root: yaml.Node | None, name: str) -> None:
    """Raise ParameterError where a mapping has a key twice, or a file stands for too many values or too deep ones."""
    extents: dict[int, tuple[int, int]] = {}

    def extent(node: yaml.Node, inside: frozenset[int]) -> tuple[int, int]:
        """Number of values that a node stands for, and number of lists and groups inside each other."""
        if not isinstance(node, yaml.CollectionNode):
            return 1, 0
        if id(node) in inside:
            raise ParameterError(f"{name}: a value contains itself; write it out")
        if id(node) not in extents:
            if isinstance(node, yaml.MappingNode):
                _require_keys_once(node, name)
                children = [child for pair in node.value for child in pair]
            else:
                children = node.value
            below = [extent(child, inside | {id(node)}) for child in children]
            extents[id(node)] = 1 + sum(size for size, _ in below), 1 + max((depth for _, depth in below), default=0)
        return extents[id(node)]

    size, depth = (0, 0) if root is None else extent(root, frozenset())
    if size > MAX_NODES:
        raise ParameterError(f"{name}: stands for too many values; allowed: up to {MAX_NODES}; write fewer aliases")
    if depth > MAX_DEPTH:
        raise ParameterError(
            f"{name}: {depth} lists and groups inside each other; allowed: up to {MAX_DEPTH}; write fewer"
        )


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


def yaml_text(data: Any) -> str:
    """Data as YAML text; `read_yaml` reads it back."""
    text: str = yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=120)
    return text


def shown(value: Any) -> str:
    """A value for an error message: short, on one line."""
    try:
        # Aliases of aliases may stand for more than memory holds: no more is looked at than is shown.
        return printable(_BRIEF.repr(value), 40)
    except ValueError:
        return "a number of too many digits"  # Python refuses to write it
