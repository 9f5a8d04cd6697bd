import _thread
import base64
import hashlib
import io
import math
import os
import re
import signal
import socket
import threading
import urllib.error
import urllib.request
import webbrowser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydrake.geometry import Meshcat
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from rich.console import Console

from humanwalk.diagrams.visualizer import add_visualizer
from humanwalk.diagrams.walker import make_walker
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import REPLAY
from humanwalk.scenario import load_scenario
from humanwalk.sides import Side
from humanwalk.terrain import Plane
from humanwalk.view.replay import MAX_RUNS, Recording, make_meshcat, read_recording, replay_page, safe_page, static_page
from humanwalk.view.samples import CHANNELS
from humanwalk.view.serve import LOCALHOST, replay_server, serve_replay

FRAME_RATE = 32.0
DURATION = 0.25
"""Long enough for a foot to be in the air at the end [s]."""

LISTENING = "0A"
LOOPBACK = {"0100007F", "00000000000000000000000001000000"}
TITLE = 'a "walk" & <more>'


def numbers(times: Sequence[float]) -> str:
    """Samples at times, with zeros in all other channels."""
    samples = np.zeros((len(times), len(CHANNELS)), "<f4")
    samples[:, 0] = times
    return base64.b64encode(samples.tobytes()).decode()


class Elements(HTMLParser):
    def __init__(self, page: str) -> None:
        super().__init__()
        self.found = []
        self.text = {}
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[Any]) -> None:
        self.found.append((tag, dict(attributes)))

    def handle_data(self, data: str) -> None:
        if self.found:
            tag = self.found[-1][0]
            self.text[tag] = self.text.get(tag, "") + data


@pytest.fixture(scope="module")
def meshcat() -> Meshcat:
    return make_meshcat()


@pytest.fixture(scope="module")
def page(meshcat: Meshcat) -> str:
    builder = DiagramBuilder()
    walker = builder.AddSystem(make_walker(load_scenario("thesis")))
    add_visualizer(builder, walker, meshcat, FRAME_RATE, Plane())
    Simulator(builder.Build()).AdvanceTo(DURATION)
    return static_page(meshcat, TITLE)


@pytest.fixture(scope="module")
def animation(page: str) -> bytes:
    """The recorded animation in the page: one msgpack command."""
    commands = [base64.b64decode(code) for code in re.findall(r'"([A-Za-z0-9+/=]{100,})"', page)]
    (animation,) = [command for command in commands if b"set_animation" in command]
    return animation


@pytest.fixture(scope="module")
def elements(page: str) -> Elements:
    return Elements(page)


def listening_addresses(port: int) -> set[str] | set[Any]:
    """Local addresses, in the kernel's hexadecimal, at which a port is listened to."""
    addresses = set()
    for table in (Path("/proc/net/tcp"), Path("/proc/net/tcp6")):
        if not table.exists():
            continue
        for line in table.read_text().splitlines()[1:]:
            _, local, _, state = line.split()[:4]
            address, _, hexadecimal = local.partition(":")
            if state == LISTENING and int(hexadecimal, 16) == port:
                addresses.add(address)
    return addresses


def test_no_element_of_the_page_names_another_file_or_host(elements: Elements) -> None:
    references = [
        attributes[name]
        for _, attributes in elements.found
        for name in ("src", "href", "srcset", "data", "action", "poster")
        if name in attributes
    ]
    assert references
    assert all(reference.startswith("data:") for reference in references)


def test_styles_refer_to_no_file(elements: Elements) -> None:
    assert "url(" not in elements.text["style"]
    assert "@import" not in elements.text["style"]


