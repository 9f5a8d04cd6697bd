"""Serves the replay page of a run to browsers on this machine."""

import sys
import threading
import webbrowser
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from rich.console import Console

from humanwalk.quantity import ParameterError, printable
from humanwalk.run.folder import Run
from humanwalk.view.replay import content_policy, safe_page
from humanwalk.view.replay_file import require_replay

LOCALHOST = "127.0.0.1"
HTML = "text/html; charset=utf-8"


def serve_replay(runs: Sequence[Path], *, open_browser: bool, console: Console, port: int = 0) -> None:
    """Serve a page with the replays of run folders on this machine only, until Ctrl-C; its address is printed.

    A run without a replay gets one from its signals.

    Args:
        runs: Folders.
        open_browser: Whether to open the page.
        console: Where the address is printed.
        port: 0 for a free one.

    Raises:
        ParameterError: A folder contains no run, or the port is in use.
    """
    with console.status("reading"):
        page = safe_page([require_replay(Run.open(run)) for run in runs])
    with replay_server(page.encode(), port) as server:
        url = f"http://{LOCALHOST}:{server.server_port}/"
        names = " and ".join(map(printable, runs))
        console.print(f"replay of {names} at {url} (stop with Ctrl-C)", soft_wrap=True)
        if open_browser:
            # A text browser in this terminal does not return until it is closed.
            threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            console.print("stopped")


def replay_server(page: bytes, port: int = 0) -> ThreadingHTTPServer:
    """A server of one page at /, bound to 127.0.0.1; port 0 is a free one.

    Raises:
        ParameterError: The port cannot be used.
    """
    try:
        return local_server({"/": lambda: (HTML, page)}, content_policy(), port)
    except OSError as error:
        raise ParameterError(
            f"--port {port}: {error.strerror}; allowed: a free port; choose another, or leave it out"
        ) from None


def local_server(
    contents: Mapping[str, Callable[[], tuple[str, bytes]]], policy: str, port: int = 0
) -> ThreadingHTTPServer:
    """A server bound to 127.0.0.1.

    Args:
        contents: By path, functions that return a media type and the bytes; each request calls one.
        policy: Content-Security-Policy of all of them.
        port: 0 for a free one.
    """
    return _Server((LOCALHOST, port), partial(_Handler, contents, policy))


class _Server(ThreadingHTTPServer):
    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing where a browser has closed the connection: it does so at will."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    def __init__(self, contents: Mapping[str, Callable[[], tuple[str, bytes]]], policy: str, *args: object) -> None:
        self._contents, self._policy = contents, policy
        super().__init__(*args)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        # Another name that resolves to this machine is a web site's attempt to read the page (DNS rebinding).
        port = self.connection.getsockname()[1]
        if self.headers.get("Host") not in (f"{LOCALHOST}:{port}", f"localhost:{port}"):
            self.send_error(421)
            return
        if self.path not in self._contents:
            self.send_error(404)
            return
        media_type, content = self._contents[self.path]()
        self.send_response(200)
        self.send_header("Content-Type", media_type)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", f"{self._policy}; frame-ancestors 'none'")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        # The next run may be served at the same port.
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing: requests are of no interest in the terminal."""
