"""The book is up to date: its code runs, its tables and pictures match the code."""

import dataclasses
import os
import re
import runpy
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import reduce
from pathlib import Path
from typing import Any

import pytest

from humanwalk.body.joint_map import JointMap
from humanwalk.body.segment_table import segment_rows
from humanwalk.body.subject import Subject
from humanwalk.choices import CONTROLLERS, BalancedController, PdActuation
from humanwalk.diagrams.walker import make_diagram, make_walker
from humanwalk.measures.signals import TIME
from humanwalk.parameter_file import build
from humanwalk.quantity import tag_of
from humanwalk.run.recorder import recorded_signals
from humanwalk.scenario import load_scenario, parse_scenario, shipped_scenarios
from humanwalk.study.cluster import SlurmParameters
from humanwalk.study.study import parse_study
from humanwalk.study.tuning import parse_tuning
from humanwalk.yaml_text import read_yaml

DOCS = Path(__file__).parent.parent / "docs"
HOW_TO = sorted((DOCS / "howto").glob("*.md"))

MOVING_PICTURE_LIMIT = 1_500_000
"""Bytes of the picture on README's first screen."""


PARSERS: dict[str, Callable[[str], object]] = {
    "parameters": parse_tuning,
    "factors": parse_study,
    "walltime": lambda text: build(SlurmParameters, read_yaml(text, "slurm.yaml")),
}
"""What reads a file of the book, by a field that only files of its kind have; else it is a scenario."""


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"^```{language}[^\n]*\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", HOW_TO, ids=lambda page: page.stem)
def test_the_python_of_a_how_to_runs(page: Any) -> None:
    """In a process of its own: a guide may register a class of the reader's, which other tests must not find."""
    code = "\n".join(f"exec(compile({code!r}, {page.name!r}, 'exec'), {{}})" for code in blocks(page, "python"))
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize("page", HOW_TO, ids=lambda page: page.stem)
def test_the_files_of_a_how_to_are_valid(page: Any) -> None:
    for text in blocks(page, "yaml"):
        parse = next((parse for field, parse in PARSERS.items() if f"\n{field}:" in text), parse_scenario)
        parse(text)