def test_policy_permits_only_the_scripts_of_the_page_and_no_request(elements: Elements, page: str) -> None:
    (policy,) = [
        attributes["content"]
        for tag, attributes in elements.found
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    ]
    directives = dict(directive.strip().split(" ", 1) for directive in policy.split(";"))
    scripts = re.findall(r'<script(?: type="text/javascript")?>(.*?)</script>', page, re.DOTALL)
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    assert len(hashes) == 6
    assert directives.pop("script-src").split() == [f"'sha256-{digest}'" for digest in hashes]
    assert directives == {
        "default-src": "'none'",
        "style-src": "'unsafe-inline'",
        "img-src": "data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }


def test_page_has_its_title_as_text(elements: Elements) -> None:
    assert elements.text["title"].strip() == TITLE


def test_page_contains_the_recorded_walker_and_the_view_that_follows_it(animation: bytes) -> None:
    for path in (b"/drake/visualizer/human/Pelvis", b"/drake/visualizer/human/LeftLeg_Tibia"):
        assert path in animation
    # A msgpack string is preceded by its length: the scene itself moves, not only what is in it.
    assert b"\xa6/drake" in animation


@pytest.mark.parametrize("side", ["Right", "Left"])
@pytest.mark.parametrize("part", ["", "/head", "/shaft"])
def test_force_arrows_are_recorded_at_every_frame(animation: bytes, side: Side, part: str) -> None:
    """A track that ends before the others would repeat out of step with them."""
    path = f"/drake/foot_force/{side}{part}".encode()
    _, found, track = animation.partition(bytes([0xA0 + len(path)]) + path if len(path) < 32 else path)
    assert found
    clip = track.partition(b"path")[0]
    last_frame = bytes([int(DURATION * FRAME_RATE)])
    assert b"\xa4time" + last_frame in clip


def test_page_has_one_player(elements: Elements) -> None:
    names = [attributes.get("id") for _, attributes in elements.found]
    assert names.count("player") == 1
    assert ("input", "range") in [(tag, attributes.get("type")) for tag, attributes in elements.found]


def test_server_has_only_the_page() -> None:
    with served(b"<p>the walk</p>") as root:
        with urllib.request.urlopen(f"{root}/") as answer:
            assert answer.read() == b"<p>the walk</p>"
            assert answer.headers.get_content_type() == "text/html"
            policy = answer.headers["Content-Security-Policy"]
            assert policy.startswith("default-src 'none'; script-src 'sha256-")
            assert policy.endswith("frame-ancestors 'none'")
        for other in ("/replay.html", "/scenario.yaml", "/../", "/?"):
            with pytest.raises(urllib.error.HTTPError) as error:
                urllib.request.urlopen(root + other)
            assert error.value.code == 404
            error.value.close()


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1", "127.0.0.1.evil.example", ""])
def test_server_refuses_names_of_other_hosts(host: str) -> None:
    """A web site can have its name resolve to 127.0.0.1 to read what is served there."""
    with served(b"<p>the walk</p>") as root:
        with pytest.raises(urllib.error.HTTPError) as error:
            urllib.request.urlopen(urllib.request.Request(root, headers={"Host": host}))
        assert error.value.code == 421
        error.value.close()


@contextmanager
def served(page: bytes) -> Iterator[str]:
    """The address of a running server."""
    with replay_server(page) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()


def test_server_listens_on_the_loopback_only() -> None:
    with replay_server(b"") as server:
        assert server.socket.getsockname()[0] == "127.0.0.1"
        assert server.address_family == socket.AF_INET


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="no /proc/net/tcp to see open ports in")
def test_meshcat_that_does_not_listen_leaves_no_copies_of_open_files(tmp_path: Path) -> None:
    def copies() -> int:
        return sum(os.path.realpath(f"/dev/fd/{name}") == str(file.name) for name in os.listdir("/dev/fd"))

    with open(tmp_path / "open", "wb") as file:
        make_meshcat()
        assert copies() == 1


def test_meshcat_listens_on_the_loopback_only_and_only_when_live(meshcat: Meshcat) -> None:
    assert listening_addresses(meshcat.port()) == set()
    live = make_meshcat(live=True)
    addresses = listening_addresses(live.port())
    assert addresses
    assert addresses <= LOOPBACK


