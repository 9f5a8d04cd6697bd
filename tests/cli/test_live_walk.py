"""`humanwalk walk --meshcat` where a web page ends the live view."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pydrake.geometry import Meshcat

from humanwalk.cli import walk as module
from humanwalk.run.folder import Run
from humanwalk.run.simulate import simulate


@pytest.fixture
def attacked(monkeypatch: pytest.MonkeyPatch, lose: Callable[[Meshcat], None]) -> None:
    """The live view is lost at 0.1 s."""

    def attack(*arguments: Any, live: Meshcat, on_progress: Callable[[float], None], **options: Any) -> Any:
        def look(time: float) -> None:
            on_progress(time)
            if time == pytest.approx(0.1):
                lose(live)

        return simulate(*arguments, **options, live=live, on_progress=look)  # type: ignore[misc]

    monkeypatch.setattr(module, "simulate", attack)


def test_the_walk_is_saved_with_its_replay_and_one_line_says_why_it_ended(
    humanwalk: Any, attacked: None, tmp_path: Path
) -> None:
    code, _, errors = humanwalk("walk", "thesis", "--meshcat", "--duration", 2, "--no-plots", "-o", "run")
    assert code == 130
    assert errors.count("the live view was lost") == 1
    assert "Traceback" not in errors
    run = Run.open(tmp_path / "run")
    assert run.summary["end"] == "interrupted"
    assert run.replay.is_file()


def test_a_live_view_that_is_lost_before_the_start_leaves_nothing(
    humanwalk: Any, monkeypatch: pytest.MonkeyPatch, lose: Callable[[Meshcat], None], tmp_path: Path
) -> None:
    def attack(*arguments: Any, live: Meshcat, **options: Any) -> Any:
        lose(live)
        return simulate(*arguments, **options, live=live)  # type: ignore[misc]

    monkeypatch.setattr(module, "simulate", attack)
    code, _, errors = humanwalk("walk", "thesis", "--meshcat", "--duration", 1, "-o", "run")
    assert code == 2
    assert "the live view was lost" in errors
    assert not (tmp_path / "run").exists()


def test_a_folder_that_holds_files_is_refused_before_the_address_is_shown(humanwalk: Any, tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "work").touch()
    code, _, errors = humanwalk("walk", "thesis", "--meshcat", "-o", "mine")
    assert code == 2
    (line,) = errors.splitlines()
    assert line.startswith("humanwalk: -o mine: holds files already; allowed: a new or empty folder")
