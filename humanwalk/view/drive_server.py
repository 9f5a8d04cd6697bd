"""Serves the page of a driven walk on this machine: Meshcat's page, with the figures of the walk and the keys."""

import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from typing import TypedDict

from pydrake.common import FindResourceOrThrow

from humanwalk.quantity import ParameterError
from humanwalk.view.serve import HTML, LOCALHOST, local_server

PAGE, SCRIPT = "drake/geometry/meshcat.html", "drake/geometry/meshcat.js"
"""Drake's resources: Meshcat's page and its script."""

ADDRESS, TITLE = "url = location.toString();", "<title>Drake MeshCat</title>"
"""What is replaced in the page: Meshcat listens at another port than the server of the page."""


ADDED = ("endless_floor.js", "software_rendering.js", "drive_panel.html")
"""Our part of the page."""


class Status(TypedDict):
    """What the page shows.

    Attributes:
        time: simulated [s].
        speed: of the walker [m/s].
        factor: simulated seconds per second.
        state: gait phase, or why time stands still, or the reason for the end.
        ended: whether the walk is over.
        steers: whether the walker follows a command.
    """

    time: float
    speed: float
    factor: float
    state: str
    ended: bool
    steers: bool


def drive_html(meshcat_url: str) -> str:
    """The page: that of a Meshcat, which is served at `meshcat_url`, with our panel."""
    page = Path(FindResourceOrThrow(PAGE)).read_text(encoding="utf-8")
    floor, rendering, panel = (files("humanwalk.view").joinpath(name).read_text(encoding="utf-8") for name in ADDED)
    for old, new in ((ADDRESS, f'url = "{meshcat_url}/";'), (TITLE, "<title>humanwalk drive</title>")):
        assert old in page, "another Meshcat"
        page = page.replace(old, new, 1)
    before, body_end, after = page.rpartition("</body>")
    return f"{before}<script>{floor}{rendering}</script>{panel}{body_end}{after}"


def drive_policy(meshcat_url: str) -> str:
    """Content-Security-Policy of the page: its scripts and Meshcat's, which evaluates the callbacks of its controls."""
    socket = meshcat_url.replace("http:", "ws:", 1)
    return (
        f"default-src 'none'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; connect-src 'self' {socket}; "
        "style-src 'unsafe-inline'; img-src data: blob:; worker-src blob:; base-uri 'none'; form-action 'none'"
    )


@contextmanager
def served_drive(meshcat_url: str, status: Callable[[], Status], port: int = 0) -> Iterator[str]:
    """Within the block, the page is served; gives its address.

    Args:
        meshcat_url: Address of a Meshcat.
        status: What is to be shown; called in another thread.
        port: 0 for a free one.

    Raises:
        ParameterError: The port is in use.
    """
    page, script = drive_html(meshcat_url).encode(), Path(FindResourceOrThrow(SCRIPT)).read_bytes()
    contents = {
        "/": lambda: (HTML, page),
        "/meshcat.js": lambda: ("text/javascript; charset=utf-8", script),
        "/status": lambda: ("application/json", json.dumps(status()).encode()),
    }
    try:
        server = local_server(contents, drive_policy(meshcat_url), port)
    except OSError as error:
        raise ParameterError(f"--port {port}: {error.strerror}; allowed: a free port; choose another") from None
    with server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://{LOCALHOST}:{server.server_port}/"
        finally:
            server.shutdown()
