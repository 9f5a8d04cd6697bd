import shutil
from pathlib import Path

import pytest

from humanwalk.run.folder import REPLAY
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.replay import Recording, replay_page


@pytest.fixture(scope="session")
def short_run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 0.02 s with a replay page that contains no motion."""
    folder = tmp_path_factory.mktemp("short") / "run"
    simulate(load_scenario("thesis", {"duration": "0.02"})).save(folder)
    (folder / REPLAY).write_text(replay_page([Recording("a walk", ["AAAA"])]), encoding="utf-8")
    return folder


@pytest.fixture
def run(short_run_folder: Path, tmp_path: Path) -> Path:
    """A copy of the folder, to change."""
    return shutil.copytree(short_run_folder, tmp_path / "run")
