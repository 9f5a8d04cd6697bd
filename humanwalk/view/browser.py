"""A replay page in a headless browser, which shows any instant of the walk from any side, one still at a time."""

import base64
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NoReturn

from humanwalk.body.skeleton import Vector3
from humanwalk.quantity import ParameterError

if TYPE_CHECKING:
    from playwright.sync_api import Page

CHROMIUM = "CHROMIUM"
"""Environment variable that names the browser, before the names that are looked for."""
BROWSER_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
MACOS_BROWSERS = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)

FLAGS = (
    # Renders on the processor: the same picture on every machine, and no other flags give WebGL without a display.
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--hide-scrollbars",
    "--force-color-profile=srgb",
)

START_TIMEOUT_S = 90.0
"""Until the page must have its walk: software WebGL takes its time on a busy machine."""
STILL_TIMEOUT_S = 60.0

JPEG_QUALITY = 0.93

Format = Literal["jpeg", "png"]

HAS_WEBGL = "() => document.createElement('canvas').getContext('webgl2') !== null"

LOADED = "() => typeof viewer !== 'undefined' && viewer.animator.duration > 0"

# Meshcat's own loop stops: nothing moves or is drawn but when a still is taken, and the canvas leaves the page, which
# would be drawn once more around it. Software WebGL pays for every triangle, highlight and soft shadow: materials are
# dull, shadows hard, on a map just around the walker, and what is small on the picture gets fewer triangles. y is up
# in three.js.
HOLD = """() => {
    viewer.animator.pause();
    viewer.animate = () => {};
    window.requestAnimationFrame = () => 0;
    viewer.set_3d_pane_size(innerWidth, innerHeight);
    viewer.renderer.domElement.remove();
    viewer.renderer.shadowMap.type = 0;
    const round = [8, 12, 16].map(n => new THREE.SphereGeometry(1, n, Math.round(0.75 * n)));
    const pixelsPerMetre = innerHeight / 2.4;
    viewer.scene.updateMatrixWorld(true);
    viewer.scene.traverse(object => {
        if (object.isMesh) {
            const {color, map, transparent, opacity, side} = object.material;
            object.material = new THREE.MeshLambertMaterial({color, map, transparent, opacity, side});
        }
        if (object.isMesh && object.castShadow) {
            object.geometry.computeBoundingSphere();
            const radius = object.geometry.boundingSphere.radius * object.matrixWorld.getMaxScaleOnAxis();
            const size = radius * pixelsPerMetre;
            object.castShadow = size > 12;
            const coarse = size < 5 ? 0 : size < 12 ? 1 : size < 50 ? 2 : 3;
            const {type, parameters: {radius: r, height: h}} = object.geometry;
            if (type === "SphereGeometry" && coarse < 3) object.geometry = round[coarse];
            if (type === "CapsuleGeometry" && coarse < 3)
                object.geometry = new THREE.CapsuleGeometry(r, h, 2 + coarse, 8 + 2 * coarse);
        }
        if (object.isDirectionalLight) {
            const {shadow} = object;
            shadow.map?.dispose();
            shadow.map = null;
            shadow.mapSize.set(1024, 1024);
            Object.assign(shadow.camera, {left: -1.6, right: 1.6, bottom: -1.6, top: 1.6}).updateProjectionMatrix();
        }
    });
    const up = ([x, y, z]) => [x, z, -y];
    window.humanwalkShow = (time, position, target) => {
        viewer.animator.seek(time);
        viewer.camera.position.set(...up(position));
        viewer.controls.target.set(...up(target));
        viewer.render();
    };
    return viewer.animator.duration;
}"""

STILL = """([time, position, target, type, quality]) => {
    humanwalkShow(time, position, target);
    return viewer.renderer.domElement.toDataURL(type, quality).split(",")[1];
}"""

# Relative to Meshcat's moved scene, that is in W; three.js keeps matrices by columns.
POSE = """([time, body]) => {
    humanwalkShow(time, [3, -3, 1], [0, 0, 1]);
    const scene = viewer.scene_tree.find(["drake"]).object;
    const object = viewer.scene_tree.find(["drake", "visualizer", "human", ...body]).object;
    return scene.matrixWorld.clone().invert().multiply(object.matrixWorld).elements;
}"""


@dataclass(frozen=True)
class Camera:
    """Where one looks from, in W moved along with the pelvis: x counts from the pelvis, y and z from the ground's."""

    position: Vector3
    target: Vector3


