"""A replay page that somebody else made reaches no network while it is rendered, and claims no duration of its own."""

import asyncio
import base64
import json
import socket
import struct
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.view.browser import open_browser, open_stage
from humanwalk.view.replay import RECORDING, RECORDING_TAG
from humanwalk.view.views import camera

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 160, 120

SCRIPT = """
const host = "127.0.0.1:PORT", site = "http://" + host;
fetch(site + "/fetch").catch(() => 0);
navigator.sendBeacon(site + "/beacon", "x");
try { new WebSocket("ws://" + host); } catch {}
try { window.open(site + "/popup"); } catch {}
try { new EventSource(site + "/events"); } catch {}
try { new Worker(site + "/worker.js"); } catch {}
try { import(site + "/module.js").catch(() => 0); } catch {}
try { new WebTransport("https://" + host); } catch {}
const peer = new RTCPeerConnection({iceServers: [{urls: "stun:" + host}]});
peer.createDataChannel("x");
peer.createOffer().then(offer => peer.setLocalDescription(offer));
for (const rel of ["preconnect", "dns-prefetch", "prefetch", "stylesheet", "icon", "manifest"])
    document.head.append(Object.assign(document.createElement("link"), {rel, href: site + "/" + rel}));
document.body.append(Object.assign(document.createElement("iframe"), {src: site + "/frame"}));
document.body.append(Object.assign(document.createElement("img"), {src: "http://localhost:PORT/image"}));
document.body.append(Object.assign(document.createElement("img"), {src: "http://[::ffff:7f00:1]:PORT/image"}));
new Image().src = site + "/image";
setTimeout(() => { location = site + "/navigation"; }, 500);
"""

MARKUP = """
<link rel="preconnect" href="http://127.0.0.1:PORT"><link rel="dns-prefetch" href="http://127.0.0.1:PORT">
<img src="http://127.0.0.1:PORT/img"><iframe src="http://127.0.0.1:PORT/iframe"></iframe>
<form action="http://127.0.0.1:PORT/form"></form><meta http-equiv="refresh" content="1;url=http://127.0.0.1:PORT/x">
"""


def packed(value: Any) -> bytes:
    """Msgpack of text, numbers, lists and dictionaries."""
    match value:
        case str():
            raw = value.encode()
            return b"\xdb" + struct.pack(">I", len(raw)) + raw
        case bool():
            return b"\xc3" if value else b"\xc2"
        case int() | float():
            return b"\xcb" + struct.pack(">d", value)
        case list():
            return b"\xdd" + struct.pack(">I", len(value)) + b"".join(map(packed, value))
        case dict():
            items = b"".join(packed(key) + packed(item) for key, item in value.items())
            return b"\xdf" + struct.pack(">I", len(value)) + items
    raise TypeError(value)


def hostile_commands(script: Any, port: Any) -> Any:
    """Commands that Meshcat's viewer would evaluate, insert as HTML, or load an image for."""
    url = f"http://127.0.0.1:{port}/texture.png"
    texture = {
        "metadata": {"version": 4.5, "type": "Object"},
        "images": [{"uuid": "i", "url": url}],
        "textures": [{"uuid": "t", "image": "i", "wrap": [1001, 1001], "repeat": [1, 1]}],
        "geometries": [{"uuid": "g", "type": "SphereGeometry", "radius": 1.0}],
        "materials": [{"uuid": "m", "type": "MeshPhongMaterial", "map": "t"}],
        "object": {"uuid": "o", "type": "Mesh", "geometry": "g", "material": "m"},
    }
    return [
        {"type": "set_control", "name": "a", "callback": script},
        {"type": "set_render_callback", "callback": script},
        {"type": "set_object", "path": "/drake/hostile", "object": texture},
        {"type": "set_property", "path": "/Background/<object>", "property": "environment_map", "value": url},
        {
            "type": "set_property",
            "path": f"/drake/<img src={url} onerror=alert(1)>",
            "property": "visible",
            "value": True,
        },
    ]


def animation(duration: float) -> Any:
    keys = [{"time": frame, "value": [0.0, 0.0, 0.0]} for frame in (0.0, duration)]
    track = {"name": ".position", "type": "vector3", "keys": keys}
    clip = {"fps": 1.0, "name": "default", "tracks": [track]}
    return {
        "type": "set_animation",
        "animations": [{"path": "/drake", "clip": clip}],
        "options": {
            "play": True,
            "loopMode": 2201.0,
            "repetitions": 1.0,
            "autoplay": False,
            "clampWhenFinished": False,
        },
    }


def with_recording(page: Any, commands: Any) -> Any:
    """A page with these commands after its own; with `page` None, a page that contains nothing else."""
    own = json.loads(RECORDING.search(page)[1])  # type: ignore[index]
    added = [base64.b64encode(packed(command)).decode() for command in commands]
    return RECORDING.sub(f"{RECORDING_TAG}{json.dumps(own + added)}</script>", page)


