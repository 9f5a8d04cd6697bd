"""JSON Schemas of the files that people write: scenarios, studies and tunings."""

from typing import Any

from humanwalk.parameter_schema import Also, Schema, json_schema
from humanwalk.scenario import Scenario
from humanwalk.study.factors import Values
from humanwalk.study.study import Study
from humanwalk.study.tuning import Tuning

FORMATS: dict[str, type[Any]] = {"scenario": Scenario, "study": Study, "tuning": Tuning}
"""Dataclass of each kind of file."""

ALSO: Also = {
    Scenario: {"type": "string", "description": "Name of a shipped scenario, or path of a file."},
    Values: {"type": "array", "description": "A list of values."},
}
"""Shorthands that `humanwalk.study.study.complete` replaces."""


def schema_of(name: str) -> Schema:
    """JSON Schema of a kind of file, one of `FORMATS`."""
    return json_schema(FORMATS[name], f"humanwalk {name}", ALSO)
