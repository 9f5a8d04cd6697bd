"""Shorthands of the command line for fields of a scenario: text in, overrides by field name out."""

import dataclasses
import inspect
import json
import math
import re
from collections.abc import Mapping, Sequence, Set
from typing import Any

from humanwalk.body.devices import DEVICES
from humanwalk.body.impairments import IMPAIRMENTS
from humanwalk.body.loads import LOADS
from humanwalk.quantity import ParameterError, did_you_mean, printable, require_in_range
from humanwalk.terrain import PIECES, TERRAINS
from humanwalk.walking.push import Push

PUSH_GRAMMAR = "IMPULSE N s at TIME s from SIDE [for DURATION s] [on BODY]"
PUSH_EXAMPLE = "60 N s at 8 s from behind"
SIDES_GRAMMAR = "SIDE is front, behind, left, right, or an angle like 45 deg: 0 is the front, 90 the left"
TERRAIN_GRAMMAR = (
    "[TERRAIN] [FIELD VALUE [UNIT]], ..., or PIECE [up | down] [[FIELD] VALUE [UNIT], ...] [then PIECE ...]"
)
TERRAIN_EXAMPLES = "plane slope 3 deg, friction coefficient 0.5", "stairs down 17 cm, number 8 then obstacle 20 cm"

LOAD_GRAMMAR = "LOAD MASS kg [in the right hand | in the left hand] [unknown]"
LOAD_EXAMPLE = "backpack 10 kg"

PART_GRAMMAR = "{} [right | left | both] [[FIELD] VALUE [UNIT], ...] [unknown]"

BEARINGS = {"front": 0.0, "left": 90.0, "behind": 180.0, "right": -90.0}
"""Where a push comes from, for a walker that faces x: angle from x to the left [deg]."""

NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"

PUSH = re.compile(
    rf"(?P<impulse>{NUMBER}) \s* N[\s*·]*s"
    rf"\s+ at \s+ (?P<time>{NUMBER}) \s* s"
    rf"\s+ from \s+ (?:the \s+)? (?:(?P<side>{'|'.join(BEARINGS)}) | (?P<angle>{NUMBER}) \s* deg)"
    rf"(?: \s+ for \s+ (?P<duration>{NUMBER}) \s* s)?"
    rf"(?: \s+ on \s+ (?:the \s+)? (?P<body>\w+))?",
    re.VERBOSE,
)
LOAD = re.compile(
    rf"(?P<kind>[A-Za-z_][A-Za-z_ ]*?) \s+ (?P<mass>{NUMBER}) \s* kg"
    rf"(?: \s+ in \s+ the \s+ (?P<side>right|left) \s+ hand)? (?: \s+ (?P<unknown>unknown))?",
    re.VERBOSE,
)
THEN = re.compile(r"\s+then\s+")

PART = re.compile(
    rf"(?P<name>(?:[A-Za-z_][A-Za-z_ ]*?(?=\s))?)\s*(?:(?P<number>{NUMBER})\s*(?P<unit>[^\d]*)|(?P<word>[A-Za-z_]\w*))"
)

WORDS = {
    "right": ("side", "Right"),
    "left": ("side", "Left"),
    "both": ("side", "Both"),
    "up": ("direction", "up"),
    "down": ("direction", "down"),
    "unknown": ("known", False),
}
"""Words of a part that say a field without naming it: the field, and its value."""

UNITS: dict[str, dict[str, float]] = {
    "rad": {"rad": 1.0, "deg": math.radians(1.0)},
    "m": {"m": 1.0, "cm": 0.01, "mm": 0.001},
    "s": {"s": 1.0, "ms": 0.001},
}
"""By unit of a field: units that may be written, and their size in it."""


def push_overrides(texts: Sequence[str]) -> dict[str, str]:
    """The given pushes of a scenario, like "60 N s at 8 s from behind".

    Raises:
        ParameterError: a text is no push.
    """
    return {"pushes.given": json.dumps([dataclasses.asdict(push_of(text)) for text in texts])}


