"""A picture of a Diagram, drawn by the system's Graphviz or by one that is installed without root."""

import re
import shutil
import sysconfig
from itertools import zip_longest
from pathlib import Path

import pydot
from pydrake.systems.framework import Diagram

from humanwalk.extras import install_command
from humanwalk.files import write_whole
from humanwalk.quantity import ParameterError

FORMATS = ("svg", "png", "pdf")

PURE = "graphviz-pure"
"""The program of the Python package of that name, of the extra `diagram`; it draws no PDF."""
PURE_FORMATS = ("svg", "png")


def draw_diagram(diagram: Diagram, path: Path, depth: int = 1, every_port: bool = False) -> None:
    """Draw a diagram's systems and connections as SVG, PNG or PDF; the same diagram gives the same picture.

    Args:
        path: The picture; its suffix is the format.
        depth: Number of levels of diagrams that are expanded.
        every_port: Whether to draw unconnected ports too; a plant has dozens.

    Raises:
        ParameterError: The format is unknown, or there is no Graphviz.
    """
    kind = path.suffix.removeprefix(".").lower()
    if kind not in FORMATS:
        raise ParameterError(f"-o {path}: unknown picture format; allowed: {', '.join(FORMATS)}; name it diagram.svg")
    program = find_graphviz(kind)
    text = diagram.GetGraphvizString(max_depth=depth, options={"split": "I/O"})
    text = with_own_numbers(text if every_port else with_wired_ports(text))
    graphs = pydot.graph_from_dot_data(text)
    assert graphs, "Drake wrote a graph that pydot cannot read"
    write_whole(path, lambda beside: graphs[0].write(str(beside), prog=program, format=kind))


def find_graphviz(kind: str) -> str:
    """Program that draws a format: the system's dot, else the one of the Python package graphviz-pure.

    Raises:
        ParameterError: Neither is installed.
    """
    if dot := shutil.which("dot"):
        return dot
    pure = shutil.which(PURE, path=sysconfig.get_path("scripts"))
    if pure is not None and kind in PURE_FORMATS:
        return pure
    also = "" if kind in PURE_FORMATS else f" (or draw one of {', '.join(PURE_FORMATS)})"
    raise ParameterError(
        f"diagram: no Graphviz draws {kind}; install it: apt-get install graphviz; "
        f"or without root, for {' and '.join(PURE_FORMATS)}: {install_command('diagram')}{also}"
    )


NODE = re.compile(
    r"^s(\d+) \[shape=none, border=0, label=<\n<TABLE[^>]*>\n(.*?)</TABLE>\n>\];", re.DOTALL | re.MULTILINE
)
PORT = re.compile(r'<TD PORT="([uy]\d+)"[^>]*>(.+?)</TD>')
NODE_ID = re.compile(r"(?<![\w<>])(_|s|clusters?)(\d+)((?:in|out|diagram|subsystems)?)(?![\w<>])")
WIRE_END = re.compile(r"\bs(\d+):([uy]\d+)\b")


def with_wired_ports(text: str) -> str:
    """Drake's graph with only the connected ports of its systems, and class names without modules."""
    wired = set(WIRE_END.findall(text))

    def node(match: re.Match[str]) -> str:
        number, rows = match.groups()
        ports = [(name, label) for name, label in PORT.findall(rows) if (number, name) in wired]
        if not ports:
            return match[0]
        sides = ([port for port in ports if port[0].startswith(side)] for side in "uy")
        title = re.sub(r"<B>(?:\w+\.)*(\w+)</B>", r"<B>\1</B>", rows[: rows.index("</TR>")])
        table = "".join(f"<TR>\n{_cell(left)}{_cell(right)}</TR>\n" for left, right in zip_longest(*sides))
        return (
            f's{number} [shape=none, border=0, label=<\n<TABLE BORDER="0" CELLSPACING="0">\n'
            f"{title}</TR>\n{table}</TABLE>\n>];"
        )

    return NODE.sub(node, text)


def _cell(port: tuple[str, str] | None) -> str:
    return '<TD BORDER="1"></TD>\n' if port is None else f'<TD PORT="{port[0]}" BORDER="1">{port[1]}</TD>\n'


def with_own_numbers(text: str) -> str:
    """Drake's graph with its nodes numbered from one: Drake numbers all systems of the process."""
    numbers: dict[str, str] = {}

    def renumber(match: re.Match[str]) -> str:
        before, number, after = match.groups()
        return before + numbers.setdefault(number, str(len(numbers) + 1)) + after

    return NODE_ID.sub(renumber, text)
