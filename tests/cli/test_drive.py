"""`humanwalk drive`: a folder for every walk that is to be saved; what cannot be driven is refused."""

import os
import signal
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from pydrake.geometry import Meshcat
from rich.console import Console

from humanwalk.cli import drive as module
from humanwalk.cli.drive import drive_and_write
from humanwalk.cli.drive_commands import DURATION
from humanwalk.quantity import ParameterError
from humanwalk.run.reproduce import reproduce
from humanwalk.scenario import load_scenario
from humanwalk.view.drive import wait_for_reset
from humanwalk.view.drive_page import DrivePage, Hand

IDLE = Hand(None, (), 30.0, 1.0, True, True, False, False, False)
PUSH, RESET = replace(IDLE, pushes=(0.0,)), replace(IDLE, reset=True)
UNSAVED = replace(IDLE, record=False)


def script() -> Iterator[Hand]:
    """A walk with a push until a reset, one that is not saved, and one until Ctrl-C."""
    yield from [IDLE, PUSH, IDLE, RESET]
    yield from [UNSAVED, UNSAVED, replace(RESET, record=False)]
    yield from [IDLE, IDLE]
    os.kill(os.getpid(), signal.SIGINT)
    while True:
        yield IDLE


@pytest.fixture
def interruptible() -> Iterator[None]:
    """A process that Ctrl-C reaches: a shell starts background jobs with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def drive(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, interruptible: None) -> Any:
    """Drives the thesis' walker from a page whose controls follow the script."""
    hands = script()

    class ScriptedPage(DrivePage):
        watched = True

        def begin(self, *arguments: Any, **options: Any) -> None:
            pass

        def read(self) -> Hand:
            return next(hands)

    monkeypatch.setattr(module, "DrivePage", ScriptedPage)

    def run(scenario: str = "thesis", overrides: dict[str, str] | None = None, output: Path | None = None) -> Any:
        options: dict[str, Any] = {"browser": False, "port": 0, "record": True, "replay": False, "plots": False}
        return drive_and_write(
            scenario,
            {"duration": "5", **(overrides or {})},
            output or tmp_path / "driven",
            console=Console(quiet=True),
            **options,
        )

    return run


def test_every_walk_that_is_recorded_becomes_a_run(drive: Any, tmp_path: Path) -> None:
    first, last = drive()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["driven", "driven-2"]
    assert (first.path.name, last.path.name) == ("driven", "driven-2")
    assert [run.summary["end"] for run in (first, last)] == ["completed", "completed"]
    assert [len(run.scenario.pushes.given) for run in (first, last)] == [1, 0]
    assert reproduce(first).bits_agree


def test_the_runs_after_the_first_take_the_next_free_names(
    drive: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    (tmp_path / "here-2").mkdir()
    (tmp_path / "here-2" / "mine").touch()
    monkeypatch.chdir(here)
    first, last = drive(output=Path())
    assert (first.path.absolute(), last.path.name) == (here, "here-3")
    assert [path.name for path in (tmp_path / "here-2").iterdir()] == ["mine"]


def test_a_page_that_is_lost_ends_driving_and_every_walk_is_kept(
    drive: Any, monkeypatch: pytest.MonkeyPatch, lose: Callable[[Meshcat], None]
) -> None:
    def wait(page: DrivePage) -> Any:
        lose(page.meshcat)
        return wait_for_reset(page)

    monkeypatch.setattr(module, "wait_for_reset", wait)
    (walk,) = drive(overrides={"duration": "0.03"})
    assert walk.summary["end"] == "completed"


def test_a_recording_without_physics_is_refused_before_anything_is_written(drive: Any, tmp_path: Path) -> None:
    recorded = {"controller": "{recorded: {angles: walk.mot, kinematic: true}}"}
    with pytest.raises(ParameterError, match=r"^drive: a recording without physics"):
        drive(overrides=recorded)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_holds_files_is_refused_before_there_is_a_page(
    humanwalk: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "make_meshcat", lambda **options: pytest.fail("a page"))
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "work").touch()
    code, _, errors = humanwalk("drive", "-o", "mine", "--no-browser")
    assert code == 2
    (line,) = errors.splitlines()
    assert line.startswith("humanwalk: -o mine: holds files already; allowed: a new or empty folder")


@pytest.mark.parametrize("options", [("--set", "duration=7"), ("--duration", "7"), ()])
def test_the_longest_walk_is_that_of_the_options(
    humanwalk: Any, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...]
) -> None:
    durations: list[float] = []
    monkeypatch.setattr(
        module,
        "drive_and_write",
        lambda scenario, overrides, *others, **more: durations.append(load_scenario(scenario, overrides).duration),
    )
    assert humanwalk("drive", *options)[0] == 0
    assert durations == [7.0 if options else DURATION]
