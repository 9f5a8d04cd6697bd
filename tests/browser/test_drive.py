"""A real browser drives the walker: it speeds up, turns, is pushed; Ctrl-C saves a run that can be reproduced."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.measures.signals import TIME, matrix
from humanwalk.run.folder import Run
from humanwalk.run.reproduce import reproduce
from humanwalk.view.browser import RENDERING, launch_options

pytestmark = pytest.mark.browser

DRIVE = "from humanwalk.cli.main import main; main()"
SETTINGS = (
    "controller.balanced.command.acceleration=2.0",
    "controller.balanced.command.turn_acceleration=2.0",
    "controller.balanced.planner.timing.weight_shift=0.6",
)
"""A walk that is soon under way."""
PATIENCE = 120.0
"""For a step of the test, on a machine that does other things too [s]."""


@pytest.fixture
def drive(browser: None, tmp_path: Path) -> Iterator[Any]:
    """Starts `humanwalk drive`; gives the process, the address of its page and the folder of its run."""
    folder = tmp_path / "driven"
    settings = [argument for setting in SETTINGS for argument in ("--set", setting)]
    arguments = ["drive", "stand", "-o", str(folder), "--no-browser", "--no-plots", "--no-replay", *settings]
    process = subprocess.Popen(
        [sys.executable, "-c", DRIVE, *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"COLUMNS": "200"},
    )
    try:
        assert process.stderr is not None
        url = re.search(r"http://127.0.0.1:\d+/", process.stderr.readline())
        assert url is not None
        yield process, url[0], folder
    finally:
        process.kill()
        process.communicate()


FLOORS = """() => [
    viewer.scene.getObjectByName("endless floor") !== undefined,
    viewer.scene_tree.find(["drake", "visualizer"]).object.children.flatMap(
        node => node.name === "floor" ? [node.visible] : []),
]"""
"""Whether the floor without edge is there, and whether those that Meshcat draws are visible."""


@pytest.fixture
def tab(drive: Any) -> Iterator[Any]:
    """The page in a headless browser."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(**launch_options(RENDERING))
        tab = chromium.new_page(viewport={"width": 400, "height": 720})
        tab.set_default_timeout(1000.0 * PATIENCE)
        tab.goto(drive[1])
        yield tab
        chromium.close()


def value(tab: Any, label: str) -> float:
    """Number that a slider shows."""
    return float(tab.locator("li.cr.number", has_text=label).locator("input").input_value())


def wait_until(tab: Any, condition: Callable[[], bool]) -> None:
    for _ in range(int(10 * PATIENCE)):
        if condition():
            return
        tab.wait_for_timeout(100)
    pytest.fail(f"not within {PATIENCE:g} s; the page shows: {tab.locator('.dg').first.inner_text()}")


def text(tab: Any, name: str) -> str:
    """What the panel shows: speed, factor, time or state."""
    return str(tab.locator(f"#{name}").inner_text())


def test_the_walker_obeys_the_page(drive: Any, tab: Any) -> None:
    process, _, folder = drive
    wait_until(tab, lambda: text(tab, "state") == "standing")
    for key in ("ArrowUp", "ArrowUp", "ArrowUp", "ArrowLeft", "ArrowLeft", "ArrowLeft"):
        tab.keyboard.press(key)
    wait_until(tab, lambda: value(tab, "forward") == pytest.approx(0.3) and value(tab, "turn") == pytest.approx(0.3))
    tab.keyboard.press("KeyW")
    wait_until(tab, lambda: value(tab, "forward") == pytest.approx(0.4))
    wait_until(tab, lambda: float(text(tab, "speed")) > 0.15)
    pushed = float(text(tab, "time"))
    tab.get_by_text("push right (numpad 6)").click()
    wait_until(tab, lambda: float(text(tab, "time")) > pushed + 3.0)
    tab.keyboard.press("Space")
    wait_until(tab, lambda: text(tab, "state") == "paused")
    paused = text(tab, "time")
    tab.wait_for_timeout(500)
    assert text(tab, "time") == paused
    assert tab.evaluate(FLOORS) == [True, [False]]

    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=PATIENCE) == 0
    run = Run.open(folder)
    time = run[TIME]
    # It speeds up, and turns to the left, out of the direction in which it stood.
    velocity = matrix(run.signals, ["com.velocity_x_m_s", "com.velocity_y_m_s"])
    speed = np.hypot(*velocity.T)
    assert speed[time < 0.3].max() < 0.1 < 0.2 < speed[time > time[-1] - 0.5].mean()
    w, z = run["pelvis.quaternion_w"][-1], run["pelvis.quaternion_z"][-1]
    assert 2.0 * np.arctan2(z, w) > 0.1
    # The push acts to the right of where it then faces.
    force = matrix(run.signals, ["push.force_x_N", "push.force_y_N"])
    (given,) = run.scenario.pushes.given
    assert np.hypot(*force.T).max() == pytest.approx(300.0, rel=1e-3)
    assert -np.pi / 2 < given.direction < 0.0
    assert reproduce(run).bits_agree
