"""Serves the replay page of a run to browsers on this machine."""

import threading
import webbrowser
from collections.abc import Sequence
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from rich.console import Console

from humanwalk.quantity import printable
from humanwalk.run.folder import Run
from humanwalk.view.replay import content_policy, safe_page

LOCALHOST = "127.0.0.1"


def serve_replay(runs: Sequence[Path], *, open_browser: bool, console: Console) -> None:
    """Serve a page with the replays of run folders on this machine only, until Ctrl-C; its address is printed.

    Raises:
        ParameterError: A folder contains no run, or a run without a replay.
    """
    page = safe_page([Run.open(run).replay for run in runs])
    with replay_server(page.encode()) as server:
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


def replay_server(page: bytes) -> ThreadingHTTPServer:
    """A server of one page at /, bound to 127.0.0.1 at a free port."""
    return ThreadingHTTPServer((LOCALHOST, 0), partial(_OnePage, page))


class _OnePage(BaseHTTPRequestHandler):
    def __init__(self, page: bytes, *args: object) -> None:
        self._page = page
        super().__init__(*args)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        # Another name that resolves to this machine is a web site's attempt to read the page (DNS rebinding).
        port = self.connection.getsockname()[1]
        if self.headers.get("Host") not in (f"{LOCALHOST}:{port}", f"localhost:{port}"):
            self.send_error(421)
            return
        if self.path != "/":
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self._page)))
        self.send_header("Content-Security-Policy", f"{content_policy()}; frame-ancestors 'none'")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        # The next run may be served at the same port.
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(self._page)

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing: requests are of no interest in the terminal."""