@dataclass(frozen=True)
class Stage:
    """A replay page that is held still in a browser.

    Attributes:
        duration: of the replay [s].
        complaints: what the page logged as warning or error, and what it asked of another host; empty if all is well.
    """

    duration: float
    complaints: list[str]
    _page: "Page"

    def still(self, time: float, camera: Camera, format: Format = "jpeg") -> bytes:
        """The picture of one instant [s], as the bytes of a JPEG or PNG file.

        Raises:
            ParameterError: the browser ended or hangs.
        """
        from playwright.sync_api import Error

        arguments = [time, list(camera.position), list(camera.target), f"image/{format}", JPEG_QUALITY]
        try:
            return base64.b64decode(self._page.evaluate(STILL, arguments))
        except Error as error:
            raise ParameterError(f"browser: it ended while the frame at {time:g} s was drawn: {_line(error)}") from None

    def pose(self, time: float, *body: str) -> list[float]:
        """X_WB of a body as the page shows it: 16 numbers of a 4x4 matrix, by columns.

        Args:
            time: instant [s].
            body: name, or names down from the human's to the geometry's.
        """
        elements: list[float] = self._page.evaluate(POSE, [time, list(body)])
        return elements


@contextmanager
def open_stage(page: Path, width: int, height: int) -> Iterator[Stage]:
    """Open a replay page in a headless browser; it is closed at the end of the block.

    Args:
        page: the HTML file.
        width, height: of the picture in pixels.

    Raises:
        ParameterError: there is no Playwright, no browser or no WebGL, with what to install.
    """
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError:
        raise ParameterError(missing_extra("playwright")) from None
    # As root, as in most containers, Chromium refuses its sandbox.
    flags = [*FLAGS, "--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else [*FLAGS]
    with sync_playwright() as playwright:
        executable = find_browser()
        try:
            # Ctrl-C is for us to see first: we close the browser when the frame is done.
            browser = playwright.chromium.launch(executable_path=executable, args=flags, handle_sigint=False)
        except Error as error:
            _no_browser(executable, error)
        try:
            yield _hold(browser, page, width, height)
        finally:
            # Playwright's process may be gone with the terminal.
            with suppress(Error):
                browser.close()


def find_browser() -> str | None:
    """The browser to run: $CHROMIUM, else a known name or place, else None for Playwright's own.

    Raises:
        ParameterError: $CHROMIUM names nothing that runs.
    """
    if named := os.environ.get(CHROMIUM):
        found = shutil.which(named)
        if found is None:
            raise ParameterError(
                f"${CHROMIUM}: {named} is no program; allowed: the path of a Chromium or Chrome; mend or unset it"
            )
        return found
    return next(filter(None, map(shutil.which, (*BROWSER_NAMES, *MACOS_BROWSERS))), None)


def missing_extra(package: str) -> str:
    """What to say when a package of the extra `video` is not there."""
    return f"video: the Python package {package} is not installed; install it: pip install 'humanwalk[video]'"


def _hold(browser: Any, page: Path, width: int, height: int) -> Stage:
    from playwright.sync_api import TimeoutError as BrowserTimeout

    tab = browser.new_page(viewport={"width": width, "height": height}, device_scale_factor=1)
    tab.set_default_timeout(1000.0 * STILL_TIMEOUT_S)
    complaints: list[str] = []

    def ask(route: Any) -> None:
        # What the page holds itself never comes here.
        if route.request.url.startswith("file:"):
            route.continue_()
        else:
            complaints.append(f"asked for {route.request.url}")
            route.abort()

    def listen(message: Any) -> None:
        if message.type in ("error", "warning"):
            complaints.append(f"{message.type}: {message.text}")

    tab.route("**/*", ask)
    tab.on("pageerror", lambda error: complaints.append(f"error: {error}"))
    tab.on("console", listen)
    if not tab.evaluate(HAS_WEBGL):
        _no_webgl("it has none")
    tab.goto(page.resolve().as_uri(), wait_until="commit")
    try:
        tab.wait_for_function(LOADED, timeout=1000.0 * START_TIMEOUT_S)
    except BrowserTimeout:
        _no_webgl(f"the page shows no walk after {START_TIMEOUT_S:g} s" + "".join(f"; {text}" for text in complaints))
    return Stage(float(tab.evaluate(HOLD)), complaints, tab)


def _no_browser(executable: str | None, error: Exception) -> NoReturn:
    if executable is not None:
        raise ParameterError(
            f"browser: {executable} does not start: {_line(error)}; name another Chromium in ${CHROMIUM}"
        ) from None
    raise ParameterError(
        "browser: no Chromium or Chrome found; install one (Debian: apt-get install chromium; anywhere: "
        f"playwright install chromium), or name it in ${CHROMIUM}"
    ) from None


def _no_webgl(what: str) -> NoReturn:
    raise ParameterError(
        f"browser: no WebGL: {what}; use a Chromium with SwiftShader (Debian: apt-get install chromium; anywhere: "
        f"playwright install chromium) and name it in ${CHROMIUM}"
    )


def _line(error: Exception) -> str:
    return next((line for line in str(error).splitlines() if line.strip()), type(error).__name__)
