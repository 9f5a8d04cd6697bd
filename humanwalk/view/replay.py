"""The replay of a run: recorded by Meshcat during the simulation, shown with plots by one page that needs no network.

A page that somebody else made is never shown itself: only its recording and its numbers are extracted, and played by
our own page. The page's policy lets no script run but ours, and no request leave it.
"""

import base64
import hashlib
import html
import json
import os
import re
import socket
import stat
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams

from humanwalk.files import read_text
from humanwalk.quantity import ParameterError, printable
from humanwalk.view.samples import CHANNELS, SOLE_OUTLINE, require_samples
from humanwalk.view.views import FIELD_OF_VIEW_DEG, FIXED, camera

MAX_TITLE = 200
"""Longest title of a page [characters]."""

MAX_PAGE_BYTES = 150_000_000
"""Largest replay page that is read; ten minutes at 32 frames per second have 110 MB."""

MAX_RUNS = 2
"""Most runs in one page."""

STATIC_COMMAND = re.compile(r'fetch\("data:application/octet-binary;base64,([A-Za-z0-9+/=]+)"\)[^;]*;\s*')
"""A command in Meshcat's static page: JavaScript that decodes and executes it."""
SCRIPT = re.compile(r'<script(?: type="text/javascript")?>(.*?)</script>', re.DOTALL)
RECORDING_TAG = '<script type="application/json" class="recording">'
RECORDING = re.compile(RECORDING_TAG + r'(\["[A-Za-z0-9+/=", ]+"\])</script>')
"""Data in our page, not JavaScript: commands for Meshcat's viewer, msgpack in base64."""
SAMPLES_TAG = '<script type="application/json" class="samples">'
SAMPLES = re.compile(SAMPLES_TAG + r'"([A-Za-z0-9+/=]*)"</script>')
"""Signals for the plots, see `humanwalk.view.samples`."""
TITLE = re.compile(r"<title>([^<]{0,2000})</title>")

PLACE = "<!-- runs -->"
"""Where the runs are in the page without any."""

PAGE_FILES = ("replay_player.html", "endless_floor.js", "replay_scene.js", "replay_plots.js", "replay_player.js")


@dataclass(frozen=True)
class Recording:
    """A run in a page.

    Attributes:
        title: Shown in the page.
        commands: For Meshcat's viewer, msgpack in base64.
        samples: Signals for the plots, see `humanwalk.view.samples.encode_samples`; empty for none.
    """

    title: str
    commands: Sequence[str]
    samples: str = ""


def make_meshcat(*, live: bool = False) -> Meshcat:
    """A Meshcat with light and camera set for a walker.

    Args:
        live: Whether it listens on this machine for browsers that watch. Without, its port is closed: any web page
            that is open in a browser could connect to it.

    Raises:
        ParameterError: No server can be started.
    """
    meshcat = _quiet_meshcat() if not live else _start_meshcat()
    for path in ("/Grid", "/Axes", "/Lights/SpotLight", "/Lights/PointLightNegativeX", "/Lights/PointLightPositiveX"):
        meshcat.SetProperty(path, "visible", False)
    meshcat.SetProperty("/Background/<object>", "top_color", [0.62, 0.76, 0.90])
    meshcat.SetProperty("/Background/<object>", "bottom_color", [0.95, 0.96, 0.97])
    meshcat.SetProperty("/Lights/AmbientLight/<object>", "intensity", 1.4)
    sun = "/Lights/FillLight/<object>"
    meshcat.SetProperty(sun, "position", [3.0, -2.5, 6.0])
    meshcat.SetProperty(sun, "intensity", 2.2)
    meshcat.SetProperty(sun, "castShadow", True)
    for side in ("width", "height"):
        meshcat.SetProperty(sun, f"shadow.mapSize.{side}", 2048.0)
    # Without a bias the floor shades itself in rings.
    meshcat.SetProperty(sun, "shadow.normalBias", 0.02)
    meshcat.SetCamera(Meshcat.PerspectiveCamera(fov=FIELD_OF_VIEW_DEG, aspect=16 / 9, near=0.1, far=200.0))
    start = camera("follow", 0.0)
    meshcat.SetCameraPose(np.array(start.position), np.array(start.target))
    return meshcat


def static_page(meshcat: Meshcat, title: str = "humanwalk", samples: str = "") -> str:
    """A Meshcat's recording, published, as one HTML page that needs no network.

    Args:
        meshcat: Has recorded.
        title: Of the page.
        samples: See `Recording`.
    """
    meshcat.PublishRecording()
    return replay_page([Recording(title, STATIC_COMMAND.findall(meshcat.StaticHtml()), samples)])