@contextmanager
def listener() -> Iterator[Any]:
    """A port on which TCP connections and UDP packets are collected."""
    seen, done = [], threading.Event()
    with socket.socket() as tcp, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp:
        tcp.bind(("127.0.0.1", 0))
        port = tcp.getsockname()[1]
        udp.bind(("127.0.0.1", port))
        tcp.listen()

        def collect_tcp() -> None:
            while not done.is_set():
                try:
                    connection, _ = tcp.accept()
                except OSError:
                    continue
                with connection:
                    connection.settimeout(1.0)
                    try:
                        seen.append(connection.recv(100))
                    except OSError:
                        seen.append(b"connected")

        def collect_udp() -> None:
            while not done.is_set():
                try:
                    seen.append(udp.recv(100))
                except OSError:
                    continue

        threads = [threading.Thread(target=collect) for collect in (collect_tcp, collect_udp)]
        for plug, thread in zip((tcp, udp), threads, strict=True):
            plug.settimeout(0.1)
            thread.start()
        try:
            yield port, seen
        finally:
            done.set()
            for thread in threads:
                thread.join()


@pytest.fixture
def hostile_page(short_run: Any, tmp_path: Path) -> Any:
    """Writes the page of a short run with scripts, markup and commands that try to reach a port."""

    def write(port: Any) -> Any:
        script = SCRIPT.replace("PORT", str(port))
        page = short_run.replay.read_text(encoding="utf-8")
        begin = page.index("<meta http-equiv")
        page = page[:begin] + page[page.index(">", begin) + 1 :]
        page = page.replace("<body>", f"<body>{MARKUP.replace('PORT', str(port))}<script>{script}</script>", 1)
        path = tmp_path / "hostile.html"
        path.write_text(with_recording(page, hostile_commands(script, port)), encoding="utf-8")
        return path

    return write


def test_hostile_page_is_rendered_without_a_byte_to_the_network(hostile_page: Any, loop: Any) -> None:
    async def render(page: Path) -> list[str]:
        async with open_stage(page, WIDTH, HEIGHT, 0.5) as stage:
            assert stage.duration == pytest.approx(0.5)
            for time in (0.0, 0.25, 0.5):
                assert await stage.still(time, camera("side", time))
            await asyncio.sleep(1.0)
        return stage.complaints

    with listener() as (port, seen):
        complaints = loop.run(render(hostile_page(port)))
        assert seen == []
        # Neither did any script of the page get as far as a request that was blocked.
        assert [text for text in complaints if "/fetch" in text or "/beacon" in text] == []


def test_browser_has_no_network_even_for_scripts_that_run(hostile_page: Any, loop: Any) -> None:
    async def attempted_requests(page: Path) -> list[str]:
        attempts = []
        async with open_browser() as browser:
            tab = await browser.new_page()
            tab.on("request", lambda request: attempts.append(request.url))
            await tab.goto(page.as_uri())
            await asyncio.sleep(3.0)
        return attempts

    with listener() as (port, seen):
        # The listener works.
        socket.create_connection(("127.0.0.1", port)).close()
        attempts = loop.run(attempted_requests(hostile_page(port)))
        for target in ("fetch", "image", "img", "navigation"):
            assert f"http://127.0.0.1:{port}/{target}" in attempts
        assert [data for data in seen if data != b""] == []


@pytest.mark.parametrize("duration", [1e9, float("inf"), float("nan"), -1.0, 0.6])
def test_duration_beyond_that_of_the_run_is_refused(short_run: Any, loop: Any, tmp_path: Path, duration: float) -> None:
    page = tmp_path / "page.html"
    recording = json.dumps([base64.b64encode(packed(animation(duration))).decode()])
    page.write_text(RECORDING.sub(f"{RECORDING_TAG}{recording}</script>", short_run.replay.read_text(encoding="utf-8")))
    with pytest.raises(ParameterError, match=r"page\.html: .*allowed: up to 0\.5 s") as error:
        loop.run(open_stage(page, WIDTH, HEIGHT, 0.5).__aenter__())
    assert str(error.value).isprintable()


@pytest.mark.parametrize(
    "command", [b"\xc1", b"\xdf\xff\xff\xff\xff", packed({"type": "set_object", "path": "/a"}), b""]
)
def test_broken_recording_produces_a_one_line_error(short_run: Any, loop: Any, tmp_path: Path, command: Any) -> None:
    page = tmp_path / "page.html"
    recording = json.dumps([base64.b64encode(command).decode() or "AAAA"])
    page.write_text(RECORDING.sub(f"{RECORDING_TAG}{recording}</script>", short_run.replay.read_text(encoding="utf-8")))
    with pytest.raises(ParameterError, match=r"page\.html: ") as error:
        loop.run(open_stage(page, WIDTH, HEIGHT, 0.5).__aenter__())
    assert str(error.value).isprintable()
