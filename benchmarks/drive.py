"""Real time, first picture and robustness of driven walks.

    python benchmarks/drive.py real_time            # a page in a headless browser, 60 s; needs an idle machine
    python benchmarks/drive.py real_time --external # the same with a page that you open yourself
    python benchmarks/drive.py abrupt --seeds 8     # speeds that jump over their whole range; falls count

`real_time` starts `humanwalk drive walk` and reads the page: time from the command to the first picture, simulated
seconds per second in every second, and the latency of a push. `abrupt` simulates without a page.
"""

import argparse
import os
import random
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

from humanwalk.measures.signals import TIME
from humanwalk.run.folder import Run
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.browser import RENDERING, launch_options
from humanwalk.view.drive_page import FORWARD, SIDEWAYS, START, TURN
from humanwalk.walking.command import CommandParameters

DRIVE = "from humanwalk.cli.main import main; main()"
JUMPS = (0.3, 2.0)
"""Shortest and longest time between two jumps of the speeds [s]."""


def real_time(duration: float, external: bool) -> None:
    from playwright.sync_api import sync_playwright

    with ExitStack() as stack:
        # The browser is open when the command is given.
        playwright = stack.enter_context(sync_playwright())
        chromium = playwright.chromium.launch(**launch_options(RENDERING))
        stack.callback(chromium.close)
        began = time.perf_counter()
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory())) / "run"
        browser = [] if external else ["--no-browser"]
        arguments = ["drive", "walk", "-o", str(folder), "--no-replay", *browser]
        process = subprocess.Popen([sys.executable, "-c", DRIVE, *arguments], stderr=subprocess.PIPE, text=True)
        stack.callback(process.kill)
        assert process.stderr
        url = re.search(r"http://127.0.0.1:\d+/", process.stderr.readline())
        assert url
        width, height = (64, 48) if external else (640, 360)
        tab = chromium.new_page(viewport={"width": width, "height": height})
        tab.goto(url[0])

        def simulated() -> float:
            starting = tab.locator("#state").inner_text() in ("", START["state"])
            return -1.0 if starting else float(tab.locator("#time").inner_text())

        while simulated() < 0.0:
            time.sleep(0.01)
        print(f"first picture {time.perf_counter() - began:.2f} s after the command")
        samples = [(time.perf_counter(), simulated())]
        while samples[-1][1] < duration:
            time.sleep(1.0)
            samples.append((time.perf_counter(), simulated()))
            if len(samples) == 20:
                tab.keyboard.press("Numpad8")
        # A shell's background job ignores Ctrl-C, and passes that on.
        process.send_signal(signal.SIGTERM)
        process.communicate()
        print_factors(samples)
        print_push(Run.open(folder))


def print_factors(samples: list[tuple[float, float]]) -> None:
    """The page is updated every 0.2 s: factors are of five seconds each."""
    (first_clock, first), (last_clock, last) = samples[0], samples[-1]
    parts = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(samples[::5], samples[5::5], strict=False)]
    print(
        f"real-time factor {(last - first) / (last_clock - first_clock):.3f} over {last - first:.0f} s; in parts of "
        f"5 s {min(parts):.3f} to {max(parts):.3f}, standard deviation {statistics.pstdev(parts):.3f}; "
        f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
    )


def print_push(run: Run) -> None:
    """The walker is pushed at a reading of the page, 10 ms before `time`; the record shows when the force acts."""
    force = run["push.force_x_N"]
    for push in run.scenario.pushes.given:
        acts = run[TIME][(abs(force) > 0.0) & (run[TIME] >= push.time - 1e-9)][0]
        print(f"a push read at {push.time - 0.01:.2f} s acts at {acts:.2f} s")


def abrupt(seeds: int, duration: float, rates: float) -> None:
    falls = 0
    for seed in range(seeds):
        draw = random.Random(seed)
        points, now = [], 0.5
        while now < duration - 1.0:
            forward = draw.choice((FORWARD.low, 0.0, 0.7, FORWARD.high))
            sideways, turn = draw.choice((SIDEWAYS.low, 0.0, SIDEWAYS.high)), draw.choice((TURN.low, 0.0, TURN.high))
            points.append(f"{{time: {now:g}, forward: {forward}, sideways: {sideways}, turn: {turn}}}")
            now += draw.uniform(*JUMPS)
        command, default = "controller.balanced.command", CommandParameters()
        changes = {
            f"{command}.points": f"[{', '.join(points)}]",
            f"{command}.acceleration": repr(rates * default.acceleration),
            f"{command}.turn_acceleration": repr(rates * default.turn_acceleration),
            "duration": repr(duration),
        }
        outcome = simulate(load_scenario("stand", changes))
        falls += not outcome.survived
        print(f"seed {seed}: {outcome.end} at {outcome.signals[TIME][-1].as_py():.2f} s", flush=True)
    print(f"{seeds - falls} of {seeds} stay up for {duration:g} s")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", required=True)
    clock = kinds.add_parser("real_time")
    clock.add_argument("--duration", type=float, default=60.0, help="simulated [s]")
    clock.add_argument("--external", action="store_true", help="also open the page in your own browser")
    jumps = kinds.add_parser("abrupt")
    jumps.add_argument("--seeds", type=int, default=8)
    jumps.add_argument("--duration", type=float, default=15.0, help="of each walk [s]")
    jumps.add_argument("--rates", type=float, default=1.0, help="factor of the rates at which commands change")
    options = parser.parse_args()
    if options.kind == "real_time":
        real_time(options.duration, options.external)
    else:
        abrupt(options.seeds, options.duration, options.rates)


if __name__ == "__main__":
    main()