def push_of(text: str) -> Push:
    """A push from its text; see `PUSH_GRAMMAR`.

    Raises:
        ParameterError: the text is no push.
    """
    found = PUSH.fullmatch(text.strip())
    if found is None:
        raise ParameterError(
            f"--push {printable(text)}: not a push; allowed: {PUSH_GRAMMAR}, where {SIDES_GRAMMAR}; write it like "
            f'"{PUSH_EXAMPLE}"'
        )
    bearing = BEARINGS[found["side"]] if found["side"] else float(found["angle"])
    require_in_range(f"--push {printable(text)}: from", bearing, "deg", -360.0, 360.0)
    # The force points away from where it comes from.
    direction = math.remainder(math.radians(bearing + 180.0), 2.0 * math.pi)
    numbers = {name: float(found[name]) for name in ("impulse", "time", "duration") if found[name]}
    for name, number in numbers.items():
        _require_allowed(f"--push {printable(text)}", _fields(Push)[name], number)
    return Push(direction=direction, body=found["body"] or Push.body, **numbers)


def load_overrides(texts: Sequence[str]) -> dict[str, str]:
    """The loads of a subject, like "backpack 10 kg" or "suitcase 8 kg in the left hand".

    Raises:
        ParameterError: a text is no load.
    """
    return {"subject.loads": json.dumps([_load(text) for text in texts])}


def _load(text: str) -> dict[str, dict[str, Any]]:
    found = LOAD.fullmatch(text.strip())
    tag = "_".join(found["kind"].split()) if found else text.strip().partition(" ")[0]
    if found is None or tag not in LOADS:
        raise ParameterError(
            f"--load {printable(text)}: not a load; allowed: {LOAD_GRAMMAR} with LOAD one of {', '.join(LOADS)}; write "
            f'it like "{LOAD_EXAMPLE}"{did_you_mean(tag, tuple(LOADS))}'
        )
    fields: dict[str, Any] = {"mass": float(found["mass"]), "known": found["unknown"] is None}
    _require_allowed(f"--load {printable(text)}", _fields(LOADS[tag])["mass"], fields["mass"])
    if found["side"]:
        fields["side"] = found["side"].capitalize()
    return {tag: fields}


def impairment_overrides(texts: Sequence[str]) -> dict[str, str]:
    """The impairments of a subject, like "stiff knee left 10 deg".

    Raises:
        ParameterError: a text is no impairment.
    """
    return {"subject.impairments": json.dumps([_subject_part(text, "impairment", IMPAIRMENTS) for text in texts])}


def device_overrides(texts: Sequence[str]) -> dict[str, str]:
    """The devices of a subject, like "ankle prosthesis left" or "hip exoskeleton 15 N m".

    Raises:
        ParameterError: a text is no device.
    """
    return {"subject.devices": json.dumps([_subject_part(text, "device", DEVICES) for text in texts])}


def _subject_part(text: str, name: str, kinds: Mapping[str, type[Any]]) -> dict[str, dict[str, Any]]:
    """An impairment or device by its text."""
    noun = name.upper()
    return _part(text, f"--{name}", kinds, noun, PART_GRAMMAR.format(noun))


def _part(text: str, option: str, kinds: Mapping[str, type[Any]], noun: str, grammar: str) -> dict[str, dict[str, Any]]:
    """One of several kinds by its text.

    Args:
        text: Of the part.
        option: For messages.
        kinds: By their tags.
        noun: What the grammar calls a kind.
        grammar: How a text is written.
    """
    tag = _kind_of(text, kinds)
    end = f"allowed: {grammar} with {noun} one of {', '.join(kinds)}"
    if not tag:
        near = did_you_mean("_".join(text.replace("_", " ").split()[:2]), tuple(kinds))
        raise ParameterError(f"{option} {printable(text)}: no such kind; {end}; write one of them{near}")
    return {tag: _values(text.strip()[len(tag) :].lstrip("_"), tag, kinds[tag], f"{option} {printable(text)}", end)}