def read_recording(page: Path) -> Recording:
    """The recording in a page that somebody else may have made.

    Raises:
        ParameterError: The file cannot be read, or is not a page of `static_page`.
    """
    text = read_text(page, MAX_PAGE_BYTES)
    found, samples, title = RECORDING.search(text), SAMPLES.search(text), TITLE.search(text)
    try:
        commands = json.loads(found[1] if found else "")
    except ValueError:
        raise _refusal(page, "no recording") from None
    if samples is None:
        raise _refusal(page, "no recording of signals")
    try:
        require_samples(samples[1])
    except ParameterError as error:
        raise _refusal(page, str(error)) from None
    return Recording(printable(html.unescape(title[1]), MAX_TITLE) if title else "", commands, samples[1])


def safe_page(pages: Sequence[Path]) -> str:
    """Our own page with the recordings and titles of pages that somebody else may have made.

    Raises:
        ParameterError: A file cannot be read or is not a page of `static_page`, or there are too many.
    """
    if not 1 <= len(pages) <= MAX_RUNS:
        raise ParameterError(f"replay: {len(pages)} runs; allowed: 1 to {MAX_RUNS}; name fewer")
    return replay_page([read_recording(page) for page in pages])


def replay_page(runs: Sequence[Recording]) -> str:
    """A page that plays recordings at the same time."""
    shell, policy = _shell()
    title = html.escape(" | ".join(run.title for run in runs))
    labels = "".join(f'\n  <meta name="run" content="{html.escape(run.title)}">' for run in runs)
    head = f'<title>{title}</title>\n  <meta http-equiv="Content-Security-Policy" content="{policy}">{labels}'
    data = (
        f'{RECORDING_TAG}{json.dumps(list(run.commands))}</script>\n{SAMPLES_TAG}"{run.samples}"</script>'
        for run in runs
    )
    return shell.replace("<title></title>", head, 1).replace(PLACE, "\n".join(data), 1)


def content_policy() -> str:
    """Content-Security-Policy of every page: no script but ours, no request to any host."""
    return _shell()[1]


@cache
def _shell() -> tuple[str, str]:
    """Meshcat's viewer with our player and no runs, and the policy that permits exactly its scripts."""
    folder = files("humanwalk.view")
    markup, *scripts = (folder.joinpath(name).read_text(encoding="utf-8") for name in PAGE_FILES)
    views = {name: asdict(view) for name, view in FIXED.items()}
    constants = {"views": views, "channels": CHANNELS, "outline": SOLE_OUTLINE}
    data = f'<script type="application/json" id="constants">{json.dumps(constants)}</script>'
    player = "\n".join([markup, PLACE, data, *(f"<script>{script}</script>" for script in scripts)])
    viewer = STATIC_COMMAND.sub("", _quiet_meshcat().StaticHtml())
    viewer = viewer.replace("<title>Drake MeshCat</title>", "<title></title>", 1)
    before, body_end, after = viewer.rpartition("</body>")
    shell = f"{before}{player}\n{body_end}{after}"
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in SCRIPT.findall(shell))
    permitted = " ".join(f"'sha256-{digest}'" for digest in digests)
    return shell, (
        f"default-src 'none'; script-src {permitted}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


def _refusal(page: Path, reason: str) -> ParameterError:
    return ParameterError(f"{printable(page)}: {reason}; allowed: a page that `humanwalk walk` wrote; run it again")


def _start_meshcat() -> Meshcat:
    try:
        return Meshcat(MeshcatParams(host="localhost", show_stats_plot=False))
    except RuntimeError as error:
        raise ParameterError(f"replay: Meshcat does not start: {error}; run with --no-replay") from None


def _quiet_meshcat() -> Meshcat:
    """A Meshcat that records but does not listen: Drake has no option for that, so its port is closed."""
    meshcat = _start_meshcat()
    for descriptor in _listening(meshcat.port()):
        # Meshcat still owns the descriptor: an unconnected socket takes its place.
        with socket.socket() as idle:
            os.dup2(idle.fileno(), descriptor, inheritable=False)
    return meshcat


def _listening(port: int) -> Iterator[int]:
    """File descriptors of this process that listen at a TCP port."""
    for name in os.listdir("/dev/fd"):
        with suppress(OSError):
            if not stat.S_ISSOCK(os.fstat(int(name)).st_mode):
                continue
        with suppress(OSError), socket.socket(fileno=os.dup(int(name))) as candidate:
            listens = candidate.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN)
            if listens and candidate.family in (socket.AF_INET, socket.AF_INET6) and candidate.getsockname()[1] == port:
                yield int(name)
