"""Driving by a scripted hand: pause, single steps, reset, and the sliders that follow the scenario's own command."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

from humanwalk.measures.signals import TIME
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.view.drive import Ended, drive
from humanwalk.view.drive_page import DrivePage, Hand
from humanwalk.view.replay import make_meshcat
from humanwalk.walking.command import Command

IDLE = Hand(None, (), 30.0, 1.0, True, True, False, False, False)


class ScriptedPage(DrivePage):
    """A page whose controls follow a script; by default nothing is pressed."""

    def __init__(self, script: Callable[[str], Hand] = lambda status: IDLE) -> None:
        super().__init__(make_meshcat())
        self.script, self.lines, self.targets = script, list[str](), list[Command]()

    @property
    def watched(self) -> bool:
        return True

    def read(self) -> Hand:
        return self.script(self.lines[-1] if self.lines else "")

    def show(self, time: float, speed: float, factor: float, state: str, *, ended: bool = False) -> None:
        self.lines.append(f"{time:.2f} s: {state}")

    def set_speeds(self, target: Command) -> None:
        self.targets.append(target)


def thesis(duration: float) -> Scenario:
    return load_scenario("thesis", {"duration": repr(duration)})


def in_turn(*hands: Hand) -> Callable[[str], Hand]:
    rest: Iterator[Hand] = iter(hands)
    return lambda status: next(rest, IDLE)


@pytest.fixture(autouse=True)
def always_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("humanwalk.view.drive.SHOW_PERIOD", 0.0)


def test_a_walk_lasts_for_its_duration_and_is_shown() -> None:
    page = ScriptedPage()
    result = drive(thesis(0.05), page)
    assert (result.ended, result.outcome.end, result.record) == (Ended.WALK, "completed", True)
    assert page.lines[0].startswith("0.00 s: ")
    assert page.lines[-1] == "0.05 s: completed; reset with R"
    assert page.targets == []


def test_time_stands_still_during_a_pause_and_goes_on_by_single_frames() -> None:
    pause, step = replace(IDLE, pause=True), replace(IDLE, step=True)
    page = ScriptedPage(in_turn(IDLE, pause, IDLE, IDLE, step, *[IDLE] * 8, pause))
    result = drive(thesis(0.2), page)
    paused = [line for line in page.lines if line.endswith("paused")]
    assert paused[0] == paused[1] == "0.00 s: paused"
    assert result.outcome.end == "completed"
    assert paused[-1] == "0.04 s: paused"
    # The signals have no gap and no row twice.
    time = result.outcome.signals[TIME].to_numpy()
    assert time == pytest.approx([0.01 * i for i in range(21)])


@pytest.mark.parametrize("record", [True, False])
def test_a_reset_ends_a_walk_as_its_duration_would(record: bool) -> None:
    reset = replace(IDLE, reset=True, record=record)
    page = ScriptedPage(in_turn(*[IDLE] * 4, reset))
    result = drive(thesis(5.0), page)
    assert (result.ended, result.outcome.end, result.record) == (Ended.RESET, "completed", record)
    assert result.outcome.scenario.duration == pytest.approx(result.outcome.signals[TIME][-1].as_py())


def test_a_fall_stays_on_the_page_with_its_reason() -> None:
    limp = load_scenario(
        "thesis", {"duration": "5", "controller.thesis.balance.support.enabled": "false", "start.pelvis_lift": "0.5"}
    )
    page = ScriptedPage()
    result = drive(limp, page)
    assert (result.ended, result.outcome.end) == (Ended.WALK, "fell")
    assert " s: fell at " in page.lines[-1]
    assert "likely cause" in page.lines[-1]
    assert page.lines[-1].endswith("; reset with R")


def test_sliders_follow_the_command_of_the_scenario_until_a_hand_moves_them() -> None:
    points = "[{time: 0.02, forward: 0.5}, {time: 0.05, forward: 0.7}, {time: 0.1, forward: 0.9}]"
    scenario = load_scenario("stand", {"duration": "0.12", "controller.balanced.command.points": points})
    hands = [IDLE] * 8 + [replace(IDLE, target=Command(forward=0.1))]
    page = ScriptedPage(in_turn(*hands))
    result = drive(scenario, page)
    assert [target.forward for target in page.targets] == [0.0, 0.5, 0.7]
    recorded: Any = result.outcome.scenario.controller
    assert [point.forward for point in recorded.command.points] == [0.5, 0.7, 0.1]


def test_a_checkpoint_holds_what_was_commanded_so_far() -> None:
    push = replace(IDLE, pushes=(0.0,))
    saved: list[Outcome] = []
    drive(thesis(0.05), ScriptedPage(in_turn(IDLE, IDLE, push)), on_checkpoint=saved.append, checkpoint_period=0.0)
    assert [len(outcome.scenario.pushes.given) for outcome in saved][0::4] == [0, 1]
    assert saved[-1].end == "unfinished"