def test_replay_opens_the_page_and_ends_at_ctrl_c(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []

    def browse_and_press_ctrl_c(url: str) -> None:
        with urllib.request.urlopen(url) as answer:
            seen.append(answer.read().decode())
        _thread.interrupt_main()

    monkeypatch.setattr(webbrowser, "open", browse_and_press_ctrl_c)
    # Whoever starts the tests in the background may have made Python deaf to Ctrl-C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    output = io.StringIO()
    try:
        serve_replay([run], open_browser=True, console=Console(file=output))
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [replay_page([Recording("a walk", ["AAAA"])])]
    assert re.search(r"http://127\.0\.0\.1:\d+/", output.getvalue())


def test_replay_does_not_open_the_browser_with_no_browser(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def press_ctrl_c(self: Any, *_: object) -> None:
        raise KeyboardInterrupt

    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr("humanwalk.view.serve.ThreadingHTTPServer.serve_forever", press_ctrl_c)
    serve_replay([run], open_browser=False, console=Console(file=io.StringIO()))
    assert opened == []


def test_a_port_in_use_is_refused(run: Path) -> None:
    with socket.create_server((LOCALHOST, 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(ParameterError, match=rf"--port {port}: .*; allowed: a free port"):
            serve_replay([run], open_browser=False, console=Console(file=io.StringIO()), port=port)


def test_folder_without_run_produces_an_error(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="no run"):
        serve_replay([tmp_path], open_browser=False, console=Console(file=io.StringIO()))


def test_safe_page_of_our_page_is_the_same_page(page: str, tmp_path: Path) -> None:
    (tmp_path / REPLAY).write_text(page, encoding="utf-8")
    assert safe_page([tmp_path / REPLAY]) == page


def test_safe_page_contains_nothing_of_another_page_but_recording_and_title(tmp_path: Path) -> None:
    foreign = "<script>alert(1)</script><img src=http://evil.example/x>"
    title = "&lt;b onload=alert(2)&gt;\x1b]0;evil\x07"
    page = (
        replay_page([Recording("TITLE", ["AAAA", "BBBB"])])
        .replace("TITLE", title)
        .replace("<body>", f"<body>{foreign}")
    )
    (tmp_path / REPLAY).write_text(page.replace("viewer.handle_command =", "evil ="), encoding="utf-8")
    assert safe_page([tmp_path / REPLAY]) == replay_page(
        [Recording(r"<b onload=alert(2)>\x1b]0;evil\x07", ["AAAA", "BBBB"])]
    )


@pytest.mark.parametrize(
    "page",
    [
        "",
        "<html>",
        '<script type="application/json" class="recording">[]</script>',
        '<script type="application/json" class="recording">["<b>"]</script>',
        '<script type="application/json" class="recording">["A" "B"]</script>',
        '<script type="application/json" class="recording">["A"</script>',
    ],
)
def test_page_without_recording_produces_a_one_line_error(page: str, tmp_path: Path) -> None:
    (tmp_path / REPLAY).write_text(page)
    with pytest.raises(ParameterError, match="no recording"):
        safe_page([tmp_path / REPLAY])


def test_page_of_two_runs_has_both_recordings_and_titles(tmp_path: Path) -> None:
    pages = [tmp_path / name for name in ("one.html", "two.html")]
    runs = [Recording("<one>", ["AAAA"]), Recording("two", ["BBBB"], numbers([0.0, 0.1]))]
    for path, run in zip(pages, runs, strict=True):
        path.write_text(replay_page([run]), encoding="utf-8")
    assert [read_recording(path) for path in pages] == runs
    both = safe_page(pages)
    assert both == replay_page(runs)
    assert Elements(both).text["title"].strip() == "<one> | two"
    labels = [attributes["content"] for tag, attributes in Elements(both).found if attributes.get("name") == "run"]
    assert labels == ["<one>", "two"]


@pytest.mark.parametrize("number", [0, MAX_RUNS + 1])
def test_other_numbers_of_runs_are_refused(run: Path, number: int) -> None:
    with pytest.raises(ParameterError, match=rf"{number} runs; allowed: 1 to {MAX_RUNS}"):
        serve_replay([run] * number, open_browser=False, console=Console(file=io.StringIO()))


@pytest.mark.parametrize("samples", ["AAAA", "A", numbers([1e10]), numbers([1.0, 1.0]), numbers([math.nan])])
def test_page_with_wrong_signals_produces_a_one_line_error(samples: str, tmp_path: Path) -> None:
    (tmp_path / REPLAY).write_text(replay_page([Recording("a walk", ["AAAA"], samples)]), encoding="utf-8")
    with pytest.raises(ParameterError, match=r"replay\.html: its signals are not") as error:
        safe_page([tmp_path / REPLAY])
    assert "\n" not in str(error.value)
