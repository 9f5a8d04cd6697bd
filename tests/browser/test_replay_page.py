import base64
import hashlib
import json
import re
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest

from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.browser import RENDERING
from humanwalk.view.replay import make_meshcat, static_page

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium, chromium-browser or google-chrome on the PATH"),
]

TIMES = (0.12, 0.36)
"""Times of frames at which signals are recorded too [s]."""

WATCH = """
<script>
  const probe = {errors: [], blocked: []};
  for (const name of ["error", "warn"]) {
    const say = console[name];
    console[name] = (...words) => { probe.errors.push(words.join(" ")); say(...words); };
  }
  window.addEventListener("error", event => probe.errors.push(event.message || "a file that did not load"), true);
  window.addEventListener("unhandledrejection", event => probe.errors.push(String(event.reason)));
  document.addEventListener("securitypolicyviolation", event => probe.blocked.push(event.blockedURI));
</script>
"""

LOOK = """
<script>
  (function look() {
    const animator = viewer.animator;
    if (!(animator.duration > 0)) { setTimeout(look, 20); return; }
    const pelvis = viewer.scene_tree.find(["run0", "drake", "visualizer", "human", "Pelvis"]).object;
    probe.playing = document.getElementById("player").dataset.playing === "true";
    probe.durations = animator.actions.map(action => action.getClip().duration);
    probe.frames = TIMES.map(time => {
      picture.show(time);
      viewer.render();
      return {recorded: pelvis.position.toArray(), shown: pelvis.getWorldPosition(new THREE.Vector3()).toArray()};
    });
    probe.requests = performance.getEntriesByType("resource").map(entry => entry.name);
    const answer = document.createElement("pre");
    answer.id = "probe";
    answer.textContent = JSON.stringify(probe);
    document.body.append(answer);
  })();
</script>
"""


@pytest.fixture(scope="module")
def outcome_and_page() -> Any:
    meshcat = make_meshcat()
    outcome = simulate(load_scenario("thesis", {"duration": "0.5", "recording.frame_rate": "50"}), meshcat)
    return outcome, static_page(meshcat)


@pytest.fixture(scope="module")
def probe(outcome_and_page: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """What the page did in a browser: its complaints, its requests, and the pelvis at TIMES."""
    _, page = outcome_and_page
    folder = tmp_path_factory.mktemp("replay")
    look = LOOK.replace("TIMES", json.dumps(TIMES))
    before, body_end, after = page.rpartition("</body>")
    page = before.replace("<head>", "<head>" + WATCH, 1) + look + body_end + after
    # The policy permits only the scripts of the page; this one is the test's.
    (script,) = re.findall(r"<script>(.*?)</script>", look, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    page = page.replace("script-src ", f"script-src 'sha256-{digest}' ", 1)
    (folder / "page.html").write_text(page, encoding="utf-8")
    result = subprocess.run(
        [
            CHROMIUM,  # type: ignore[list-item]
            "--headless",
            "--no-sandbox",
            *RENDERING,
            "--disable-background-networking",
            f"--user-data-dir={folder / 'profile'}",
            "--window-size=320,240",
            "--virtual-time-budget=5000",
            "--dump-dom",
            (folder / "page.html").as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
    )
    found = re.search(r'<pre id="probe">(.*?)</pre>', result.stdout, re.DOTALL)
    assert found, f"the page did not come to play: {result.stderr[-2000:]}"
    return json.loads(found.group(1))


def test_page_logs_no_error(probe: Any) -> None:
    assert probe["errors"] == []


def test_page_requests_nothing(probe: Any) -> None:
    assert probe["blocked"] == []
    assert [url for url in probe["requests"] if not url.startswith(("data:", "blob:"))] == []


def test_page_plays_automatically(probe: Any) -> None:
    assert probe["playing"]


def test_tracks_are_equally_long_so_that_they_repeat_in_step(probe: Any) -> None:
    assert set(probe["durations"]) == {0.5}


def test_pelvis_is_where_it_was_in_the_simulation(probe: Any, outcome_and_page: Any) -> None:
    signals = outcome_and_page[0].signals
    time = signals["time_s"].to_numpy()
    for instant, frame in zip(TIMES, probe["frames"], strict=True):
        (row,) = np.flatnonzero(np.isclose(time, instant, rtol=0.0, atol=1e-9))
        expected = [signals[f"pelvis.{axis}_m"][int(row)].as_py() for axis in "xyz"]
        np.testing.assert_allclose(frame["recorded"], expected, rtol=0.0, atol=1e-6)


def test_view_stays_with_the_walker(probe: Any) -> None:
    travelled = probe["frames"][1]["recorded"][0] - probe["frames"][0]["recorded"][0]
    assert travelled > 0.1
    for frame in probe["frames"]:
        # Meshcat shows z up as three.js' y up; x is the same.
        assert frame["shown"][0] == pytest.approx(0.0, abs=1e-6)
        assert frame["shown"][1] == pytest.approx(frame["recorded"][2], abs=1e-6)