def _values(items: str, tag: str, kind: type[Any], where: str, end: str) -> dict[str, Any]:
    """Fields of one kind by their text; a value without a field is that of the first quantity that the kind declares.

    Args:
        items: "[FIELD] VALUE [UNIT], ...".
        tag: Of the kind, for messages.
        kind: Whose fields they are.
        where: Begin of messages: option and text.
        end: Of messages: what is allowed.
    """
    known = _fields(kind)
    own = [name for name in inspect.get_annotations(kind) if name in known]
    first = next(name for name in (*own, *known) if "unit" in known[name].metadata)
    fields: dict[str, Any] = {}
    for item in items.split(","):
        words = {word: WORDS[word] for word in item.split() if word in WORDS and WORDS[word][0] in known}
        said = list(words.values())
        for name, value in said:
            _give(fields, name, value, where)
        rest = " ".join(word for word in item.split() if word not in words)
        if not rest or rest in dict(said):
            continue
        found = PART.fullmatch(rest)
        name = _name_in(rest)
        if found and found["number"]:
            name = name or first
        if not found or name not in known:
            raise ParameterError(
                f"{where}: {printable(rest)} is not FIELD VALUE of {tag}, which has "
                f"{', '.join(known)}; {end}; correct it{did_you_mean(name, tuple(known))}"
            )
        unit = known[name].metadata.get("unit", "")
        factors, written = UNITS.get(unit, {unit: 1.0}), (found["unit"] or "").strip() or unit
        if found["word"]:
            _give(fields, name, found["word"], where)
        elif written in factors:
            value = float(found["number"]) * factors[written]
            if found["unit"].strip():
                _require_allowed(where, known[name], value)
            whole = not unit and value.is_integer()
            _give(fields, name, int(value) if whole else value, where)
        else:
            raise ParameterError(
                f"{where}: {printable(written)} is no unit of {name}, which has "
                f"{' or '.join(factors) or 'none'}; {end}; correct it"
            )
    return fields


def _name_in(item: str) -> str:
    """Name of the field of "[FIELD] VALUE [UNIT]"; empty without one."""
    found = PART.fullmatch(item.strip())
    return "_".join(found["name"].split()) if found else ""


def _give(fields: dict[str, Any], name: str, value: Any, where: str) -> None:
    """Give a field its value.

    Raises:
        ParameterError: it has one.
    """
    if name in fields:
        raise ParameterError(f"{where}: {name} is given twice; allowed: every field once; remove one")
    fields[name] = value


def _kind_of(text: str, kinds: Mapping[str, type[Any]]) -> str:
    """Tag of the kind with which a text begins; empty if it begins with none."""
    words = text.strip().replace("_", " ")
    return next((tag for tag in kinds if re.match(rf"{tag.replace('_', ' ')}\b", words)), "")


def terrain_overrides(text: str) -> dict[str, str]:
    """The terrain of a scenario, like "slope 3 deg", or the pieces of a course, like "stairs 17 cm then obstacle".

    Raises:
        ParameterError: no such terrain, piece, field or unit.
    """
    pieces = THEN.split(text.strip())
    # A slope alone is that of a plane.
    if len(pieces) > 1 or _kind_of(text, PIECES) not in ("", *_fields(TERRAINS["plane"])):
        parts = [_part(piece, "--terrain", PIECES, "PIECE", TERRAIN_GRAMMAR) for piece in pieces]
        return {"terrain": json.dumps({"course": {"pieces": parts}})}
    where = f"--terrain {printable(text)}"
    end = f"allowed: {TERRAIN_GRAMMAR} with TERRAIN one of {', '.join(TERRAINS)} and PIECE one of {', '.join(PIECES)}"
    tag = _kind_of(text, TERRAINS)
    items = text.strip()[len(tag) :]
    if not tag:
        tag = _terrain_with({_name_in(item) or item.strip() for item in items.split(",")}, where, end)
    return {"terrain": json.dumps({tag: _values(items, tag, TERRAINS[tag], where, end)})}


def _terrain_with(names: Set[str], where: str, end: str) -> str:
    """The only terrain that has all of the fields; `where` and `end` are those of messages."""
    fields = {tag: _fields(kind) for tag, kind in TERRAINS.items()}
    having = [tag for tag, known in fields.items() if names <= known.keys()]
    if len(having) > 1:
        raise ParameterError(f"{where}: {' and '.join(having)} have these fields; {end}; begin with one of them")
    if not having:
        every = (*TERRAINS, *PIECES, *sorted({name for known in fields.values() for name in known}))
        near = "".join(did_you_mean(name, every) for name in sorted(names) if name not in every)
        raise ParameterError(
            f'{where}: no such terrain, and none has these fields; {end}; write it like "{TERRAIN_EXAMPLES[0]}"{near}'
        )
    return having[0]


def _fields(terrain: Any) -> dict[str, dataclasses.Field[Any]]:
    return {field.name: field for field in dataclasses.fields(terrain)}


def _require_allowed(where: str, field: dataclasses.Field[Any], value: float) -> None:
    """Raise ParameterError unless a value that was written with its unit is in the range of its field.

    Where the scenario is checked, the unit is no longer known: the message there may take the value for one in another.
    """
    unit, low, high = (field.metadata[key] for key in ("unit", "low", "high"))
    require_in_range(f"{where}: {field.name}", value, unit, low, high, other_units=False)
