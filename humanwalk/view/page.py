"""Parts of a self-contained HTML page: escaped text, tables and figures; no scripts, nothing from another host."""

import html
from collections.abc import Iterable, Sequence
from importlib.resources import files
from pathlib import Path
from string import Template

from matplotlib.figure import Figure

from humanwalk.files import write_text
from humanwalk.view.plots.drawing import svg_data


def write_page(path: Path, title: str, parts: Iterable[str]) -> None:
    """Write a page whole or not at all.

    Args:
        path: of the page.
        title: its heading, as text.
        parts: HTML, made by the functions of this module.

    Raises:
        ParameterError: it cannot be written.
    """
    template = Template(files("humanwalk.view").joinpath("page.html").read_text(encoding="utf-8"))
    write_text(path, template.substitute(title=html.escape(title), body="\n".join(parts)))


def heading(text: str) -> str:
    """A heading below that of the page."""
    return _element("h2", text)


def paragraph(text: str) -> str:
    """A paragraph."""
    return _element("p", text)


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; the first column is aligned left, the others right."""
    lines = (_elements("th", header), *(_elements("td", row) for row in rows))
    return "\n".join(("<table>", *(f"<tr>{line}</tr>" for line in lines), "</table>"))


def numbered_notes(texts: Iterable[str]) -> str:
    """A numbered list in small print."""
    return f'<ol class="notes">{_elements("li", texts)}</ol>'


def notes(texts: Iterable[str]) -> str:
    """A list in small print."""
    return f'<ul class="notes">{_elements("li", texts)}</ul>'


def picture(figure: Figure, name: str) -> str:
    """A figure, drawn into the page."""
    return f'<img alt="{html.escape(name)}" src="{svg_data(figure, name)}">'


def _elements(tag: str, texts: Iterable[str]) -> str:
    return "".join(_element(tag, text) for text in texts)


def _element(tag: str, text: str) -> str:
    return f"<{tag}>{html.escape(text)}</{tag}>"
