"""What is installed is complete, and the links at the top lead into it."""

import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from importlib.metadata import entry_points, version
from importlib.resources import files
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "humanwalk"


@pytest.mark.parametrize("name", ["systems", "diagrams", "models"])
def test_link_at_the_top_leads_into_the_package(name: str) -> None:
    link = ROOT / name
    assert link.is_symlink()
    assert not link.readlink().is_absolute()
    assert link.resolve() == PACKAGE / name
    assert link.is_dir()


def test_data_of_the_package_is_there() -> None:
    package = files("humanwalk")
    assert package.joinpath("py.typed").is_file()
    assert package.joinpath("models/sdf/human.sdf").is_file()
    assert package.joinpath("models/scenarios/thesis.yaml").is_file()


def test_every_data_file_is_declared() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]["humanwalk"]
    data = {
        path.relative_to(PACKAGE)
        for path in PACKAGE.rglob("*")
        if path.is_file() and path.suffix != ".py" and "__pycache__" not in path.parts
    }
    assert [path for path in data if not any(fnmatch(str(path), pattern) for pattern in declared)] == []


def test_every_folder_of_code_is_a_package() -> None:
    folders = {path.parent for path in PACKAGE.rglob("*.py")}
    assert [folder for folder in folders if not (folder / "__init__.py").is_file()] == []


def test_command_is_installed_and_versions_agree() -> None:
    (command,) = entry_points(group="console_scripts", name="humanwalk")
    assert callable(command.load())
    assert version("humanwalk") == tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]


def test_importing_the_scenario_does_not_load_the_application() -> None:
    code = "import sys, humanwalk.scenario; sys.exit(any(m.startswith('humanwalk.run') for m in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
