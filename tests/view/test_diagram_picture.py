import re
import shutil
import sysconfig
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import Adder, Gain

from humanwalk.choices import BalancedController, ThesisController
from humanwalk.diagrams.walker import make_diagram
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario, shipped_scenarios
from humanwalk.view.diagram_picture import draw_diagram, find_graphviz, with_own_numbers, with_wired_ports

# pydot is not yet used to the names of the newest pyparsing.
pytestmark = pytest.mark.filterwarnings("ignore:.* deprecated - use:DeprecationWarning")


def small_diagram() -> Diagram:
    builder = DiagramBuilder()
    adder = builder.AddNamedSystem("both", Adder(2, 1))
    gain = builder.AddNamedSystem("twice", Gain(2.0, 1))
    builder.Connect(adder.get_output_port(), gain.get_input_port())
    builder.ExportInput(adder.get_input_port(0), "first")
    builder.ExportOutput(gain.get_output_port(), "result")
    diagram = builder.Build()
    diagram.set_name("sum")
    return diagram


@pytest.fixture
def without_dot(monkeypatch: pytest.MonkeyPatch) -> None:
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name, path=None: None if name == "dot" else which(name, path=path))


def words(svg: Path) -> str:
    return " ".join("".join(element.itertext()) for element in ET.fromstring(svg.read_bytes()).iter())


@pytest.mark.parametrize("name", shipped_scenarios())
def test_the_walker_of_every_scenario_is_drawn_with_its_systems_by_name(name: str, tmp_path: Path) -> None:
    path = tmp_path / "walker.svg"
    scenario = load_scenario(name)
    draw_diagram(make_diagram(scenario), path)
    text = words(path)
    own = {
        ThesisController: ("gait", "inverse_kinematics"),
        BalancedController: ("planner", "controller"),
    }[type(scenario.controller)]
    for system in (*own, "actuators", "plant", "scene_graph", "foot_contact"):
        assert f"name={system}" in text


def test_a_picture_is_drawn_without_the_systems_graphviz(without_dot: None, tmp_path: Path) -> None:
    if not (Path(sysconfig.get_path("scripts")) / "graphviz-pure").is_file():
        pytest.skip("the extra `diagram` is not installed")
    assert "graphviz-pure" in find_graphviz("svg")
    for kind, beginning in (("svg", b"<"), ("png", b"\x89PNG")):
        path = tmp_path / f"sum.{kind}"
        draw_diagram(small_diagram(), path)
        assert path.read_bytes().startswith(beginning)
    assert "name=twice" in words(tmp_path / "sum.svg")
    with pytest.raises(ParameterError, match=r"no Graphviz draws pdf; .*apt-get install graphviz"):
        draw_diagram(small_diagram(), tmp_path / "sum.pdf")


def test_the_same_diagram_gives_the_same_picture(tmp_path: Path) -> None:
    pictures = []
    for name in ("one.svg", "two.svg"):
        draw_diagram(small_diagram(), tmp_path / name)
        pictures.append((tmp_path / name).read_bytes())
    assert pictures[0] == pictures[1]


def test_nodes_are_numbered_by_first_appearance() -> None:
    text = "digraph _7 { cluster7diagram s31:y0:e -> s7out:0:w; label=<Lumbar_6 s31x> s31 }"
    assert with_own_numbers(text) == "digraph _1 { cluster1diagram s2:y0:e -> s1out:0:w; label=<Lumbar_6 s31x> s2 }"


def test_only_connected_ports_are_drawn_by_default() -> None:
    text = small_diagram().GetGraphvizString(max_depth=1, options={"split": "I/O"})
    wired = with_wired_ports(text)
    assert len(re.findall(r'PORT="[uy]\d"', text)) > len(re.findall(r'PORT="[uy]\d"', wired)) == 4
    # Every wire still ends at a port.
    for number, port in re.findall(r"\bs(\d+):([uy]\d+)", wired):
        node = wired[wired.index(f"\ns{number} [") :]
        assert f'PORT="{port}"' in node[: node.index("</TABLE>")]


def test_depth_expands_diagrams(tmp_path: Path) -> None:
    draw_diagram(small_diagram(), tmp_path / "closed.svg", depth=0)
    draw_diagram(small_diagram(), tmp_path / "open.svg", depth=1)
    assert "name=twice" not in words(tmp_path / "closed.svg")
    assert "name=twice" in words(tmp_path / "open.svg")


def test_an_unknown_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"x\.gif: unknown picture format; allowed: svg, png, pdf"):
        draw_diagram(small_diagram(), tmp_path / "x.gif")
