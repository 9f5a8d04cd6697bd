"""The command that writes the schemas of parameter files."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from humanwalk.cli.common import INSPECT, OverwriteOption, app, console


class FileKind(StrEnum):
    """Kinds of files that people write; `humanwalk.study.schemas.FORMATS` has the same."""

    SCENARIO = "scenario"
    STUDY = "study"
    TUNING = "tuning"


@app.command(
    rich_help_panel=INSPECT,
    epilog="Example: humanwalk schema scenario -o scenario.schema.json. "
    "A file that begins with `# yaml-language-server: $schema=scenario.schema.json` is then completed and checked.",
)
def schema(
    kind: Annotated[FileKind, typer.Argument(help="Kind of file.")] = FileKind.SCENARIO,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="JSON file to write. Default: print it.")
    ] = None,
    overwrite: OverwriteOption = False,
) -> None:
    """Write the JSON Schema of a kind of file, with units and ranges: editors complete and check files with it."""
    from humanwalk.files import require_new, write_text
    from humanwalk.study.schemas import schema_of

    text = json.dumps(schema_of(kind), indent=1, allow_nan=False)
    if output is None:
        print(text)
        return
    require_new(output, overwrite)
    write_text(output, text + "\n")
    console.print(f"{output}", soft_wrap=True)
