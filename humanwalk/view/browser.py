"""A replay page in a headless browser without network, which draws any instant of the walk from any side.

What is opened is our own page with the recording of the given one, see `safe_page`. Should a script run in it anyway,
Chromium has no name resolution, no proxy that answers and no direct connection. Its sandbox is on, except for root,
as whom Chromium does not start with it.

Playwright's asynchronous interface drives several browsers from one thread. Its synchronous one would need a thread for
each, and has crashed the interpreter in them.
"""

import asyncio
import base64
import os
import shutil
from collections.abc import AsyncIterator, Coroutine, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from humanwalk.extras import missing_package
from humanwalk.quantity import ParameterError, printable
from humanwalk.view.replay import content_policy, safe_page
from humanwalk.view.views import Camera

if TYPE_CHECKING:
    from playwright.async_api import Browser, Page

CHROMIUM = "CHROMIUM"
"""Environment variable that names the browser, before the names that are looked for."""
BROWSER_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
MACOS_BROWSERS = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)

RENDERING = ("--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist", "--enable-unsafe-swiftshader")
"""Flags for WebGL on the processor, the same picture on every machine: Mesa's, else SwiftShader's, which takes twice as
long."""

MESA = {"EGL_PLATFORM": "surfaceless", "LIBGL_ALWAYS_SOFTWARE": "1"}
"""Environment variables for Mesa to render on the processor, without a display."""

FLAGS = (
    *RENDERING,
    # No network: neither names nor addresses resolve, and all else goes to a proxy that does not exist.
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--proxy-server=http://127.0.0.1:9",
    "--proxy-bypass-list=<-loopback>",
    "--webrtc-ip-handling-policy=disable_non_proxied_udp",
    "--disable-background-networking",
    "--hide-scrollbars",
    "--force-color-profile=srgb",
)

PAGE_URL = "http://replay.invalid/"
"""Address under which the page is handed to the browser; no request is sent."""

DURATION_TOLERANCE = 1e-3
"""Excess of the replay's duration over the run's that is rounding [s]."""

START_TIMEOUT_S = 90.0
"""Time to load the page and its recording; software WebGL is slow on a busy machine."""
STILL_TIMEOUT_S = 60.0

JPEG_QUALITY = 0.93

Format = Literal["jpeg", "png"]

# Runs before the page's scripts: no frame is drawn, in the full quality of the page, until one is wanted.
NO_FRAMES = "window.requestAnimationFrame = () => 0;"

HAS_WEBGL = "() => document.createElement('canvas').getContext('webgl2') !== null"

LOADED_DURATION = "() => String(typeof viewer === 'undefined' ? 0 : viewer.animator.duration)"

# Meshcat's own loop stops: nothing moves or is drawn except when a still is taken, and the canvas is removed from the
# page, which would be composited once more around it.
HOLD = (
    """() => {"""
    + files("humanwalk.view").joinpath("software_rendering.js").read_text(encoding="utf-8")
    + """
    viewer.animate = () => {};
    viewer.set_3d_pane_size(innerWidth, innerHeight);
    viewer.renderer.domElement.remove();
    const floor = viewer.scene.getObjectByName("endless floor");
    if (floor) Object.assign(floor.material.map, {anisotropy: 1, needsUpdate: true});
    cheapScene.simplify(viewer, innerHeight);
    window.humanwalkShow = (time, position, target) => {
        picture.show(time);
        picture.look(position, target);
        viewer.render();
    };
    return true;
}"""
)

STILL = """([time, position, target, type, quality]) => {
    humanwalkShow(time, position, target);
    return viewer.renderer.domElement.toDataURL(type, quality).split(",")[1];
}"""

# Relative to Meshcat's moved scene, which is W; three.js stores matrices by columns.
POSE = """([time, body]) => {
    humanwalkShow(time, [3, -3, 1], [0, 0, 1]);
    const scene = viewer.scene_tree.find(["run0", "drake"]).object;
    const object = viewer.scene_tree.find(["run0", "drake", "visualizer", "human", ...body]).object;
    return scene.matrixWorld.clone().invert().multiply(object.matrixWorld).elements;
}"""


@dataclass(frozen=True)
class Stage:
    """A replay page in a browser, paused.

    Attributes:
        duration: Duration of the replay [s].
        complaints: Warnings and errors that the page logged, and requests that it made; empty if all is well.
    """

    duration: float
    complaints: list[str]
    _page: "Page"

    async def still(self, time: float, camera: Camera, format: Format = "jpeg") -> bytes:
        """The picture of one instant [s], as the bytes of a JPEG or PNG file.

        Raises:
            ParameterError: The browser has crashed or hangs.
        """
        from playwright.async_api import Error

        arguments = [time, list(camera.position), list(camera.target), f"image/{format}", JPEG_QUALITY]
        try:
            return base64.b64decode(await _evaluate(self._page, STILL, arguments, STILL_TIMEOUT_S))
        except Error as error:
            raise ParameterError(f"browser: failed while drawing the frame at {time:g} s: {_line(error)}") from None

    async def pose(self, time: float, *body: str) -> list[float]:
        """X_WB of a body as shown by the page: 16 numbers of a 4x4 matrix, by columns.

        Args:
            time: Instant [s].
            body: Name, or names from the human's down to the geometry's.
        """
        elements: list[float] = await _evaluate(self._page, POSE, [time, list(body)], STILL_TIMEOUT_S)
        return elements


