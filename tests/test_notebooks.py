"""Both notebooks run from top to bottom, with shorter simulations."""

import os
import re
from pathlib import Path
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))

SHORTER = {r'"duration": "8"': '"duration": "0.3"', r"duration=1\.0": "duration=0.1"}
"""Durations in the notebooks, and those of the test."""

# The kernel's own clients warn; the test is of the notebooks.
pytestmark = pytest.mark.filterwarnings("ignore")


def texts(notebook: Any) -> str:
    """Text and HTML of all outputs."""
    outputs = (output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs)
    data = (output.get("data", {"text": output.get("text", "")}) for output in outputs)
    return "\n".join(str(value) for values in data for value in values.values())


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_is_stored_without_outputs(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert texts(notebook) == ""


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("first_walk", ["<table>", "greatest force on the right foot", "completed at 0.30 s"]),
        ("own_controller", ["array"]),
    ],
)
def test_notebook_runs(name: str, expected: list[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    notebook = nbformat.read(ROOT / "examples" / f"{name}.ipynb", as_version=4)
    shortened = 0
    for cell in notebook.cells:
        for pattern, text in SHORTER.items():
            cell.source, changes = re.subn(pattern, text, cell.source)
            shortened += changes
    assert shortened > 0
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(ROOT), os.environ.get("PYTHONPATH", ""))))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    client = nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    shown = texts(notebook)
    assert all(text in shown for text in expected)
