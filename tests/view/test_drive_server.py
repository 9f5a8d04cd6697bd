"""The page of a driven walk: served on this machine only, with figures that follow the walk."""

import json
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.view.drive_page import START
from humanwalk.view.drive_server import Status, drive_html, drive_policy, served_drive
from humanwalk.view.serve import LOCALHOST, local_server

MESHCAT = "http://localhost:7123"


@pytest.fixture
def shown() -> list[Status]:
    return [START]


@pytest.fixture
def url(shown: list[Status]) -> Iterator[str]:
    with served_drive(MESHCAT, lambda: shown[-1]) as url:
        yield url


def test_the_page_connects_to_the_meshcat_of_the_walk() -> None:
    assert f'url = "{MESHCAT}/";' in drive_html(MESHCAT)
    assert drive_html(MESHCAT).count("<script") == drive_html(MESHCAT).count("</script>")


def test_it_is_served_with_its_script_and_the_present_figures(url: str, shown: list[Status]) -> None:
    for path, media_type in (("", "text/html"), ("meshcat.js", "text/javascript"), ("status", "application/json")):
        with urllib.request.urlopen(url + path) as answer:
            assert answer.headers.get_content_type() == media_type
            assert answer.headers["Content-Security-Policy"].startswith("default-src 'none'")
            content = answer.read()
    assert json.loads(content) == START
    shown.append({**START, "time": 2.5, "state": "fell; reset with R", "ended": True})
    with urllib.request.urlopen(url + "status") as answer:
        assert json.loads(answer.read()) == shown[-1]


def test_it_is_served_on_this_machine_only_and_under_its_own_name(url: str) -> None:
    assert urlsplit(url).hostname == "127.0.0.1"
    for host in ("example.org", f"example.org:{urlsplit(url).port}"):
        with pytest.raises(urllib.error.HTTPError) as error:
            urllib.request.urlopen(urllib.request.Request(url, headers={"Host": host}))
        assert error.value.code == 421
        error.value.close()


@pytest.mark.parametrize(
    ("error", "said"), [(ConnectionResetError(), ""), (BrokenPipeError(), ""), (ValueError("a defect"), "a defect")]
)
def test_a_browser_may_close_its_connection_at_any_time(
    error: Exception, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with local_server({}, "") as server, socket.socket() as request:
        try:
            raise error
        except (ConnectionError, ValueError):
            server.handle_error(request, (LOCALHOST, 1))
    errors = capfd.readouterr().err
    assert said in errors
    assert bool(errors) == bool(said)


def test_the_page_may_connect_to_its_own_meshcat_only() -> None:
    policy = dict(part.split(" ", 1) for part in drive_policy(MESHCAT).split("; "))
    assert policy["default-src"] == "'none'"
    assert policy["connect-src"] == "'self' ws://localhost:7123"


def test_a_port_in_use_is_refused_in_one_line(url: str) -> None:
    port = urlsplit(url).port
    assert port is not None
    with (
        pytest.raises(ParameterError, match=rf"^--port {port}: .*; allowed: a free port; choose another$"),
        served_drive(MESHCAT, lambda: START, port),
    ):
        pass