def run_browsers[T](drawing: Coroutine[Any, Any, T]) -> T:
    """Result of a coroutine that uses browsers, in a thread of its own: that of a notebook already runs a loop."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, drawing).result()


@asynccontextmanager
async def open_stage(page: Path, width: int, height: int, max_duration: float) -> AsyncIterator[Stage]:
    """Open the recording of a replay page in a headless browser, which is closed at the end of the block.

    Args:
        page: The HTML file.
        width, height: Size of the picture in pixels.
        max_duration: Duration of the run's replay [s]; a longer recording is refused.

    Raises:
        ParameterError: No Playwright, browser or WebGL, with what to install; or a page that cannot be shown.
    """
    text = safe_page([page])
    async with open_browser() as browser:
        yield await _hold(browser, text, printable(page), width, height, max_duration)


@asynccontextmanager
async def open_browser() -> AsyncIterator["Browser"]:
    """Start a headless Chromium that renders on the processor and has no network.

    Raises:
        ParameterError: No Playwright or no browser, with what to install.
    """
    try:
        from playwright.async_api import Error, async_playwright
    except ImportError:
        raise missing_package("playwright", "video") from None
    async with async_playwright() as playwright:
        options = launch_options()
        try:
            # Ctrl-C is handled between two frames.
            browser = await playwright.chromium.launch(**options, handle_sigint=False)
        except Error as error:
            executable = options["executable_path"]
            if executable is None:
                raise ParameterError(
                    "browser: no Chromium or Chrome found; install one (Debian: apt-get install chromium; anywhere: "
                    f"playwright install chromium), or name it in ${CHROMIUM}"
                ) from None
            raise ParameterError(
                f"browser: {executable} does not start: {_line(error)}; name another Chromium in ${CHROMIUM}"
            ) from None
        try:
            yield browser
        finally:
            # Playwright's process may have ended with the terminal.
            with suppress(Error):
                await browser.close()


def launch_options(flags: Sequence[str] | None = None) -> dict[str, Any]:
    """Arguments of Playwright's `launch` for a Chromium that renders on the processor.

    Args:
        flags: Of Chromium; None for FLAGS, without network.

    Raises:
        ParameterError: $CHROMIUM is not executable.
    """
    return {
        "executable_path": find_browser(),
        "args": FLAGS if flags is None else flags,
        "env": {**os.environ, **MESA},
        "chromium_sandbox": has_sandbox(),
    }


def has_sandbox() -> bool:
    """Whether Chromium runs in its sandbox: always, except as root, as whom it does not start with one."""
    return os.geteuid() != 0


def find_browser() -> str | None:
    """The browser to run: $CHROMIUM, else a known name or place, else None for Playwright's own.

    Raises:
        ParameterError: $CHROMIUM is not executable.
    """
    if named := os.environ.get(CHROMIUM):
        found = shutil.which(named)
        if found is None:
            raise ParameterError(
                f"${CHROMIUM}: {printable(named)} is not a program; allowed: the path of a Chromium or Chrome; "
                "change or unset it"
            )
        return found
    return next(filter(None, map(shutil.which, (*BROWSER_NAMES, *MACOS_BROWSERS))), None)


async def _hold(browser: "Browser", text: str, name: str, width: int, height: int, max_duration: float) -> Stage:
    from playwright.async_api import Error

    tab = await browser.new_page(viewport={"width": width, "height": height}, device_scale_factor=1)
    complaints: list[str] = []

    async def answer(route: Any) -> None:
        if route.request.url == PAGE_URL:
            policy = {"Content-Security-Policy": content_policy()}
            await route.fulfill(body=text, content_type="text/html; charset=utf-8", headers=policy)
        else:
            complaints.append(f"requested {route.request.url}")
            await route.abort()

    def log(message: Any) -> None:
        if message.type in ("error", "warning"):
            complaints.append(f"{message.type}: {message.text}")

    await tab.add_init_script(NO_FRAMES)
    await tab.route("**/*", answer)
    tab.on("pageerror", lambda error: complaints.append(f"error: {error}"))
    tab.on("console", log)
    if not await tab.evaluate(HAS_WEBGL):
        raise ParameterError(
            "browser: no WebGL; allowed: a Chromium with SwiftShader (Debian: apt-get install chromium; anywhere: "
            f"playwright install chromium); name it in ${CHROMIUM}"
        )
    try:
        await tab.goto(PAGE_URL, timeout=1000.0 * START_TIMEOUT_S)
        duration = float(await _evaluate(tab, LOADED_DURATION, None, START_TIMEOUT_S))
    except Error as error:
        raise ParameterError(f"{name}: does not load: {_line(error)}; allowed: a page of `humanwalk walk`") from None
    if not 0.0 < duration <= max_duration + DURATION_TOLERANCE:
        raise ParameterError(
            f"{name}: a recording of {duration:g} s{''.join(f'; {printable(text)}' for text in complaints[:3])}; "
            f"allowed: up to {max_duration:g} s, by the run's summary; walk again"
        )
    await _evaluate(tab, HOLD, None, STILL_TIMEOUT_S)
    return Stage(duration, complaints, tab)


async def _evaluate(tab: "Page", function: str, argument: Any, timeout_s: float) -> Any:
    """Result of a JavaScript function that returns no false value; unlike `Page.evaluate`, with a timeout."""
    result = await tab.wait_for_function(function, arg=argument, polling=100.0, timeout=1000.0 * timeout_s)
    return await result.json_value()


def _line(error: Exception) -> str:
    return next((line for line in str(error).splitlines() if line.strip()), type(error).__name__)
