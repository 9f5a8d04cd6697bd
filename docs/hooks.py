"""Steps of the book's build: list every module in the reference, and turn formulas into MathML.

MathML needs no script from another host.
"""

import html
import re
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert

FORMULA = re.compile(r'<(div|span) class="arithmatex">\\(\[|\()(.*?)\\(?:\]|\))</\1>', re.DOTALL)

ROOT = Path(__file__).parents[1]
ALL_MODULES = re.compile(r"^::: (\S+)\.\*$", re.MULTILINE)


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Replace `::: package.*` by one `::: package.module` for each module of the package and its subpackages."""

    def modules(match: re.Match[str]) -> str:
        files = sorted((ROOT / match[1].replace(".", "/")).rglob("*.py"))
        names = [file.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".") for file in files]
        return "\n\n".join(f"::: {name}" for name in names if not name.endswith("__init__"))

    return ALL_MODULES.sub(modules, markdown)


def on_page_content(content: str, **_: Any) -> str:
    """Replace every formula of a page that Markdown has marked."""

    def mathml(match: re.Match[str]) -> str:
        tag, opening, latex = match.groups()
        display = "block" if opening == "[" else "inline"
        return f"<{tag}>{convert(html.unescape(latex), display=display)}</{tag}>"

    return FORMULA.sub(mathml, content)
