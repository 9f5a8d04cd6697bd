"""Driven walks: each is simulated by hand on a page, and saved in a run folder of its own."""

import threading
import webbrowser
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from rich.console import Console

from humanwalk.cli.common import print_warnings
from humanwalk.cli.walk import LOST, illustrate, run_folder, write_or_rescue
from humanwalk.quantity import ParameterError
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD
from humanwalk.run.driven import require_drivable
from humanwalk.run.folder import RUNS, Run
from humanwalk.run.live_view import is_lost
from humanwalk.run.monitor import caught_signals
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.view.drive import Drive, Ended, drive, wait_for_reset
from humanwalk.view.drive_page import DrivePage
from humanwalk.view.drive_server import served_drive
from humanwalk.view.replay import make_meshcat

NAME = "drive"
"""Of driven runs."""


def drive_and_write(
    scenario: str,
    overrides: Mapping[str, str],
    output: Path | None,
    *,
    browser: bool,
    port: int,
    record: bool,
    replay: bool,
    plots: bool,
    console: Console,
    checkpoint_period: float = CHECKPOINT_PERIOD,
) -> list[Run]:
    """Drive a scenario until Ctrl-C or the loss of the page; returns the saved runs, one for each reset and the last.

    Args:
        scenario: Name or path.
        overrides: See `load_scenario`.
        output: Folder of the first run, whose name the others extend by a number; None for the next free ones under
            runs/.
        browser: Whether to open the page.
        port: Of the page; 0 for a free one.
        record: Whether runs are saved unless the page decides otherwise.
        replay, plots: Whether to write them.
        console: Where the address and summaries are printed.
        checkpoint_period: Wall-clock seconds between checkpoints.

    Raises:
        ParameterError: Invalid input.
    """
    loaded = load_scenario(scenario, overrides)
    require_drivable(loaded)
    print_warnings(loaded.warnings, console)
    first = output.absolute() if output else RUNS / NAME
    # An unusable folder is refused before the page opens. Every walk claims its own folder.
    with run_folder(output, first, loaded):
        pass
    page = DrivePage(make_meshcat(live=True))
    runs: list[Run] = []
    with served_drive(page.meshcat.web_url(), lambda: page.status, port) as url:
        console.print(f"drive at {url} (Ctrl-C saves and ends)", soft_wrap=True)
        if browser:
            # A text browser in this terminal does not return until it is closed.
            threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        ended = Ended.RESET
        try:
            while ended is not Ended.INTERRUPT:
                wanted = None if runs else output
                ended, run = _drive_once(loaded, page, wanted, first, record, replay, plots, console, checkpoint_period)
                runs += [run] if run else []
                if ended is Ended.WALK:
                    ended = wait_for_reset(page)
        except RuntimeError:
            if not is_lost(page.meshcat):
                raise
    if is_lost(page.meshcat):
        console.print(LOST, soft_wrap=True)
    return runs


def _drive_once(
    scenario: Scenario,
    page: DrivePage,
    wanted: Path | None,
    otherwise: Path,
    record: bool,
    replay: bool,
    plots: bool,
    console: Console,
    checkpoint_period: float,
) -> tuple[Ended, Run | None]:
    recording = make_meshcat() if replay else None
    with run_folder(wanted, otherwise, scenario) as path:

        def checkpoint(so_far: Outcome) -> None:
            # A disk that is full now may have space at the end.
            with suppress(ParameterError):
                so_far.write(path, NAME)

        def save(walk: Drive) -> None:
            if walk.record:
                write_or_rescue(path, walk.outcome, NAME)
            else:
                for file in path.iterdir():
                    file.unlink()

        walk = drive(scenario, page, recording, record, checkpoint, checkpoint_period, save)
    if not walk.record:
        console.print(f"a walk of {walk.outcome.scenario.duration:.2f} s was not saved")
        return walk.ended, None
    run = Run.open(path)
    with caught_signals() as received:
        illustrate(run, recording, plots=plots, console=console)
    return Ended.INTERRUPT if received else walk.ended, run