def test_the_book_builds_without_a_warning(tmp_path: Path) -> None:
    """Every link and anchor leads somewhere, and every docstring can be shown."""
    mkdocs = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    built = subprocess.run(
        mkdocs,
        cwd=DOCS.parent,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "true"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr


def test_the_search_of_the_book_works_from_the_disk_without_a_network() -> None:
    """The plugin inlines the index; the script that replaces a web worker is ours, not another host's."""
    settings = (DOCS.parent / "mkdocs.yml").read_text()
    assert "\n  - offline" in settings
    (script,) = re.findall(r"polyfills: \[(.*)\]", settings)
    assert "window.Worker" in (DOCS / script).read_text()


def test_there_is_code_to_run() -> None:
    assert sum(len(blocks(page, "python")) for page in HOW_TO) >= 3


@pytest.mark.parametrize("name", shipped_scenarios())
def test_the_block_diagram_of_every_scenario_is_in_the_book(name: str) -> None:
    scenario = load_scenario(name)
    graph = make_diagram(scenario).GetGraphvizString(max_depth=1, options={"split": "I/O"})
    picture = DOCS / "images" / f"diagram_{tag_of(CONTROLLERS, scenario.controller)}.svg"
    drawn = picture.read_text(encoding="utf-8")
    assert sorted(re.findall(r"name=(\w+)", drawn)) == sorted(re.findall(r"name=(\w+)", graph)), (
        "run docs/make_gallery.py"
    )
    # The implicit law adds the wire of the desired state.
    more = scenario.actuation == PdActuation(law="implicit")
    assert drawn.count('class="edge"') == graph.count(" -> ") - more


def gains(parameters: Any, path: str = "") -> Iterator[Any]:
    """Name, default and unit of every number, a task's numbers together, as docs/reference/gains.md writes them."""
    for field in dataclasses.fields(parameters):
        value, name = getattr(parameters, field.name), f"{path}{field.name}"
        if "unit" in field.metadata:
            yield name, f"{value:g}", field.metadata["unit"]
        elif hasattr(value, "stiffness"):
            numbers = dataclasses.asdict(value)
            units = ["1/s2", "1/s", "-"][: len(numbers)]
            yield name, " / ".join(f"{float(f'{x:.3g}'):g}" for x in numbers.values()), ", ".join(units)
        elif dataclasses.is_dataclass(value) and name != "command":
            yield from gains(value, f"{name}.")


def test_the_table_of_gains_is_the_code() -> None:
    page = (DOCS / "reference" / "gains.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([a-z_.]+)` \| ([^|]+?) \| ([^|]*?) ?\| [^|]+ \|$", page, re.MULTILINE)
    assert rows == list(gains(BalancedController()))


WALKERS: list[tuple[str, dict[str, Any]]] = [
    *(("thesis", {f"controller.thesis.balance.{level}.enabled": True}) for level in ("foot_force", "upper_body")),
    *(("thesis", {"actuation": actuation}) for actuation in ("pid", "adaptive")),
    ("walk", {"subject.devices": "[hip_exoskeleton]"}),
]
"""Scenarios that together record every signal."""

PLACEHOLDERS = {".": r"\.", "JOINT": r"\w+Motion", "SIDE": "(right|left)", "AXIS": "[xyz]"}


def test_the_table_of_signals_has_every_column_once(joints: JointMap) -> None:
    page = (DOCS / "reference" / "signals.md").read_text(encoding="utf-8").partition("## Joints")[0]
    names = re.findall(r"`(\S+)`", "".join(re.findall(r"^\| (`[^|]*)\|", page, re.MULTILINE)))
    patterns = [reduce(lambda name, each: name.replace(*each), PLACEHOLDERS.items(), name) for name in names]
    walkers = [make_walker(load_scenario(name, changes)) for name, changes in WALKERS]
    columns = {column for walker in walkers for signal in recorded_signals(walker, joints) for column in signal.columns}
    found = {column: [pattern for pattern in patterns if re.fullmatch(pattern, column)] for column in {TIME, *columns}}
    assert {column: fitting for column, fitting in found.items() if len(fitting) != 1} == {}
    assert set(patterns) == {fitting for (fitting,) in found.values()}


def test_the_moving_picture_is_light_enough_for_a_first_screen() -> None:
    assert 10_000 < (DOCS / "images" / "walker.webp").stat().st_size < MOVING_PICTURE_LIMIT


PAGES = (
    *("performance", "robustness", "likeness", "contact", "claims", "actuation"),
    *("howto/subjects", "howto/terrain", "reference/signals"),
)


@pytest.mark.parametrize("name", PAGES)
def test_the_tables_of_a_page_are_those_of_the_results(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    page, benchmarks = DOCS / f"{name}.md", DOCS.parent / "benchmarks"
    # A script's folder is on the path.
    monkeypatch.syspath_prepend(str(benchmarks))
    filled = runpy.run_path(str(benchmarks / "pages.py"))["filled"]
    assert filled(page) == page.read_text(encoding="utf-8"), "run benchmarks/pages.py"


def test_the_reference_has_every_package() -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in (DOCS / "reference").glob("*.md"))
    package = DOCS.parent / "humanwalk"
    folders = {folder.name for folder in package.iterdir() if (folder / "__init__.py").is_file()}
    assert set(re.findall(r"^::: humanwalk\.(\w+)\.\*$", pages, re.MULTILINE)) == folders - {"cli"}


def test_the_index_lists_every_decision_with_its_title_date_and_changes() -> None:
    folder = DOCS / "decisions"
    records = sorted(folder.glob("0*.md"))
    assert [int(record.name[:4]) for record in records] == list(range(1, len(records) + 1))
    rows = []
    for record in records:
        title, _, accepted = record.read_text(encoding="utf-8").splitlines()[:3]
        status = re.fullmatch(r"Accepted on (\d{4}-\d\d-\d\d)\.(?: Changed in part by (.*)\.)?", accepted)
        assert status is not None, record.name
        changed = f" {status[2]}" if status[2] else ""
        rows.append(f"| [{title.removeprefix('# ')}]({record.name}) | {status[1]} |{changed} |")
    assert (folder / "index.md").read_text(encoding="utf-8").splitlines()[-len(rows) :] == rows


def test_the_table_of_segments_is_the_code() -> None:
    page = (DOCS / "howto" / "subjects.md").read_text(encoding="utf-8")
    found = re.findall(r"^\| ([a-z ]+) ((?:\| \d\.\d\d ){4})\|", page, re.MULTILINE)
    rows = {name.replace(" ", "_"): cells.split("|")[1:] for name, cells in found}
    for row in segment_rows(Subject(sex="unspecified")):
        ratios = [f" {ratio:.2f} " for ratio in row.ratios]
        assert rows[row.name.removeprefix("right_").removeprefix("left_")] == ratios, row.name
    assert len(rows) == 10
