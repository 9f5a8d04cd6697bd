"""Turns the book's formulas into MathML while it is built, so that no page asks another host for a script."""

import html
import re
from typing import Any

from latex2mathml.converter import convert

FORMULA = re.compile(r'<(div|span) class="arithmatex">\\(\[|\()(.*?)\\(?:\]|\))</\1>', re.DOTALL)


def on_page_content(content: str, **_: Any) -> str:
    """Replace every formula of a page that Markdown has marked."""

    def mathml(match: re.Match[str]) -> str:
        tag, opening, latex = match.groups()
        display = "block" if opening == "[" else "inline"
        return f"<{tag}>{convert(html.unescape(latex), display=display)}</{tag}>"

    return FORMULA.sub(mathml, content)
