"""Tables for notebooks."""

import html
from collections.abc import Iterable


def html_table(title: str, rows: Iterable[tuple[str, ...]]) -> str:
    """HTML of a table with a title; all text is escaped. The second cell of a row is a number or short text."""
    cells = ("".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in cells)
    return f"<table><caption><b>{html.escape(title)}</b></caption>{body}</table>"
