"""The controls of the replay page, pressed in a browser."""

from collections.abc import Iterator
from typing import Any

import pytest

from humanwalk.view.browser import launch_options
from humanwalk.view.replay import safe_page
from humanwalk.view.samples import CHANNELS
from humanwalk.view.views import FIXED

pytestmark = pytest.mark.browser

FRAME_RATE = 50.0
WIDTH, HEIGHT = 960, 480
"""Wide enough for the plots."""

SEEK = """time => {
    const slider = document.querySelector("#player input");
    slider.value = time;
    slider.dispatchEvent(new Event("input"));
}"""
PELVIS = """run => new THREE.Vector3().setFromMatrixPosition((() => {
    const {object} = viewer.scene_tree.find([`run${run}`, "drake", "visualizer", "human", "Pelvis"]);
    object.updateWorldMatrix(true, false);
    return object.matrixWorld;
})()).toArray()"""
SHOWN_PLOTS = "() => document.querySelector('#plots canvas').toDataURL()"


def opened(browser: Any, pages: Any, complaints: list[str]) -> Any:
    tab = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
    tab.on("pageerror", lambda error: complaints.append(str(error)))
    tab.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    tab.route("**/*", lambda route: route.fulfill(body=safe_page(pages), content_type="text/html; charset=utf-8"))
    tab.goto("http://replay.invalid/")
    return tab


@pytest.fixture(scope="module")
def chromium(short_run: Any) -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(**launch_options())
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def tab(chromium: Any, short_run: Any) -> Iterator[Any]:
    """The page of one run."""
    complaints: list[str] = []
    yield opened(chromium, [short_run.replay], complaints)
    assert complaints == []


@pytest.fixture(scope="module")
def both(chromium: Any, short_run: Any) -> Iterator[Any]:
    """A page with the same run twice."""
    complaints: list[str] = []
    yield opened(chromium, [short_run.replay, short_run.replay], complaints)
    assert complaints == []


def time_of(tab: Any) -> float:
    return float(tab.locator("#player input").input_value())


def test_page_plays_until_it_is_paused(tab: Any) -> None:
    assert tab.locator("#player").get_attribute("data-playing") == "true"
    tab.keyboard.press("Space")
    assert tab.locator("#player").get_attribute("data-playing") == "false"


@pytest.mark.parametrize(("key", "button", "frames"), [("ArrowRight", "#forth", 1), ("ArrowLeft", "#back", -1)])
def test_a_step_is_one_frame_by_key_and_by_button(tab: Any, key: str, button: str, frames: int) -> None:
    tab.evaluate(SEEK, 0.2)
    before = tab.evaluate(PELVIS, 0)
    tab.keyboard.press(key)
    assert time_of(tab) == pytest.approx(0.2 + frames / FRAME_RATE)
    tab.locator(button).click()
    assert time_of(tab) == pytest.approx(0.2 + 2 * frames / FRAME_RATE)
    assert tab.evaluate(PELVIS, 0) != before


def test_without_loop_the_page_stops_at_the_end(tab: Any) -> None:
    tab.keyboard.press("l")
    assert tab.locator("#loop").get_attribute("aria-pressed") == "false"
    tab.locator("#speed").select_option("4")
    tab.evaluate(SEEK, 0.4)
    tab.keyboard.press("Space")
    tab.wait_for_function("() => document.getElementById('player').dataset.playing === 'false'")
    assert time_of(tab) == pytest.approx(0.5)
    tab.locator("#loop").click()
    assert tab.locator("#loop").get_attribute("aria-pressed") == "true"


@pytest.mark.parametrize("name", FIXED)
def test_a_camera_preset_places_the_camera(tab: Any, name: str) -> None:
    tab.locator("#camera").select_option(name)
    x, y, z = FIXED[name].position
    # y is up in three.js.
    assert tab.evaluate("() => viewer.camera.position.toArray()") == pytest.approx([x, z, -y], abs=0.01)


def test_ground_that_rises_lifts_the_camera_out_of_it(tab: Any) -> None:
    tab.evaluate(
        """() => {
            const step = new THREE.Mesh(new THREE.BoxGeometry(4, 4, 1));
            step.name = "ground_test";
            step.position.set(5, 0, 0.5);
            viewer.scene_tree.find(["run0", "drake", "visualizer"]).object.add(step);
        }"""
    )
    heights = {}
    for name in FIXED:
        tab.locator("#camera").select_option(name)
        heights[name] = tab.evaluate("() => viewer.camera.position.y") - FIXED[name].position[2]
    tab.evaluate("() => viewer.scene.getObjectByName('ground_test').removeFromParent()")
    assert heights.pop("front") > 1.0
    assert all(lift == pytest.approx(0.0, abs=1e-9) for lift in heights.values())


def test_turning_the_picture_makes_the_camera_free(tab: Any) -> None:
    tab.locator("#camera").select_option("side")
    before = tab.evaluate("() => viewer.camera.position.toArray()")
    tab.mouse.move(300, 200)
    tab.mouse.down()
    tab.mouse.move(400, 210)
    tab.mouse.up()
    assert tab.locator("#camera").input_value() == "free"
    assert tab.evaluate("() => viewer.camera.position.toArray()") != pytest.approx(before, abs=0.01)


def test_plots_move_with_the_time_and_set_it(tab: Any) -> None:
    tab.evaluate(SEEK, 0.1)
    before = tab.evaluate(SHOWN_PLOTS)
    tab.evaluate(SEEK, 0.4)
    assert tab.evaluate(SHOWN_PLOTS) != before
    tab.locator("#plots canvas").click(position={"x": 60, "y": 100})
    assert time_of(tab) != pytest.approx(0.4, abs=0.01)
    tab.keyboard.press("p")
    assert not tab.locator("#plots").is_visible()
    tab.keyboard.press("p")
    assert tab.locator("#plots").is_visible()


def test_page_has_the_signals_of_the_run(tab: Any, short_run: Any) -> None:
    samples = tab.evaluate(
        """() => {
            const text = JSON.parse(document.querySelector("script.samples").textContent);
            return [...new Float32Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer)].map(String);
        }"""
    )
    column = samples[CHANNELS.index("Right vertical") :: len(CHANNELS)]
    assert [float(value) for value in column] == pytest.approx(
        list(short_run["right_foot.force_z"]), rel=1e-6, abs=1e-3
    )


def test_the_floor_reaches_beyond_meshcats(tab: Any) -> None:
    floor = tab.evaluate(
        """() => {
            const names = [];
            viewer.scene.traverse(object => { if (object.visible && object.isMesh) names.push(object.name); });
            const drawn = viewer.scene_tree.find(["run0", "drake", "visualizer"]).object.children;
            const floors = drawn.filter(node => node.name === "floor");
            return [names.includes("endless floor"), floors.map(node => node.visible)];
        }"""
    )
    assert floor == [True, [False]]


def test_two_runs_stand_side_by_side_or_in_one_place(both: Any) -> None:
    both.keyboard.press("Space")
    both.evaluate(SEEK, 0.3)
    both.locator("#camera").select_option("side")
    # Side by side in the picture: along x.
    first, second = (both.evaluate(PELVIS, run) for run in (0, 1))
    assert second[0] - first[0] == pytest.approx(1.3)
    for arrangement in ("overlaid", "ground"):
        both.locator("#arrangement").select_option(arrangement)
        first, second = (both.evaluate(PELVIS, run) for run in (0, 1))
        assert second == pytest.approx(first, abs=1e-6)
