"""A picture of a Diagram through pydot."""

import shutil
from pathlib import Path

import pydot
from pydrake.systems.framework import Diagram

from humanwalk.quantity import ParameterError
from humanwalk.run.files import write_whole

FORMATS = ("svg", "png", "pdf")


def draw_diagram(diagram: Diagram, path: Path, depth: int = 1) -> None:
    """Draw a diagram's systems and connections into an SVG, PNG or PDF file.

    Args:
        diagram: what to draw.
        path: the picture; its suffix says the format.
        depth: how many levels of diagrams are opened.

    Raises:
        ParameterError: the format is unknown, or Graphviz is not installed.
    """
    kind = path.suffix.removeprefix(".").lower()
    if kind not in FORMATS:
        raise ParameterError(f"-o {path}: unknown picture format; allowed: {', '.join(FORMATS)}; name it diagram.svg")
    if shutil.which("dot") is None:
        raise ParameterError("diagram: Graphviz' dot is not found; install it: apt-get install graphviz")
    graphs = pydot.graph_from_dot_data(diagram.GetGraphvizString(max_depth=depth, options={"split": "I/O"}))
    assert graphs, "Drake wrote a graph that pydot cannot read"
    write_whole(path, lambda beside: graphs[0].write(str(beside), format=kind))
