import asyncio
from collections.abc import Iterator
from typing import Any

import pytest

from humanwalk.run.folder import REPLAY
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.browser import find_browser
from humanwalk.view.replay import make_meshcat, static_page
from humanwalk.view.samples import encode_samples

DURATION = 0.5
"""Of the run that is looked at [s]: one step."""


@pytest.fixture(scope="session")
def browser() -> None:
    """Skips what needs a browser where there is none, or none of the packages that drive it."""
    pytest.importorskip("playwright.sync_api")
    pytest.importorskip("imageio_ffmpeg")
    if find_browser() is None:
        pytest.skip("no Chromium or Chrome on the PATH or in $CHROMIUM")


@pytest.fixture(scope="module")
def loop() -> Iterator[asyncio.Runner]:
    """Runs coroutines of one browser, one after the other."""
    with asyncio.Runner() as runner:
        yield runner


@pytest.fixture(scope="session")
def short_run(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A run with its replay."""
    meshcat = make_meshcat()
    outcome = simulate(load_scenario("thesis", {"duration": str(DURATION), "recording.frame_rate": "50"}), meshcat)
    folder = tmp_path_factory.mktemp("runs") / "short"
    folder.mkdir()
    samples = encode_samples(outcome.signals, outcome.scenario)
    (folder / REPLAY).write_text(static_page(meshcat, "a short walk", samples), encoding="utf-8")
    return outcome.write(folder, "thesis")
