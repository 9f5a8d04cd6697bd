"""The command that compares runs."""

from pathlib import Path
from typing import Annotated

import typer

from humanwalk.cli.common import SHOW, OverwriteOption, app, console, stdout
from humanwalk.files import require_new, require_replaceable
from humanwalk.quantity import ParameterError, printable

PAGES = (".html", ".htm")
"""Suffixes of a page."""


@app.command(
    rich_help_panel=SHOW,
    epilog="Examples: humanwalk compare runs/walk runs/brisk  |  humanwalk compare runs/a runs/b runs/c -o abc.html",
)
def compare(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN RUN...", help="Folders of two to eight runs.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Page to write. Default: comparison.html, which is replaced.")
    ] = None,
    page: Annotated[bool, typer.Option(help="Write the page.")] = True,
    overwrite: OverwriteOption = False,
) -> None:
    """Compare runs: measures side by side, overlaid curves, and what differs between their scenarios."""
    from rich import box
    from rich.table import Column, Table

    from humanwalk.run.folder import Run
    from humanwalk.view.compare import difference_rows, falls, measure_rows, names_of, write_comparison

    path = output or Path("comparison.html")
    if output is not None:
        if not page:
            raise ParameterError(
                f"-o {printable(output)}: no page with --no-page; allowed: one of the two; leave one out"
            )
        require_new(output, overwrite)
        if output.suffix.lower() not in PAGES:
            raise ParameterError(
                f"-o {printable(output)}: unknown page format; allowed: {', '.join(PAGES)}; name it comparison.html"
            )
    elif page:
        require_replaceable(path)
    opened = [Run.open(run) for run in runs]
    names = names_of(opened)
    for title, rows in (("measure", measure_rows(opened)), ("different field", difference_rows(opened))):
        # A field without its end would be ambiguous.
        table = Table(Column(title, overflow="fold"), *names, box=box.SIMPLE)
        for row in rows:
            table.add_row(*row)
        if table.row_count:
            stdout.print(table)
    for line in falls(opened, names):
        stdout.print(line, soft_wrap=True)
    if page:
        with console.status("drawing"):
            write_comparison(path, opened)
        console.print(f"{path}", soft_wrap=True)
