"""JSON Schema of parameter files, made from their dataclasses: editors complete and check a file with it.

It describes what `humanwalk.parameter_file` reads, with units and ranges. Checks of several fields together, and of
names that depend on the scenario, are made by humanwalk only.
"""

import ast
import dataclasses
import inspect
import math
import textwrap
import types
import typing
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, Literal

from humanwalk.parameter_file import MAX_ENTRIES, plain, required_fields
from humanwalk.quantity import only_field

DIALECT = "https://json-schema.org/draft/2020-12/schema"

SCALARS: dict[Any, str] = {float: "number", int: "integer", bool: "boolean", str: "string"}

Schema = dict[str, Any]
Also = Mapping[type[Any], Schema]


def json_schema(kind: type[Any], title: str, also: Also | None = None) -> Schema:
    """JSON Schema of the files of a dataclass of parameters.

    Args:
        kind: The dataclass.
        title: Name of the files.
        also: By dataclass, a shorthand that may stand for it inside another one.

    Returns:
        The schema, ready for JSON; every dataclass is a definition.
    """
    definitions: dict[str, Schema] = {}
    root = _define(kind, definitions, also or {})
    # Keys at the root with an underscore hold anchors.
    definitions[root]["patternProperties"] = {"^_": {}}
    return {"$schema": DIALECT, "title": title, "$ref": f"#/$defs/{root}", "$defs": definitions}


def _define(kind: Any, definitions: dict[str, Schema], also: Also) -> str:
    """Add the definition of a dataclass, and return its name."""
    name = f"{kind.__module__.removeprefix('humanwalk.')}.{kind.__qualname__}"
    if name not in definitions:
        definitions[name] = schema = {"type": "object", "description": _summary(kind), "additionalProperties": False}
        hints, documents = typing.get_type_hints(kind), field_documents(kind)
        schema["properties"] = {
            field.name: _field(field, hints[field.name], documents.get(field.name, ""), definitions, also)
            for field in dataclasses.fields(kind)
        }
        if required := required_fields(kind):
            schema["required"] = required
    return name


def _field(
    field: dataclasses.Field[Any], hint: Any, document: str, definitions: dict[str, Schema], also: Also
) -> Schema:
    metadata = field.metadata
    if "choices" in metadata:
        schema = _choice(metadata["choices"], definitions, also)
    elif "choices_by_name" in metadata:
        schema = {"type": "object", "additionalProperties": _choice(metadata["choices_by_name"], definitions, also)}
    elif "choice_list" in metadata:
        items = _choice(metadata["choice_list"], definitions, also)
        schema = {"type": "array", "items": items, "maxItems": MAX_ENTRIES}
    else:
        schema = _type(hint, definitions, also)
    if "unit" in metadata:
        schema |= {"minimum": metadata["low"], "maximum": metadata["high"]}
        document = f"{document} [{metadata['unit']}]".strip() if metadata["unit"] else document
    if document:
        schema["description"] = document
    # JSON has no infinite numbers.
    is_infinite = isinstance(field.default, float) and math.isinf(field.default)
    if field.default is not dataclasses.MISSING and not dataclasses.is_dataclass(field.default) and not is_infinite:
        schema["default"] = plain(field.default)
    return schema


def _choice(choices: Mapping[str, type[Any]], definitions: dict[str, Schema], also: Also) -> Schema:
    """A tag alone, or a mapping of the tag to its fields."""
    options: list[Schema] = [{"enum": list(choices)}]
    options += [also[kind] for kind in choices.values() if kind in also]
    for tag, kind in choices.items():
        only = only_field(kind)
        inside = (
            {"anyOf": [{"$ref": f"#/$defs/{_define(kind, definitions, also)}"}, {"type": "null"}]}
            if only is None
            else _type(typing.get_type_hints(kind)[only], definitions, also)
        )
        options.append(
            {"type": "object", "properties": {tag: inside}, "required": [tag], "additionalProperties": False}
        )
    return {"anyOf": options}


def _type(hint: Any, definitions: dict[str, Schema], also: Also) -> Schema:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if hint is Any:
        return {}
    if dataclasses.is_dataclass(hint):
        assert isinstance(hint, type)
        reference = {"$ref": f"#/$defs/{_define(hint, definitions, also)}"}
        return {"anyOf": [reference, also[hint]]} if hint in also else reference
    if origin is Literal:
        return {"enum": list(arguments)}
    if origin is types.UnionType:
        return {"anyOf": [_type(argument, definitions, also) for argument in arguments]}
    if hint is types.NoneType:
        return {"type": "null"}
    if origin is tuple:
        return {"type": "array", "items": _type(arguments[0], definitions, also), "maxItems": MAX_ENTRIES}
    if origin in (dict, Mapping):
        return {"type": "object", "additionalProperties": _type(arguments[1], definitions, also)}
    return {"type": SCALARS[hint]}


def _summary(kind: type[Any]) -> str:
    return inspect.cleandoc(kind.__doc__ or "").partition("\n\n")[0]


def field_documents(kind: type[Any]) -> dict[str, str]:
    """Docstrings below the fields of a dataclass and of its bases, by field; a class without source has none."""
    documents: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        try:
            (tree,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
        except (OSError, TypeError):
            continue
        assert isinstance(tree, ast.ClassDef)
        for field, below in pairwise(tree.body):
            match field, below:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                    documents[name] = " ".join(inspect.cleandoc(text).split())
    return documents
